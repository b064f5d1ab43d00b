"""What is said of a folder's series: the same in Python, as JSON and in words."""

from __future__ import annotations

import shutil
from pathlib import Path

import bonemesh
import numpy as np
import pydicom
import pytest


@pytest.fixture
def two_series(ct_folder, tmp_path) -> Path:
    """A folder with a series of 30 slices, two of them gone and one doubled, and a smaller one."""
    folder = tmp_path / "two"
    shutil.copytree(ct_folder, folder)
    files = sorted(
        folder.glob("*.dcm"), key=lambda f: pydicom.dcmread(f).ImagePositionPatient[2]
    )
    files[10].unlink()
    files[11].unlink()
    shutil.copy(files[20], folder / "once more.dcm")
    bonemesh.write_phantom("tube", folder / "other", coarser=4.0)
    return folder


def test_python_and_the_command_say_the_same(command, two_series):
    found = bonemesh.scan(two_series, pixels=True)
    printed = command("info", two_series, "--pixels", "--json").json
    assert printed["recommended"] == found.recommended == 1
    assert printed["alternatives"] == found.alternatives == [2]
    assert printed["series"] == [series.report for series in found.series]
    words = command("info", two_series, "--pixels").out
    for series in found.series:
        for line in series.lines:
            assert f"   {line}\n" in words
    assert [(Path(entry["path"]).name) for entry in printed["left_out"]] == [
        left_out.path.name for left_out in found.left_out
    ]


def test_gaps_and_copies_are_reported_at_their_place(two_series):
    series = bonemesh.scan(two_series).series[0]
    positions = np.array(series.slice_positions_mm)
    assert (series.slices, series.slices_found) == (30, 28)
    step = series.spacing_mm[2]
    assert np.allclose(np.diff(positions)[9], 3 * step)
    [(after_mm, missing)] = series.gaps
    assert missing == 2 and np.isclose(after_mm, positions[9])
    assert len(series.duplicates) == 1 and not series.is_resampled
    assert series.hu_range is None
    assert any("2 slices are missing" in warning for warning in series.warnings)


def test_the_report_says_what_the_volume_has(two_series):
    series = bonemesh.scan(two_series, pixels=True).series[0]
    volume = bonemesh.read_series(two_series, 1)
    assert series.hu_range == (volume.hu.min(), volume.hu.max())
    assert np.array_equal(series.patient_from_voxel, volume.patient_from_voxel)
    assert volume.warnings == series.warnings


def test_slices_with_uids_of_their_own_are_one_series_on_request(ct_folder, tmp_path):
    folder = tmp_path / "broken"
    shutil.copytree(ct_folder, folder)
    for file in folder.iterdir():
        dataset = pydicom.dcmread(file)
        dataset.SeriesInstanceUID = pydicom.uid.generate_uid()
        dataset.save_as(file)
    with pytest.raises(bonemesh.DicomError, match="single slice"):
        bonemesh.scan(folder)
    healed = bonemesh.read_series(folder, one_series=True)
    assert np.array_equal(healed.hu, bonemesh.read_series(ct_folder).hu)
    assert any("taken as one" in warning for warning in healed.warnings)
    mesh = bonemesh.render(folder, one_series=True)
    assert np.array_equal(mesh.vertices, bonemesh.render(ct_folder).vertices)


def test_choosing_belongs_to_folders(volume):
    with pytest.raises(bonemesh.ArgumentError, match="leave them out with a volume"):
        bonemesh.render(volume, one_series=True)
