"""Draws meshes side by side, coloured by their signed error: red outside the bone, blue in it."""

import os
import tempfile
from collections.abc import Mapping
from pathlib import Path

import bonemesh
import numpy as np
import pyvista

# The ends of the colours: larger errors look like these.
END_MM = 0.5
WIDTH, HEIGHT = 800, 860
VIEW_FROM = np.array([0.62, -1.0, 0.22])
BACKGROUND = "#edf0f5"
# From in the bone over none to outside it.
COLOURS = np.array(
    [[33, 60, 160], [120, 165, 225], [240, 240, 238], [235, 150, 110], [165, 20, 30]]
)


def colours() -> pyvista.LookupTable:
    """The scale of errors."""
    at = np.linspace(0.0, len(COLOURS) - 1.0, 256)
    mixed = [np.interp(at, range(len(COLOURS)), COLOURS[:, c]) for c in range(3)]
    table = pyvista.LookupTable()
    table.values = np.column_stack([*mixed, np.full(256, 255)]).astype(np.uint8)
    table.scalar_range = (-END_MM, END_MM)
    return table


def coloured(mesh: bonemesh.Mesh, surface: bonemesh.PhantomSurface) -> pyvista.PolyData:
    """The mesh with its error at each vertex."""
    shape = pyvista.PolyData.from_regular_faces(
        mesh.vertices.astype(np.float64), mesh.triangles.astype(np.int64)
    )
    shape["error in mm"] = surface.nearest(mesh.vertices)["distance_mm"]
    return shape


def draw(
    meshes: Mapping[str, bonemesh.Mesh],
    surface: bonemesh.PhantomSurface,
    title: str,
    target: Path,
) -> None:
    """Writes one picture of all meshes."""
    plotter = pyvista.Plotter(
        off_screen=True,
        shape=(1, len(meshes)),
        window_size=(WIDTH * len(meshes), HEIGHT),
        border=False,
    )
    plotter.set_background(BACKGROUND)
    for column, (name, mesh) in enumerate(meshes.items()):
        plotter.subplot(0, column)
        plotter.add_mesh(
            coloured(mesh, surface),
            scalars="error in mm",
            cmap=colours(),
            ambient=0.4,
            diffuse=0.65,
            smooth_shading=False,
            scalar_bar_args={
                "title": f"error in mm {column * ' '}",
                "color": "black",
                "fmt": "%.2f",
                "position_x": 0.25,
                "width": 0.5,
            },
        )
        plotter.add_text(f"{name}\n{title}", font_size=12, color="black")
        shape = plotter.meshes[-1]
        middle = np.array(shape.center)
        plotter.camera.focal_point = middle
        plotter.camera.position = middle + VIEW_FROM * shape.length * 2.0
        plotter.camera.up = (0.0, 0.0, 1.0)
    with tempfile.TemporaryDirectory(dir=target.parent) as scratch:
        made = Path(scratch) / "picture.png"
        plotter.screenshot(made)
        os.replace(made, target)
    plotter.close()
