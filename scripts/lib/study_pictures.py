"""The study's pictures: clouds, meshes coloured by distance, histograms."""

import os
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import bonemesh
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
import pyvista
from matplotlib.figure import Figure

Array = np.ndarray[Any, Any]

BACKGROUND = "#edf0f5"
VIEW_FROM = (0.62, -1.0, 0.22)
SIDE_PX = 520
DPI = 110
# The ends of a heat map's colours: so many of a hundred distances are below it.
END_PERCENT = 95.0


def keep(figure: Figure, target: Path) -> None:
    """The whole file or none."""
    with tempfile.TemporaryDirectory(dir=target.parent) as scratch:
        made = Path(scratch) / "picture.png"
        figure.savefig(made, dpi=DPI, bbox_inches="tight")
        os.replace(made, target)
    plt.close(figure)


def clouds(points: Mapping[str, Array], target: Path) -> None:
    """Clouds of one slice beside one another."""
    figure, axes = plt.subplots(
        1, len(points), figsize=(3.2 * len(points), 3.4), squeeze=False
    )
    for axis, (name, places) in zip(axes[0], points.items(), strict=True):
        axis.plot(places[:, 0], places[:, 1], ".", markersize=2, color="#213ca0")
        axis.set_title(f"{name}\n{len(places):,} points", fontsize=8)
        axis.set_aspect("equal")
        axis.invert_yaxis()
        axis.tick_params(labelsize=6)
    keep(figure, target)


def histograms(distances_mm: Mapping[str, Array], target: Path) -> None:
    """How often each distance occurs."""
    end = max(np.percentile(np.abs(d), 99.0) for d in distances_mm.values())
    figure, axis = plt.subplots(figsize=(6.0, 3.6))
    for name, values in distances_mm.items():
        axis.hist(
            values,
            bins=120,
            range=(-end, end),
            histtype="step",
            density=True,
            label=name,
        )
    axis.set_xlabel("signed distance to the mesh of all points (mm)")
    axis.set_ylabel("share of vertices per mm")
    axis.legend(fontsize=7)
    keep(figure, target)


def lines(
    series: Mapping[str, tuple[Sequence[float], Sequence[float]]], target: Path
) -> None:
    """Distance by percentage kept."""
    figure, axis = plt.subplots(figsize=(6.0, 3.6))
    for name, (percents, values) in series.items():
        axis.plot(percents, values, "o-", label=name, markersize=3)
    axis.set_xlabel("points kept (%)")
    axis.set_ylabel("distance at the middles of edges (mm)")
    axis.legend(fontsize=7)
    keep(figure, target)


def meshes(
    shown: Mapping[str, tuple[bonemesh.Mesh, Array | None]],
    target: Path,
    view_from: tuple[float, float, float] = VIEW_FROM,
) -> None:
    """Meshes beside one another, coloured by signed distance where there is one."""
    known = [np.abs(d) for _, d in shown.values() if d is not None]
    end = max((float(np.percentile(d, END_PERCENT)) for d in known), default=1.0)
    columns = min(len(shown), 3)
    rows = -(-len(shown) // columns)
    plotter = pyvista.Plotter(
        off_screen=True,
        shape=(rows, columns),
        window_size=(SIDE_PX * columns, SIDE_PX * rows),
        border=False,
    )
    plotter.set_background(BACKGROUND)
    for number, (name, (mesh, distance_mm)) in enumerate(shown.items()):
        plotter.subplot(number // columns, number % columns)
        shape = pyvista.PolyData.from_regular_faces(
            mesh.vertices.astype(np.float64), mesh.triangles.astype(np.int64)
        )
        options: dict[str, Any] = {"color": "#cdb88c"}
        if distance_mm is not None:
            shape["mm"] = distance_mm
            bar = {"title": f"mm {number * ' '}", "color": "black", "fmt": "%.2f"}
            options = {"scalars": "mm", "cmap": "coolwarm", "clim": (-end, end)}
            options |= {"scalar_bar_args": bar}
        plotter.add_mesh(shape, ambient=0.3, diffuse=0.7, **options)
        plotter.add_text(name, font_size=9, color="black")
        middle = np.array(shape.center)
        plotter.camera.focal_point = middle
        plotter.camera.position = middle + np.array(view_from) * shape.length * 2.0
        plotter.camera.up = (0.0, 0.0, 1.0)
    with tempfile.TemporaryDirectory(dir=target.parent) as scratch:
        made = Path(scratch) / "picture.png"
        plotter.screenshot(made)
        os.replace(made, target)
    plotter.close()
