"""Delaunay tetrahedra: SciPy's in general position, exact on lattices."""

from __future__ import annotations

import itertools

import bonemesh
import numpy as np
import pytest
from scipy.spatial import ConvexHull, Delaunay


def as_set(cells: np.ndarray) -> set[tuple[int, ...]]:
    return {tuple(sorted(map(int, cell))) for cell in cells}


def doubled(points: np.ndarray, cells: np.ndarray) -> np.ndarray:
    """Six times the signed volume of each cell; exact for whole numbers."""
    a, b, c, d = (points[cells[:, i]] for i in range(4))
    u, v, w = b - a, c - a, d - a
    return (
        u[:, 0] * (v[:, 1] * w[:, 2] - v[:, 2] * w[:, 1])
        - u[:, 1] * (v[:, 0] * w[:, 2] - v[:, 2] * w[:, 0])
        + u[:, 2] * (v[:, 0] * w[:, 1] - v[:, 1] * w[:, 0])
    )


def in_general_position() -> dict[str, np.ndarray]:
    random = np.random.default_rng(7)
    ball = random.normal(size=(2000, 3))
    thick_shell = ball / np.linalg.norm(ball, axis=1)[:, None]
    thick_shell = thick_shell * random.uniform(30, 36, (2000, 1))
    return {
        "a box": random.random((3000, 3)),
        "a ball": ball,
        "a shell": thick_shell,
        "a flat box": random.random((1500, 3)) * [1000, 1, 30],
        "away from the origin": random.random((500, 3)) * 90 + 300,
        "few": random.random((4, 3)),
        "five": random.random((5, 3)),
    }


@pytest.mark.parametrize("name", in_general_position())
def test_the_same_tetrahedra_as_scipy(name):
    points = in_general_position()[name]
    cells = bonemesh.tetrahedralize(points)
    assert as_set(cells) == as_set(Delaunay(points).simplices)
    assert (doubled(points, cells) > 0).all()


def test_the_cells_do_not_depend_on_threads_or_order():
    random = np.random.default_rng(1)
    points = random.integers(0, 12, (900, 3))
    points = np.unique(points, axis=0)
    cells = bonemesh.tetrahedralize(points, threads=1)
    assert (bonemesh.tetrahedralize(points, threads=3) == cells).all()
    order = random.permutation(len(points))
    shuffled = order[bonemesh.tetrahedralize(points[order])]
    assert as_set(shuffled) == as_set(cells)


def lattices() -> dict[str, np.ndarray]:
    full = np.array(list(itertools.product(range(5), range(4), range(4))))
    random = np.random.default_rng(4)
    some = np.unique(random.integers(-6, 6, (160, 3)), axis=0)
    ring = np.array(
        [(round(9 * np.cos(t)), round(9 * np.sin(t))) for t in np.linspace(0, 6.3, 90)]
    )
    ring = np.unique(ring, axis=0)
    stacked = np.array([(x, y, z) for z in range(3) for x, y in ring])
    return {
        "a full lattice": full,
        "some of a lattice": some,
        "rings in slices": stacked,
    }


def ints(array: np.ndarray) -> np.ndarray:
    """The same numbers as Python's own, which never overflow."""
    return np.array(array.tolist(), dtype=object)


