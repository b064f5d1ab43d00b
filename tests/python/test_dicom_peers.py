"""What other programs wrote is read as pydicom reads it: pydicom's own test files, and a phantom
compressed by DCMTK and GDCM."""

from __future__ import annotations

import shutil
import subprocess
import time
import warnings
from pathlib import Path
from typing import NamedTuple

import bonemesh
import numpy as np
import pydicom
import pytest
from pydicom import uid

FILES = Path(pydicom.__file__).parent / "data" / "test_files"
ALL = sorted(str(f.relative_to(FILES)) for f in FILES.rglob("*") if f.is_file())

# A second is what is promised; a busy machine may take more.
SECONDS = 5.0

# Many of pydicom's files are odd on purpose, and pydicom says so.
pytestmark = pytest.mark.filterwarnings("ignore::UserWarning:pydicom")


def dataset(name: str) -> pydicom.Dataset:
    with warnings.catch_warnings(action="ignore"):
        return pydicom.dcmread(FILES / name, force=True)


def is_image(data: pydicom.Dataset) -> bool:
    """Grey, up to 16 bits: what a CT series can be made of."""
    return (
        "PixelData" in data
        and data.get("SamplesPerPixel") == 1
        and data.get("BitsAllocated") in (8, 16)
        and data.get("PhotometricInterpretation") in ("MONOCHROME1", "MONOCHROME2")
    )


IMAGES = [name for name in ALL if is_image(dataset(name))]


def as_ct(data: pydicom.Dataset, folder: Path) -> Path:
    """The same pixels as two slices of a CT series, byte for byte."""
    folder.mkdir()
    data.Modality = "CT"
    data.ImageType = ["ORIGINAL", "PRIMARY", "AXIAL"]
    data.SeriesInstanceUID = uid.generate_uid()
    data.ImageOrientationPatient = [1, 0, 0, 0, 1, 0]
    data.PixelSpacing = [1, 1]
    for number in range(2):
        data.ImagePositionPatient = [0, 0, 2 * number]
        data.SOPInstanceUID = uid.generate_uid()
        data.file_meta.MediaStorageSOPInstanceUID = data.SOPInstanceUID
        data.save_as(folder / f"{number}.dcm")
    return folder


def expected_hu(data: pydicom.Dataset) -> np.ndarray:
    """Hounsfield units by pydicom; padding is air."""
    stored = data.pixel_array
    slope = float(data.get("RescaleSlope", 1))
    hu = stored * slope + float(data.get("RescaleIntercept", 0))
    if "PixelPaddingValue" in data:
        hu[stored == data.PixelPaddingValue] = -1000
    return hu.astype(np.float32)


# How far the values may lie from pydicom's, and why.
TOLERATED = {
    # Two implementations of the inverse cosine transform round some pixels differently.
    "JPEG-lossy.dcm": 1,
    "JPGExtended.dcm": 1,
}

# Files that neither pydicom with all its codecs nor bonemesh can decode, and what is said of them.
UNDECODABLE = {
    # Fewer bytes of pixels than rows and columns ask for.
    "MR_truncated.dcm": "fewer pixels than rows and columns say",
    # The delimiter of sequences was written over the size of the image, to test the parser.
    "JPEG2000-embedded-sequence-delimiter.dcm": "where the header says 1024 x 256",
}

# pydicom with its codecs cannot decode it: the header of its only scan names no coefficients.
# JPGExtended.dcm is the same picture with this put right.
REPAIRED = {"JPEG-lossy.dcm": "JPGExtended.dcm"}


@pytest.mark.parametrize("name", [n for n in IMAGES if n not in UNDECODABLE])
def test_an_image_of_pydicom_has_the_values_that_pydicom_reads(name, tmp_path):
    expected = expected_hu(dataset(REPAIRED.get(name, name)))
    volume = bonemesh.read_series(as_ct(dataset(name), tmp_path / "series"))
    assert volume.hu.shape == (2, *expected.shape)
    # Nothing but doubts about the unit: most of these are no CT images.
    units = ("HU", "Hounsfield")
    for warning in volume.warnings:
        assert any(unit in warning for unit in units), warning
    for hu in volume.hu:
        assert abs(hu - expected).max() <= TOLERATED.get(name, 0)


