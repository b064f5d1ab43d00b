"""Writes the files that fuzzing begins with: from phantoms, and from CT test data where there are some.

usage: fuzz_seeds.py BONEMESH CORPUS_DIR [CT_DIR]
"""

import gzip
import struct
import subprocess
import sys
import tempfile
import zlib
from pathlib import Path

MAX_BYTES = 64 * 1024

# As in the target `frame`.
SYNTAXES = [
    "1.2.840.10008.1.2.5",
    "1.2.840.10008.1.2.4.50",
    "1.2.840.10008.1.2.4.51",
    "1.2.840.10008.1.2.4.57",
    "1.2.840.10008.1.2.4.70",
    "1.2.840.10008.1.2.4.80",
    "1.2.840.10008.1.2.4.81",
    "1.2.840.10008.1.2.4.90",
    "1.2.840.10008.1.2.4.91",
    "1.2.840.10008.1.2.4.201",
    "1.2.840.10008.1.2.4.203",
    "1.2.840.10008.1.2.1",
]
DEFLATED = b"1.2.840.10008.1.2.1.99"

# A flag in the first bytes of `frame`: the pixels are signed.
SIGNED = 1

STL = b"""solid one
facet normal 0 0 1
outer loop
vertex 0 0 0
vertex 1 0 0
vertex 0 1.5e0 0
endloop
endfacet
endsolid one
"""
PLY = b"""ply
format ascii 1.0
comment a triangle
element vertex 3
property float x
property float y
property double z
property uchar red
element face 1
property list uchar int vertex_indices
end_header
0 0 0 1
1 0 0 2
0 1 0 3
3 0 1 2
"""

NRRD = b"""NRRD0004
type: int16
dimension: 3
space: left-posterior-superior
sizes: 4 4 4
space directions: (0.5,0,0) (0,0.5,0) (0,0,1)
space origin: (0,0,-10)
kinds: domain domain domain
endian: little
encoding: %s
%s
"""

# ITU-T T.87, annex H.3: 4 x 4 samples of 8 bits.
JPEG_LS = bytes.fromhex(
    "ffd8 fff7 000b 08 0004 0004 01 011100 ffda 0008 01 0100 00 00 00"
    "c000006c80208e01c0000057400000 6ee6000001bc18000005d80000 9160 ffd9"
)


class Corpus:
    def __init__(self, folder: Path):
        self.folder = folder

    def add(self, target: str, name: str, content: bytes) -> None:
        folder = self.folder / target
        folder.mkdir(parents=True, exist_ok=True)
        if len(content) <= MAX_BYTES:
            (folder / name).write_bytes(content)


def data_set_begin(file: bytes) -> int:
    """Where the data set of an explicit little endian file begins."""
    length = struct.unpack_from("<I", file, 140)[0]
    return 144 + length


def deflated(file: bytes) -> bytes:
    uid = DEFLATED + b"\0" * (len(DEFLATED) % 2)
    element = struct.pack("<HH2sH", 2, 0x10, b"UI", len(uid)) + uid
    head = (
        bytes(128)
        + b"DICM"
        + struct.pack("<HH2sHI", 2, 0, b"UL", 4, len(element))
        + element
    )
    packer = zlib.compressobj(wbits=-15)
    return head + packer.compress(file[data_set_begin(file) :]) + packer.flush()


def two(first: bytes, second: bytes) -> bytes:
    """Two files as the target `dicom_file` takes them apart."""
    return struct.pack("<H", len(first)) + first + second


def frame(uid: str, rows: int, columns: int, bits: int, flags: int, pixels: bytes):
    allocated = 0 if bits <= 8 else 1
    head = [SYNTAXES.index(uid), allocated << 5 | bits - 1, flags]
    return bytes(head) + struct.pack("<HH", rows, columns) + pixels


def number(file: bytes, element: int) -> int:
    """A number of group 0028 in explicit little endian."""
    at = file.find(struct.pack("<HH2sH", 0x28, element, b"US", 2))
    return struct.unpack_from("<H", file, at + 8)[0]


def compressed(file: bytes) -> bytes | None:
    """The first frame's first piece."""
    at = file.find(b"\xe0\x7f\x10\x00OB\0\0\xff\xff\xff\xff")
    if at < 0:
        return None
    table = struct.unpack_from("<I", file, at + 16)[0]
    begin = at + 20 + table
    length = struct.unpack_from("<I", file, begin + 4)[0]
    return file[begin + 8 : begin + 8 + length]


def frame_of(file: bytes) -> bytes | None:
    pixels = compressed(file)
    uids = [u for u in SYNTAXES if u.encode() in file[:600]]
    if not uids or pixels is None:
        return None
    uid = max(uids, key=len)
    flags = SIGNED if number(file, 0x103) else 0
    return frame(
        uid, number(file, 0x10), number(file, 0x11), number(file, 0x101), flags, pixels
    )


def rle(pixels: bytes) -> bytes:
    """Bytes of one segment, none repeated."""
    out = struct.pack("<16I", 1, 64, *[0] * 14)
    for at in range(0, len(pixels), 128):
        part = pixels[at : at + 128]
        out += bytes([len(part) - 1]) + part
    return out


