"""The methods that are there for study, beside SciPy and formulas."""

from __future__ import annotations

import bonemesh
import numpy as np
import pytest
from scipy.spatial import ConvexHull, Delaunay


def area(vertices: np.ndarray, triangles: np.ndarray) -> float:
    a, b, c = (vertices[triangles[:, i]].astype(float) for i in range(3))
    return np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2


@pytest.fixture(scope="module")
def ball() -> np.ndarray:
    """Points all over a sphere of 20 mm, nearly evenly, on no lattice."""
    turn = np.pi * (3 - np.sqrt(5)) * np.arange(4000)
    z = 1 - 2 * (np.arange(4000) + 0.5) / 4000
    ring = np.sqrt(1 - z**2)
    return 20 * np.c_[ring * np.cos(turn), ring * np.sin(turn), z]


@pytest.fixture
def meshed(command, tmp_path):
    """A cloud meshed by a method of the command: the mesh, and what is said of it."""

    def mesh(points: np.ndarray, method: str, *options: str):
        np.save(tmp_path / "cloud.npy", points)
        out = tmp_path / "mesh.ply"
        words = ("mesh", tmp_path / "cloud.npy", "-o", out, "--method", method)
        answer = command(*words, *options, "--json")
        assert answer.code == 0, answer.err
        return bonemesh.read_mesh(out), answer.json

    return mesh


def test_all_tetrahedra_are_scipys_and_their_surface_is_the_hull(meshed):
    points = np.random.default_rng(3).normal(size=(1500, 3)) * [20, 15, 30]
    mesh, report = meshed(points, "tetrahedra")
    hull = ConvexHull(points)
    assert report["tetrahedra"] == len(Delaunay(points).simplices)
    assert report["triangles"] == len(hull.simplices)
    assert report["volume_mm3"] == pytest.approx(hull.volume, rel=1e-9)
    assert area(mesh.vertices, mesh.triangles) == pytest.approx(hull.area, rel=1e-5)


def test_the_sheet_is_scipys_triangles_of_the_plane(meshed):
    points = np.random.default_rng(4).random((2000, 3)) * [60, 50, 10]
    mesh, report = meshed(points, "planar")
    flat = Delaunay(points[:, :2]).simplices
    assert report["triangles"] == len(flat)
    assert area(mesh.vertices, mesh.triangles) == pytest.approx(
        area(points, flat), rel=1e-5
    )


def test_a_ball_rolls_over_the_whole_hull_of_a_ball(meshed, ball):
    mesh, report = meshed(ball, "ball-pivoting")
    hull = ConvexHull(ball)
    assert area(mesh.vertices, mesh.triangles) == pytest.approx(hull.area, rel=1e-3)
    assert report["volume_mm3"] == pytest.approx(hull.volume, rel=1e-3)


def test_poissons_ball_is_the_formulas(meshed, ball):
    mesh, report = meshed(ball, "poisson", "--depth", "6")
    assert report["watertight"]
    assert report["volume_mm3"] == pytest.approx(4 / 3 * np.pi * 20**3, rel=0.01)
    assert area(mesh.vertices, mesh.triangles) == pytest.approx(
        4 * np.pi * 20**2, rel=0.01
    )


def test_alphas_surface_is_that_of_scipys_small_tetrahedra(meshed):
    points = np.random.default_rng(5).random((1500, 3)) * 20
    cells = Delaunay(points).simplices
    a = points[cells[:, 0]]
    edges = points[cells[:, 1:]] - a[:, None]
    centres = np.linalg.solve(2 * edges, (edges**2).sum(2)[..., None])[..., 0]
    small = np.linalg.norm(centres, axis=1) <= 1.6
    volume = abs(np.linalg.det(edges[small])).sum() / 6
    _, report = meshed(points, "alpha", "--alpha", "1.6")
    assert report["tetrahedra"] == small.sum()
    assert report["volume_mm3"] == pytest.approx(volume, rel=1e-9)
