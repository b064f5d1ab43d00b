# SPDX-License-Identifier: GPL-3.0-or-later
"""The part Patient Views of the panel: the bone from the patient's sides, with their letters."""

from typing import ClassVar

import bpy
from bpy.types import Context, Panel, UILayout

from ..operators.view_patient import BONEMESH_OT_view_patient
from ..views.patient import SIDES
from .part import Part


class BONEMESH_PT_views(Part, Panel):
    """Looks at the active bone from a side of the patient."""

    bl_label = "Patient Views"
    bl_options: ClassVar[set[str]] = set()

    def draw_fields(self, context: Context, layout: UILayout) -> None:
        """Draws two buttons a row, and the switch of the letters."""
        layout.use_property_split = False
        column = layout.column(align=True)
        for first in range(0, len(SIDES), 2):
            row = column.row(align=True)
            for key in tuple(SIDES)[first : first + 2]:
                name = BONEMESH_OT_view_patient.bl_idname
                row.operator(name, text=SIDES[key].name).side = key
        layout.prop(context.window_manager, "bonemesh_directions")


def register() -> None:
    """Adds the part."""
    bpy.utils.register_class(BONEMESH_PT_views)


def unregister() -> None:
    """Takes it away."""
    bpy.utils.unregister_class(BONEMESH_PT_views)
