"""The thesis's drawn models: volumes of filled clouds, meshing methods on line and cylinder, similarity."""

import itertools
import math
import time
from typing import Any

import bonemesh
import numpy as np
from study_report import Cell, Table
from study_values import METHODS, SIMILARITY, TABLE_3_2, Volumes

Array = np.ndarray[Any, Any]

MM3_IN_CM3 = 1000.0
PIXEL_MM = 0.3515625
THRESHOLD_HU = 600.0
# Phantom, slices, their distance in mm, by the name of the row.
FILLED = {
    "1 cube": ("cube", 100, PIXEL_MM),
    "2 cubes": ("two-cubes", 100, PIXEL_MM),
    "cube with a hole": ("cube-with-hole", 100, PIXEL_MM),
    "1 cube, slices of 0.703 mm": ("cube", 100, 2.0 * PIXEL_MM),
    "1 cube, 50 slices of 0.703 mm": ("cube", 50, 2.0 * PIXEL_MM),
}

LINE_SLICES = (1, 2, 10)
SPACINGS_MM = (1.0, 5.0)
CYLINDER_SLICES = (20, 40, 60)
CYLINDER_ALPHAS_MM = (0.1, 0.5, 1.0, 5.0, 10.0, 20.0)
CYLINDER_PIXEL_MM = 0.4492
WALL_MM = 10 * CYLINDER_PIXEL_MM


def stacked(name: str, slices: int, slice_mm: float) -> bonemesh.Volume:
    """A model of so many equal slices."""
    one = bonemesh.phantom(name)
    matrix = one.patient_from_voxel.copy()
    matrix[:3, 2] *= slice_mm / np.linalg.norm(matrix[:3, 2])
    return bonemesh.Volume(np.repeat(one.hu[:1], slices, axis=0), matrix)


def centres(volume: bonemesh.Volume) -> Array:
    """The centres of all voxels of bone, in mm."""
    k, j, i = np.nonzero(volume.hu > THRESHOLD_HU)
    places = np.column_stack([i, j, k, np.ones(len(i))])
    return (places @ volume.patient_from_voxel.T)[:, :3]


def filled_volumes(
    name: str, slices: int, slice_mm: float
) -> tuple[float, float, float]:
    """In cm3: by the voxels, by a mesh through their centres, by the surface around them."""
    volume = stacked(name, slices, slice_mm)
    points = centres(volume)
    voxel_mm3 = PIXEL_MM**2 * slice_mm
    # Just more than half the diagonal of a voxel, which is every tetrahedron's circumradius.
    alpha_mm = 0.51 * math.sqrt(2.0 * PIXEL_MM**2 + slice_mm**2)
    through = bonemesh.alpha_surface(points, alpha_mm)
    around = bonemesh.render(volume, threshold_hu=THRESHOLD_HU, true_edges=False)
    volumes = [
        len(points) * voxel_mm3,
        bonemesh.check(through)["volume_mm3"],
        around.report["volume_mm3"],
    ]
    first, second, third = (v / MM3_IN_CM3 for v in volumes)
    return first, second, third


def table_3_2() -> Table:
    """Volumes of filled clouds."""
    rows: list[list[Cell]] = []
    for name, model in FILLED.items():
        theirs: Volumes = TABLE_3_2[name]
        rows.append([name, *theirs, *filled_volumes(*model)])
    return Table(
        "table_3_2",
        "Table 3.2: volumes in cm3",
        [
            "model",
            "theory",
            "PyVista (thesis)",
            "Meshmixer (thesis)",
            "PreForm (thesis)",
            "voxels",
            "mesh through the centres",
            "surface around the voxels",
        ],
        rows,
        "A mesh through the centres of n slices is one slice short and one pixel narrow: 0.99 cubed of a cube of 100. "
        "The thesis's meshes lack the slice but not the pixel, since its squares are drawn with one more. "
        "The thesis prints 21.73 for the cube with a hole; three quarters of the cube are 32.59, and why its mesh has less "
        "its text does not say. The surface around the voxels has the volume in every case.",
    )


def table_similarity() -> Table:
    """Figure 3.9: how alike the normals of a line and of a parabola are."""
    x = np.arange(0.0, 100.0, 2.0)
    shapes = {"line": 10.0 * x, "parabola": -((x - 50.0) ** 2)}
    rows: list[list[Cell]] = []
    for name, y in shapes.items():
        points = np.column_stack([x, y, np.zeros_like(x)])
        inside = bonemesh.normal_similarity(points)
        space = bonemesh.normal_similarity(points, normals="space")
        rows.append([name, SIMILARITY[name], space, inside])
    return Table(
        "figure_3_9",
        "Figure 3.9: similarity of normals",
        [
            "shape",
            "thesis (normals in space)",
            "here, normals in space",
            "here, normals in the slice's plane",
        ],
        rows,
        "All points of a slice lie in one plane, so what principal components find in space is the plane's own normal, "
        "up or down by chance: the figure is a count of signs (20 of 50 turned over give 0.52), and of a line, where "
        "not even that direction is unique, rounding. In the plane and without a sign a line is 1 and a parabola less.",
    )


