"""Pixels compressed here, in all depths and signs, as slices and as frames, come back unchanged."""

from __future__ import annotations

import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import bonemesh
import numpy as np
import pydicom
import pytest
from pydicom import encaps, uid
from pydicom.dataset import Dataset, FileMetaDataset

SHAPE = (37, 51)


class Depth(NamedTuple):
    """Bits of a cell and of the value in it; values from the lowest to the highest."""

    allocated: int
    stored: int
    is_signed: bool

    def __str__(self) -> str:
        sign = "signed" if self.is_signed else "unsigned"
        return f"{self.stored} of {self.allocated} bits, {sign}"

    @property
    def cell(self) -> np.dtype:
        return np.dtype(f"<{'i' if self.is_signed else 'u'}{self.allocated // 8}")


DEPTHS = [
    Depth(allocated, stored, is_signed)
    for allocated, stored in [(8, 8), (16, 8), (16, 12), (16, 13), (16, 16)]
    for is_signed in (False, True)
]


def values(depth: Depth, slices: int) -> np.ndarray:
    """A slope over all values with noise on it, and both ends."""
    low = -(2 ** (depth.stored - 1)) if depth.is_signed else 0
    high = low + 2**depth.stored - 1
    shape = (slices, *SHAPE)
    smooth = np.linspace(low, high, int(np.prod(shape))).reshape(shape)
    noise = np.random.default_rng(5).normal(0, (high - low) / 100, shape)
    pixels = np.clip(np.rint(smooth + noise), low, high)
    pixels[:, 0, :2] = low, high
    return pixels.astype(depth.cell)


def image(depth: Depth) -> Dataset:
    """A header without pixels, of the first slice."""
    data = Dataset()
    data.file_meta = FileMetaDataset()
    data.file_meta.TransferSyntaxUID = uid.ExplicitVRLittleEndian
    data.file_meta.MediaStorageSOPClassUID = uid.CTImageStorage
    data.file_meta.MediaStorageSOPInstanceUID = uid.generate_uid()
    data.SOPClassUID = uid.CTImageStorage
    data.SOPInstanceUID = data.file_meta.MediaStorageSOPInstanceUID
    data.SeriesInstanceUID = "1.2.3.4"
    data.Modality = "CT"
    data.ImagePositionPatient = [0, 0, 0]
    data.ImageOrientationPatient = [1, 0, 0, 0, 1, 0]
    data.PixelSpacing = [1, 1]
    data.SamplesPerPixel = 1
    data.PhotometricInterpretation = "MONOCHROME2"
    data.Rows, data.Columns = SHAPE
    data.BitsAllocated, data.BitsStored = depth.allocated, depth.stored
    data.HighBit = depth.stored - 1
    data.PixelRepresentation = int(depth.is_signed)
    data.RescaleIntercept, data.RescaleSlope = 0, 1
    return data


# Compresses the pixels that a data set has.
Encoder = Callable[[Dataset], None]


def by_pydicom(syntax: uid.UID, plugin: str) -> Encoder:
    return lambda data: data.compress(
        syntax, encoding_plugin=plugin, generate_instance_uid=False
    )


def by_dcmtk(program: str, *options: str) -> Encoder:
    """pydicom cannot write JPEG."""

    def compress(data: Dataset) -> None:
        if shutil.which(program) is None:
            pytest.skip(f"{program} is not installed")
        source = Path(data.filename)
        data.save_as(source)
        target = source.with_suffix(".compressed")
        words = [program, *options, str(source), str(target)]
        subprocess.run(words, check=True, capture_output=True, timeout=60)
        source.unlink()
        compressed = pydicom.dcmread(target)
        target.unlink()
        data.PixelData = compressed.PixelData
        data["PixelData"].is_undefined_length = True
        data.file_meta.TransferSyntaxUID = compressed.file_meta.TransferSyntaxUID

    return compress


CODECS: dict[str, Encoder] = {
    "RLE": by_pydicom(uid.RLELossless, "pydicom"),
    "RLE of DCMTK": by_dcmtk("dcmcrle"),
    "JPEG-LS": by_pydicom(uid.JPEGLSLossless, "pyjpegls"),
    "JPEG 2000": by_pydicom(uid.JPEG2000Lossless, "pylibjpeg"),
    "JPEG, first predictor": by_dcmtk("dcmcjpeg", "+e1"),
    "JPEG, sixth predictor": by_dcmtk("dcmcjpeg", "+el", "+sv", "6"),
}


def put(data: Dataset, pixels: np.ndarray) -> None:
    content = pixels.tobytes()
    data.PixelData = content + b"\0" * (len(content) % 2)
    data["PixelData"].VR = "OB" if data.BitsAllocated == 8 else "OW"


def write(folder: Path, pixels: np.ndarray, depth: Depth, codec: str) -> None:
    """A series of one file for each slice."""
    for number, slice_ in enumerate(pixels):
        data = image(depth)
        data.ImagePositionPatient = [0, 0, number]
        data.filename = folder / f"{number}.dcm"
        put(data, slice_)
        CODECS[codec](data)
        data.save_as(data.filename)


@pytest.mark.parametrize("depth", DEPTHS, ids=str)
@pytest.mark.parametrize("codec", CODECS)
def test_compressed_slices_are_the_values_that_were_compressed(codec, depth, tmp_path):
    if codec == "RLE" and depth.stored == 8 < depth.allocated:
        pytest.skip("pydicom compresses these cells as if they were of 8 bits")
    pixels = values(depth, 2)
    write(tmp_path, pixels, depth, codec)
    assert (bonemesh.read_series(tmp_path).hu == pixels).all()


