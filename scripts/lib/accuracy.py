"""Measures every method and its peers on bodies of known shape and writes the tables.

usage: accuracy.py --out DIR [--quick] [--methods A,B] [--bodies A,B] [--settings A,B] [--hu A,B]
                   [--samples N] [--no-peers] [--no-picture] [--resume]

`accuracy.md`, `accuracy.json` and `heat_map.png` go to the folder `--out`; rows are also written to
`rows.jsonl` as they are measured, from where `--resume` takes them. The metric is described in accuracy_metric.py.
"""

import argparse
import itertools
import json
import sys
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import bonemesh
import vtk
from accuracy_engines import Engine, engines
from accuracy_heat_map import draw
from accuracy_metric import NEAR_MM, Truth, measure
from accuracy_table import markdown
from bench_machine import machine

BODIES = ["sphere-shell", "tube", "box-with-hole", "femur", "head"]
QUICK_BODIES = ["sphere-shell", "tube", "box-with-hole"]
THRESHOLDS_HU = [200.0, 250.0, 300.0, 400.0, 500.0, 650.0, 800.0]
QUICK_HU = [250.0, 400.0, 800.0]
HEAT_MAP_HU = 350.0
# What makes a row different from the others.
NAMES = ["setting", "body", "hu", "engine"]


@dataclass(frozen=True)
class Setting:
    """How a scanner is set: thick slices of fine pixels, the usual, thin slices with more noise."""

    name: str
    pixel_mm: float
    slice_mm: float
    psf_px: float
    noise_hu: float

    def scan(self, body: str) -> bonemesh.Volume:
        """A scan of the phantom."""
        lengths = {"pixel_mm": self.pixel_mm, "slice_mm": self.slice_mm}
        return bonemesh.phantom(
            body, **lengths, psf_px=self.psf_px, noise_hu=self.noise_hu, seed=0
        )


SETTINGS = [
    Setting("0.5/1.5 mm", 0.5, 1.5, 0.8, 15.0),
    Setting("0.35/2.5 mm", 0.35, 2.5, 1.1, 10.0),
    Setting("0.45/0.625 mm", 0.45, 0.625, 0.7, 30.0),
]


def say(text: str) -> None:
    """Tells who waits."""
    print(f"   {text}", file=sys.stderr, flush=True)


def listed(text: str) -> list[str]:
    """Words between commas."""
    return [word.strip() for word in text.split(",") if word.strip()]


def parsed() -> argparse.Namespace:
    """The command line."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--samples", type=int)
    for word in ["--methods", "--bodies", "--settings", "--hu"]:
        parser.add_argument(word, type=listed, default=[])
    for word in ["--quick", "--no-peers", "--no-picture", "--resume"]:
        parser.add_argument(word, action="store_true")
    words = parser.parse_args()
    words.bodies = words.bodies or (QUICK_BODIES if words.quick else BODIES)
    usual = QUICK_HU if words.quick else THRESHOLDS_HU
    words.hu = [float(hu) for hu in words.hu] or usual
    words.samples = words.samples or (5_000 if words.quick else 20_000)
    return words


def settings(words: argparse.Namespace) -> list[Setting]:
    """Those that were asked for, by the beginning of their names."""
    if not words.settings:
        return SETTINGS[:1] if words.quick else SETTINGS
    chosen = [s for s in SETTINGS if any(s.name.startswith(n) for n in words.settings)]
    if not chosen:
        known = ", ".join(s.name for s in SETTINGS)
        raise SystemExit(f"error: there is no such setting; choose from: {known}")
    return chosen


def row(
    engine: Engine, volume: bonemesh.Volume, hu: float, truth: Truth, samples: int
) -> dict[str, Any]:
    """One mesh, or why there is none."""
    try:
        mesh, seconds = engine.make(volume, hu)
        slice_mm = volume.spacing_mm[2]
        return {"seconds": seconds, **measure(mesh, truth, slice_mm, samples)}
    except (bonemesh.BonemeshError, ValueError) as refused:
        return {"error": str(refused)}


def rows(
    words: argparse.Namespace, chosen: Sequence[Engine], known: Sequence[dict[str, Any]]
) -> Iterator[dict[str, Any]]:
    """All meshes that are not `known`, body by body."""
    done = {tuple(row[name] for name in NAMES) for row in known}
    for body in words.bodies:
        truth = Truth.of(body, words.samples)
        for setting in settings(words):
            volume = setting.scan(body)
            for hu, engine in itertools.product(words.hu, chosen):
                if (setting.name, body, hu, engine.name) in done:
                    continue
                found = row(engine, volume, hu, truth, words.samples)
                line = found.get("error") or found["away"]
                say(f"{setting.name} {body} {hu:g} HU {engine.name}: {line}")
                yield {
                    "setting": setting.name,
                    "body": body,
                    "hu": hu,
                    "engine": engine.name,
                    "is_ours": engine.is_ours,
                    **found,
                }


def how(words: argparse.Namespace) -> str:
    """What was measured."""
    scans = "; ".join(
        f"{s.name}: blur {s.psf_px:g} pixels, noise {s.noise_hu:g} HU"
        for s in settings(words)
    )
    return (
        f"Errors at {words.samples} points of each mesh; complete is the share of {words.samples} points of the "
        f"true surface with mesh within {NEAR_MM:g} mm. Scans: {scans}."
    )


def main() -> None:
    """Measures, writes, draws."""
    words = parsed()
    chosen = engines(words.methods, not words.no_peers)
    kept = words.out / "rows.jsonl"
    lines = kept.read_text("utf-8").splitlines() if words.resume else []
    found = [json.loads(line) for line in lines]
    with kept.open("a" if words.resume else "w", encoding="utf-8") as file:
        for each in rows(words, chosen, tuple(found)):
            found.append(each)
            file.write(f"{json.dumps(each)}\n")
            file.flush()
    place = machine()
    versions = f"Bonemesh {bonemesh.__version__}, VTK {vtk.vtkVersion.GetVTKVersion()}"
    said = (
        f"{place['processor']}, {place['cores']} cores, {place['system']}; {versions}."
    )
    text = markdown(found, said, how(words))
    (words.out / "accuracy.md").write_text(text, encoding="utf-8")
    data = {
        "machine": place,
        "settings": [asdict(s) for s in settings(words)],
        "samples": words.samples,
        "rows": found,
    }
    (words.out / "accuracy.json").write_text(
        json.dumps(data, indent=1), encoding="utf-8"
    )
    if not words.no_picture:
        draw_pair(words, chosen)


def draw_pair(words: argparse.Namespace, chosen: Sequence[Engine]) -> None:
    """Our best beside 3D Slicer's engine, on the last body."""
    body, setting = words.bodies[-1], settings(words)[0]
    surface, volume = bonemesh.PhantomSurface(body), setting.scan(body)
    own = [e for e in chosen if e.is_ours and e.name != "alpha"] or list(chosen[:1])
    slicer = [e for e in chosen if not e.is_ours][-1:]
    shown = {e.name: e.make(volume, HEAT_MAP_HU)[0] for e in [own[0], *slicer]}
    title = f"{body}, {setting.name}, {HEAT_MAP_HU:g} HU"
    draw(shown, surface, title, words.out / "heat_map.png")


if __name__ == "__main__":
    main()
