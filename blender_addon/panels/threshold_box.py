# SPDX-License-Identifier: GPL-3.0-or-later
"""The HU threshold: slider, preview, and folded in the histogram with thresholds to choose from."""

from typing import Any

import bonemesh

from ..jobs.messages import one_line
from ..operators.use_threshold import BONEMESH_OT_use_threshold
from ..preview import histogram_icon, previewing
from ..preview.previews import Reading
from .report_box import draw_fold
from .text import draw_text

ICON_UNITS = 9.0  # of 20 pixels


def draw(layout: Any, context: Any) -> None:
    """Draws the slider with the preview's switch; below it, where the series is known, the histogram, folded in."""
    properties = context.scene.bonemesh
    row = layout.row(align=True)
    row.prop(properties, "hu_threshold", slider=True)
    eye = "HIDE_OFF" if properties.show_preview else "HIDE_ON"
    row.prop(properties, "show_preview", text="", icon=eye)
    if not properties.ct_directory.strip():
        return
    reading = previewing.shown(properties)
    if reading is None:
        return
    column = layout.column(align=True)
    if reading.error is not None:
        draw_problem(column, context, reading.error)
        return
    if reading.histogram is None:
        progress = reading.job.progress
        column.progress(factor=progress.fraction, text="Reading the Images", type="BAR")
    else:
        draw_thresholds(column, context, reading, properties.hu_threshold)
    problem = previewing.problem()
    if problem is not None and properties.show_preview:
        draw_problem(column, context, problem)


def draw_thresholds(
    column: Any, context: Any, reading: Reading, threshold_hu: int
) -> None:
    """Draws the recommended threshold beside what unfolds the histogram and all of them."""
    row = column.row(align=True)
    is_open = draw_fold(row, context, "show_histogram", "Histogram")
    recommended = next((s for s in reading.suggestions if s["recommended"]), None)
    if is_open:
        box = column.box().column(align=True)
        draw_histogram(box, reading, threshold_hu)
        grid = box.grid_flow(columns=2, even_columns=True, align=True)
        for suggestion in reading.suggestions:
            draw_suggestion(grid, suggestion, threshold_hu)
    elif recommended is not None:
        draw_suggestion(row, recommended, threshold_hu)


def draw_histogram(column: Any, reading: Reading, threshold_hu: int) -> None:
    """Draws the picture and how its scale ends."""
    row = column.row()
    row.alignment = "CENTER"
    row.template_icon(
        icon_value=histogram_icon.icon_id(reading, threshold_hu), scale=ICON_UNITS
    )


def draw_suggestion(layout: Any, suggestion: dict[str, Any], threshold_hu: int) -> None:
    """Draws the button of a threshold that was found in the images or published."""
    hu = round(suggestion["threshold_hu"])
    button = layout.operator(
        BONEMESH_OT_use_threshold.bl_idname,
        text=f"{name(suggestion)} {hu}",
        icon="SOLO_ON" if suggestion["recommended"] else "NONE",
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
