"""Histograms, thresholds and components are NumPy's and scikit-image's."""

from __future__ import annotations

from fractions import Fraction

import bonemesh
import numpy as np
import pytest
from skimage import measure
from skimage.filters import threshold_multiotsu, threshold_otsu

PHANTOMS = {"sphere-shell": 2.0, "tube": 1.0, "femur": 2.0, "head": 2.5}
# The halfway value between the phantoms' soft tissue (40 HU) and bone (1240 HU).
HALFWAY = 640


def volume_of(hu: np.ndarray) -> bonemesh.Volume:
    return bonemesh.Volume(hu, np.eye(4))


@pytest.fixture(scope="module", params=PHANTOMS)
def phantom(request) -> bonemesh.Volume:
    return bonemesh.phantom(request.param, coarser=PHANTOMS[request.param])


@pytest.fixture
def noise() -> np.ndarray:
    """Values of all kinds, padding among them."""
    random = np.random.default_rng(7)
    hu = random.normal(200, 900, (9, 31, 40)).round().astype(np.int16)
    hu[0] = -2000
    return hu


@pytest.mark.parametrize("bin_hu", [1, 10, 37])
@pytest.mark.parametrize("kind", [np.int16, np.float32])
def test_every_voxel_is_in_its_bin(noise, bin_hu, kind):
    hu = noise.astype(kind)
    if kind is np.float32:
        hu = hu + np.float32(0.25)
    found = bonemesh.histogram(volume_of(hu), bin_hu=bin_hu)
    assert (np.diff(found.edges_hu) == bin_hu).all()
    assert (found.edges_hu % bin_hu == 0).all()
    tissue = hu[hu >= -1024].astype(float)
    # NumPy's bins hold their lower edge, ours the upper one: count what is below zero upwards.
    expected, _ = np.histogram(-tissue, -found.edges_hu[::-1])
    assert (found.counts == expected[::-1]).all()
    assert found.counts[0] > 0 and found.counts[-1] > 0
    assert found.voxels == tissue.size
    assert found.padding == hu.size - tissue.size >= 31 * 40
    assert found.counts.dtype == np.uint64


def test_a_crop_box_counts_its_part(noise):
    found = bonemesh.histogram(volume_of(noise), crop="3:20,0:31,1:4")
    part = noise[1:4, 0:31, 3:20]
    assert found.voxels == (part >= -1024).sum()
    assert found.padding + found.voxels == part.size


def parts(hu: np.ndarray, thresholds) -> np.ndarray:
    """The class of each voxel, classes being parted by what lies strictly above."""
    return sum((hu > t).astype(int) for t in thresholds)


def criterion(hu: np.ndarray, thresholds) -> Fraction:
    """What Otsu's thresholds make as large as can be, exactly."""
    classes = parts(hu, thresholds)
    values = [hu[classes == c].astype(np.int64) for c in np.unique(classes)]
    return sum((Fraction(int(v.sum()) ** 2, v.size) for v in values), Fraction(0))


def assert_no_worse(hu: np.ndarray, ours, theirs) -> None:
    """The same classes, or better ones: scikit-image's sums are of single precision."""
    differ = parts(hu, ours) != parts(hu, theirs)
    assert differ.mean() < 1e-3
    assert not differ.any() or criterion(hu, ours) > criterion(hu, theirs)


def test_two_classes_are_those_of_scikit_image(phantom):
    ours = bonemesh.histogram(phantom, bin_hu=1).otsu()
    assert_no_worse(phantom.hu, ours, [threshold_otsu(phantom.hu)])


@pytest.mark.parametrize("classes", [2, 3, 4])
def test_several_classes_are_those_of_scikit_image(phantom, classes):
    # Theirs takes all combinations of bins: coarse ones keep it short.
    found = bonemesh.histogram(phantom, bin_hu=32)
    ours = found.otsu(classes)
    upper = found.edges_hu[1:]
    theirs = threshold_multiotsu(classes=classes, hist=(found.counts, upper))
    assert len(ours) == classes - 1
    in_bins = np.ceil(phantom.hu / 32).astype(int) * 32
    assert_no_worse(in_bins, ours, theirs)


@pytest.mark.parametrize("classes", [-1, 0, 1, 6, 1 << 70])
def test_other_numbers_of_classes_are_refused(volume, classes):
    with pytest.raises(bonemesh.ArgumentError, match="2 to 5"):
        bonemesh.histogram(volume).otsu(classes)


