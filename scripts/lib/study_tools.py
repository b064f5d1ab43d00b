"""Other programs beside ours, from a folder to a mesh: seconds, error on bodies of known shape, topology.

usage: study_tools.py HU [CT_FOLDER]...        prints the table

Each runs as a program of its own, without a screen, on a series that is written for it. Two of them give meshes
in frames of their own, so all are laid on the truth by the middle of the bounding box, mirrored as fits best.
"""

import itertools
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import bonemesh
import numpy as np
from study_report import Cell, Table

HERE = Path(__file__).parent
INVESALIUS = Path("/usr/share/invesalius/app.py")
BODIES = ["sphere-shell", "tube", "box-with-hole", "femur", "head"]
SAMPLES = 4_000
# So many tell which way a mesh in a frame of its own lies, and so far off (mm) is one that needs it.
FEW = 300
MISPLACED_MM = 2.0
MOST_SECONDS = 300


def say(text: str) -> None:
    """Tells who waits."""
    print(f"   {text}", file=sys.stderr, flush=True)


@dataclass(frozen=True)
class Tool:
    """A program that turns a folder into an STL."""

    name: str
    command: Callable[[Path, float, Path], list[str]]


def script(name: str) -> str:
    """A console script of this environment."""
    return str(Path(sys.executable).parent / name)


def ours(*options: str) -> Callable[[Path, float, Path], list[str]]:
    """Our command."""

    def command(folder: Path, hu: float, mesh: Path) -> list[str]:
        return [
            script("bonemesh"),
            "render",
            str(folder),
            "--hu",
            f"{hu:g}",
            "-o",
            str(mesh),
            *options,
        ]

    return command


def dicom2stl(folder: Path, hu: float, mesh: Path) -> list[str]:
    """The program of that name."""
    return [script("dicom2stl"), "-i", f"{hu:g}", "-o", str(mesh), str(folder)]


def slicer(folder: Path, hu: float, mesh: Path) -> list[str]:
    """3D Slicer's default chain through SimpleITK and VTK."""
    return [
        sys.executable,
        str(HERE / "slicer_surface.py"),
        str(folder),
        f"{hu:g}",
        str(mesh),
    ]


def invesalius(folder: Path, hu: float, mesh: Path) -> list[str]:
    """InVesalius on a screen that is none."""
    places = [
        "PYTHONPATH=/usr/lib/invesalius",
        "INVESALIUS_LIBRARY_PATH=/usr/share/invesalius/",
    ]
    program = ["xvfb-run", "-a", "/usr/bin/python3", str(INVESALIUS), "--no-gui"]
    return [
        "env",
        *places,
        *program,
        "-i",
        str(folder),
        "-t",
        f"{hu:g},3071",
        "-e",
        str(mesh),
    ]


def found() -> list[Tool]:
    """Those that are installed."""
    all_tools = [
        Tool("Bonemesh", ours()),
        Tool("Bonemesh, alpha", ours("--method", "alpha")),
        Tool("3D Slicer's default chain", slicer),
        Tool("dicom2stl", dicom2stl),
    ]
    if INVESALIUS.exists() and shutil.which("xvfb-run"):
        all_tools.append(Tool("InVesalius", invesalius))
    return all_tools


def made(tool: Tool, folder: Path, hu: float, mesh: Path) -> tuple[float, str | None]:
    """The seconds it took, and what went wrong."""
    start = time.perf_counter()
    try:
        done = subprocess.run(
            tool.command(folder, hu, mesh),
            check=False,
            capture_output=True,
            text=True,
            timeout=MOST_SECONDS,
        )
    except subprocess.TimeoutExpired:
        return MOST_SECONDS, f"not done after {MOST_SECONDS} s"
    seconds = time.perf_counter() - start
    if done.returncode == 0 and mesh.exists():
        return seconds, None
    lines = (done.stderr or done.stdout).strip().splitlines() or ["no mesh"]
    return seconds, f"failed: {lines[-1][:80]}"


def topology(mesh: bonemesh.Mesh) -> str:
    """Closed, manifold, parts."""
    report = bonemesh.check(mesh)
    faults = [
        f"{report[key]} {word}"
        for key, word in (
            ("boundary_edges", "open edges"),
            ("non_manifold_edges", "non-manifold edges"),
            ("self_intersections", "self-intersections"),
        )
        if report[key]
    ]
    return f"{report['components']} parts; {', '.join(faults) or 'no faults'}"


def error_mm(mesh: bonemesh.Mesh, body: str) -> float:
    """The mean distance of its vertices to the true surface; of a mesh in a frame of its own, laid on it as fits best."""
    truth = bonemesh.PhantomSurface(body)
    points = mesh.vertices.astype(float)[:: max(1, len(mesh.vertices) // SAMPLES)]

    def mean(places: Any) -> float:
        return float(np.abs(truth.nearest(places)["distance_mm"]).mean())

    as_it_lies = mean(points)
    if as_it_lies < MISPLACED_MM:
        return as_it_lies
    true_points = truth.samples(SAMPLES)
    middle = (true_points.min(axis=0) + true_points.max(axis=0)) / 2
    centred = points - (points.min(axis=0) + points.max(axis=0)) / 2
    placings = [
        centred * signs + middle for signs in itertools.product((1, -1), repeat=3)
    ]
    few = max(1, len(points) // FEW)
    best = min(placings, key=lambda places: mean(places[::few]))
    return min(as_it_lies, mean(best))


def on_folder(name: str, folder: Path, hu: float, body: str | None) -> list[list[Cell]]:
    """A row for each program."""
    rows: list[list[Cell]] = []
    for tool in found():
        say(f"{tool.name} on {name}")
        with tempfile.TemporaryDirectory() as scratch:
            target = Path(scratch) / "bone.stl"
            seconds, trouble = made(tool, folder, hu, target)
            if trouble is not None:
                rows.append([name, tool.name, f"{seconds:.1f}", "", "", trouble])
                continue
            mesh = bonemesh.read_mesh(target)
            error = "" if body is None else f"{error_mm(mesh, body):.3f}"
            rows.append(
                [
                    name,
                    tool.name,
                    f"{seconds:.1f}",
                    error,
                    len(mesh.triangles),
                    topology(mesh),
                ]
            )
    return rows


def table_tools(folders: Sequence[Path], hu: float) -> Table:
    """Every program on every body of known shape, and on folders of CT images."""
    rows: list[list[Cell]] = []
    with tempfile.TemporaryDirectory() as scratch:
        for body in BODIES:
            series = bonemesh.write_phantom(body, Path(scratch) / body)["series"]
            rows += on_folder(body, Path(series), hu, body)
    for folder in folders:
        rows += on_folder(folder.name, folder, hu, None)
    missing = (
        ""
        if INVESALIUS.exists()
        else " InVesalius is not installed here (apt-get install invesalius xvfb)."
    )
    return Table(
        "tools",
        f"Other programs at {hu:g} HU, from folder to file",
        ["series", "program", "s", "error (mm)", "triangles", "topology"],
        rows,
        "Seconds are those of the whole program. Errors are mean distances of vertices to the true surface; meshes in "
        f"frames of their own are laid on it first, so a shift does not count.{missing}",
    )


if __name__ == "__main__":
    hu, *folders = sys.argv[1:]
    print(table_tools([Path(folder) for folder in folders], float(hu)).markdown())
