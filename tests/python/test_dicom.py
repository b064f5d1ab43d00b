"""Phantom series are what other DICOM readers expect, and reading gives back what was written."""

from __future__ import annotations

from pathlib import Path

import bonemesh
import numpy as np
import pydicom
import pytest
import SimpleITK as sitk
from pydicom.valuerep import validate_value
from scipy.spatial import KDTree

ORIENTATIONS = [
    "axial",
    "reversed",
    "sagittal",
    "coronal",
    "oblique",
    "tilted",
    "feet-first",
    "prone",
    "decubitus-left",
    "decubitus-right",
]
# DICOM writes numbers as decimal text of 16 characters.
MM = 1e-6

pytestmark = pytest.mark.filterwarnings("error::UserWarning")


@pytest.fixture(scope="module", params=ORIENTATIONS)
def written(request, tmp_path_factory) -> tuple[bonemesh.Volume, Path]:
    """A phantom as a volume, and the folder of its series."""
    settings = {"coarser": 3.0, "orientation": request.param}
    folder = tmp_path_factory.mktemp("phantom") / request.param
    places = bonemesh.write_phantom("tube", folder, **settings)
    return bonemesh.phantom("tube", **settings), Path(places["series"])


def datasets(folder: Path, volume: bonemesh.Volume) -> list[pydicom.Dataset]:
    """The files in the order of the volume's slices."""
    found = [pydicom.dcmread(file) for file in folder.iterdir()]
    origin = volume.patient_from_voxel[:3, 3]
    step = volume.patient_from_voxel[:3, 2]
    return sorted(found, key=lambda d: np.dot(d.ImagePositionPatient - origin, step))


def test_pydicom_reads_the_same_hounsfield_units(written):
    volume, folder = written
    slices = datasets(folder, volume)
    assert len(slices) == len(volume.hu)
    for dataset, hu in zip(slices, volume.hu, strict=True):
        stored = dataset.pixel_array.astype(float)
        rescaled = stored * float(dataset.RescaleSlope) + float(
            dataset.RescaleIntercept
        )
        assert (rescaled == hu).all()


def test_pydicom_reads_the_same_geometry(written):
    volume, folder = written
    affine = volume.patient_from_voxel
    for k, dataset in enumerate(datasets(folder, volume)):
        row_spacing, column_spacing = map(float, dataset.PixelSpacing)
        along_row, along_column = np.array(
            dataset.ImageOrientationPatient, float
        ).reshape(2, 3)
        assert np.allclose(along_row * column_spacing, affine[:3, 0], rtol=0, atol=MM)
        assert np.allclose(along_column * row_spacing, affine[:3, 1], rtol=0, atol=MM)
        corner = affine @ [0, 0, k, 1]
        assert np.allclose(dataset.ImagePositionPatient, corner[:3], rtol=0, atol=1e-4)


def test_the_files_are_a_proper_ct_series(written):
    volume, folder = written
    slices = datasets(folder, volume)
    for dataset in slices:
        assert dataset.SOPClassUID == pydicom.uid.CTImageStorage
        assert dataset.file_meta.MediaStorageSOPInstanceUID == dataset.SOPInstanceUID
        assert dataset.Modality == "CT"
        for required in [
            *("PatientName", "PatientID", "StudyInstanceUID", "StudyDate", "StudyTime"),
            *("FrameOfReferenceUID", "InstanceNumber", "ImageType", "SamplesPerPixel"),
            *(
                "PhotometricInterpretation",
                "Rows",
                "Columns",
                "BitsAllocated",
                "BitsStored",
            ),
            *(
                "HighBit",
                "PixelRepresentation",
                "KVP",
                "AcquisitionNumber",
                "PatientPosition",
            ),
            *("Manufacturer", "AccessionNumber", "ReferringPhysicianName", "StudyID"),
        ]:
            assert required in dataset, required
        for uid in ("SOPInstanceUID", "SeriesInstanceUID", "StudyInstanceUID"):
            assert pydicom.uid.UID(dataset[uid].value).is_valid
        # pydicom refuses to write values that do not obey their representation.
        for element in filter(lambda element: not element.is_empty, dataset):
            values = element.value if element.VM > 1 else [element.value]
            for value in values:
                text = value if element.VR in ("US", "OB", "OW") else str(value)
                validate_value(element.VR, text, pydicom.config.RAISE)
    assert len({d.SeriesInstanceUID for d in slices}) == 1
    assert len({d.SOPInstanceUID for d in slices}) == len(slices)
    assert len({d.FrameOfReferenceUID for d in slices}) == 1
    assert sorted(int(d.InstanceNumber) for d in slices) == list(
        range(1, len(slices) + 1)
    )


def test_simpleitk_reads_the_same_voxels_at_the_same_places(written):
    volume, folder = written
    if abs(sheared(volume)) > MM:
        pytest.skip("SimpleITK knows no sheared grids")
    reader = sitk.ImageSeriesReader()
    reader.SetFileNames(reader.GetGDCMSeriesFileNames(str(folder)))
    image = reader.Execute()
    hu = sitk.GetArrayFromImage(image)
    assert sorted(hu.shape) == sorted(volume.hu.shape)
    voxel_from_patient = np.linalg.inv(volume.patient_from_voxel)
    random = np.random.default_rng(0)
    for _ in range(300):
        k, j, i = (int(random.integers(n)) for n in hu.shape)
        place = image.TransformIndexToPhysicalPoint((i, j, k))
        ours = voxel_from_patient @ [*place, 1]
        column, row, slice_ = np.rint(ours[:3]).astype(int)
        assert np.allclose(ours[:3], [column, row, slice_], rtol=0, atol=1e-3)
        assert hu[k, j, i] == volume.hu[slice_, row, column]


