# SPDX-License-Identifier: GPL-3.0-or-later
"""bonemesh.cancel: stops the running job."""

from typing import ClassVar

from bpy.types import Context, Operator

from ..jobs import job


class BONEMESH_OT_cancel(Operator):
    """Stop the running job; nothing of it is kept"""

    bl_idname = "bonemesh.cancel"
    bl_label = "Cancel"
    bl_options: ClassVar[set[str]] = {"INTERNAL"}

    def execute(self, context: Context) -> set[str]:
        """Asks the job to stop; the operator that began it tidies up."""
        running = job.running()
        if running is None:
            self.report({"INFO"}, "Nothing is running")
            return {"CANCELLED"}
        running.cancel()
        return {"FINISHED"}
