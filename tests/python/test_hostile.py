"""Files that lie about themselves end in one clear line, soon, and in little memory."""

from __future__ import annotations

import json
import os
import struct
import subprocess
import sys
import sysconfig
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import pydicom
import pytest
from hostile_files import (
    CLAIM,
    DEFLATED,
    EXPLICIT,
    IMPLICIT,
    JPEG,
    JPEG_2000,
    JPEG_LS,
    PER_FRAME,
    PIXELS,
    RLE,
    SEQUENCE_END,
    SHARED,
    STREAMS,
    UNDEFINED,
    Image,
    bomb,
    element,
    framed,
    item,
    meta,
    nested,
)

pytestmark = pytest.mark.skipif(
    sys.platform != "linux", reason="peak memory is measured as Linux counts it"
)

MEMORY_MIB = 200
# A second is what is promised; a busy machine counts up to twice as much for the same work.
CPU_S = 2.0

# Starts the command and prints how it ended. A process of its own: a child counts the memory of
# the process that started it, and pytest has a lot.
MEASURE = """
import json, os, sys
child = os.posix_spawn(sys.argv[1], sys.argv[1:], os.environ)
_, status, usage = os.wait4(child, 0)
code = os.waitstatus_to_exitcode(status)
sys.stderr.write("\\n" + json.dumps([code, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024]))
"""


class Ending(NamedTuple):
    code: int
    out: str
    err: str


def run(
    *arguments: object, cpu_s: float = CPU_S, memory_mib: int = MEMORY_MIB
) -> Ending:
    """The command's end, which came in time and within memory."""
    program = Path(sysconfig.get_path("scripts")) / "bonemesh"
    words = [sys.executable, "-I", "-S", "-c", MEASURE, str(program)]
    done = subprocess.run(
        [*words, *map(str, arguments)],
        check=True,
        capture_output=True,
        text=True,
        timeout=120,
    )
    err, measured = done.stderr.rsplit("\n", 1)
    code, seconds, mib = json.loads(measured)
    assert mib < memory_mib, f"{mib:.0f} MiB"
    assert seconds < cpu_s, f"{seconds:.1f} s"
    return Ending(code, done.stdout, err)


def fails(folder: Path, says: str = "", **limits: float) -> None:
    """Making a mesh fails with one line that says why."""
    end = run("render", folder, "-o", folder.with_suffix(".stl"), **limits)
    assert end.code == 1, end
    assert end.err.startswith("bonemesh: ") and end.err.count("\n") == 1, end.err[:2000]
    assert len(end.err) < 2000
    assert says in end.err


def write(folder: Path, files: list[bytes]) -> Path:
    folder.mkdir()
    for number, content in enumerate(files):
        (folder / f"{number:04}").write_bytes(content)
    return folder


def in_company(tmp_path: Path, hostile: bytes, says: str) -> None:
    """Alone the file is no series; among good slices it is left out, and both say why."""
    fails(write(tmp_path / "alone", [hostile]), says)
    good = [Image(n).file() for n in range(3)]
    end = run("info", write(tmp_path / "among", [*good, hostile]), "--json")
    assert end.code == 0, end
    report = json.loads(end.out)
    assert [len(s["files"]) for s in report["series"]] == [3]
    (left_out,) = report["left_out"]
    assert left_out["path"].endswith("0003") and says in left_out["reason"], left_out


