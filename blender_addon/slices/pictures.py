# SPDX-License-Identifier: GPL-3.0-or-later
"""Grey pictures as the bytes of an image file. Knows no bpy."""

import struct

import numpy as np
from numpy.typing import NDArray

HEADERS_BYTES = 14 + 40
PALETTE_BYTES = 4 * 256


def picture_file(grey: NDArray[np.uint8]) -> bytes:
    """`grey` (rows, columns), the top row first, as a BMP file of 256 greys, uncompressed and so quick to make and read."""
    rows, columns = grey.shape
    # Rows are stored from the bottom up, each in whole groups of four bytes.
    padded = np.zeros((rows, -(-columns // 4) * 4), dtype=np.uint8)
    padded[:, :columns] = grey[::-1]
    start = HEADERS_BYTES + PALETTE_BYTES
    header = struct.pack("<2sIHHI", b"BM", start + padded.size, 0, 0, start)
    info = struct.pack(
        "<IiiHHIIiiII", 40, columns, rows, 1, 8, 0, padded.size, 0, 0, 256, 0
    )
    palette = np.repeat(np.arange(256, dtype=np.uint8), 4).reshape(256, 4)
    palette[:, 3] = 0
    return header + info + palette.tobytes() + padded.tobytes()
