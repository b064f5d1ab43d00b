"""What is measured, and the rows that come of it."""

import hashlib
import subprocess
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path

from bench_process import Measured, Program, in_turn, run
from bench_programs import (
    CGAL,
    DEFAULT,
    ENGINES,
    HXT,
    ONE_THREAD,
    OURS,
    PUBLISHED,
    SLICER,
    THREADS,
    Tools,
    write_random_points,
    write_raw_points,
)
from bench_table import Row, at_least, at_most, faster, same

PHANTOM = "phantom head"
SKULL = "philips-skull"

RANDOM_POINTS = 1_000_000
RANDOM_ALPHA = "0.0086"
"""Keeps about half of the cells of that many points in a unit cube."""

HEAD_SLICES = [70, 140, 280, 560]
CGAL_BAR = 2
PEAK_BARS_MB = {OURS: 700, DEFAULT: 1000}
GROWTH_BAR = 2.2
THREADS_BAR = 1.7
NUMBERS_OF_THREADS = [1, 2, 3, 8]
SKULL_BARS = {HXT: 5, "neighbours": 5, "edges": 10, "total": 25}


def measure_folder(
    tools: Tools, folder: str, hu: str, runs: int, scratch: Path
) -> Measured:
    """Every program on the images in a folder and on the points of their edges."""
    cloud, points = scratch / "cloud.npy", scratch / "cloud.f64"
    run([tools.bonemesh, "cloud", folder, "--hu", hu, "--json", "-o", str(cloud)])
    write_raw_points(cloud, points)
    ours, *others = tools.on_folder(folder, hu, scratch)
    return in_turn([ours, *tools.on_points(points), *others], runs)


def theirs(measured: Measured, peer: str, *keys: str) -> float | str:
    """A peer's median, or why it has none."""
    median = measured.median(peer, *keys)
    return measured.absent.get(peer, "-") if median is None else median


def tetrahedra_rows(name: str, measured: Measured) -> list[Row]:
    """Delaunay and alpha beside each engine."""
    seconds = measured.ours(OURS, "seconds", "tetrahedra")
    bars = {CGAL: CGAL_BAR} | (SKULL_BARS if name == SKULL else {})
    work = f"Delaunay + alpha, {titled(name, measured)}"
    rows = [
        faster(work, seconds, peer, theirs(measured, peer, "seconds"), bars.get(peer))
        for peer in ENGINES
    ]
    other = theirs(measured, PUBLISHED, "seconds", "tetrahedra")
    return [*rows, faster(work, seconds, "PyVista/VTK, with alpha", other)]


def surface_row(name: str, measured: Measured) -> Row:
    """The surface and its check on top, beside the same bare Delaunay."""
    seconds = sum(measured.ours(OURS, "seconds", s) for s in ("tetrahedra", "surface"))
    work = f"Delaunay + alpha + surface, {titled(name, measured)}"
    return faster(work, seconds, CGAL, theirs(measured, CGAL, "seconds"))


def titled(name: str, measured: Measured) -> str:
    """The data's name with the number of its points."""
    return f"{name}, {measured.ours(OURS, 'points'):,.0f} points"


def line_rows(name: str, measured: Measured) -> list[Row]:
    """The other steps, and the whole line, beside the published method's."""
    bars = SKULL_BARS if name == SKULL else {}
    steps = {
        "neighbours": ("mean distance to 100 neighbours", "SciPy's KDTree"),
        "edges": ("Canny of every slice", "scikit-image"),
        "total": ("`render --method alpha`, folder to STL", PUBLISHED),
    }
    rows = []
    for step, (work, peer) in steps.items():
        ours = measured.ours(OURS, "seconds", step)
        other = theirs(measured, PUBLISHED, "seconds", step)
        rows.append(faster(f"{work}, {name}", ours, peer, other, bars.get(step)))
    return [*rows, peak_row(name, measured, OURS, "`render --method alpha`", PUBLISHED)]


def default_rows(name: str, measured: Measured) -> list[Row]:
    """The default surface beside 3D Slicer's, which is not even asked to write its file."""
    other: float | str | None = measured.median(SLICER, "seconds", "total")
    if other is None:
        other = measured.absent.get(SLICER, "-")
    else:
        other -= theirs(measured, SLICER, "seconds", "write")
    ours = measured.ours(DEFAULT, "seconds", "total")
    work = f"`render`, folder to STL, {name}"
    speed = faster(work, ours, SLICER, other, 1 if name == SKULL else None)
    return [speed, peak_row(name, measured, DEFAULT, "`render`", SLICER)]


