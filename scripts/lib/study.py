"""The published study, repeated on a CT series or on a phantom head.

usage: study.py --out DIR [--series UID|N] [--hu HU] [CT_FOLDER]...

The first folder is studied; other programs are tried on all of them.

`study.md`, a CSV file for each table and the pictures go to the folder `--out`.
"""

import argparse
import sys
import time
from pathlib import Path
from typing import Any

import bonemesh
import numpy as np
import study_model_pictures
import study_models
import study_pictures
import study_sampling
import study_targeted
import study_tools
from bench_machine import machine
from study_report import Picture, Report
from study_sampling import Study
from study_values import TABLE_3_4, TABLE_3_5

Array = np.ndarray[Any, Any]

SKULL_HU = 350.0
CURVED_SIGMA = 3.0
CURVED_PERCENTS = (10.0, 5.0, 2.5)
# Grid, cut-offs and percentages of the curved shape's own experiments.
CURVED_TARGETED = {
    "experiment 1": (10, TABLE_3_5[1].cutoffs, TABLE_3_5[1].percentages),
    "experiment 2": (30, TABLE_3_5[2].cutoffs, TABLE_3_5[2].percentages),
    "experiment 5": (10, TABLE_3_5[5].cutoffs, TABLE_3_5[5].percentages),
    "grid 5, cut-offs to 1": (5, (0.0, 0.95, 0.99, 1.0), (10.0, 15.0, 20.0, 25.0)),
}
HEAT_PERCENTS = (10, 30, 50, 90)


def say(text: str) -> None:
    """Tells who waits."""
    print(f"   {text}", file=sys.stderr, flush=True)


def parsed() -> argparse.Namespace:
    """The command line."""
    parser = argparse.ArgumentParser()
    parser.add_argument("folders", type=Path, nargs="*", metavar="CT_FOLDER")
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--series")
    parser.add_argument("--hu", type=float, default=SKULL_HU)
    return parser.parse_args()


def volume(words: argparse.Namespace) -> bonemesh.Volume:
    """The series, or the phantom head."""
    if not words.folders:
        return bonemesh.phantom("head")
    series = words.series
    chosen = int(series) if series is not None and series.isdecimal() else series
    return bonemesh.read_series(words.folders[0], chosen)


def models(report: Report) -> None:
    """What needs no scan."""
    report.heading("Models drawn in pixels")
    for table in (
        study_models.table_3_2,
        study_models.table_similarity,
        study_models.table_line,
        study_models.table_cylinder,
        study_models.table_alphas,
    ):
        say(table.__name__)
        report.add(table())
    say("pictures of the models")
    for picture in study_model_pictures.pictures(report.folder):
        report.add(picture)
    say("curved shape")
    report.add(curved(report.folder))
    report.add(curved_targeted(report.folder))
    report.add(study_targeted.table_curved(curved_slice()))
    say("femur")
    report.add(study_targeted.table_femur())


def curved_slice() -> Array:
    """The points of one slice of the curved shape, from its grey image."""
    scan = bonemesh.phantom("curved")
    points = bonemesh.point_cloud(scan, sigma=CURVED_SIGMA, frame="image")
    return points[points[:, 2] == points[0, 2]]


def curved(folder: Path) -> Picture:
    """Figures 3.35 to 3.37: even sampling of the curved shape."""
    points = curved_slice()
    shown = {"all": points}
    for sampler in ("thesis-uniform", "uniform"):
        for percent in CURVED_PERCENTS:
            kept = bonemesh.sample(points, percent=percent, sampler=sampler)
            shown[f"{sampler}\n{percent:g} %"] = points[kept]
    study_pictures.clouds(shown, folder / "curved_even.png")
    return Picture(
        "curved_even.png",
        "Figures 3.35 to 3.37: the curved shape, sampled evenly (below 10 per cent the published sampler keeps nothing)",
    )


