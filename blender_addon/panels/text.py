# SPDX-License-Identifier: GPL-3.0-or-later
"""Text in panels: Blender cuts a label off at the panel's edge, so it is broken into lines that fit."""

from typing import Any

import blf

from .wrapping import fitting_lines

FONT = 0  # the one of Blender's interface
BESIDE_TEXT_PX = 98.0  # margins, the box, an icon, the tabs; at a resolution scale of 1
LEAST_PX = 60.0
WITHOUT_REGION_PX = 290.0
LINE_HEIGHT = 0.8  # lines of one text stand closer than fields


def draw_text(layout: Any, context: Any, text: str, icon: str = "BLANK1") -> None:
    """Draws `text` in as many lines as the panel's width asks for, `icon` before the first."""
    column = layout.column(align=True)
    column.scale_y = LINE_HEIGHT
    for line in panel_lines(context, text):
        column.label(text=line, icon=icon)
        icon = "BLANK1"


def panel_lines(context: Any, text: str) -> list[str]:
    """`text` in lines that fit into the panel that is being drawn."""
    preferences = context.preferences
    scale = preferences.system.ui_scale or 1.0  # 0 without a window
    region_px = WITHOUT_REGION_PX * scale
    if context.region is not None:
        region_px = context.region.width
    blf.size(FONT, preferences.ui_styles[0].widget.points * scale)
    return fitting_lines(
        text,
        max(LEAST_PX * scale, region_px - BESIDE_TEXT_PX * scale),
        lambda line: blf.dimensions(FONT, line)[0],
    )
