# SPDX-License-Identifier: GPL-3.0-or-later
"""The edges of a triangle mesh as Blender wants them, found on a worker thread: Blender itself would on the main one. Knows no bpy."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

MOST_BITS = 64


class Edges(NamedTuple):
    """Each edge once."""

    ends: NDArray[np.int32]
    """(E, 2) vertices, the lower one first; ascending."""
    of_corners: NDArray[np.int32]
    """(3 M,): which of them goes from a triangle's corner to its next one."""


def edges_of(triangles: NDArray[np.uint32], vertices: int) -> Edges:
    """The edges of (M, 3) triangles."""
    begins = triangles.astype(np.uint64)
    ends = np.roll(begins, -1, axis=1)
    of_vertex, of_corner = vertices.bit_length(), triangles.size.bit_length()
    if 2 * of_vertex + of_corner > MOST_BITS:
        return edges_of_many(begins, ends)
    # Sorted as one number each, ends first, then the corner: quicker than to sort and to keep account.
    low, high = np.minimum(begins, ends).ravel(), np.maximum(begins, ends).ravel()
    shift, across = np.uint64(of_corner), np.uint64(of_vertex)
    keys = (low << (shift + across)) | (high << shift)
    keys |= np.arange(keys.size, dtype=np.uint64)
    keys.sort()
    corners = (keys & np.uint64((1 << of_corner) - 1)).astype(np.int64)
    keys >>= shift
    is_new = np.ones(keys.size, dtype=bool)
    np.not_equal(keys[1:], keys[:-1], out=is_new[1:])
    of_corners = np.empty(keys.size, dtype=np.int32)
    of_corners[corners] = np.cumsum(is_new, dtype=np.int32) - 1
    kept = keys[is_new]
    mask = np.uint64((1 << of_vertex) - 1)
    return Edges(
        np.stack([kept >> across, kept & mask], axis=1).astype(np.int32), of_corners
    )


def edges_of_many(begins: NDArray[np.uint64], ends: NDArray[np.uint64]) -> Edges:
    """The same where ends and corner do not fit into one number."""
    pairs = np.stack([np.minimum(begins, ends), np.maximum(begins, ends)], axis=-1)
    keys = (pairs[..., 0].ravel() << np.uint64(32)) | pairs[..., 1].ravel()
    kept, of_corners = np.unique(keys, return_inverse=True)
    ends_of = np.stack([kept >> np.uint64(32), kept & np.uint64(0xFFFFFFFF)], axis=1)
    return Edges(ends_of.astype(np.int32), of_corners.ravel().astype(np.int32))
