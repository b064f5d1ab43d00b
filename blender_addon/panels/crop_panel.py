# SPDX-License-Identifier: GPL-3.0-or-later
"""The part Crop of the panel."""

import bpy
from bpy.types import Context, Panel, UILayout

from ..operators.remove_crop_box import BONEMESH_OT_remove_crop_box
from ..operators.show_crop_box import BONEMESH_OT_show_crop_box
from ..operators.use_crop_box import BONEMESH_OT_use_crop_box
from .part import Part


class BONEMESH_PT_crop(Part, Panel):
    """Which part of the images is rendered, as a box in the 3D view."""

    bl_label = "Crop"

    def draw_fields(self, context: Context, layout: UILayout) -> None:
        """Draws the field and what moves the box."""
        column = layout.column()
        column.prop(context.scene.bonemesh, "crop")
        column.operator(BONEMESH_OT_show_crop_box.bl_idname, icon="MESH_CUBE")
        column.operator(BONEMESH_OT_use_crop_box.bl_idname)
        column.operator(BONEMESH_OT_remove_crop_box.bl_idname)


def register() -> None:
    """Adds the part."""
    bpy.utils.register_class(BONEMESH_PT_crop)


def unregister() -> None:
    """Takes it away."""
    bpy.utils.unregister_class(BONEMESH_PT_crop)
