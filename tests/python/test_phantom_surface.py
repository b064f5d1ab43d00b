"""The truth that meshes are measured against, as Python sees it."""

from __future__ import annotations

import bonemesh
import numpy as np
import pytest


@pytest.fixture(scope="module")
def shell() -> bonemesh.PhantomSurface:
    return bonemesh.PhantomSurface("sphere-shell")


def test_distances_are_those_of_the_formula(shell):
    points = np.random.default_rng(1).uniform(-40, 40, (500, 3))
    r = np.linalg.norm(points, axis=1)
    found = shell.nearest(points)
    expected = np.maximum(30 - r, r - 36)
    close = abs(expected) < 1
    assert abs(found["distance_mm"] - expected)[close].max() < 0.005
    assert np.allclose(found["distance_mm"], expected, rtol=0.006, atol=0.005)
    assert not found["crease"].any()
    assert np.allclose(
        np.linalg.norm(found["point_mm"] - points, axis=1), abs(found["distance_mm"])
    )
    outward = np.einsum("ij,ij->i", found["normal"], found["point_mm"]) > 0
    outer = np.linalg.norm(found["point_mm"], axis=1) > 33
    assert (outward == outer).all()
    assert (found["outside_hu"] == 40).all()


def test_creases_are_edges_and_follow_the_asked_length():
    box = bonemesh.PhantomSurface("box-with-hole")
    points = [[20.1, 12, 0], [20.1, 14.5, 0], [20.2, 15.2, 15.2]]
    assert box.nearest(points)["crease"].tolist() == [False, True, True]
    assert box.nearest(points, crease_mm=4)["crease"].tolist() == [True, True, True]


def test_samples_lie_on_the_surface_and_repeat(shell):
    points = shell.samples(1000, seed=3)
    r = np.linalg.norm(points, axis=1)
    assert points.shape == (1000, 3)
    assert np.minimum(abs(r - 30), abs(r - 36)).max() < 1e-5
    assert (points == shell.samples(1000, seed=3, threads=1)).all()
    assert (points != shell.samples(1000, seed=4)).any()


def test_volumes_are_those_of_the_formula(shell):
    expected = 4 / 3 * np.pi * (36**3 - 30**3)
    assert shell.volume_mm3(cell_mm=0.5) == pytest.approx(expected, rel=5e-4)


def test_parts_of_the_head_have_names():
    head = bonemesh.PhantomSurface("head")
    found = head.nearest([[0.0, 6.0, 80.0], [-2.4, -55.0, -48.0]])
    names = [head.structures[n] for n in found["structure"]]
    assert names[0] == "braincase, outside"
    assert "septum" in names[1]


def test_a_scan_with_other_voxels_shows_the_same_body():
    usual = bonemesh.phantom("tube", psf_px=0, noise_hu=0)
    thick = bonemesh.phantom("tube", pixel_mm=0.35, slice_mm=2.5, psf_px=0, noise_hu=0)
    assert thick.spacing_mm == pytest.approx((0.35, 0.35, 2.5))
    bone = [
        ((v.hu.astype(float) - 40) / 1200).sum() * np.prod(v.spacing_mm)
        for v in (usual, thick)
    ]
    truth = bonemesh.PhantomSurface("tube").volume_mm3(cell_mm=0.5)
    assert bone == pytest.approx([truth, truth], rel=2e-3)
    middle = [
        (v.patient_from_voxel @ [*(np.array(v.hu.shape[::-1]) - 1) / 2, 1])[:3]
        for v in (usual, thick)
    ]
    assert np.allclose(middle, 0, atol=1e-9)


def test_voxels_of_a_scan_must_have_lengths():
    with pytest.raises(bonemesh.ArgumentError, match="pixel_mm"):
        bonemesh.phantom("tube", pixel_mm=0)
    with pytest.raises(bonemesh.ArgumentError, match="slice_mm"):
        bonemesh.phantom("tube", slice_mm=float("nan"))


def test_what_cannot_be_measured_is_refused(shell):
    with pytest.raises(bonemesh.ArgumentError, match="pixels"):
        bonemesh.PhantomSurface("cube")
    with pytest.raises(bonemesh.ArgumentError, match="elephant"):
        bonemesh.PhantomSurface("elephant")
    with pytest.raises(bonemesh.ArgumentError, match="crease_mm"):
        shell.nearest([[0, 0, 0]], crease_mm=0)
    with pytest.raises(bonemesh.ArgumentError, match="cell_mm"):
        shell.volume_mm3(cell_mm=0)
    with pytest.raises(bonemesh.ArgumentError, match="count"):
        shell.samples(-1)
    assert shell.nearest(np.empty((0, 3)))["distance_mm"].shape == (0,)


def test_a_switch_stops_the_search(shell):
    switch = bonemesh.Cancel()
    switch.cancel()
    with pytest.raises(bonemesh.Cancelled):
        shell.nearest([[0, 0, 0]], cancel=switch)


def test_methods_are_those_that_render_knows(volume):
    assert "alpha" in bonemesh.methods()
    for method in bonemesh.methods():
        assert len(bonemesh.render(volume, method=method).triangles) > 0
