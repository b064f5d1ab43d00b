"""Volumes in one file read as SimpleITK wrote them, and give the mesh of their DICOM series."""

from __future__ import annotations

from pathlib import Path

import bonemesh
import numpy as np
import pytest
import SimpleITK as sitk
from scipy.spatial.transform import Rotation

ENDINGS = ["nii", "nii.gz", "hdr", "nrrd", "nhdr"]
TYPES = ["int8", "uint8", "int16", "uint16", "int32", "uint32", "float32", "float64"]
# NIfTI-1 keeps its map in 32-bit numbers.
MM = 1e-4


def directions(name: str) -> np.ndarray:
    """Columns of an orientation: where columns, rows and slices run to."""
    return {
        "axial": np.eye(3),
        "feet-first": np.diag([-1.0, 1.0, -1.0]),
        "sagittal": np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, -1.0, 0.0]]),
        "coronal": np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]]),
        "oblique": Rotation.from_euler("xyz", [17, -24, 31], degrees=True).as_matrix(),
        "left-handed": np.diag([1.0, 1.0, -1.0]),
    }[name]


def image(voxels: np.ndarray, direction: np.ndarray) -> sitk.Image:
    made = sitk.GetImageFromArray(voxels)
    made.SetSpacing((0.4, 0.7, 1.3))
    made.SetOrigin((-12.5, 33.25, 101.75))
    made.SetDirection(direction.ravel().tolist())
    return made


def patient_from_voxel(made: sitk.Image) -> np.ndarray:
    matrix = np.eye(4)
    matrix[:3, :3] = np.array(made.GetDirection()).reshape(3, 3) * made.GetSpacing()
    matrix[:3, 3] = made.GetOrigin()
    return matrix


@pytest.mark.parametrize("ending", ENDINGS)
@pytest.mark.parametrize(
    "orientation",
    ["axial", "feet-first", "sagittal", "coronal", "oblique", "left-handed"],
)
def test_every_orientation_is_where_simpleitk_puts_it(tmp_path, ending, orientation):
    voxels = np.random.default_rng(3).integers(-1000, 2000, (7, 6, 5), dtype=np.int16)
    made = image(voxels, directions(orientation))
    path = tmp_path / f"volume.{ending}"
    sitk.WriteImage(made, str(path))
    volume = bonemesh.read_series(path)
    assert volume.hu.dtype == np.int16
    assert (volume.hu == voxels).all()
    found = volume.patient_from_voxel
    np.testing.assert_allclose(found, patient_from_voxel(made), atol=MM)


@pytest.mark.parametrize("ending", ENDINGS)
@pytest.mark.parametrize("kind", TYPES)
def test_every_type_gives_the_values_that_simpleitk_reads(tmp_path, ending, kind):
    random = np.random.default_rng(4)
    if kind.startswith("float"):
        voxels = random.normal(0, 900, (7, 6, 5)).astype(kind)
    else:
        limits = np.iinfo(kind)
        low, high = max(limits.min, -30_000), min(limits.max, 60_000)
        voxels = random.integers(low, high, (7, 6, 5)).astype(kind)
    path = tmp_path / f"volume.{ending}"
    sitk.WriteImage(image(voxels, np.eye(3)), str(path), ending in ("nrrd", "nhdr"))
    assert (bonemesh.read_series(path).hu == voxels.astype(np.float32)).all()


@pytest.mark.parametrize("ending", ["nii.gz", "nrrd"])
def test_a_series_saved_as_one_file_gives_its_mesh(tmp_path, ct_folder, ending):
    series = bonemesh.read_series(ct_folder)
    made = sitk.GetImageFromArray(np.ascontiguousarray(series.hu))
    matrix = series.patient_from_voxel
    spacing = np.linalg.norm(matrix[:3, :3], axis=0)
    made.SetSpacing(spacing.tolist())
    made.SetDirection((matrix[:3, :3] / spacing).ravel().tolist())
    made.SetOrigin(matrix[:3, 3].tolist())
    path = tmp_path / f"sphere.{ending}"
    sitk.WriteImage(made, str(path))
    expected, found = bonemesh.render(ct_folder), bonemesh.render(path)
    assert found.report["watertight"] == expected.report["watertight"]
    assert len(found.vertices) == len(expected.vertices)
    np.testing.assert_allclose(found.vertices, expected.vertices, atol=10 * MM)


def test_the_file_is_reported_as_a_series(tmp_path):
    voxels = np.zeros((7, 6, 5), np.int16)
    path = tmp_path / "Schädel 頭.nii.gz"
    sitk.WriteImage(image(voxels, np.eye(3)), str(tmp_path / "plain.nii.gz"))
    (tmp_path / "plain.nii.gz").rename(path)
    (found,) = bonemesh.find_series(path)
    assert (found.slices, found.rows, found.columns) == (7, 6, 5)
    np.testing.assert_allclose(found.spacing_mm, (0.4, 0.7, 1.3), atol=MM)
    assert any("Hounsfield" in w for w in bonemesh.read_series(path).warnings)


def test_several_volumes_in_a_file_are_counted(tmp_path):
    one = image(np.zeros((7, 6, 5), np.int16), np.eye(3))
    path = tmp_path / "times.nii"
    sitk.WriteImage(sitk.JoinSeries([one, one, one]), str(path))
    with pytest.raises(bonemesh.BonemeshError, match="holds 3 volumes"):
        bonemesh.read_series(path)


def test_a_file_that_is_cut_off_is_named(tmp_path, command):
    path: Path = tmp_path / "volume.nii"
    voxels = np.zeros((7, 6, 5), np.int16)
    sitk.WriteImage(image(voxels, np.eye(3)), str(path))
    path.write_bytes(path.read_bytes()[:-1])
    answer = command("info", path)
    assert answer.code != 0
    assert "volume.nii is cut off" in answer.err