def state(mesh: bonemesh.Mesh) -> str:
    """What a mesh is, in a few words."""
    report = bonemesh.check(mesh)
    kind = (
        "closed" if report["watertight"] else f"{report['boundary_edges']:,} open edges"
    )
    parts = report["components"]
    return f"{kind}, {parts:,} {'part' if parts == 1 else 'parts'}"


def made(volume: bonemesh.Volume, method: str, **options: Any) -> list[Cell]:
    """Triangles, volume, state and seconds of a method; or why there is no mesh."""
    begun = time.perf_counter()
    try:
        mesh = bonemesh.render(
            volume, threshold_hu=THRESHOLD_HU, method=method, **options
        )
    except bonemesh.BonemeshError as refused:
        return [None, None, f"refused: {str(refused).split(';')[0]}", None]
    seconds = time.perf_counter() - begun
    volume_cm3 = mesh.report["volume_mm3"] / MM3_IN_CM3
    return [len(mesh.triangles), volume_cm3, state(mesh), seconds]


def table_line() -> Table:
    """Figures 3.11 to 3.14: every method on the line model."""
    rows: list[list[Cell]] = []
    for method, slice_mm, slices in itertools.product(
        bonemesh.methods(), SPACINGS_MM, LINE_SLICES
    ):
        volume = stacked("line", slices, slice_mm)
        theirs = METHODS.get(method, "not tried") if slices == LINE_SLICES[-1] else ""
        rows.append([method, slice_mm, slices, *made(volume, method), theirs])
    head = ["method", "spacing (mm)", "slices", "triangles", "cm3", "mesh", "s"]
    return Table(
        "line",
        "Figures 3.11 to 3.14: methods on the line model",
        [*head, "thesis"],
        rows,
        "Agrees: nothing but tetrahedra (all, or up to alpha) and surfaces of the volume gives the line a body. "
        "Alpha here keeps whole tetrahedra alone, so one slice, which has none, is refused where VTK draws a flat sheet.",
    )


def table_cylinder() -> Table:
    """Figures 3.15 and 3.16: tetrahedra and the volume's surfaces on the hollow cylinder."""
    rows: list[list[Cell]] = []
    methods = ("tetrahedra", "alpha", "labelled", "isosurface")
    for method, slice_mm, slices in itertools.product(
        methods, SPACINGS_MM, CYLINDER_SLICES
    ):
        theory = cylinder_cm3(slices * slice_mm)
        cells = made(stacked("cylinder", slices, slice_mm), method)
        rows.append([method, slice_mm, slices, *cells, theory])
    head = ["method", "spacing (mm)", "slices", "triangles", "cm3", "mesh", "s"]
    return Table(
        "cylinder",
        "Figures 3.15 and 3.16: methods on the hollow cylinder",
        [*head, "drawn cm3"],
        rows,
        "Agrees: without alpha the cylinder is solid. Labelled tetrahedra and the isosurface have the volume that is drawn; "
        "one alpha for all makes holes where slices lie nearer than edges are apart, and webs where they do not.",
    )


def table_alphas() -> Table:
    """Figures 3.17 to 3.20: what alpha does to the cylinder."""
    rows: list[list[Cell]] = []
    for slice_mm, alpha_mm in itertools.product(SPACINGS_MM, CYLINDER_ALPHAS_MM):
        volume = stacked("cylinder", 10, slice_mm)
        cells = made(volume, "alpha", alpha_mm=alpha_mm)
        rows.append([slice_mm, alpha_mm, *cells, cylinder_cm3(9 * slice_mm)])
    return Table(
        "alphas",
        "Figures 3.17 to 3.20: alpha on a cylinder of 10 slices",
        [
            "spacing (mm)",
            "alpha (mm)",
            "triangles",
            "cm3",
            "mesh",
            "s",
            "cm3 between the slices",
        ],
        rows,
        "Agrees: slices join once alpha reaches their distance, both sides of the wall once it reaches the wall's "
        f"{WALL_MM:.1f} mm, and beyond that chords begin to cross the bore.",
    )


def cylinder_cm3(height_mm: float) -> float:
    """Of the hollow cylinder as its pixels are drawn."""
    image = bonemesh.phantom("cylinder").hu[0] > THRESHOLD_HU
    area_mm2 = np.count_nonzero(image) * CYLINDER_PIXEL_MM**2
    return float(area_mm2 * height_mm / MM3_IN_CM3)
