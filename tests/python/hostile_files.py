"""Small DICOM files, to be made worse: what the tests of hostile folders are built from."""

from __future__ import annotations

import struct
import zlib

IMPLICIT = "1.2.840.10008.1.2"
EXPLICIT = "1.2.840.10008.1.2.1"
DEFLATED = "1.2.840.10008.1.2.1.99"
RLE = "1.2.840.10008.1.2.5"
JPEG = "1.2.840.10008.1.2.4.50"
JPEG_LOSSLESS = "1.2.840.10008.1.2.4.70"
JPEG_LS = "1.2.840.10008.1.2.4.80"
JPEG_2000 = "1.2.840.10008.1.2.4.90"

UNDEFINED = 0xFFFFFFFF
SEQUENCE_END = struct.pack("<HHI", 0xFFFE, 0xE0DD, 0)
SHARED, PER_FRAME = (0x5200, 0x9229), (0x5200, 0x9230)
PIXELS = (0x7FE0, 0x10)

CLAIM = 0xFFFFFFF0


def element(
    tag: tuple[int, int], vr: str, value: bytes | str, length: int | None = None
) -> bytes:
    """An element in explicit VR little endian; `length` is what it says, not what it is."""
    if isinstance(value, str):
        value = value.encode()
    value += (b"\0" if vr in ("UI", "OB") else b" ") * (len(value) % 2)
    length = len(value) if length is None else length
    head = struct.pack("<HH2s", *tag, vr.encode())
    long = vr in ("OB", "OW", "SQ", "UN", "UT")
    return (
        head
        + struct.pack("<HI" if long else "<H", *((0, length) if long else (length,)))
        + value
    )


def item(content: bytes, length: int | None = None) -> bytes:
    return (
        struct.pack("<HHI", 0xFFFE, 0xE000, len(content) if length is None else length)
        + content
    )


def meta(syntax: str) -> bytes:
    content = element((2, 0x10), "UI", syntax)
    return (
        bytes(128)
        + b"DICM"
        + element((2, 0), "UL", struct.pack("<I", len(content)))
        + content
    )


class Image:
    """One small slice, to be made worse."""

    def __init__(self, number: int = 0, syntax: str = EXPLICIT):
        self.syntax = syntax
        self.elements = {
            (0x08, 0x60): element((0x08, 0x60), "CS", "CT"),
            (0x20, 0x0E): element((0x20, 0x0E), "UI", "1.2.3.4"),
        }
        self.text((0x20, 0x32), "DS", f"0\\0\\{2 * number}")
        self.text((0x20, 0x37), "DS", "1\\0\\0\\0\\1\\0")
        self.number(0x02, 1)
        self.size(4, 4)
        self.text((0x28, 0x30), "DS", "1\\1")
        self.number(0x100, 16)
        self.number(0x101, 16)
        self.number(0x102, 15)
        self.number(0x103, 0)
        self.text((0x28, 0x1052), "DS", "-1024")
        self.text((0x28, 0x1053), "DS", "1")
        self.put(PIXELS, element(PIXELS, "OW", bytes(32)))

    def put(self, tag: tuple[int, int], content: bytes) -> Image:
        self.elements[tag] = content
        return self

    def text(self, tag: tuple[int, int], vr: str, value: str) -> Image:
        return self.put(tag, element(tag, vr, value))

    def number(self, tag: int, value: int) -> Image:
        return self.put(
            (0x28, tag), element((0x28, tag), "US", struct.pack("<H", value))
        )

    def size(self, rows: int, columns: int, frames: int | None = None) -> Image:
        if frames is not None:
            self.text((0x28, 0x08), "IS", str(frames))
        return self.number(0x10, rows).number(0x11, columns)

    def pieces(
        self, *content: bytes, table: bytes = b"", end: bytes | None = None
    ) -> Image:
        """Compressed pixels."""
        items = b"".join(item(c) for c in (table, *content))
        end = SEQUENCE_END if end is None else end
        return self.put(PIXELS, element(PIXELS, "OB", items + end, UNDEFINED))

    def data_set(self) -> bytes:
        return b"".join(content for _, content in sorted(self.elements.items()))

    def file(self) -> bytes:
        data_set = self.data_set()
        if self.syntax == DEFLATED:
            packer = zlib.compressobj(wbits=-15)
            data_set = packer.compress(data_set) + packer.flush()
        return meta(self.syntax) + data_set


def nested(depth: int, *, defined: bool, explicit: bool, tag: tuple[int, int]) -> bytes:
    """Sequences in sequences, from the innermost outwards."""
    if not defined:
        head = (
            element(tag, "SQ", b"", UNDEFINED)
            if explicit
            else struct.pack("<HHI", *tag, UNDEFINED)
        )
        return (head + item(b"", UNDEFINED)) * depth
    heads = []
    length = 0
    for _ in range(depth):
        inner = item(b"", length)
        length += len(inner)
        head = (
            element(tag, "SQ", b"", length)
            if explicit
            else struct.pack("<HHI", *tag, length)
        )
        heads.append(head + inner)
        length += len(head)
    return b"".join(reversed(heads))


