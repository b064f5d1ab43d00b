"""Samples of clouds: what each sampler promises, and the published ones by their definitions."""

from __future__ import annotations

import itertools
import time

import bonemesh
import numpy as np
import pytest

SAMPLERS = ["uniform", "targeted", "random", "thesis-uniform"]
CUTOFFS = (0.0, 0.4, 0.6, 0.8)


@pytest.fixture(scope="module")
def points(volume) -> np.ndarray:
    return bonemesh.point_cloud(volume)


@pytest.fixture(scope="module")
def curved() -> np.ndarray:
    """One slice of a square with one sharp corner and three rounded ones."""
    cloud = bonemesh.point_cloud(bonemesh.phantom("curved"))
    return cloud[cloud[:, 2] == cloud[0, 2]]


@pytest.mark.parametrize("sampler", [*SAMPLERS, "thesis-targeted"])
def test_samples_are_distinct_points_whatever_the_number_of_threads(points, sampler):
    options = {} if sampler == "thesis-targeted" else {"percent": 20, "seed": 3}
    kept = bonemesh.sample(points, sampler=sampler, **options)
    assert kept.dtype == np.uint32
    assert (np.diff(kept.astype(int)) > 0).all()
    assert kept.max() < len(points)
    again = bonemesh.sample(points, sampler=sampler, threads=1, **options)
    assert (kept == again).all()


@pytest.mark.parametrize("sampler", ["uniform", "targeted"])
@pytest.mark.parametrize("percent", [0.3, 2, 9, 25, 33.3, 50, 72.5, 90, 99.9, 100])
def test_our_samplers_keep_exactly_what_is_asked_for(points, sampler, percent):
    kept = bonemesh.sample(points, percent=percent, sampler=sampler)
    assert len(kept) == pytest.approx(percent / 100 * len(points), abs=0.6)


@pytest.mark.parametrize("percent", [2, 5, 10])
def test_the_curved_shape_stays_closed(curved, percent):
    """By the angle around its middle, along which the shape is passed once."""
    middle = (curved.min(axis=0) + curved.max(axis=0)) / 2
    x, y, _ = (curved - middle).T
    angles = np.arctan2(y, x)
    order = np.argsort(angles)
    kept = np.isin(
        order, bonemesh.sample(curved, percent=percent, sampler="uniform")
    ).nonzero()[0]
    steps = np.diff([*kept, kept[0] + len(curved)])
    assert steps.max() <= 3 * len(curved) / len(kept)


def test_another_seed_gives_another_random_sample():
    points = np.random.default_rng(11).random((4000, 3)) * [10, 200, 3]
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


def test_the_published_targeted_sampler_by_its_definition(points):
    """In cells of up to 30 points all normals are one, so that the highest range is taken."""
    dx, dy, _ = (np.diff(np.unique(axis)).min() for axis in points.T)
    grid = 5
    columns, rows = (
        np.rint((points[:, axis] - points[:, axis].min()) / step).astype(int) // grid
        for axis, step in ((0, dx), (1, dy))
    )
    cells = list(zip(points[:, 2], rows, columns, strict=True))
    expected = []
    by_cell = sorted(range(len(points)), key=cells.__getitem__)
    for _, group in itertools.groupby(by_cell, cells.__getitem__):
        members = np.array(list(group))
        assert len(members) <= 30
        kept = bonemesh.sample(points[members], percent=40, sampler="thesis-uniform")
        expected.extend(members[kept])
    found = bonemesh.sample(
        points,
        sampler="thesis-targeted",
        grid_px=grid,
        cutoffs=CUTOFFS,
        percentages=(40.0, 60.0, 80.0, 90.0),
    )
    assert found.tolist() == sorted(expected)
    low, middle, high, highest = bonemesh.similarity_ranges(points, grid_px=grid)
    assert (low, middle, high) == (0, 0, 0)
    assert highest == len(set(cells))


def test_a_line_is_straight_in_the_plane_and_not_in_space():
    x = np.arange(0.0, 100.0, 2.0)
    line = np.column_stack([x, 10 * x, 0 * x])
    parabola = np.column_stack([x, -((x - 50) ** 2), 0 * x])
    assert bonemesh.normal_similarity(line) == 1.0
    assert bonemesh.normal_similarity(parabola) < 0.95
    # As published: some normals up, the others down, whatever the shape.
    found = bonemesh.normal_similarity(parabola, normals="space")
    ups = [(up**2 + (50 - up) ** 2) / 2500 for up in range(1, 50)]
    assert min(abs(found - up) for up in ups) < 1e-9
    assert bonemesh.normal_similarity(line, normals="space") < 1.0


@pytest.mark.parametrize(
    ("options", "word"),
    [
        ({"sampler": "magic", "percent": 10}, "thesis-targeted"),
        ({"sampler": "uniform"}, "percent"),
        ({"sampler": "thesis-targeted", "percent": 10}, "leave the percentage out"),
        ({"sampler": "uniform", "percent": 10, "grid_px": 10}, "leave them out"),
        ({"sampler": "thesis-targeted", "grid_px": 0}, "pixels"),
        ({"sampler": "thesis-targeted", "cutoffs": (0.0, 0.5, 0.4, 0.9)}, "rising"),
        (
            {"sampler": "thesis-targeted", "percentages": (10.0, 20.0, 30.0, 0.0)},
            "percentage",
        ),
    ],
)
def test_what_a_sampler_has_no_use_for_is_refused(points, options, word):
    with pytest.raises(bonemesh.ArgumentError, match=word):
        bonemesh.sample(points, **options)


def test_cells_need_pixels():
    free = np.random.default_rng(1).random((50, 3))
    with pytest.raises(bonemesh.ArgumentError, match="spacing"):
        bonemesh.sample(free, sampler="thesis-targeted")


@pytest.mark.parametrize("sampler", ["uniform", "targeted"])
def test_a_large_cloud_takes_a_fraction_of_a_second(real_ct, sampler):
    volume = bonemesh.read_series(real_ct("philips-skull"))
    points = bonemesh.point_cloud(volume, threshold_hu=300)
    start = time.perf_counter()
    kept = bonemesh.sample(points, percent=10, sampler=sampler)
    seconds = time.perf_counter() - start
    print(f"{sampler}: {len(points)} points to {len(kept)} in {seconds:.3f} s")
    assert seconds < 3.0


def test_a_tenth_of_a_real_skull_is_nearer_than_by_the_published_sampler(real_ct):
    volume = bonemesh.read_series(real_ct("cranium"))
    points = bonemesh.point_cloud(volume, threshold_hu=300, frame="image")

    def meshed(cloud: np.ndarray) -> bonemesh.Mesh:
        return bonemesh.alpha_surface(cloud, bonemesh.mean_neighbour_distance(cloud))

    full = meshed(points)
    ours, published = (
        bonemesh.compare(meshed(points[kept]), full, residual=False, samples=1000)
        for kept in (
            bonemesh.sample(points, percent=10, sampler="uniform"),
            bonemesh.sample(points, percent=10, sampler="thesis-uniform"),
        )
    )
    for figure in ("overall_mm", "midpoint_mm"):
        found, theirs = (r["edge_midpoints"][figure] for r in (ours, published))
        print(f"{figure}: {found:.3f}, published {theirs:.3f}")
        assert found < theirs