IN_ANOTHER_PROGRAM = """
import ctypes, os, sys
try:
    ctypes.CDLL("libopenjp2.so.7", mode=os.RTLD_GLOBAL)
except OSError:
    sys.exit(3)
import bonemesh
sys.stdout.buffer.write(bonemesh.read_series(sys.argv[1]).hu.tobytes())
"""


@pytest.mark.skipif(sys.platform != "linux", reason="other loaders keep them apart")
def test_a_program_with_another_jpeg_2000_decoder_keeps_it_to_itself(tmp_path):
    """As Blender from a distribution: its library has functions of the same names."""
    depth = Depth(16, 12, is_signed=False)
    pixels = values(depth, 2)
    write(tmp_path, pixels, depth, "JPEG 2000")
    words = [sys.executable, "-c", IN_ANOTHER_PROGRAM, str(tmp_path)]
    done = subprocess.run(words, capture_output=True, timeout=60, check=False)
    if done.returncode == 3:
        pytest.skip("libopenjp2 is not installed")
    assert done.returncode == 0, done.stderr.decode()
    read = np.frombuffer(done.stdout, bonemesh.read_series(tmp_path).hu.dtype)
    assert (read.reshape(pixels.shape) == pixels).all()


@pytest.mark.parametrize("is_signed", [False, True])
@pytest.mark.parametrize("codec", ["JPEG-LS", "JPEG 2000", "JPEG, first predictor"])
def test_a_stream_of_8_bits_fills_cells_of_16(codec, is_signed, tmp_path):
    """The stream was made from 8-bit cells; the header around it says 16."""
    narrow, wide = Depth(8, 8, is_signed), Depth(16, 8, is_signed)
    pixels = values(narrow, 2)
    for number, slice_ in enumerate(pixels):
        data = image(narrow)
        data.ImagePositionPatient = [0, 0, number]
        data.filename = tmp_path / f"{number}.dcm"
        put(data, slice_)
        CODECS[codec](data)
        data.BitsAllocated = wide.allocated
        data.save_as(data.filename)
    assert (bonemesh.read_series(tmp_path).hu == pixels).all()


FRAMES = 6
DEPTH = Depth(16, 13, is_signed=True)
# How the frames are put into items: fragments a frame, and the table of their offsets.
LAYOUTS = {
    "one fragment, basic table": (1, "basic"),
    "one fragment, no table": (1, None),
    "one fragment, extended table": (1, "extended"),
    "three fragments, basic table": (3, "basic"),
    "three fragments, no table": (3, None),
}


def enhanced(pixels: np.ndarray) -> Dataset:
    """An Enhanced CT image; its frames are stored in another order than they lie."""
    data = image(DEPTH)
    data.SOPClassUID = uid.EnhancedCTImageStorage
    data.file_meta.MediaStorageSOPClassUID = uid.EnhancedCTImageStorage
    for keyword in ("ImagePositionPatient", "RescaleIntercept", "RescaleSlope"):
        delattr(data, keyword)
    shared, orientation, measures = Dataset(), Dataset(), Dataset()
    orientation.ImageOrientationPatient = [1, 0, 0, 0, 1, 0]
    measures.PixelSpacing = [1, 1]
    shared.PlaneOrientationSequence = [orientation]
    shared.PixelMeasuresSequence = [measures]
    data.SharedFunctionalGroupsSequence = [shared]
    data.NumberOfFrames = len(pixels)
    data.PerFrameFunctionalGroupsSequence = []
    for number in range(len(pixels)):
        own, position, rescale = Dataset(), Dataset(), Dataset()
        position.ImagePositionPatient = [0, 0, place(number)]
        # Each frame has its own way to Hounsfield units.
        rescale.RescaleIntercept, rescale.RescaleSlope = -number, 2
        own.PlanePositionSequence = [position]
        own.PixelValueTransformationSequence = [rescale]
        data.PerFrameFunctionalGroupsSequence.append(own)
    return data


def place(number: int) -> int:
    """Where the frame of this number lies."""
    return (number * 5 + 2) % FRAMES


def frame_of(data: Dataset, pixels: np.ndarray, codec: str, folder: Path) -> bytes:
    single = image(DEPTH)
    single.filename = folder / "frame.dcm"
    put(single, pixels)
    CODECS[codec](single)
    data.file_meta.TransferSyntaxUID = single.file_meta.TransferSyntaxUID
    return next(encaps.generate_frames(single.PixelData, number_of_frames=1))


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("codec", CODECS)
def test_compressed_frames_are_the_values_that_were_compressed(codec, layout, tmp_path):
    fragments, table = LAYOUTS[layout]
    if "RLE" in codec and fragments > 1:
        pytest.skip("one fragment a frame, by the standard")
    pixels = values(DEPTH, FRAMES)
    data = enhanced(pixels)
    frames = [frame_of(data, p, codec, tmp_path) for p in pixels]
    if table == "extended":
        data.PixelData, offsets, lengths = encaps.encapsulate_extended(frames)
        data.ExtendedOffsetTable, data.ExtendedOffsetTableLengths = offsets, lengths
    else:
        data.PixelData = encaps.encapsulate(
            frames, fragments_per_frame=fragments, has_bot=table == "basic"
        )
    data["PixelData"].VR = "OB"
    data["PixelData"].is_undefined_length = True
    folder = tmp_path / "series"
    folder.mkdir()
    data.save_as(folder / "frames.dcm")
    expected = np.empty(pixels.shape, int)
    for number, frame in enumerate(pixels):
        expected[place(number)] = 2 * frame.astype(int) - number
    assert (bonemesh.read_series(folder).hu == expected).all()
