# SPDX-License-Identifier: GPL-3.0-or-later
"""The box under CT Images: what the chosen folder holds, and which series is rendered."""

from typing import Any

import bonemesh

from ..jobs.messages import one_line
from ..operators.choose_series import BONEMESH_OT_choose_series
from ..operators.scan_ct_directory import BONEMESH_OT_scan_ct_directory
from ..operators.stop_scan import BONEMESH_OT_stop_scan
from ..series import scanning
from ..series.scans import FolderScan
from .report_box import MOST_ROWS, draw_report, draw_rest
from .text import draw_text


def draw(layout: Any, context: Any) -> None:
    """Draws the box, where CT images are chosen."""
    properties = context.scene.bonemesh
    if not properties.ct_directory.strip():
        return
    scan = scanning.shown(properties)
    column = layout.box().column(align=True)
    if scan is None:
        column.label(text="Waiting for another scan")
    elif scan.job.is_running():
        draw_progress(column, scan)
    elif scan.contents is None:
        draw_failure(column, context, scan.error)
    else:
        draw_contents(column, context, scan, scan.contents)


def draw_progress(column: Any, scan: FolderScan) -> None:
    """Draws how far the scan is, and the button that stops it."""
    row = column.row(align=True)
    row.progress(
        factor=scan.job.progress.fraction, text="Looking at the Files", type="BAR"
    )
    row.operator(BONEMESH_OT_stop_scan.bl_idname, text="", icon="X")


def draw_failure(column: Any, context: Any, error: BaseException | None) -> None:
    """Draws why there is no series, and the button that tries again."""
    if isinstance(error, bonemesh.Cancelled):
        column.label(text="Stopped looking")
    elif error is not None:
        draw_text(column, context, one_line(error), icon="ERROR")
    column.operator(BONEMESH_OT_scan_ct_directory.bl_idname, icon="FILE_REFRESH")


def draw_contents(
    column: Any, context: Any, scan: FolderScan, contents: bonemesh.Scan
) -> None:
    """Draws the list of series, the report of the chosen one and what was left out."""
    series = scan.chosen(context.scene.bonemesh.series)
    head = column.row(align=True)
    head.label(text=f"{len(contents.series)} series")
    head.operator(BONEMESH_OT_scan_ct_directory.bl_idname, text="", icon="FILE_REFRESH")
    draw_series(column, context, contents, series)
    draw_advice(column, context, contents, series)
    draw_report(column, context, scan, series)


def draw_series(
    column: Any, context: Any, contents: bonemesh.Scan, chosen: bonemesh.Series | None
) -> None:
    """Draws a row for each series; a click takes it."""
    for series in contents.series[:MOST_ROWS]:
        is_chosen = chosen is not None and series.number == chosen.number
        row = column.split(factor=0.62, align=True)
        button = row.operator(
            BONEMESH_OT_choose_series.bl_idname,
            text=f"{series.number}  {series.description or 'no description'}",
            icon="RADIOBUT_ON" if is_chosen else "RADIOBUT_OFF",
            depress=is_chosen,
        )
        button.number = series.number
        button.title = title(series, contents)
        row.label(text=f"{series.slices} x {series.spacing_mm[2]:.4g} mm")
    draw_rest(
        column, context, len(contents.series) - MOST_ROWS, "type its number in Advanced"
    )


def title(series: bonemesh.Series, contents: bonemesh.Scan) -> str:
    """One line with everything of a row, for its tooltip."""
    spacing = " x ".join(f"{s:.4g}" for s in series.spacing_mm)
    mark = ""
    if contents.alternatives and series.number == contents.recommended:
        mark = " (recommended)"
    elif series.number in contents.alternatives:
        mark = " (could be meant as well)"
    name = series.description or "no description"
    folder = f", in {series.files[0].parent.name}" if series.files else ""
    return (
        f"{series.number}: {name}, {series.slices} slices, {spacing} mm{folder}{mark}"
    )


def draw_advice(
    column: Any, context: Any, contents: bonemesh.Scan, chosen: bonemesh.Series | None
) -> None:
    """Draws what the user has to decide."""
    typed = context.scene.bonemesh.series.strip()
    if chosen is None:
        text = f"{typed} names no single series here; choose one of the list"
    elif contents.alternatives and not typed:
        text = (
            f"{1 + len(contents.alternatives)} series could be meant. The recommended one, "
            f"{chosen.number}, is marked and will be rendered; click another if it is not yours"
        )
    else:
        return
    column.separator(factor=0.5)
    draw_text(column, context, text, icon="ERROR")
