# SPDX-License-Identifier: GPL-3.0-or-later
"""The box at the HU threshold: histogram, thresholds to choose from, the preview."""

from typing import Any

import bonemesh

from . import histogram_icon, previewing
from .messages import one_line
from .operators.use_threshold import BONEMESH_OT_use_threshold
from .previews import Reading
from .text import draw_text

ICON_UNITS = 9.0  # of 20 pixels


def draw(layout: Any, context: Any) -> None:
    """Draws the box, where the series is known."""
    properties = context.scene.bonemesh
    if not properties.ct_directory.strip():
        return
    reading = previewing.shown(properties)
    if reading is None:
        return
    column = layout.box().column(align=True)
    if reading.error is not None:
        draw_problem(column, context, reading.error)
        return
    if reading.histogram is None:
        progress = reading.job.progress
        column.progress(factor=progress.fraction, text="Reading the Images", type="BAR")
    else:
        draw_histogram(column, reading, properties.hu_threshold)
        draw_suggestions(column, reading, properties.hu_threshold)
    column.prop(properties, "show_preview")
    problem = previewing.problem()
    if problem is not None and properties.show_preview:
        draw_problem(column, context, problem)


def draw_histogram(column: Any, reading: Reading, threshold_hu: int) -> None:
    """Draws the picture and how its scale ends."""
    row = column.row()
    row.alignment = "CENTER"
    row.template_icon(
        icon_value=histogram_icon.icon_id(reading, threshold_hu), scale=ICON_UNITS
    )


def draw_suggestions(column: Any, reading: Reading, threshold_hu: int) -> None:
    """Draws a button for each threshold found in the images or published."""
    grid = column.grid_flow(columns=2, even_columns=True, align=True)
    for suggestion in reading.suggestions:
        hu = round(suggestion["threshold_hu"])
        mark = "SOLO_ON" if suggestion["recommended"] else "NONE"
        button = grid.operator(
            BONEMESH_OT_use_threshold.bl_idname,
            text=f"{name(suggestion)} {hu}",
            icon=mark,
            depress=hu == threshold_hu,
        )
        button.hu = hu
        button.title = f"{hu} HU: {suggestion['reason']} ({suggestion['source']})"


def name(suggestion: dict[str, Any]) -> str:
    """How a threshold is called in the panel."""
    return suggestion["name"].replace("-", " ").title()


def draw_problem(column: Any, context: Any, error: BaseException) -> None:
    """Draws why there is nothing to see."""
    if not isinstance(error, bonemesh.Cancelled):
        draw_text(column, context, one_line(error), icon="ERROR")
