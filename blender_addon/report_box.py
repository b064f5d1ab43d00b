# SPDX-License-Identifier: GPL-3.0-or-later
"""The lower part of the box under CT Images: the report of the chosen series, and what is in none."""

from pathlib import Path
from typing import Any

import bonemesh

from .scans import FolderScan
from .text import draw_text

MOST_ROWS = 20
# Size, spacing, orientation, positions; the rest (how it is stored, the UID) is folded in.
SUMMARY_LINES = 4


def draw_report(column: Any, context: Any, series: bonemesh.Series) -> None:
    """Draws the lines that `bonemesh info` prints: the summary, the notes, and the rest folded in."""
    notes = [line for line in series.lines if line.startswith("note: ")]
    lines = [line for line in series.lines if not line.startswith("note: ")]
    for line in lines[:SUMMARY_LINES]:
        draw_text(column, context, line, icon="DOT")
    for note in notes:
        draw_text(column, context, note.removeprefix("note: "), icon="ERROR")
    if draw_fold(column, context, "show_details", "Details"):
        for line in lines[SUMMARY_LINES:]:
            draw_text(column, context, line)


def draw_left_out(
    column: Any, context: Any, scan: FolderScan, contents: bonemesh.Scan
) -> None:
    """Draws how many files are in no series and, unfolded, which and why."""
    number = len(contents.left_out)
    if number == 0:
        return
    files = "1 file" if number == 1 else f"{number:,} files"
    if draw_fold(column, context, "show_left_out", f"{files} left out"):
        for left_out in contents.left_out[:MOST_ROWS]:
            name = name_in(scan.request.path, left_out.path)
            draw_text(column, context, f"{name}: {left_out.reason}")
        draw_rest(column, context, number - MOST_ROWS, "bonemesh info lists them")


def name_in(folder: str, path: Path) -> Path:
    """`path` without the folder that was scanned."""
    inside = path.is_relative_to(folder) and path != Path(folder)
    return path.relative_to(folder) if inside else path


def draw_fold(column: Any, context: Any, name: str, text: str) -> bool:
    """Draws the switch `name` of what is folded in; whether it is open."""
    folds = context.window_manager.bonemesh_folds
    is_open = getattr(folds, name)
    icon = "TRIA_DOWN" if is_open else "TRIA_RIGHT"
    row = column.row()
    row.alignment = "LEFT"
    row.prop(folds, name, text=text, icon=icon, emboss=False)
    return is_open


def draw_rest(column: Any, context: Any, number: int, remedy: str) -> None:
    """Draws how many rows a list lacks, if any."""
    if number > 0:
        draw_text(column, context, f"and {number:,} more; {remedy}")
