"""Coarse surfaces: near what is rendered, quick, refused and stopped as everything else."""

from __future__ import annotations

import threading

import bonemesh
import numpy as np
import pytest


@pytest.fixture(scope="module")
def preview(volume: bonemesh.Volume) -> bonemesh.Preview:
    return bonemesh.Preview(volume)


def test_it_knows_the_scan_it_was_made_of(preview, volume):
    assert preview.shape == volume.hu.shape
    assert (preview.patient_from_voxel == volume.patient_from_voxel).all()
    slices, rows, columns = volume.hu.shape
    assert repr(preview) == f"<bonemesh.Preview, {slices} slices of {rows} x {columns}>"


def test_a_surface_lies_where_the_rendered_one_does(preview, volume):
    shown = preview.surface(350)
    rendered = bonemesh.render(volume, threshold_hu=350)
    side_mm = max(shown.report["spacing_mm"])
    assert np.allclose(shown.vertices.min(0), rendered.vertices.min(0), atol=side_mm)
    assert np.allclose(shown.vertices.max(0), rendered.vertices.max(0), atol=side_mm)
    assert shown.report["triangles"] == len(shown.triangles)
    assert shown.report["threshold_hu"] == 350
    assert shown.report["seconds"] > 0


def test_a_crop_box_is_in_voxels_of_the_scan(preview):
    slices, rows, columns = preview.shape
    half = preview.surface(350, crop=f"0:{columns},0:{rows},0:{slices // 2}")
    whole = preview.surface(350)
    assert half.vertices[:, 2].max() < whole.vertices[:, 2].max() - 10
    with pytest.raises(bonemesh.ArgumentError, match="crop"):
        preview.surface(350, crop="everything")
    with pytest.raises(bonemesh.BonemeshError, match=f"slices 0:{slices + 1}"):
        preview.surface(350, crop=f"0:{columns},0:{rows},0:{slices + 1}")


@pytest.mark.parametrize(("threshold_hu", "words"), [(9000, "9000"), (-9000, "-9000")])
def test_thresholds_beyond_the_scan_are_refused(preview, threshold_hu, words):
    with pytest.raises(bonemesh.BonemeshError, match=words):
        preview.surface(threshold_hu)
    with pytest.raises(bonemesh.ArgumentError):
        preview.surface(float("nan"))


def test_making_one_and_its_surface_can_be_stopped(preview, volume):
    cancel = bonemesh.Cancel()
    cancel.cancel()
    with pytest.raises(bonemesh.Cancelled):
        bonemesh.Preview(volume, cancel=cancel)
    with pytest.raises(bonemesh.Cancelled):
        preview.surface(350, cancel=cancel)


def test_surfaces_at_the_same_time_are_those_of_one_after_the_other(preview):
    thresholds = [200, 350, 500, 650]
    found: dict[int, bonemesh.Mesh] = {}

    def work(threshold: int) -> None:
        found[threshold] = preview.surface(threshold)

    threads = [threading.Thread(target=work, args=(t,)) for t in thresholds]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for threshold in thresholds:
        alone = preview.surface(threshold)
        assert (alone.vertices == found[threshold].vertices).all()
        assert (alone.triangles == found[threshold].triangles).all()