@pytest.mark.parametrize("name", [*UNDECODABLE, *REPAIRED])
def test_exceptions_are_files_that_pydicom_cannot_decode(name):
    with pytest.raises((RuntimeError, ValueError)):
        _ = dataset(name).pixel_array


@pytest.mark.parametrize("name", UNDECODABLE)
def test_an_image_that_nobody_decodes_is_refused_by_name(name, tmp_path):
    folder = as_ct(dataset(name), tmp_path / "series")
    began = time.perf_counter()
    with pytest.raises(bonemesh.DicomError, match=UNDECODABLE[name]):
        bonemesh.read_series(folder)
    assert time.perf_counter() - began < SECONDS


OTHERS = [
    name
    for name in ALL
    if name not in IMAGES
    and "PixelData" in (data := dataset(name))
    # More than 16 bits are read where there is one frame.
    and not (data.get("SamplesPerPixel") == 1 and data.get("BitsAllocated") == 32)
    # Elements without representations, where its transfer syntax says that they are there: pydicom
    # cannot write that again.
    and name != "SC_rgb_jpeg.dcm"
]


@pytest.mark.parametrize("name", OTHERS)
def test_a_picture_that_is_no_ct_is_refused_even_where_it_says_that_it_is(
    name, tmp_path
):
    folder = as_ct(dataset(name), tmp_path / "series")
    began = time.perf_counter()
    with pytest.raises(bonemesh.DicomError, match="no image|no transfer syntax"):
        bonemesh.read_series(folder)
    assert time.perf_counter() - began < SECONDS


# Why a file alone makes no series, where its modality does not say it.
REASONS = {
    "UN_sequence.dcm": "no pixels",
    "empty_charset_LEI.dcm": "no pixels",
    "meta_missing_tsyntax.dcm": "no transfer syntax",
    "nested_priv_SQ.dcm": "no rows",
    "no_meta_group_length.dcm": "no pixels",
    "priv_SQ.dcm": "no pixels",
    "rtplan_truncated.dcm": "cut off",
    # Big endian needs a header that says so.
    "ExplVR_BigEndNoMeta.dcm": "not a DICOM file",
    # It begins in the middle of an element.
    "no_meta.dcm": "not a DICOM file",
    "JPEGLSNearLossless_08.dcm": "no orientation",
    "JPEGLSNearLossless_16.dcm": "no orientation",
    "image_dfl.dcm": "modality OT",
}


def reason(name: str) -> str:
    """What to say of a file of pydicom's that is alone."""
    data = dataset(name)
    modality = data.get("Modality")
    if name in REASONS:
        return REASONS[name]
    if "DICOMDIR" in name:
        return "a directory of files, no image"
    if modality not in (None, "CT"):
        return f"modality {modality}, not CT"
    if data.get("SamplesPerPixel") == 3:
        return "a colour picture"
    if "LOCALIZER" in data.get("ImageType", ()):
        return "localizer"
    if modality == "CT":
        return "a single slice" if "PixelData" in data else "no pixels"
    return "not a DICOM file"


@pytest.mark.parametrize("name", ALL)
def test_a_file_of_pydicom_alone_is_refused_for_what_it_is(name, tmp_path):
    shutil.copy(FILES / name, tmp_path / "file")
    began = time.perf_counter()
    with pytest.raises(bonemesh.DicomError, match=reason(name)) as error:
        bonemesh.scan(tmp_path)
    assert time.perf_counter() - began < SECONDS
    assert "\n" not in str(error.value)


