# SPDX-License-Identifier: GPL-3.0-or-later
"""bonemesh.scan_ct_directory: looks again at what the chosen CT images hold."""

from typing import ClassVar

import bonemesh
from bpy.types import Context, Event, Operator

from ..jobs.messages import EXPECTED, one_line
from ..preview import previewing
from ..request.inputs import NO_CT_IMAGES
from ..series import scanning, scans
from ..series.scans import FolderScan
from ..views import window


class BONEMESH_OT_scan_ct_directory(Operator):
    """Look again at what the chosen folder holds"""

    bl_idname = "bonemesh.scan_ct_directory"
    bl_label = "Look Again"
    bl_options: ClassVar[set[str]] = {"INTERNAL"}

    def execute(self, context: Context) -> set[str]:
        """Scans before it returns, and says how many series there are."""
        request = scanning.request_of(context.scene.bonemesh)
        if request is None:
            return self._nothing_chosen()
        scan = FolderScan(request)
        try:
            with window.CursorProgress(context) as cursor:
                scan.job.on_progress = cursor.show
                contents = scan.run_here()
        except bonemesh.Cancelled:
            self.report({"INFO"}, "Stopped")
            return {"CANCELLED"}
        except EXPECTED as error:
            self.report({"ERROR"}, one_line(error))
            return {"CANCELLED"}
        finally:
            scans.keep(scan)
            previewing.look_again(context.scene.bonemesh)
            window.redraw_views(context)
        self.report({"INFO"}, f"{request.path}: {len(contents.series)} series")
        return {"FINISHED"}

    def invoke(self, context: Context, _event: Event) -> set[str]:
        """Starts the scan beside the window; the panel shows it."""
        if context.window is None:
            return self.execute(context)
        if scanning.begin(context.scene.bonemesh) is None:
            return self._nothing_chosen()
        previewing.look_again(context.scene.bonemesh)
        return {"FINISHED"}

    def _nothing_chosen(self) -> set[str]:
        self.report({"ERROR"}, NO_CT_IMAGES)
        return {"CANCELLED"}