def sheared(volume: bonemesh.Volume) -> float:
    """How far the step from slice to slice is from the normal of the slices (mm)."""
    x, y, step = volume.patient_from_voxel[:3, :3].T
    return float(np.hypot(np.dot(step, x), np.dot(step, y)))


def test_reading_gives_back_what_was_written(written):
    """Slices come in the order of their normal, whichever way they were written."""
    volume, folder = written
    read = bonemesh.read_series(folder)
    written_from_read = (
        np.linalg.inv(volume.patient_from_voxel) @ read.patient_from_voxel
    )
    expected = np.eye(4)
    hu = volume.hu
    if written_from_read[2, 2] < 0:
        expected[2] = [0, 0, -1, len(hu) - 1]
        hu = hu[::-1]
    assert np.allclose(written_from_read, expected, rtol=0, atol=1e-4)
    assert (read.hu == hu).all()
    assert np.allclose(read.spacing_mm, volume.spacing_mm, rtol=0, atol=1e-4)
    assert np.linalg.det(read.patient_from_voxel) > 0, "right-handed"
    assert read.warnings == []


def test_rendering_the_series_is_rendering_the_volume(written):
    volume, folder = written
    from_files, from_memory = (
        bonemesh.render(scanned, method="alpha") for scanned in (folder, volume)
    )
    assert len(from_files.vertices) == len(from_memory.vertices)
    distances, partners = KDTree(from_memory.vertices).query(from_files.vertices)
    assert distances.max() < 1e-3
    assert len(set(partners.tolist())) == len(partners)
    for key in ("points", "volume_mm3", "alpha_mm"):
        assert from_files.report[key] == pytest.approx(
            from_memory.report[key], rel=1e-5
        )


def test_every_orientation_gives_the_same_body(written):
    """The tube stands upright in the patient, however its slices lie."""
    volume, _ = written
    low, high = np.array(bonemesh.check(bonemesh.render(volume))["bounds_mm"])
    assert np.allclose(low[:2], [-15, -15], rtol=0, atol=max(volume.spacing_mm))
    assert np.allclose(high[:2], [15, 15], rtol=0, atol=max(volume.spacing_mm))
    assert low[2] < -20 and high[2] > 20


def test_series_are_found_by_number_and_uid(tmp_path):
    small = bonemesh.write_phantom("tube", tmp_path / "small", coarser=4.0)
    large = bonemesh.write_phantom("tube", tmp_path / "large", coarser=2.0)
    found = bonemesh.find_series(tmp_path)
    assert [s.number for s in found] == [1, 2]
    assert [len(s.files) for s in found] == [len(large["files"]), len(small["files"])]
    assert {file.parent for file in found[1].files} == {Path(small["series"])}
    with pytest.raises(bonemesh.DicomError, match="choose one") as caught:
        bonemesh.read_series(tmp_path)
    assert found[0].uid in str(caught.value)
    for series in found:
        by_number = bonemesh.read_series(tmp_path, series.number)
        by_uid = bonemesh.read_series(str(tmp_path), series.uid)
        assert len(by_number.hu) == len(by_uid.hu) == series.slices
    for missing in (3, "1.2.3"):
        with pytest.raises(bonemesh.ArgumentError, match="no series"):
            bonemesh.read_series(tmp_path, missing)


def test_what_is_known_before_reading_is_what_is_read(ct_folder):
    series = bonemesh.find_series(ct_folder)[0]
    volume = bonemesh.read_series(ct_folder)
    assert volume.hu.shape == (series.slices, series.rows, series.columns)
    assert np.allclose(volume.spacing_mm, series.spacing_mm)
    assert volume.hu.nbytes == series.estimated_memory_bytes
    assert (series.modality, series.slices_found) == ("CT", series.slices)


def test_folders_are_os_errors_and_their_content_is_not(ct_folder, tmp_path):
    file = next(ct_folder.iterdir())
    for path, error in [
        (tmp_path / "missing", FileNotFoundError),
        (file, NotADirectoryError),
        (tmp_path, bonemesh.DicomError),
    ]:
        for call in (
            bonemesh.scan,
            bonemesh.find_series,
            bonemesh.read_series,
            bonemesh.render,
        ):
            with pytest.raises(error) as caught:
                call(path)
            assert str(path) in str(caught.value) and "\n" not in str(caught.value)
    with pytest.raises(FileExistsError, match="choose an empty"):
        bonemesh.write_phantom("tube", ct_folder, coarser=4.0)


@pytest.mark.parametrize("name", ["headsq", "cranium", "philips-skull"])
def test_real_series_are_read_as_simpleitk_reads_them(real_ct, name):
    volume = bonemesh.read_series(real_ct(name))
    reader = sitk.ImageSeriesReader()
    series = reader.GetGDCMSeriesIDs(str(real_ct(name)))
    files = [reader.GetGDCMSeriesFileNames(str(real_ct(name)), uid) for uid in series]
    reader.SetFileNames(max(files, key=len))
    image = reader.Execute()
    assert (sitk.GetArrayFromImage(image) == volume.hu).all()
    for index in [(0, 0, 0), (7, 3, 11)]:
        ours = volume.patient_from_voxel @ [*index, 1]
        theirs = image.TransformIndexToPhysicalPoint(index)
        assert np.allclose(ours[:3], theirs, rtol=0, atol=1e-3)