def test_every_file_of_pydicom_is_in_a_series_or_left_out():
    began = time.perf_counter()
    found = bonemesh.scan(FILES)
    assert time.perf_counter() - began < SECONDS
    used = [Path(f) for s in found.series for f in s.files]
    left_out = [Path(f.path) for f in found.left_out]
    names = sorted(str(f.relative_to(FILES)) for f in {*used, *left_out})
    assert names == ALL
    assert all(f.reason for f in found.left_out)


# What the stored values of the phantom are: (bits, is signed, HU of 0, HU of a step).
FORMS = {
    "8 bits": (8, False, -1024, 16),
    "12 bits": (12, False, -1024, 1),
    "16 bits": (16, True, 0, 1),
}


# Of values in 32-bit floating point (HU).
ROUNDING = 1e-3


class Recipe(NamedTuple):
    command: str
    form: str
    syntax: str
    # In stored values; None for what has lost more than that.
    from_original: int | None = 0
    # Decoders of JPEG and of lossy JPEG 2000 round their fractions differently.
    from_pydicom: int = 0


RECIPES = [
    Recipe("dcmconv +ti", "16 bits", uid.ImplicitVRLittleEndian),
    Recipe("dcmconv +te", "16 bits", uid.ExplicitVRLittleEndian),
    Recipe("dcmconv +tb", "16 bits", uid.ExplicitVRBigEndian),
    Recipe("dcmconv +tb", "8 bits", uid.ExplicitVRBigEndian),
    Recipe("dcmconv +td", "16 bits", uid.DeflatedExplicitVRLittleEndian),
    Recipe("dcmcrle", "8 bits", uid.RLELossless),
    Recipe("dcmcrle", "12 bits", uid.RLELossless),
    Recipe("dcmcrle +fs 1", "16 bits", uid.RLELossless),
    Recipe("dcmcjpeg +e1", "8 bits", uid.JPEGLosslessSV1),
    Recipe("dcmcjpeg +e1", "12 bits", uid.JPEGLosslessSV1),
    Recipe("dcmcjpeg +e1 +fs 1", "16 bits", uid.JPEGLosslessSV1),
    *(
        Recipe(f"dcmcjpeg +el +sv {sv}", form, uid.JPEGLossless)
        for sv in range(1, 8)
        for form in FORMS
    ),
    Recipe("dcmcjpeg +eb", "8 bits", uid.JPEGBaseline8Bit, None, 1),
    Recipe("dcmcjpeg +ee", "8 bits", uid.JPEGExtended12Bit, None, 1),
    Recipe("dcmcjpeg +ee +bt", "12 bits", uid.JPEGExtended12Bit, None, 1),
    Recipe("dcmcjpeg +ee +bt +fs 1", "12 bits", uid.JPEGExtended12Bit, None, 1),
    Recipe("dcmcjpls", "8 bits", uid.JPEGLSLossless),
    Recipe("dcmcjpls", "12 bits", uid.JPEGLSLossless),
    Recipe("dcmcjpls +fs 1 -ot", "16 bits", uid.JPEGLSLossless),
    Recipe("dcmcjpls +pc", "12 bits", uid.JPEGLSLossless),
    Recipe("dcmcjpls +en +md 3", "8 bits", uid.JPEGLSNearLossless, 3),
    Recipe("dcmcjpls +en", "12 bits", uid.JPEGLSNearLossless, 2),
    Recipe("gdcmconv --implicit", "16 bits", uid.ImplicitVRLittleEndian),
    Recipe("gdcmconv --explicit", "12 bits", uid.ExplicitVRLittleEndian),
    Recipe("gdcmconv --deflated", "16 bits", uid.DeflatedExplicitVRLittleEndian),
    *(
        Recipe(f"gdcmconv {kind}", form, syntax)
        for kind, syntax in [
            ("--jpeg", uid.JPEGLosslessSV1),
            ("--jpegls", uid.JPEGLSLossless),
            ("--j2k", uid.JPEG2000Lossless),
        ]
        for form in FORMS
    ),
    # An odd number of pixels of 8 bits ends GDCM itself.
    Recipe("gdcmconv --rle", "12 bits", uid.RLELossless),
    Recipe("gdcmconv --rle", "16 bits", uid.RLELossless),
    Recipe("gdcmconv --j2k --tile 32,32", "12 bits", uid.JPEG2000Lossless),
    Recipe("gdcmconv --jpeg --lossy -q 90", "8 bits", uid.JPEGBaseline8Bit, None, 1),
    Recipe("gdcmconv --j2k --lossy -r 8", "12 bits", uid.JPEG2000, None, 1),
    Recipe("gdcmconv --j2k --lossy -r 5", "16 bits", uid.JPEG2000, None, 1),
    Recipe("gdcmconv --jpegls --lossy -e 2", "12 bits", uid.JPEGLSNearLossless, 2),
]


