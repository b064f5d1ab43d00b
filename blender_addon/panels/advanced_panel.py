# SPDX-License-Identifier: GPL-3.0-or-later
"""The part Advanced of the panel."""

import bpy
from bpy.types import Context, Panel, UILayout

from ..request.inputs import uses_edge_points
from .part import Part


class BONEMESH_PT_advanced(Part, Panel):
    """What is right as it stands for most images."""

    bl_label = "Advanced"

    def draw_fields(self, context: Context, layout: UILayout) -> None:
        """Draws the settings of the next rendering."""
        properties = context.scene.bonemesh
        column = layout.column()
        column.prop(properties, "series")
        column.prop(properties, "one_series")
        column.prop(properties, "damp_metal")
        column.prop(properties, "method")
        table = column.row()
        table.active = not uses_edge_points(properties)
        table.prop(properties, "leave_out_table")
        edges = column.column()
        edges.active = uses_edge_points(properties)
        edges.prop(properties, "sigma")
        edges.prop(properties, "sample_percent")
        sampler = edges.row()
        sampler.enabled = properties.sample_percent < 100.0
        sampler.prop(properties, "sampler")
        column.prop(properties, "center_in_world")


def register() -> None:
    """Adds the part."""
    bpy.utils.register_class(BONEMESH_PT_advanced)


def unregister() -> None:
    """Takes it away."""
    bpy.utils.unregister_class(BONEMESH_PT_advanced)
