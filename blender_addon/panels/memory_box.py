# SPDX-License-Identifier: GPL-3.0-or-later
"""The warning above Render Surface Mesh where the machine has too little memory."""

from __future__ import annotations

import math
import time
from typing import Any

from ..crop import crop_box, cropping
from ..request import memory
from ..request.inputs import RefusalError
from ..series import scanning
from .text import draw_text

ASKED_EVERY_S = 2.0  # the panel is drawn far more often


class Free:
    """What the system said last, and when."""

    bytes: float | None = None
    asked_s = -math.inf


def draw(layout: Any, context: Any) -> None:
    """Draws the warning, if there is one."""
    text = warning(context.scene.bonemesh)
    if text is not None:
        draw_text(layout.box(), context, text, icon="ERROR")


def warning(properties: Any) -> str | None:
    """What is to be said of memory before a rendering; None as long as the series is not known."""
    if scanning.marked_series(properties) is None:
        return None
    try:
        grid = cropping.grid_of(properties)
    except RefusalError:
        return None
    used = crop_box.read(properties.crop, grid)
    used_voxels = math.prod(end - first for first, end in used)
    needed = memory.needed_bytes(math.prod(grid.shape), used_voxels, properties.method)
    now_s = time.monotonic()
    if now_s - Free.asked_s > ASKED_EVERY_S:
        Free.bytes, Free.asked_s = memory.free_bytes(), now_s
    return memory.warning(needed, Free.bytes)