@pytest.mark.parametrize("defined", [True, False], ids=["defined", "undefined"])
@pytest.mark.parametrize("place", ["root", "private", "shared", "per-frame", "unknown"])
def test_200_000_nested_sequences_end_the_file_and_not_the_program(
    tmp_path, place, defined
):
    inner = (0x28, 0x9145)
    tag = {"private": (0x09, 0x1001), "shared": SHARED, "per-frame": PER_FRAME}.get(
        place, (0x08, 0x1140)
    )
    content = nested(200_000, defined=defined, explicit=place != "unknown", tag=inner)
    content = item(content, None if defined else UNDEFINED)
    vr = "UN" if place == "unknown" else "SQ"
    # What is unknown is a sequence only where its length is undefined.
    length = None if defined and place != "unknown" else UNDEFINED
    image = Image().put(tag, element(tag, vr, content + SEQUENCE_END, length))
    if defined and place in ("root", "private", "unknown"):
        # Passed over as a whole: the slice is as good as any.
        folder = write(tmp_path / "series", [image.file(), Image(1).file()])
        assert len(json.loads(run("info", folder, "--json").out)["series"]) == 1
    else:
        in_company(tmp_path, image.file(), "nested too deeply")


@pytest.mark.parametrize(
    "claim",
    [
        element((0x08, 0x60), "UT", b"CT", CLAIM),
        element((0x08, 0x60), "UN", b"CT", CLAIM),
        element((0x09, 0x1001), "OB", b"", CLAIM),
        element((0x08, 0x1140), "SQ", item(b""), CLAIM),
        element((0x08, 0x1140), "SQ", item(b"", CLAIM), UNDEFINED),
        element(SHARED, "SQ", item(element((0x28, 0x9110), "SQ", b"", CLAIM))),
        element(PER_FRAME, "SQ", item(element((0x20, 0x32), "UN", b"", CLAIM))),
    ],
    ids=["text", "unknown", "bytes", "sequence", "item", "shared", "per-frame"],
)
def test_a_claim_of_4_gb_is_not_believed(tmp_path, claim):
    tag = struct.unpack_from("<HH", claim)
    in_company(tmp_path, Image().put(tag, claim).file(), "cut off")


def test_a_deflate_bomb_in_the_header_is_not_inflated(tmp_path):
    image = Image(syntax=DEFLATED)
    data_set = image.data_set()
    for place, head in {
        "private": element((0x09, 0x1001), "OB", b"", 3 << 30),
        "wanted": element((0x08, 0x60), "UT", b"", 3 << 30),
        "empty elements": b"",
    }.items():
        (tmp_path / place).mkdir()
        begin = data_set.find(struct.pack("<HH", 0x20, 0x0E))
        hostile = bomb((data_set[:begin] if place == "private" else b"") + head)
        in_company(tmp_path / place, hostile, "")


def test_a_deflate_bomb_behind_the_pixels_is_not_touched(tmp_path):
    files = [bomb(Image(n, DEFLATED).data_set()) for n in range(3)]
    end = run("info", write(tmp_path / "series", files), "--json")
    assert [s["slices"] for s in json.loads(end.out)["series"]] == [3]


@pytest.mark.parametrize("side", [20_000, 50_000, 65_535])
def test_a_deflate_bomb_of_pixels_is_not_believed(tmp_path, side):
    files = []
    for n in range(2):
        image = Image(n, DEFLATED).size(side, side).number(0x100, 8).number(0x101, 8)
        image.number(0x102, 7).put(
            PIXELS, element(PIXELS, "OB", b"", min(side**2, CLAIM))
        )
        files.append(bomb(image.data_set()))
    fails(write(tmp_path / "series", files), "left out")


@pytest.mark.parametrize(
    ("side", "count"), [(512, 3), (1024, 3), (2048, 2), (4096, 100), (65_535, 100)]
)
@pytest.mark.parametrize("stream", STREAMS)
def test_compressed_claims_are_held_against_the_bytes(tmp_path, stream, side, count):
    """65,535 x 65,535 pixels, and sizes that could be, in a few hundred bytes a file."""
    syntax, content = STREAMS[stream]
    bits = 8 if stream.startswith("jpeg") and "2000" not in stream else 16
    files = []
    for n in range(count):
        image = Image(n, syntax).size(side, side).pieces(content(side))
        image.number(0x100, bits).number(0x101, bits).number(0x102, bits - 1)
        files.append(image.file())
    fails(write(tmp_path / "series", files))