def curved_targeted(folder: Path) -> Picture:
    """Figures 3.38 to 3.40: targeted sampling of the curved shape."""
    points = curved_slice()
    shown = {}
    for name, (grid_px, cutoffs, percentages) in CURVED_TARGETED.items():
        kept = bonemesh.sample(
            points,
            sampler="thesis-targeted",
            grid_px=grid_px,
            cutoffs=cutoffs,
            percentages=percentages,
        )
        shown[f"thesis-targeted\n{name}"] = points[kept]
    for percent in CURVED_PERCENTS:
        kept = bonemesh.sample(points, percent=percent, sampler="targeted")
        shown[f"targeted\n{percent:g} %"] = points[kept]
    study_pictures.clouds(shown, folder / "curved_targeted.png")
    return Picture(
        "curved_targeted.png", "Figures 3.38 to 3.40: the curved shape, targeted"
    )


def sampling(report: Report, scan: bonemesh.Volume, hu: float) -> None:
    """What is done to the scan's cloud."""
    study = Study.of(scan, hu)
    report.heading(
        f"Sampling {len(study.points):,} points of the scan, bone above {hu:g} HU"
    )
    for table in (
        study_sampling.table_3_4,
        study_sampling.table_3_5,
        study_sampling.table_3_6,
        study_sampling.table_3_7,
        study_sampling.regression,
        study_sampling.table_3_8,
    ):
        say(table.__name__)
        report.add(table(study))
    say("pictures")
    for picture in pictures(report.folder, study):
        report.add(picture)


def pictures(folder: Path, study: Study) -> list[Picture]:
    """Figures 3.29 to 3.34: distances as colours, histograms and lines."""
    samplers = ("thesis-uniform", "uniform", "targeted")
    series = {
        name: (
            [study.sampled(name, p).percent for p in TABLE_3_4],
            [study.sampled(name, p).midpoint_mm for p in TABLE_3_4],
        )
        for name in samplers
    }
    study_pictures.lines(series, folder / "distances.png")
    shown: dict[str, tuple[bonemesh.Mesh, Array | None]] = {}
    apart: dict[str, Array] = {}
    for percent in HEAT_PERCENTS:
        for name in ("thesis-uniform", "uniform"):
            mesh = study.sampled(name, percent).mesh
            # Points of the cloud lie on the full mesh: what is between them is not.
            middles = mesh.vertices[mesh.triangles].mean(axis=1)
            distance = bonemesh.signed_distances(middles, study.full)
            shown[f"{name}, {percent} %"] = (mesh, distance)
            apart[f"{name}, {percent} %"] = distance
    study_pictures.meshes(shown, folder / "heat_maps.png")
    study_pictures.histograms(apart, folder / "histograms.png")
    return [
        Picture("distances.png", "Distance to the mesh of all points by what is kept"),
        Picture(
            "heat_maps.png",
            "Figures 3.29 to 3.34: distance of triangles' middles to the mesh of all points",
        ),
        Picture("histograms.png", "How often each of these distances occurs"),
    ]


def main() -> None:
    """Measures and writes, part by part."""
    words = parsed()
    words.out.mkdir(parents=True, exist_ok=True)
    begun = time.perf_counter()
    scan = volume(words)
    what = words.folders[0].name if words.folders else "a phantom head"
    report = Report(words.out, f"The published study, repeated on {what}")
    place = machine()
    report.text(
        f"{place['processor']}, {place['cores']} cores, {place['system']}; Bonemesh {bonemesh.__version__}. Values of the "
        "thesis (E. Rier, MASc thesis, McMaster University) stand beside ours; its skull (Skull2) is not public, so trends can "
        "be compared, not values."
    )
    models(report)
    sampling(report, scan, words.hu)
    report.heading("Other programs")
    report.add(study_tools.table_tools(words.folders, words.hu))
    report.text(f"Made in {time.perf_counter() - begun:.0f} s.")
    report.save()


if __name__ == "__main__":
    main()