def zeros(gib: float) -> bytes:
    """Deflated zeros without an end, a thousandth of their size."""
    packer = zlib.compressobj(9, wbits=-15)
    chunk = packer.compress(bytes(16 << 20)) + packer.flush(zlib.Z_FULL_FLUSH)
    return chunk * int(gib * 64)


def bomb(before: bytes, gib: float = 3) -> bytes:
    """A deflated file that begins with `before` and goes on with zeros."""
    packer = zlib.compressobj(wbits=-15)
    return (
        meta(DEFLATED)
        + packer.compress(before)
        + packer.flush(zlib.Z_FULL_FLUSH)
        + zeros(gib)
    )


def jpeg(marker: int, rows: int, columns: int, after: bytes = b"") -> bytes:
    frame = struct.pack(">HBHHB3B", 11, 8, rows, columns, 1, 1, 0x11, 0)
    scan = struct.pack(">HB2B3B", 8, 1, 1, 0, 0, 63, 0)
    return (
        b"\xff\xd8\xff"
        + bytes([marker])
        + frame
        + after
        + b"\xff\xda"
        + scan
        + bytes(40)
        + b"\xff\xd9"
    )


def jpeg_2000(
    side: int, tile: int = 0, components: int = 1, layers: int = 1, precinct: int = 15
) -> bytes:
    """A code stream with one tile's data, which are none; precincts of 2**precinct pixels."""
    tile = tile or side
    size = struct.pack(">H8IH", 0, side, side, 0, 0, tile, tile, 0, 0, components)
    size += b"\x0f\x01\x01" * components
    coding = struct.pack(">BBHB5B", 1, 0, layers, 0, 5, 4, 4, 0, 1)
    coding += bytes([precinct << 4 | precinct] * 6)
    steps = bytes([0x40, *[0x48] * 16])

    def segment(marker: int, content: bytes) -> bytes:
        return struct.pack(">BBH", 0xFF, marker, len(content) + 2) + content

    head = segment(0x51, size) + segment(0x52, coding) + segment(0x5C, steps)
    part = segment(0x90, struct.pack(">HIBB", 0, 0, 0, 1))
    return b"\xff\x4f" + head + part + b"\xff\x93" + bytes(200) + b"\xff\xd9"


STREAMS = {
    "rle": (RLE, lambda _: struct.pack("<16I", 2, 64, 66, *[0] * 13) + b"\x81\0" * 2),
    "rle-segments": (RLE, lambda _: struct.pack("<16I", CLAIM, *[64] * 15)),
    "jpeg": (JPEG, lambda side: jpeg(0xC0, side, side)),
    "jpeg-late-rows": (
        JPEG,
        lambda side: jpeg(0xC0, 0, side, b"\xff\xdc" + struct.pack(">HH", 4, side)),
    ),
    "jpeg-lossless": (JPEG_LOSSLESS, lambda side: jpeg(0xC3, side, side)),
    "jpeg-ls": (JPEG_LS, lambda side: jpeg(0xF7, side, side)),
    "jpeg-2000": (JPEG_2000, jpeg_2000),
    "jpeg-2000-tiles": (JPEG_2000, lambda side: jpeg_2000(side, side // 250)),
    "jpeg-2000-components": (
        JPEG_2000,
        lambda side: jpeg_2000(side, components=16_384),
    ),
    "jpeg-2000-layers": (JPEG_2000, lambda side: jpeg_2000(side, layers=65_535)),
    "jpeg-2000-precincts": (JPEG_2000, lambda side: jpeg_2000(side, precinct=1)),
    "jpeg-2000-both": (
        JPEG_2000,
        lambda side: jpeg_2000(side, layers=65_535, precinct=1),
    ),
}


def framed(frames: int, syntax: str = EXPLICIT) -> Image:
    """Frames in 1 mm steps, as many as it says."""
    image = Image(0, syntax)
    for tag in [(0x20, 0x32), (0x20, 0x37), (0x28, 0x30)]:
        del image.elements[tag]
    shared = element(
        (0x20, 0x9116), "SQ", item(element((0x20, 0x37), "DS", "1\\0\\0\\0\\1\\0"))
    )
    shared += element((0x28, 0x9110), "SQ", item(element((0x28, 0x30), "DS", "1\\1")))
    image.put(SHARED, element(SHARED, "SQ", item(shared)))

    def own(n: int) -> bytes:
        position = element((0x20, 0x32), "DS", f"0\\0\\{n}")
        return item(element((0x20, 0x9113), "SQ", item(position)))

    image.put(PER_FRAME, element(PER_FRAME, "SQ", b"".join(map(own, range(frames)))))
    return image.size(4, 4, frames)