@pytest.fixture(scope="session")
def forms(tmp_path_factory) -> dict[str, Path]:
    """Slices through a phantom in all forms of stored values, as folders of a series."""
    root = tmp_path_factory.mktemp("forms")
    written = bonemesh.write_phantom("sphere-shell", root / "whole", coarser=3.0)
    slices = sorted(Path(written["series"]).iterdir())[8:11]
    folders = {}
    for form, (bits, is_signed, intercept, slope) in FORMS.items():
        folders[form] = root / form
        folders[form].mkdir()
        for file in slices:
            data = pydicom.dcmread(file)
            hu = data.pixel_array.astype(int) - 1024
            cell = np.dtype(f"{'i' if is_signed else 'u'}{1 if bits == 8 else 2}")
            data.PixelData = ((hu - intercept) // slope).astype(cell).tobytes()
            data.PixelData += b"\0" * (len(data.PixelData) % 2)
            data["PixelData"].VR = "OB" if bits == 8 else "OW"
            data.BitsAllocated = 8 * cell.itemsize
            data.BitsStored, data.HighBit = bits, bits - 1
            data.PixelRepresentation = int(is_signed)
            data.RescaleIntercept, data.RescaleSlope = intercept, slope
            data.save_as(folders[form] / file.name)
    return folders


def converted(command: str, source: Path, folder: Path) -> Path:
    """The series as another program writes it."""
    program, *options = command.split()
    if shutil.which(program) is None:
        pytest.skip(f"{program} is not installed")
    folder.mkdir()
    for file in source.iterdir():
        words = [program, *options, str(file), str(folder / file.name)]
        subprocess.run(words, check=True, capture_output=True, timeout=60)
    return folder


@pytest.mark.parametrize("recipe", RECIPES, ids=lambda r: f"{r.command}, {r.form}")
def test_a_phantom_that_others_compressed_is_read_as_pydicom_reads_it(
    recipe, forms, tmp_path
):
    original = forms[recipe.form]
    folder = converted(recipe.command, original, tmp_path / "series")
    by_pydicom = [pydicom.dcmread(f) for f in sorted(folder.iterdir())]
    assert {d.file_meta.TransferSyntaxUID for d in by_pydicom} == {recipe.syntax}
    hu = bonemesh.read_series(folder).hu.astype(float)
    assert len(hu) == 3
    step = float(by_pydicom[0].RescaleSlope)
    expected = np.stack([expected_hu(d) for d in by_pydicom])
    assert abs(hu - expected).max() <= recipe.from_pydicom * step + ROUNDING
    if recipe.from_original is not None:
        truth = bonemesh.read_series(original).hu
        assert abs(hu - truth).max() <= recipe.from_original * step


@pytest.mark.parametrize(
    ("process", "syntax"),
    [("+es", "1.2.840.10008.1.2.4.53"), ("+ep", "1.2.840.10008.1.2.4.55")],
)
def test_processes_that_the_standard_gave_up_are_refused_by_their_number(
    process, syntax, forms, tmp_path
):
    folder = converted(f"dcmcjpeg {process}", forms["8 bits"], tmp_path / "series")
    with pytest.raises(bonemesh.DicomError, match=f"transfer syntax {syntax}"):
        bonemesh.read_series(folder)
