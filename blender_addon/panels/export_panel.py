# SPDX-License-Identifier: GPL-3.0-or-later
"""The part Export of the panel."""

import bpy
from bpy.types import Context, Panel, UILayout

from ..operators.choose_mesh_directory import BONEMESH_OT_choose_mesh_directory
from ..operators.export_mesh import BONEMESH_OT_export_mesh
from ..request import suggestions
from . import files_box
from .part import Part


class BONEMESH_PT_export(Part, Panel):
    """The active mesh as a file for printers and other programs."""

    bl_label = "Export"

    def draw_fields(self, context: Context, layout: UILayout) -> None:
        """Draws format, frame, name and the button."""
        properties = context.scene.bonemesh_output
        active = context.active_object
        column = layout.column()
        column.prop(properties, "format")
        column.prop(properties, "frame")
        column.prop(properties, "as_placed")
        folder = suggestions.filled(context).mesh_directory.strip()
        name = suggestions.export_name(context, folder)
        if active is not None and not name:
            name = active.name
        column.prop(properties, "file_name", placeholder=name)
        named = properties.file_name.strip()
        files_box.draw(layout, context, folder, named, properties.format)
        if not folder:
            layout.operator(BONEMESH_OT_choose_mesh_directory.bl_idname)
        layout.operator(BONEMESH_OT_export_mesh.bl_idname, icon="EXPORT")


def register() -> None:
    """Adds the part."""
    bpy.utils.register_class(BONEMESH_PT_export)


def unregister() -> None:
    """Takes it away."""
    bpy.utils.unregister_class(BONEMESH_PT_export)
