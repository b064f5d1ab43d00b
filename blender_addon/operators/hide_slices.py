# SPDX-License-Identifier: GPL-3.0-or-later
"""bonemesh.hide_slices: takes the CT slices away."""

from typing import ClassVar

from bpy.types import Context, Operator

from ..slices import scene_slices, slice_updates


class BONEMESH_OT_hide_slices(Operator):
    """Take the CT slices and their contours away, and free the memory that the images take"""

    bl_idname = "bonemesh.hide_slices"
    bl_label = "Remove CT Slices"
    bl_options: ClassVar[set[str]] = {"UNDO"}

    @classmethod
    def poll(cls, _context: Context) -> bool:
        """Needs slices."""
        if scene_slices.found("stack") is None:
            cls.poll_message_set("There are no CT slices")
            return False
        return True

    def execute(self, _context: Context) -> set[str]:
        """Removes them."""
        scene_slices.remove()
        slice_updates.forget()
        return {"FINISHED"}