def from_phantoms(bonemesh: str, corpus: Corpus, scratch: Path) -> None:
    def run(*words: str | Path) -> None:
        subprocess.run([bonemesh, *map(str, words)], check=True, capture_output=True)

    run("phantom", "tube", scratch / "tube", "--coarser", "6", "--ideal")
    series = scratch / "tube" / "dicom"
    files = [p.read_bytes() for p in sorted(series.iterdir())]
    middle = len(files) // 2
    first, second = files[middle : middle + 2]
    corpus.add("dicom_file", "phantom", bytes(2) + first)
    corpus.add("dicom_file", "phantom-two", two(first, second))
    corpus.add("dicom_file", "phantom-deflated", two(deflated(first), deflated(second)))
    corpus.add("dicom_file", "phantom-bare", bytes(2) + first[data_set_begin(first) :])
    for target, command, kinds in [
        ("mesh_file", "render", ["stl", "ply", "obj", "3mf"]),
        ("cloud_file", "cloud", ["npy", "ply", "xyz"]),
    ]:
        for kind, ending in enumerate(kinds):
            out = scratch / f"{command}.{ending}"
            run(command, series, "-o", out)
            corpus.add(target, f"phantom-{ending}", bytes([kind]) + out.read_bytes())


def by_hand(corpus: Corpus) -> None:
    corpus.add("mesh_file", "text-stl", b"\0" + STL)
    corpus.add("mesh_file", "text-ply", b"\1" + PLY)
    corpus.add("mesh_file", "text-obj", b"\2v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/1 -2 3//3\n")
    corpus.add("cloud_file", "text-ply", b"\1" + PLY)
    corpus.add("cloud_file", "text-xyz", b"\2# cloud\n1 2 3 4\n-1e3 .5 0\n")
    corpus.add("frame", "jpeg-ls", frame(SYNTAXES[5], 4, 4, 8, 0, JPEG_LS))
    corpus.add("frame", "rle", frame(SYNTAXES[0], 16, 16, 8, 0, rle(bytes(range(256)))))
    corpus.add("frame", "native", frame(SYNTAXES[11], 8, 8, 12, SIGNED, bytes(128)))


def nifti(magic: bytes, begin: int) -> bytes:
    """A header of version 1: 4 x 4 x 4 voxels of 16 bits, placed by a matrix."""
    head = bytearray(begin)
    struct.pack_into("<i", head, 0, 348)
    struct.pack_into("<8h", head, 40, 3, 4, 4, 4, 1, 1, 1, 1)
    struct.pack_into("<2h", head, 70, 4, 16)
    struct.pack_into("<11f", head, 76, 1, 0.5, 0.5, 1, 1, 0, 0, 0, begin, 1, 0)
    struct.pack_into("<2h", head, 252, 1, 1)
    struct.pack_into("<12f", head, 280, -0.5, 0, 0, 0, 0, -0.5, 0, 0, 0, 0, 1, 0)
    head[344:348] = magic
    return bytes(head)


def nifti_2() -> bytes:
    """The same in version 2."""
    head = bytearray(544)
    struct.pack_into(
        "<i8s2h8q", head, 0, 540, b"n+2\0\r\n\x1a\n", 4, 16, 3, 4, 4, 4, 1, 1, 1, 1
    )
    struct.pack_into("<8d", head, 104, 1, 0.5, 0.5, 1, 1, 0, 0, 0)
    struct.pack_into("<q2d", head, 168, 544, 1, 0)
    struct.pack_into("<2i", head, 344, 1, 1)
    struct.pack_into("<12d", head, 400, -0.5, 0, 0, 0, 0, -0.5, 0, 0, 0, 0, 1, 0)
    return bytes(head)


def volume_files(corpus: Corpus) -> None:
    voxels = bytes(range(128))
    text = b" ".join(b"%d" % n for n in range(64))
    nii = nifti(b"n+1\0", 352) + voxels

    def add(name: str, header: bytes, data: bytes = b"", kind: int = 0) -> None:
        split = struct.pack("<BH", kind, len(header))
        corpus.add("volume_file", name, split + header + data)

    add("nifti-1", nii)
    add("nifti-1-gzip", gzip.compress(nii, mtime=0))
    add("nifti-1-pair", nifti(b"ni1\0", 352), voxels)
    add("nifti-2", nifti_2() + voxels)
    add("nrrd-raw", NRRD % (b"raw", b"") + voxels)
    add("nrrd-gzip", NRRD % (b"gzip", b"") + gzip.compress(voxels, mtime=0))
    add("nrrd-text", NRRD % (b"text", b"") + text)
    add("nrrd-pair", NRRD % (b"raw", b"data file: volume.raw"), voxels, kind=1)


def from_ct(corpus: Corpus, folders: Path) -> None:
    for folder in sorted(folders.iterdir()):
        files = [p.read_bytes() for p in sorted(folder.iterdir()) if p.is_file()]
        small = [f for f in files if len(f) < MAX_BYTES // 2][:2]
        if len(small) == 2:
            corpus.add("dicom_file", folder.name, two(*small))
        frames = [f for f in map(frame_of, files[:1]) if f]
        for content in frames:
            corpus.add("frame", folder.name, content)


def main(bonemesh: str, folder: str, ct: str | None = None) -> None:
    corpus = Corpus(Path(folder))
    with tempfile.TemporaryDirectory() as scratch:
        from_phantoms(bonemesh, corpus, Path(scratch))
    by_hand(corpus)
    volume_files(corpus)
    if ct:
        from_ct(corpus, Path(ct) / "hard")


if __name__ == "__main__":
    main(*sys.argv[1:])