@pytest.mark.parametrize("syntax", [EXPLICIT, DEFLATED, RLE, JPEG, JPEG_LS, JPEG_2000])
def test_65_535_squared_pixels_in_10_000_frames_are_not_believed(tmp_path, syntax):
    image = framed(10_000, syntax).size(65_535, 65_535)
    if syntax in (EXPLICIT, DEFLATED):
        image.put(PIXELS, element(PIXELS, "OW", bytes(100), CLAIM))
    else:
        image.pieces(*[bytes(100)] * 10_000)
    fails(write(tmp_path / "series", [image.file()]), "left out")


@pytest.mark.parametrize(
    "frames", ["2000000000", "-1", "99999999999999999999", "1e9", "\\"]
)
def test_frame_counts_that_cannot_be_are_not_believed(tmp_path, frames):
    for name, image in [("plain", Image()), ("groups", framed(3))]:
        (tmp_path / name).mkdir()
        image.text((0x28, 0x08), "IS", frames)
        image.put(PIXELS, element(PIXELS, "OW", bytes(96)))
        folder = write(tmp_path / name / "series", [image.file()])
        fails(folder)


@pytest.mark.parametrize(
    "table",
    [
        struct.pack("<3I", 0, 0, 0),
        struct.pack("<3I", 200, 100, 0),
        struct.pack("<3I", 0, 4, 8),
        struct.pack("<3I", *[0xFFFFFFFF] * 3),
        struct.pack("<3I", 0, 0x80000000, 0xFFFFFFF8),
        b"\x07",
        bytes(1 << 20),
    ],
    ids=["same", "backward", "overlapping", "last", "far", "odd", "long"],
)
@pytest.mark.parametrize("syntax", [RLE, JPEG_LS])
def test_offset_tables_that_lead_nowhere_end(tmp_path, syntax, table):
    image = framed(3, syntax).pieces(
        bytes(80), bytes(80), bytes(80), bytes(80), table=table
    )
    fails(write(tmp_path / "series", [image.file()]))


def test_items_that_have_no_end_end(tmp_path):
    for name, pieces in {
        "none": b"",
        "huge": item(b"") + item(b"", CLAIM),
        "undefined": item(b"", UNDEFINED) * 1000,
        "empty": item(b"") * 100_000,
        "no items": bytes(1000),
    }.items():
        image = Image(syntax=RLE).put(PIXELS, element(PIXELS, "OB", pieces, UNDEFINED))
        other = Image(1, RLE).put(PIXELS, element(PIXELS, "OB", pieces, UNDEFINED))
        fails(write(tmp_path / name, [image.file(), other.file()]))


def test_links_that_lead_in_circles_are_left_out(tmp_path):
    folder = write(tmp_path / "series", [Image(n).file() for n in range(3)])
    (folder / "up").symlink_to(tmp_path)
    (folder / "self").symlink_to(folder)
    (folder / "loop").symlink_to(folder / "loop")
    (folder / "nowhere").symlink_to(folder / "nothing")
    report = json.loads(run("info", folder, "--json").out)
    assert [s["slices"] for s in report["series"]] == [3]
    names = {Path(f["path"]).name for f in report["left_out"]}
    assert names == {"up", "self", "loop", "nowhere"}


NUMBERS = [
    "",
    "0",
    "-0",
    "-1",
    "nan",
    "inf",
    "-inf",
    "1e300",
    "-1e300",
    "1e-320",
    "5e-324",
    "1e999",
    "x",
]


def values(count: int) -> Iterator[str]:
    for number in NUMBERS:
        yield "\\".join([number] * count)
        yield "\\".join([number] + ["1"] * (count - 1))
    yield "1" * 65_000
    yield "\\" * 1000


