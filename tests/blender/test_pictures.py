"""Greys as an image file, read back by another reader of it (needs no Blender)."""

import struct

import numpy as np
import pytest

from blender_addon.slices.pictures import HEADERS_BYTES, PALETTE_BYTES, picture_file


@pytest.mark.parametrize("shape", [(1, 1), (3, 4), (4, 3), (5, 7)])
def test_greys_come_back_row_by_row(shape: tuple[int, int]) -> None:
    rows, columns = shape
    grey = (np.arange(rows * columns) * 7 % 256).astype(np.uint8).reshape(shape)
    file = picture_file(grey)
    kind, size, _, _, start = struct.unpack_from("<2sIHHI", file)
    assert (kind, size, start) == (b"BM", len(file), HEADERS_BYTES + PALETTE_BYTES)
    _, width, height, _, bits = struct.unpack_from("<IiiHH", file, 14)
    assert (width, height, bits) == (columns, rows, 8)
    palette = np.frombuffer(file, np.uint8, PALETTE_BYTES, HEADERS_BYTES).reshape(-1, 4)
    assert palette[200].tolist() == [200, 200, 200, 0]
    stored = np.frombuffer(file, np.uint8, offset=start).reshape(rows, -1)
    assert stored.shape[1] % 4 == 0
    # A positive height means from the bottom up.
    np.testing.assert_array_equal(stored[::-1, :columns], grey)
