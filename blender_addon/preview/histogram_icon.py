# SPDX-License-Identifier: GPL-3.0-or-later
"""The histogram's picture as an icon, which a panel can draw large; it is in no file."""

from __future__ import annotations

from typing import Any

import bpy
import bpy.utils.previews
import numpy as np

from . import histogram_picture
from .previews import Reading

NAME = "histogram"


class Icon:
    """The one picture and what it shows."""

    collection: Any = None
    shown: Any = None
    reading: Reading | None = None
    bars: Any = None


def icon_id(reading: Reading, threshold_hu: int) -> int:
    """The icon with the histogram of a reading that has one; 0 without a window, where Blender makes none."""
    if Icon.collection is None:
        Icon.collection = bpy.utils.previews.new()
        Icon.collection.new(NAME)
    icon = Icon.collection[NAME]
    if Icon.reading is not reading:
        histogram = reading.histogram
        Icon.reading = reading
        Icon.bars = histogram_picture.heights(histogram.counts, histogram.edges_hu)
        Icon.shown = None
    if Icon.shown != threshold_hu:
        Icon.shown = threshold_hu
        marks = [(s["threshold_hu"], s["recommended"]) for s in reading.suggestions]
        picture = histogram_picture.drawn(Icon.bars, threshold_hu, marks)
        icon.image_size = (histogram_picture.SIDE, histogram_picture.SIDE)
        icon.image_pixels.foreach_set(picture.view(np.int32).ravel())
    return icon.icon_id


def remove() -> None:
    """Gives the picture back to Blender."""
    if Icon.collection is not None:
        bpy.utils.previews.remove(Icon.collection)
    Icon.collection = Icon.shown = Icon.reading = Icon.bars = None