@pytest.mark.parametrize("weights", [(1, 1, 1), (1, 1, 9), (4, 25, 1)])
@pytest.mark.parametrize("name", lattices())
def test_every_sphere_on_a_lattice_is_exactly_empty(name, weights):
    """The sign of the in-sphere determinant, in whole numbers of any size."""
    points = lattices()[name]
    spacing = np.sqrt(weights)
    cells = bonemesh.tetrahedralize(points, spacing_mm=spacing)
    exact = ints(points)
    volumes = doubled(exact, cells)
    assert (volumes > 0).all(), "no cell is flat or turned inside out"
    metric = ints(np.array(weights))
    for cell, volume in zip(cells, volumes, strict=True):
        origin = exact[cell[0]]
        edges = exact[cell[1:]] - origin
        lifts = (edges * edges * metric).sum(1)
        others = exact - origin
        # Lift of each point minus that of the plane through the cell's lifted corners: by
        # Cramer's rule, times the volume, which is positive.
        p, q, r = edges
        plane = [
            lifts[0] * np.cross(q, r)[axis]
            + lifts[1] * np.cross(r, p)[axis]
            + lifts[2] * np.cross(p, q)[axis]
            for axis in range(3)
        ]
        above = (others * others * metric).sum(1) * volume - others @ np.array(
            plane, object
        )
        assert (above >= 0).all()
        assert (above[cell] == 0).all()


@pytest.mark.parametrize("name", lattices())
def test_the_cells_fill_the_convex_hull(name):
    points = lattices()[name]
    cells = bonemesh.tetrahedralize(points)
    hull = ConvexHull(points).volume
    assert sum(doubled(ints(points), cells)) / 6 == pytest.approx(hull, rel=1e-12)


def test_millimetres_on_a_lattice_are_decided_as_the_lattice():
    """Rounded coordinates lose ties that the lattice has."""
    lattice = lattices()["rings in slices"]
    spacing = np.array([0.451, 0.451, 1.0])
    whole = bonemesh.tetrahedralize(lattice, spacing_mm=spacing)
    moved = bonemesh.tetrahedralize(lattice * spacing + 17.3, spacing_mm=spacing)
    assert (whole == moved).all()


def test_duplicates_are_used_once():
    points = np.array(list(itertools.product([0, 1], repeat=3)) * 2)
    cells = bonemesh.tetrahedralize(points)
    assert cells.max() == 7
    assert doubled(points, cells).sum() == 6


def circumradii(points: np.ndarray, cells: np.ndarray) -> np.ndarray:
    a = points[cells[:, 0]]
    edges = points[cells[:, 1:]] - a[:, None]
    centres = np.linalg.solve(2 * edges, (edges**2).sum(2)[..., None])[..., 0]
    return np.linalg.norm(centres, axis=1)


def test_the_alpha_surface_bounds_the_small_tetrahedra():
    random = np.random.default_rng(14)
    points = random.random((1500, 3)) * 20
    alpha = 1.6
    cells = bonemesh.tetrahedralize(points)
    small = cells[circumradii(points, cells) <= alpha]
    assert 0 < len(small) < len(cells)
    mesh = bonemesh.alpha_surface(points, alpha)
    assert mesh.report["tetrahedra"] == len(small)
    assert mesh.report["watertight"]
    volume = doubled(points, small).sum() / 6
    assert mesh.report["volume_mm3"] == pytest.approx(volume, rel=1e-9)
    faces: dict[tuple[int, ...], int] = {}
    for cell in small:
        for face in itertools.combinations(sorted(map(int, cell)), 3):
            faces[face] = faces.get(face, 0) + 1
    boundary = [face for face, times in faces.items() if times == 1]
    assert len(mesh.triangles) == len(boundary)
    corners = {
        tuple(map(float, np.float32(points[i]))) for face in boundary for i in face
    }
    assert {tuple(map(float, v)) for v in mesh.vertices} == corners


def test_rendering_is_the_alpha_surface_of_the_cloud():
    volume = bonemesh.phantom("tube", coarser=2.0)
    mesh = bonemesh.render(volume, method="alpha")
    points = bonemesh.point_cloud(volume)
    surface = bonemesh.alpha_surface(
        points, mesh.report["alpha_mm"], spacing_mm=volume.spacing_mm
    )
    assert np.allclose(
        np.sort(surface.vertices, axis=0), np.sort(mesh.vertices, axis=0), atol=1e-4
    )
    assert surface.report["tetrahedra"] == mesh.report["tetrahedra"]
    assert len(surface.triangles) == len(mesh.triangles)
