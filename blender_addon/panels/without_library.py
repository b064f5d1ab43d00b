# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel that stands in when the compiled library does not load: what is wrong and the remedy."""

import bpy
from bpy.types import Context, Panel

from .text import draw_text

_problem = ""


class BONEMESH_PT_without_library(Panel):
    """Says why nothing can be rendered."""

    bl_label = "Segment CT"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Segment CT"

    def draw(self, context: Context) -> None:
        """Draws the problem, line by line."""
        column = self.layout.column(align=True)
        column.label(text="Bonemesh cannot work", icon="ERROR")
        draw_text(column, context, _problem)


def is_registered() -> bool:
    """Whether this panel stands in."""
    return BONEMESH_PT_without_library.is_registered


def register(problem: str) -> None:
    """Shows the panel with `problem`."""
    global _problem
    _problem = problem
    bpy.utils.register_class(BONEMESH_PT_without_library)


def unregister() -> None:
    """Takes the panel away."""
    bpy.utils.unregister_class(BONEMESH_PT_without_library)
