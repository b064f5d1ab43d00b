# SPDX-License-Identifier: GPL-3.0-or-later
"""The line above a button that writes a file, where one of that name is there already."""

from typing import Any

from ..request import suggestions
from ..request.inputs import without_suffix
from .text import draw_text


def draw(layout: Any, context: Any, folder: str, name: str) -> None:
    """Draws it; suggested names are always free."""
    if folder and name and suggestions.is_there(folder, name):
        stem = without_suffix(name)
        draw_text(layout, context, f"{stem}.stl will be replaced", icon="INFO")
