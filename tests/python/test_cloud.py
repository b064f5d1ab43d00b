"""Point clouds: their frames and order, and neighbour distances as SciPy finds them."""

from __future__ import annotations

import bonemesh
import numpy as np
import pytest
from scipy.spatial import KDTree

RELATIVE = 1e-9


def alpha_by_scipy(points: np.ndarray, k: int, include_self: bool) -> float:
    k = min(k, len(points))
    distances, _ = KDTree(points).query(points, k=k, workers=-1)
    return float(distances.mean() if include_self else distances[:, 1:].mean())


@pytest.fixture(scope="module")
def clouds(volume) -> dict[str, np.ndarray]:
    random = np.random.default_rng(11)
    sphere = random.normal(size=(3000, 3))
    sphere /= np.linalg.norm(sphere, axis=1)[:, None]
    return {
        "phantom": bonemesh.point_cloud(volume),
        "tilted phantom": bonemesh.point_cloud(
            bonemesh.phantom("tube", coarser=2.0, orientation="tilted")
        ),
        "free": random.random((4000, 3)) * [10, 200, 3],
        "sphere": sphere * 40,
        "clusters": np.concatenate(
            [random.normal(c, 0.1, (300, 3)) for c in (0, 5, 90)]
        ),
        "duplicates": np.repeat(random.random((60, 3)), 7, axis=0),
        "line": np.linspace([0, 0, 0], [1, 2, 3], 250),
        "few": random.random((5, 3)),
    }


@pytest.mark.parametrize("include_self", [True, False])
@pytest.mark.parametrize("k", [2, 10, 100])
def test_the_mean_neighbour_distance_is_scipys(clouds, k, include_self):
    for name, points in clouds.items():
        ours = bonemesh.mean_neighbour_distance(points, k=k, include_self=include_self)
        assert ours == pytest.approx(
            alpha_by_scipy(points, k, include_self), rel=RELATIVE
        ), name


def test_a_lattice_gives_the_distance_of_its_millimetres():
    random = np.random.default_rng(2)
    lattice = np.unique(random.integers(0, 40, (5000, 3)), axis=0)
    spacing = (0.5, 0.7, 2.5)
    expected = alpha_by_scipy(lattice * spacing, 100, True)
    whole = bonemesh.mean_neighbour_distance(lattice, spacing_mm=spacing)
    in_mm = bonemesh.mean_neighbour_distance(lattice * spacing, spacing_mm=spacing)
    free = bonemesh.mean_neighbour_distance(lattice * spacing)
    for ours in (whole, in_mm, free):
        assert ours == pytest.approx(expected, rel=RELATIVE)


def test_rendering_takes_this_distance_as_alpha(volume, mesh):
    points = bonemesh.point_cloud(volume)
    assert mesh.report["points"] == len(points)
    expected = alpha_by_scipy(points, 100, True)
    assert mesh.report["alpha_mm"] == pytest.approx(expected, rel=RELATIVE)


def test_points_are_the_edge_pixels_by_slice_row_and_column(volume):
    edges = bonemesh.canny(volume.hu > 350)
    k, j, i = np.nonzero(edges)
    dx, dy, dz = volume.spacing_mm
    affine = volume.patient_from_voxel
    patient = np.column_stack([i, j, k, np.ones(len(i))]) @ affine.T
    assert np.allclose(bonemesh.point_cloud(volume), patient[:, :3], rtol=0, atol=1e-9)
    image = np.column_stack([i * dx - dx / 2, j * dy - dy / 2, k * dz + affine[2, 3]])
    points = bonemesh.point_cloud(volume, frame="image")
    assert np.allclose(points, image, rtol=0, atol=1e-9)


def test_an_oblique_volume_keeps_its_points_in_the_patient():
    volume = bonemesh.phantom("tube", coarser=2.0, orientation="oblique")
    k, j, i = np.nonzero(bonemesh.canny(volume.hu > 350))
    expected = np.column_stack([i, j, k, np.ones(len(i))]) @ volume.patient_from_voxel.T
    assert np.allclose(bonemesh.point_cloud(volume), expected[:, :3], rtol=0, atol=1e-9)


def test_the_published_ring_has_21560_points():
    assert len(bonemesh.point_cloud(bonemesh.phantom("cylinder"))) == 21_560


@pytest.mark.parametrize("name", ["headsq", "cranium", "philips-skull"])
def test_the_alpha_of_real_series(real_ct, name):
    points = bonemesh.point_cloud(bonemesh.read_series(real_ct(name)), threshold_hu=300)
    alpha = bonemesh.mean_neighbour_distance(points)
    print(f"{name}: {len(points)} points, alpha {alpha} mm")
    assert alpha == pytest.approx(alpha_by_scipy(points, 100, True), rel=RELATIVE)
