# SPDX-License-Identifier: GPL-3.0-or-later
"""The part After-Care of the panel."""

import bpy
from bpy.types import Context, Panel, UILayout

from .part import Part


class BONEMESH_PT_after_care(Part, Panel):
    """What is done to the mesh after it was made; little unless asked for."""

    bl_label = "After-Care"

    def draw_fields(self, context: Context, layout: UILayout) -> None:
        """Draws the steps in the order in which they are done."""
        properties = context.scene.bonemesh
        column = layout.column()
        column.prop(properties, "fill_holes")
        if properties.fill_holes == "small":
            column.prop(properties, "holes_mm")
        column.prop(properties, "remove_islands")
        if properties.remove_islands == "small":
            column.prop(properties, "islands_mm3")
        column.prop(properties, "fill_cavities")
        if properties.fill_cavities == "small":
            column.prop(properties, "cavities_mm3")
        column.prop(properties, "smooth_mm")
        column.prop(properties, "reduce_triangles")
        if properties.reduce_triangles == "number":
            column.prop(properties, "triangles")
        elif properties.reduce_triangles == "error":
            column.prop(properties, "decimate_mm")


def register() -> None:
    """Adds the part."""
    bpy.utils.register_class(BONEMESH_PT_after_care)


def unregister() -> None:
    """Takes it away."""
    bpy.utils.unregister_class(BONEMESH_PT_after_care)
