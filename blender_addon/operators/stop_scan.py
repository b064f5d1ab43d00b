# SPDX-License-Identifier: GPL-3.0-or-later
"""bonemesh.stop_scan: stops the look at the CT images."""

from typing import ClassVar

from bpy.types import Context, Operator

from ..series import scans


class BONEMESH_OT_stop_scan(Operator):
    """Stop looking; the series can still be rendered by its number (Advanced)"""

    bl_idname = "bonemesh.stop_scan"
    bl_label = "Stop"
    bl_options: ClassVar[set[str]] = {"INTERNAL"}

    def execute(self, _context: Context) -> set[str]:
        """Asks the scan to stop; the panel shows when it has."""
        running = scans.running()
        if not running:
            self.report({"INFO"}, "Nothing is being looked at")
            return {"CANCELLED"}
        for scan in running:
            scan.job.cancel()
        return {"FINISHED"}
