# SPDX-License-Identifier: GPL-3.0-or-later
"""bonemesh.resume_roi: back to the selection and the settings that a region was cut with."""

from typing import Any, ClassVar

import bpy
from bpy.types import Context, Operator

from ..jobs.messages import one_line
from ..request.inputs import RefusalError
from ..scene import meshes

# By the key of a region's setting the panel's field.
NAMES_OR_NUMBERS = {"direction": "direction", "mirror": "plane"}
VALUES = {
    "clearance_mm": "clearance",
    "hidden": "hidden",
    "separate": "separate",
    "mirror_back": "mirror_back",
}


class BONEMESH_OT_resume_roi(Operator):
    """Select again what the active region was cut from, with the settings it was cut with, to cut it anew with others"""

    bl_idname = "bonemesh.resume_roi"
    bl_label = "Take Region Up Again"
    bl_options: ClassVar[set[str]] = {"UNDO"}

    @classmethod
    def poll(cls, context: Context) -> bool:
        """Needs a region."""
        active = context.active_object
        if active is None or meshes.SOURCE not in active:
            cls.poll_message_set("Make a region of interest active")
            return False
        return True

    def execute(self, context: Context) -> set[str]:
        """Sets the panel's fields, and selects the vertices in Edit Mode."""
        region = context.active_object
        try:
            source = meshes.source_of(region)
        except RefusalError as error:
            self.report({"ERROR"}, one_line(error))
            return {"CANCELLED"}
        kept = meshes.kept_settings(region)
        context.scene.bonemesh.cut_thickness = kept["thickness_mm"]
        restore(context.scene.bonemesh_region, kept)
        if context.mode != "OBJECT":
            bpy.ops.object.mode_set(mode="OBJECT")
        meshes.select_only(context, source)
        meshes.select_vertices(context, source, kept["selected"])
        bpy.ops.object.mode_set(mode="EDIT")
        return {"FINISHED"}


def restore(properties: bpy.types.PropertyGroup, kept: dict[str, Any]) -> None:
    """The panel's part Region as a region's settings have it; what they do not say stays."""
    properties.method = kept["method"]
    for key, field in NAMES_OR_NUMBERS.items():
        value = kept.get(key)
        if isinstance(value, str):
            setattr(properties, field, value)
        elif value is not None:
            setattr(properties, f"{field}_numbers", value)
            setattr(properties, field, "given")
    for key, field in VALUES.items():
        if key in kept:
            setattr(properties, field, kept[key])