def peak_row(name: str, measured: Measured, own: str, work: str, peer: str) -> Row:
    """Peak memory of a whole line."""
    ours = measured.ours(own, "peak_mb")
    other = measured.median(peer, "peak_mb")
    bar = PEAK_BARS_MB[own] if name == SKULL else None
    return Row(
        f"peak memory of {work}, {name}",
        f"{ours:.0f} MB",
        peer,
        measured.absent.get(peer, "-") if other is None else f"{other:.0f} MB",
        None if other is None else other / ours,
        f"at most {bar} MB" if bar else "",
        ours <= bar if bar else None,
    )


def thread_rows(
    name: str, tools: Tools, folder: str, hu: str, measured: Measured, scratch: Path
) -> list[Row]:
    """One thread beside two, and the bytes of what 1, 2, 3 and 8 make."""
    one, two = (measured.ours(p, "seconds", "tetrahedra") for p in (ONE_THREAD, OURS))
    work = f"Delaunay + alpha, {name}, 1 thread -> {THREADS}"
    speed = at_least(work, f"{one:.3g} -> {two:.3g} s", one / two, THREADS_BAR)
    bytes_of = {"STL of method alpha": tools.alpha, "STL": tools.render}
    equal = [
        bytes_row(f"bytes of the {what}, {name}", render, folder, hu, scratch)
        for what, render in bytes_of.items()
    ]
    return [speed, *equal]


def bytes_row(
    work: str, render: Callable[..., list[str]], folder: str, hu: str, scratch: Path
) -> Row:
    """Whether different numbers of threads make the same file."""
    digests = set()
    for threads in NUMBERS_OF_THREADS:
        mesh = scratch / "bytes.stl"
        run(render(folder, hu, mesh, threads))
        digests.add(hashlib.sha256(mesh.read_bytes()).digest())
    equal = len(digests) == 1
    said = "equal" if equal else "different"
    numbers = ", ".join(map(str, NUMBERS_OF_THREADS))
    return Row(f"{work}, {numbers} threads", said, bar="equal", met=equal)


def measure_random(tools: Tools, runs: int, scratch: Path) -> Measured:
    """The whole triangulation of random points."""
    points = scratch / "random.f64"
    write_random_points(points, RANDOM_POINTS)
    return in_turn(tools.on_random_points(points, RANDOM_ALPHA), runs)


def random_rows(measured: Measured) -> list[Row]:
    """Without ties there is one Delaunay triangulation: counts must be equal."""
    work = f"Delaunay, {RANDOM_POINTS:,} random points"
    ours = measured.ours(OURS, "seconds")
    rows = [
        faster(work, ours, CGAL, theirs(measured, CGAL, "seconds"), 1, is_goal=True)
    ]
    kinds = {"cells": "tetrahedra", "alpha_cells": f"tetrahedra, R <= {RANDOM_ALPHA}"}
    for key, kind in kinds.items():
        count = measured.ours(OURS, key)
        rows.append(same(f"{work}: {kind}", count, CGAL, theirs(measured, CGAL, key)))
    return rows


def measure_growth(tools: Tools, hu: str, runs: int, scratch: Path) -> Measured:
    """The same head in more and more slices."""
    programs = []
    for slices in HEAD_SLICES:
        folder = scratch / f"head_{slices}"
        scan = [str(tools.examples / "head_in_slices"), str(slices), str(folder)]
        subprocess.run(scan, check=True, stdout=subprocess.DEVNULL)
        mesh = scratch / "grown.stl"
        command = tools.alpha(str(folder / "dicom"), hu, mesh, THREADS)
        programs.append(Program(grown(slices), command, is_peer=False))
    return in_turn(programs, runs)


def grown(slices: int) -> str:
    """The name of the program that renders so many slices."""
    return f"{OURS}, {slices} slices"


def growth_rows(measured: Measured) -> list[Row]:
    """Time and memory of twice the slices."""
    rows = []
    for few, many in pairwise(HEAD_SLICES):
        for what, unit, keys in [
            ("time", "s", ["seconds", "total"]),
            ("peak memory", "MB", ["peak_mb"]),
        ]:
            less, more = (measured.ours(grown(n), *keys) for n in (few, many))
            work = (
                f"{what} of `render --method alpha`, {PHANTOM}, {few} -> {many} slices"
            )
            said = f"{less:.3g} -> {more:.3g} {unit}"
            rows.append(at_most(work, said, more / less, GROWTH_BAR))
    return rows
