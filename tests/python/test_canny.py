"""Canny's edges are scikit-image's, pixel for pixel."""

from __future__ import annotations

from functools import cache

import bonemesh
import numpy as np
import pytest
from skimage.feature import canny as reference

# Thresholds on a mask cover no smoothing, usual smoothing, and kernels wider than the structures.
SIGMAS = [0.0, 0.5, 1.0, 1.7, 4.0]
THRESHOLDS = [(0.1, 0.2), (0.0, 0.0), (0.3, 0.3), (0.05, 2.0)]
# Of a real series, one edge pixel in this many may differ: ties of the last bit.
ONE_IN = 10_000

PHANTOMS = {
    "line": 1.0,
    "cylinder": 1.0,
    "curved": 1.0,
    "cube-with-hole": 1.0,
    "sphere-shell": 1.5,
    "tube": 1.0,
    "femur": 2.0,
    "box-with-hole": 1.0,
    "head": 2.0,
}


def edges_of(images, sigma=1.0, low=0.1, high=0.2, largest=1.0) -> np.ndarray:
    """What scikit-image finds; its thresholds are in the unit of the image's type."""
    return np.array(
        [reference(i, sigma, low * largest, high * largest) for i in images]
    )


def slices_of(volume: bonemesh.Volume, most: int = 12) -> np.ndarray:
    hu = volume.hu
    return hu[:: max(1, len(hu) // most)]


@cache
def coarse_head() -> bonemesh.Volume:
    return bonemesh.phantom("head", coarser=2.5)


@pytest.mark.parametrize("name", PHANTOMS)
def test_no_pixel_of_a_phantom_differs(name):
    mask = slices_of(bonemesh.phantom(name, coarser=PHANTOMS[name])) > 350
    assert mask.any()
    edges = bonemesh.canny(mask)
    assert edges.any()
    assert (edges == edges_of(mask)).all()


@pytest.mark.parametrize("thresholds", THRESHOLDS)
@pytest.mark.parametrize("sigma", SIGMAS)
def test_no_pixel_differs_with_other_settings(sigma, thresholds):
    low, high = thresholds
    hu = slices_of(coarse_head(), most=5)
    for threshold in (200, 640):
        mask = hu > threshold
        edges = bonemesh.canny(mask, sigma=sigma, low=low, high=high)
        assert (edges == edges_of(mask, sigma, low, high)).all()


def test_no_pixel_of_random_masks_differs():
    random = np.random.default_rng(20)
    for density in (0.02, 0.5, 0.9):
        mask = random.random((4, 61, 47)) < density
        assert (bonemesh.canny(mask) == edges_of(mask)).all()


@pytest.mark.parametrize(
    "shape", [(1, 1), (1, 9), (9, 1), (2, 3), (3, 3), (4, 5), (7, 400)]
)
def test_no_pixel_of_small_and_narrow_images_differs(shape):
    random = np.random.default_rng(3)
    for _ in range(10):
        mask = random.random(shape) < 0.5
        grey = random.random(shape)
        assert (bonemesh.canny(mask) == reference(mask)).all()
        assert (bonemesh.canny(grey) == reference(grey)).all()


@pytest.mark.parametrize(
    "dtype", ["uint8", "int8", "uint16", "int16", "uint32", "int32"]
)
def test_whole_numbers_count_as_fractions_of_their_types_largest(dtype):
    largest = np.iinfo(dtype).max
    random = np.random.default_rng(8)
    smooth = random.random((3, 40, 50)).cumsum(1).cumsum(2)
    images = (smooth / smooth.max() * largest).astype(dtype)
    images[1] = np.iinfo(dtype).min
    images[1, 9:20, 9:20] = largest
    for sigma in (1.0, 2.0):
        edges = bonemesh.canny(images, sigma=sigma, low=0.01, high=0.05)
        assert edges.any()
        assert (edges == edges_of(images, sigma, 0.01, 0.05, float(largest))).all()
    # Without thresholds, scikit-image's are ours.
    assert (bonemesh.canny(images[1]) == reference(images[1])).all()


def test_floating_point_images_are_taken_as_they_are():
    random = np.random.default_rng(9)
    images = random.normal(size=(3, 50, 40)).cumsum(1) * 300
    for sigma in (0.0, 1.0, 3.0):
        edges = bonemesh.canny(images, sigma=sigma, low=50.0, high=200.0)
        assert edges.any()
        assert (edges == edges_of(images, sigma, 50.0, 200.0)).all()


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf, 1e200])
def test_pixels_that_are_no_usable_number_are_refused(value):
    image = np.ones((8, 9))
    image[3, 4] = value
    with pytest.raises(ValueError, match="row 3, column 4"):
        bonemesh.canny(image)


def test_an_image_is_a_stack_of_one():
    mask = bonemesh.phantom("curved").hu > 350
    assert (bonemesh.canny(mask[0]) == bonemesh.canny(mask)[0]).all()
    assert (bonemesh.canny(mask, threads=3) == bonemesh.canny(mask, threads=1)).all()


def test_truth_is_any_byte_but_zero():
    mask = bonemesh.phantom("curved").hu[0] > 350
    odd = (mask * np.uint8(77)).view(bool)
    assert (bonemesh.canny(odd) == bonemesh.canny(mask)).all()


def test_the_published_ring_has_2156_edge_pixels_a_slice():
    edges = bonemesh.canny(bonemesh.phantom("cylinder").hu > 350)
    assert len(edges) == 10
    assert [int(e.sum()) for e in edges] == [2156] * 10


@pytest.mark.parametrize("name", ["headsq", "cranium", "philips-skull"])
def test_real_series(real_ct, name):
    mask = bonemesh.read_series(real_ct(name)).hu > 300
    edges = bonemesh.canny(mask)
    expected = edges_of(mask)
    different = int((edges != expected).sum())
    total = int(expected.sum())
    print(f"{name}: {different} of {total} edge pixels differ")
    assert different * ONE_IN <= total