@pytest.mark.parametrize("bin_hu", [0, -1, 65536])
def test_other_widths_are_refused(volume, bin_hu):
    with pytest.raises(bonemesh.ArgumentError, match="bin_hu"):
        bonemesh.histogram(volume, bin_hu=bin_hu)


@pytest.mark.parametrize("part", [0.03, 0.2, 0.31, 0.6, 0.97])
@pytest.mark.parametrize("connectivity", [6, 26])
def test_components_are_those_of_scikit_image(part, connectivity):
    mask = np.random.default_rng(3).random((21, 30, 41)) < part
    ours = bonemesh.label_components(mask, connectivity=connectivity)
    theirs = measure.label(mask, connectivity={6: 1, 26: 3}[connectivity])
    assert ours.dtype == np.uint32
    assert (ours == theirs).all()


def test_components_of_bone_are_those_of_scikit_image(phantom):
    bone = phantom.hu > 350
    assert (
        bonemesh.label_components(bone) == measure.label(bone, connectivity=3)
    ).all()


def test_masks_that_are_none_are_refused():
    with pytest.raises(bonemesh.ArgumentError, match="bool"):
        bonemesh.label_components(np.zeros((3, 3, 3)))
    with pytest.raises(bonemesh.ArgumentError, match="bool"):
        bonemesh.label_components(np.zeros((3, 3), bool))
    with pytest.raises(bonemesh.ArgumentError, match="connectivity is 18"):
        bonemesh.label_components(np.zeros((3, 3, 3), bool), connectivity=18)


def test_bone_in_soft_tissue_is_parted_halfway(phantom):
    suggestions = bonemesh.suggest_thresholds(phantom)
    [auto] = [s for s in suggestions if s["recommended"]]
    assert auto["name"] == "edges"
    # Walls of a few coarse voxels do not reach the full 1240 HU.
    assert abs(auto["threshold_hu"] - HALFWAY) < 90
    for s in suggestions:
        assert s["voxels_above"] == (phantom.hu > s["threshold_hu"]).sum()
        assert s["reason"] and s["source"]


def test_the_presets_are_those_published(volume):
    values = {s["name"]: s["threshold_hu"] for s in bonemesh.suggest_thresholds(volume)}
    assert values["skull"] == 350 and values["cortical"] == 600


def test_a_mesh_is_made_with_the_threshold_suggested(volume):
    [auto] = [s for s in bonemesh.suggest_thresholds(volume) if s["recommended"]]
    mesh = bonemesh.render(volume, threshold_hu="auto")
    assert mesh.report["threshold_hu"] == auto["threshold_hu"]
    assert auto["reason"] in mesh.report["threshold_reason"]
    same = bonemesh.render(volume, threshold_hu=auto["threshold_hu"])
    assert (mesh.vertices == same.vertices).all()
    assert same.report["threshold_reason"] is None
    for named in bonemesh.suggest_thresholds(volume):
        if named["name"] == "teeth":  # denser than the phantoms' bone
            continue
        report = bonemesh.render(volume, threshold_hu=named["name"]).report
        assert report["threshold_hu"] == named["threshold_hu"]
    points = bonemesh.point_cloud(volume, threshold_hu="auto")
    again = bonemesh.point_cloud(volume, threshold_hu=auto["threshold_hu"])
    assert (points == again).all()


def test_a_preset_is_its_number(volume):
    named = bonemesh.render(volume, threshold_hu="cortical")
    assert named.report["threshold_hu"] == 600
    assert "Aamodt" in named.report["threshold_reason"]
    with pytest.raises(bonemesh.ArgumentError, match="skull, cortical"):
        bonemesh.render(volume, threshold_hu="bone")


def test_a_flat_volume_has_no_threshold_of_its_own():
    flat = volume_of(np.full((3, 9, 9), 40, np.int16))
    assert not any(s["recommended"] for s in bonemesh.suggest_thresholds(flat))
    with pytest.raises(bonemesh.BonemeshError, match="same value"):
        bonemesh.render(flat, threshold_hu="auto")


# Of real scans: soft tissue lies below these bounds, dense bone above them.
@pytest.mark.parametrize(
    ("name", "method"),
    [("cranium", "edges"), ("headsq", "edges"), ("philips-skull", "multi-otsu")],
)
def test_real_bone_is_parted_from_what_is_around(real_ct, name, method):
    volume = bonemesh.read_series(real_ct(name))
    suggestions = bonemesh.suggest_thresholds(volume)
    [auto] = [s for s in suggestions if s["recommended"]]
    assert auto["name"] == method
    assert 250 < auto["threshold_hu"] < 700
