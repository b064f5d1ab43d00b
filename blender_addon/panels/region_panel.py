# SPDX-License-Identifier: GPL-3.0-or-later
"""The part Region of the panel."""

import bpy
from bpy.types import Context, Panel, UILayout

from ..operators.measure_thickness import BONEMESH_OT_measure_thickness
from ..operators.mirror_roi import BONEMESH_OT_mirror_roi
from ..operators.plane_from_vertices import BONEMESH_OT_plane_from_vertices
from ..operators.resume_roi import BONEMESH_OT_resume_roi
from .part import Part


class BONEMESH_PT_region(Part, Panel):
    """How the region is cut, and its counterpart on the other side."""

    bl_label = "Region"

    def draw_fields(self, context: Context, layout: UILayout) -> None:
        """Draws thickness, cut and mirror."""
        properties = context.scene.bonemesh_region
        column = layout.column()
        column.operator(BONEMESH_OT_measure_thickness.bl_idname)
        if properties.measured:
            column.label(text=properties.measured, icon="DRIVER_DISTANCE")
        column = layout.column()
        column.prop(properties, "method")
        cut = column.column()
        cut.active = properties.method == "solid"
        cut.prop(properties, "direction")
        if properties.direction == "outward":
            cut.prop(properties, "clearance")
        if properties.direction == "given":
            cut.prop(properties, "direction_numbers")
        cut.prop(properties, "hidden")
        cut.prop(properties, "separate")
        column.operator(BONEMESH_OT_resume_roi.bl_idname)
        column = layout.column()
        column.active = properties.method == "solid"
        column.prop(properties, "plane")
        if properties.plane == "given":
            column.prop(properties, "plane_numbers")
        column.operator(BONEMESH_OT_plane_from_vertices.bl_idname)
        column.prop(properties, "mirror_back")
        column.operator(BONEMESH_OT_mirror_roi.bl_idname)


def register() -> None:
    """Adds the part."""
    bpy.utils.register_class(BONEMESH_PT_region)


def unregister() -> None:
    """Takes it away."""
    bpy.utils.unregister_class(BONEMESH_PT_region)
