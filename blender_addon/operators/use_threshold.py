# SPDX-License-Identifier: GPL-3.0-or-later
"""bonemesh.use_threshold: takes one of the thresholds that the panel lists."""

from typing import ClassVar

from bpy.props import IntProperty, StringProperty
from bpy.types import Context, Operator, OperatorProperties


class BONEMESH_OT_use_threshold(Operator):
    """Take this threshold"""

    bl_idname = "bonemesh.use_threshold"
    bl_label = "Use Threshold"
    bl_options: ClassVar[set[str]] = {"UNDO", "INTERNAL"}

    hu: IntProperty(name="HU", min=-1024, max=3071)
    title: StringProperty(name="Title", options={"HIDDEN", "SKIP_SAVE"})

    @classmethod
    def description(cls, _context: Context, properties: OperatorProperties) -> str:
        """What it separates, on what grounds, and where it is from."""
        return properties.title

    def execute(self, context: Context) -> set[str]:
        """Sets the slider."""
        context.scene.bonemesh.hu_threshold = self.hu
        return {"FINISHED"}
