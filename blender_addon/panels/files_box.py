# SPDX-License-Identifier: GPL-3.0-or-later
"""The line above a button that writes a file, where one of that name is there already."""

from typing import Any

from ..request import suggestions
from ..request.inputs import without_suffix
from .text import draw_text


def draw(
    layout: Any, context: Any, folder: str, name: str, ending: str = "stl"
) -> None:
    """Draws it; suggested names are always free."""
    stem = without_suffix(name, ending)
    if folder and stem and suggestions.is_there(folder, stem, ending):
        draw_text(layout, context, f"{stem}.{ending} will be replaced", icon="INFO")
