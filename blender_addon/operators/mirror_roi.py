# SPDX-License-Identifier: GPL-3.0-or-later
"""bonemesh.mirror_roi: the healthy side's bone for a selection around a defect."""

from typing import Any, ClassVar

from bpy.types import Context, Operator

from ..request import suggestions
from .select_roi import RegionOperator


class BONEMESH_OT_mirror_roi(RegionOperator, Operator):
    """Cut out what lies on the other side of the mirror plane in place of the selected vertices, save it as STL and add it to the scene: the template for an implant"""

    bl_idname = "bonemesh.mirror_roi"
    bl_label = "Mirror Region of Interest"
    bl_options: ClassVar[set[str]] = {"UNDO"}
    title = "Mirror Region of Interest"

    def fields(self, context: Context) -> tuple[Any, Any]:
        """The panel's; where no name is typed, one that says what it is."""
        fields, region_fields = super().fields(context)
        if context.scene.bonemesh.roi_name.strip():
            return fields, region_fields
        name = suggestions.mirrored_name(context, fields.mesh_directory)
        return suggestions.Filled(fields, roi_name=name), region_fields

    def mirror_options(self, context: Context) -> dict[str, Any]:
        """The plane and where the result goes."""
        properties = context.scene.bonemesh_region
        plane = properties.plane
        if plane == "given":
            plane = tuple(properties.plane_numbers)
        return {"mirror": plane, "mirror_back": properties.mirror_back}
