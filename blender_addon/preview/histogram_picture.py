# SPDX-License-Identifier: GPL-3.0-or-later
"""A histogram as a small picture for the panel. Knows no bpy.

Bars on a logarithmic scale, since air outnumbers bone a hundred to one; what is above the threshold in the
colour of bone, the threshold as a bright line, suggested ones as faint lines.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

SIDE = 256  # pixels
SHOWN_HU = (-1050.0, 3100.0)  # tissue and enamel; metal has no room
MARGIN = 0.06  # of the height, above the highest bar

PAPER = (34, 34, 38, 255)
BAR = (104, 118, 140, 255)
BONE_BAR = (226, 205, 160, 255)
SUGGESTED = (120, 130, 110, 255)
RECOMMENDED = (120, 200, 120, 255)
THRESHOLD = (255, 120, 60, 255)


def heights(
    counts: NDArray[np.uint64], edges_hu: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Heights of the bars of all columns, 0 to 1."""
    if len(counts) == 0:
        return np.zeros(SIDE)
    bins = np.searchsorted(edges_hu, columns_hu()) - 1
    is_inside = (bins >= 0) & (bins < len(counts))
    found = np.where(is_inside, counts[np.clip(bins, 0, len(counts) - 1)], 0)
    logarithms = np.log1p(found.astype(np.float64))
    highest = logarithms.max()
    return logarithms / highest if highest > 0.0 else logarithms


def drawn(
    bars: NDArray[np.float64],
    threshold_hu: float,
    suggestions: Iterable[tuple[float, bool]],
) -> NDArray[np.uint8]:
    """(SIDE, SIDE, 4) RGBA, the lowest row first; `suggestions` are in HU, each with whether it is recommended."""
    picture = np.empty((SIDE, SIDE, 4), dtype=np.uint8)
    picture[:] = PAPER
    rows = np.arange(SIDE)[:, np.newaxis]
    is_bar = rows < bars * (1.0 - MARGIN) * SIDE
    is_bone = columns_hu() > threshold_hu
    picture[is_bar & ~is_bone] = BAR
    picture[is_bar & is_bone] = BONE_BAR
    for hu, is_recommended in suggestions:
        picture[::3, column(hu)] = RECOMMENDED if is_recommended else SUGGESTED
    at = column(threshold_hu)
    picture[:, max(0, at - 1) : at + 1] = THRESHOLD
    return picture


def columns_hu() -> NDArray[np.float64]:
    """The value in the middle of each column."""
    low, high = SHOWN_HU
    return low + (np.arange(SIDE) + 0.5) * (high - low) / SIDE


def column(hu: float) -> int:
    """The column of a value; those outside are at the ends."""
    low, high = SHOWN_HU
    part = min(1.0, max(0.0, (hu - low) / (high - low)))
    return min(SIDE - 1, int(part * SIDE))