@pytest.mark.parametrize(
    ("tag", "count"),
    [
        ((0x20, 0x32), 3),
        ((0x20, 0x37), 6),
        ((0x28, 0x30), 2),
        ((0x28, 0x1052), 1),
        ((0x28, 0x1053), 1),
        ((0x20, 0x1041), 1),
    ],
    ids=["position", "orientation", "spacing", "intercept", "slope", "location"],
)
def test_numbers_that_are_none_end_in_a_reason(tmp_path, tag, count):
    """One folder a value would take minutes, so each value is a series of its own in one."""
    files = []
    for number, value in enumerate(values(count)):
        for n in range(3):
            image = Image(n).text((0x20, 0x0E), "UI", f"1.2.3.{number + 10}")
            files.append(image.text(tag, "DS", value).file())
    end = run("info", write(tmp_path / "series", files), "--json")
    if end.code == 0:
        report = json.loads(end.out, parse_constant=lambda word: pytest.fail(word))
        read = sum(len(s["files"]) for s in report["series"])
        assert read + len(report["left_out"]) == len(files)
        for series in report["series"]:
            folder = tmp_path / "series"
            run(
                "render", folder, "--series", series["number"], "-o", tmp_path / "x.stl"
            )
    else:
        assert end.err.count("\n") == 1 and "left out" in end.err


@pytest.mark.parametrize("tag", [0x10, 0x11, 0x100, 0x101, 0x102, 0x02])
@pytest.mark.parametrize("value", [0, 1, 7, 64, 0x7FFF, 0x8000, 0xFFFF])
def test_sizes_that_cannot_be_end_in_a_reason(tmp_path, tag, value):
    files = [Image(n).number(tag, value).file() for n in range(2)]
    fails(write(tmp_path / "series", files))


def test_pydicoms_nested_unknown_sequence_ends_at_once(tmp_path):
    source = Path(pydicom.__file__).parent / "data" / "test_files" / "UN_sequence.dcm"
    fails(write(tmp_path / "series", [source.read_bytes()]), "left out")


def test_100_000_files_of_garbage_are_left_out(tmp_path):
    folder = tmp_path / "garbage"
    folder.mkdir()
    for n in range(100_000):
        descriptor = os.open(folder / f"{n:06}", os.O_CREAT | os.O_WRONLY)
        os.write(descriptor, n.to_bytes(4, "big") * 8)
        os.close(descriptor)
    fails(folder, "100000 left out: not a DICOM file", cpu_s=20)


def test_a_sparse_file_of_3_gb_costs_nothing(tmp_path):
    begins = {
        "zeros": b"",
        "preamble": bytes(128) + b"DICM",
        "meta": meta(EXPLICIT),
        "implicit": meta(IMPLICIT),
        "deflated": meta(DEFLATED),
        "private": meta(EXPLICIT) + element((0x09, 0x1001), "OB", b"", 3_000_000_000),
        "text": meta(EXPLICIT) + element((0x08, 0x60), "UT", b"", 3_000_000_000),
        "pieces": Image(0, RLE).pieces(end=item(b"", 3_000_000_000)).file(),
        "table": Image(0, RLE)
        .put(PIXELS, element(PIXELS, "OB", item(b"", 3_000_000_000), UNDEFINED))
        .file(),
    }
    for name, begin in begins.items():
        folder = write(tmp_path / name, [begin, Image(1, RLE).file()])
        os.truncate(folder / "0000", 3 << 30)
        if name in ("pieces", "table"):
            # Two of them make a series, whose pixels are looked for.
            content = begin.replace(b"0\\0\\0 ", b"0\\0\\4 ")
            (folder / "0002").write_bytes(content)
            os.truncate(folder / "0002", 3 << 30)
        fails(folder)


def test_empty_elements_without_end_end(tmp_path):
    empty = element((0x09, 0x1001), "LO", b"") * 2_000_000
    image = Image().put((0x09, 0x1001), empty * 5)
    in_company(tmp_path, image.file(), "too many elements")
