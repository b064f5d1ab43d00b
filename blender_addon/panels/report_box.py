# SPDX-License-Identifier: GPL-3.0-or-later
"""The lower part of the box under CT Images: the report of the chosen series, and what is in none."""

from pathlib import Path
from typing import Any

import bonemesh

from ..series.scans import FolderScan
from .text import draw_text

MOST_ROWS = 20
NOTE = "note: "


def draw_report(
    column: Any, context: Any, scan: FolderScan, series: bonemesh.Series | None
) -> None:
    """Draws the notes on the chosen series, and folded in the rest that `bonemesh info` prints and what is in no series."""
    lines = [] if series is None else series.lines
    for line in lines:
        if line.startswith(NOTE):
            draw_text(column, context, line.removeprefix(NOTE), icon="ERROR")
    row = column.row()
    shows_details = series is not None and draw_fold(
        row, context, "show_details", "Details"
    )
    left_out = scan.contents.left_out
    files = "1 file" if len(left_out) == 1 else f"{len(left_out):,} files"
    shows_left_out = bool(left_out) and draw_fold(
        row, context, "show_left_out", f"{files} left out"
    )
    if shows_details:
        for line in lines:
            if not line.startswith(NOTE):
                draw_text(column, context, line, icon="DOT")
    if shows_left_out:
        draw_left_out(column, context, scan.request.path, left_out)


def draw_left_out(
    column: Any, context: Any, folder: str, left_out: list[bonemesh.LeftOut]
) -> None:
    """Draws which files are in no series, and why."""
    for file in left_out[:MOST_ROWS]:
        name = name_in(folder, file.path)
        draw_text(column, context, f"{name}: {file.reason}")
    draw_rest(column, context, len(left_out) - MOST_ROWS, "bonemesh info lists them")


def name_in(folder: str, path: Path) -> Path:
    """`path` without the folder that was scanned."""
    inside = path.is_relative_to(folder) and path != Path(folder)
    return path.relative_to(folder) if inside else path


def draw_fold(layout: Any, context: Any, name: str, text: str) -> bool:
    """Draws the switch `name` of what is folded in; whether it is open."""
    folds = context.window_manager.bonemesh_folds
    is_open = bool(getattr(folds, name))
    icon = "TRIA_DOWN" if is_open else "TRIA_RIGHT"
    row = layout.row()
    row.alignment = "LEFT"
    row.prop(folds, name, text=text, icon=icon, emboss=False)
    return is_open


def draw_rest(column: Any, context: Any, number: int, remedy: str) -> None:
    """Draws how many rows a list lacks, if any."""
    if number > 0:
        draw_text(column, context, f"and {number:,} more; {remedy}")
