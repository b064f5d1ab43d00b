# SPDX-License-Identifier: GPL-3.0-or-later
"""bonemesh.choose_series: takes one of the series that the chosen folder holds."""

from typing import ClassVar

from bpy.props import IntProperty, StringProperty
from bpy.types import Context, Operator, OperatorProperties

from ..crop import cropping
from ..series import scanning


class BONEMESH_OT_choose_series(Operator):
    """Render this series"""

    bl_idname = "bonemesh.choose_series"
    bl_label = "Choose Series"
    bl_options: ClassVar[set[str]] = {"UNDO", "INTERNAL"}

    number: IntProperty(name="Number", min=1)
    title: StringProperty(name="Title", options={"HIDDEN", "SKIP_SAVE"})

    @classmethod
    def description(cls, _context: Context, properties: OperatorProperties) -> str:
        """The whole row, which the panel may have to cut off."""
        return properties.title

    def execute(self, context: Context) -> set[str]:
        """Notes the number as if it were typed; a crop was of another series."""
        properties = context.scene.bonemesh
        marked = scanning.marked_series(properties)
        if marked is None or marked.number != self.number:
            cropping.forget(context.scene)
        properties.series = str(self.number)
        return {"FINISHED"}
