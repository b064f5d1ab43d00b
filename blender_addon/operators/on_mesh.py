# SPDX-License-Identifier: GPL-3.0-or-later
"""What the operators on the active mesh share."""

from bpy.types import Context


class OnMesh:
    """Mixed into an operator that works on the active object's mesh."""

    remedy = "Make a mesh object active and select vertices of it in Edit Mode"
    """What is said where there is none."""

    @classmethod
    def poll(cls, context: Context) -> bool:
        """Needs a mesh."""
        active = context.active_object
        if active is None or active.type != "MESH":
            cls.poll_message_set(cls.remedy)
            return False
        return True
