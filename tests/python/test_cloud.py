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


@pytest.mark.parametrize("sampler", ["uniform", "random", "thesis-uniform"])
def test_samples_are_distinct_points_of_the_cloud(clouds, sampler):
    points = clouds["phantom"]
    kept = bonemesh.sample(points, percent=20, sampler=sampler, seed=3)
    assert len(np.unique(kept)) == len(kept)
    assert kept.max() < len(points)
    assert 0.15 * len(points) <= len(kept) <= 0.21 * len(points)
    again = bonemesh.sample(points, percent=20, sampler=sampler, seed=3, threads=1)
    assert (kept == again).all()


def test_another_seed_gives_another_random_sample(clouds):
    points = clouds["free"]
    first = bonemesh.sample(points, percent=10, sampler="random", seed=0)
    second = bonemesh.sample(points, percent=10, sampler="random", seed=1)
    assert len(first) == len(second) == 400
    assert set(first.tolist()) != set(second.tolist())


def test_the_published_sampler_by_its_definition():
    """Take the first point left and its nearest, keep evenly spaced ranks, delete all, repeat."""
    random = np.random.default_rng(6)
    slices = [
        np.column_stack([random.random((37, 2)) * 50, np.full(37, z)])
        for z in (0.0, 2.5)
    ]
    points = np.concatenate(slices)
    share = 0.3
    expected = []
    for z in (0.0, 2.5):
        left = list(np.flatnonzero(points[:, 2] == z))
        while left:
            distances = np.linalg.norm(points[left] - points[left[0]], axis=1)
            nearest = [left[i] for i in np.argsort(distances, kind="stable")[:10]]
            keep = int(share * len(nearest))
            ranks = np.rint(np.linspace(1, len(nearest), keep)).astype(int) - 1
            expected += [nearest[rank] for rank in ranks]
            left = [index for index in left if index not in nearest]
    kept = bonemesh.sample(points, percent=30, sampler="thesis-uniform")
    assert sorted(kept.tolist()) == sorted(expected)


@pytest.mark.parametrize("name", ["headsq", "cranium", "philips-skull"])
def test_the_alpha_of_real_series(real_ct, name):
    points = bonemesh.point_cloud(bonemesh.read_series(real_ct(name)), threshold_hu=300)
    alpha = bonemesh.mean_neighbour_distance(points)
    print(f"{name}: {len(points)} points, alpha {alpha} mm")
    assert alpha == pytest.approx(alpha_by_scipy(points, 100, True), rel=RELATIVE)
