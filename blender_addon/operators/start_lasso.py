# SPDX-License-Identifier: GPL-3.0-or-later
"""bonemesh.start_lasso: ready to draw around a region."""

from typing import ClassVar

import bpy
from bpy.types import Context, Operator

from ..scene import edges
from .on_mesh import OnMesh


class BONEMESH_OT_start_lasso(OnMesh, Operator):
    """Go to Edit Mode with the lasso in hand: then draw around the region with the left mouse button"""

    bl_idname = "bonemesh.start_lasso"
    bl_label = "Select with Lasso"
    bl_options: ClassVar[set[str]] = {"UNDO"}
    remedy = "Make the bone active"

    def execute(self, context: Context) -> set[str]:
        """Edit Mode, faces without their edges, and the tool where there is a view to use it in."""
        edges.edit_without(context.active_object)
        # Faces, not vertices: from afar several share a pixel, and one face selects three vertices.
        context.tool_settings.mesh_select_mode = (False, False, True)
        if context.area is not None and context.area.type == "VIEW_3D":
            bpy.ops.wm.tool_set_by_id(name="builtin.select_lasso")
        return {"FINISHED"}
