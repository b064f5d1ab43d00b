"""How far a mesh is from the body that it shows, and how much of the body it shows.

The body is a phantom of known shape; `bonemesh.PhantomSurface` finds the nearest point of its true
surface to any point, to 0.005 mm. All lengths are millimetres, coordinates the patient's (LPS).

- **Error.** The distance of the mesh to the truth, at points spread over the mesh's triangles by
  area, so that many small triangles count no more than a large one, and what lies between the
  vertices counts too. Positive errors lie outside the bone (the mesh is too large there), negative
  ones in it. Mean and p95 (19 in 20 points are nearer) are of its size, the signed mean shows a
  mesh that is too large or too small everywhere.
- **Creases.** No scan shows an edge sharp, so errors are also said *away from creases*: without the
  points whose nearest true point lies where the surface turns by more than 25 degrees within 0.8
  slices (at least 1.2 mm), walking from it along the surface in eight directions. This leaves out
  edges, corners and whatever is bent more narrowly than 2.4 times that length.
- **Completeness.** The share of points spread evenly over the true surface that have mesh within
  half a millimetre: thin walls that were lost are no error of the mesh, but they are missing here.
- **Volume.** What the mesh encloses beside what the body holds.
- **Topology.** Of the mesh as it is written, with 32-bit coordinates and equal corners joined.
"""

import itertools
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import bonemesh
import numpy as np
import pyvista

NEAR_MM = 0.5
CREASE_LEAST_MM = 1.2
CREASE_SLICES = 0.8
# Still gives 0.05 percent (see the tests of the phantom crate).
VOLUME_CELL_MM = 0.5

Array = np.ndarray[Any, Any]


@dataclass(frozen=True)
class Truth:
    """What is known of a body."""

    name: str
    surface: bonemesh.PhantomSurface
    volume_mm3: float
    samples: Array

    @classmethod
    def of(cls, name: str, samples: int) -> "Truth":
        """The truth about the phantom called `name`."""
        surface = bonemesh.PhantomSurface(name)
        volume = surface.volume_mm3(cell_mm=VOLUME_CELL_MM)
        return cls(name, surface, volume, surface.samples(samples, seed=1))


def corners(mesh: bonemesh.Mesh) -> Array:
    """`(M, 3, 3)`: the corners of each triangle."""
    return mesh.vertices.astype(np.float64)[mesh.triangles]


def on_mesh(mesh: bonemesh.Mesh, count: int, seed: int = 0) -> tuple[Array, Array]:
    """Points spread over a mesh by area, and the triangle of each."""
    abc = corners(mesh)
    areas = np.linalg.norm(
        np.cross(abc[:, 1] - abc[:, 0], abc[:, 2] - abc[:, 0]), axis=1
    )
    random = np.random.default_rng(seed)
    # At equal steps of area: fewer gaps than by chance.
    steps = (np.arange(count) + random.random(count)) / count * areas.sum()
    chosen = np.searchsorted(np.cumsum(areas), steps).clip(max=len(areas) - 1)
    u, v = random.random((2, count))
    fold = u + v > 1
    u, v = np.where(fold, 1 - u, u), np.where(fold, 1 - v, v)
    a, b, c = abc[chosen].transpose(1, 0, 2)
    return a + u[:, None] * (b - a) + v[:, None] * (c - a), chosen


def spread(errors: Array) -> dict[str, float | int]:
    """Mean, signed mean, p95 and largest size of errors."""
    if len(errors) == 0:
        return {"points": 0}
    sizes = np.abs(errors)
    return {
        "points": len(errors),
        "mean_mm": float(sizes.mean()),
        "signed_mm": float(errors.mean()),
        "p95_mm": float(np.quantile(sizes, 0.95)),
        "max_mm": float(sizes.max()),
    }


def enclosed_mm3(mesh: bonemesh.Mesh) -> float:
    """The volume inside a mesh, whichever way it is turned."""
    a, b, c = corners(mesh).transpose(1, 0, 2)
    return abs(float(np.einsum("ij,ij->", a, np.cross(b, c)))) / 6.0


def completeness(mesh: bonemesh.Mesh, truth: Truth) -> float:
    """Share of the true surface with mesh near it."""
    surface = pyvista.PolyData.from_regular_faces(
        mesh.vertices.astype(np.float64), mesh.triangles.astype(np.int64)
    )
    _, nearest = surface.find_closest_cell(truth.samples, return_closest_point=True)
    away = np.linalg.norm(nearest - truth.samples, axis=1)
    return float((away <= NEAR_MM).mean())


def topology(mesh: bonemesh.Mesh) -> dict[str, Any]:
    """What `bonemesh check` counts."""
    said = bonemesh.check(mesh)
    names = [
        "boundary_edges",
        "non_manifold_edges",
        "non_manifold_vertices",
        "self_intersections",
        "components",
        "printable",
    ]
    return {name: said[name] for name in names}


def crease_mm(slice_mm: float) -> float:
    """How far from a point a turn of the surface makes a crease."""
    return max(CREASE_LEAST_MM, CREASE_SLICES * slice_mm)


def parts(truth: Truth, found: Mapping[str, Array], axis: Array) -> dict[str, Any]:
    """Errors by what the true surface is like: where they come from."""
    errors = found["distance_mm"]
    steep = np.abs(found["normal"] @ axis)
    wall = np.minimum(found["wall_mm"], found["gap_mm"])
    groups = {
        f"structure: {name}": found["structure"] == number
        for number, name in enumerate(truth.surface.structures)
    }
    bands = [0.0, 1.5, 2.5, 4.0, np.inf]
    for low, high in itertools.pairwise(bands):
        groups[f"wall {low} to {high} mm"] = (found["wall_mm"] >= low) & (
            found["wall_mm"] < high
        )
        groups[f"gap {low} to {high} mm"] = (found["gap_mm"] >= low) & (
            found["gap_mm"] < high
        )
        groups[f"{low} to {high} mm of soft tissue before air"] = (
            (found["air_mm"] >= low) & (found["air_mm"] < high) & (high < np.inf)
        )
    broad = np.minimum(wall, found["air_mm"]) > bands[-2]
    for name, chosen in {
        "faces along the slices": steep < 0.3,
        "oblique faces": (steep >= 0.3) & (steep < 0.8),
        "faces towards the next slice": steep >= 0.8,
        "beside air": found["outside_hu"] < -500,
        "beside soft tissue": found["outside_hu"] >= -500,
    }.items():
        groups[name] = chosen
        groups[f"{name}, nothing else within 4 mm"] = chosen & broad
    groups = {n: g & ~found["crease"] for n, g in groups.items()}
    groups["at creases"] = found["crease"]
    return {n: spread(errors[g]) for n, g in groups.items() if g.any()}


def measure(
    mesh: bonemesh.Mesh, truth: Truth, slice_mm: float, samples: int
) -> dict[str, Any]:
    """Everything that is said of one mesh."""
    points, _ = on_mesh(mesh, samples)
    found = truth.surface.nearest(points, crease_mm=crease_mm(slice_mm))
    errors, crease = found["distance_mm"], found["crease"]
    return {
        "triangles": len(mesh.triangles),
        "all": spread(errors),
        "away": spread(errors[~crease]),
        "at_creases": float(crease.mean()),
        "complete": completeness(mesh, truth),
        "volume": enclosed_mm3(mesh) / truth.volume_mm3 - 1.0,
        "topology": topology(mesh),
        "parts": parts(truth, found, np.array([0.0, 0.0, 1.0])),
    }
