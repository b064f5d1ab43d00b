"""The add-on is disabled or Blender quits while a folder is scanned."""

from typing import Any

import bpy
import stage
from interrupted import open_soon


def main(zip: str, out: str, ct: str, how: str) -> dict[str, Any]:
    """Says what is left of the scan and its timer."""
    stage.install(zip)
    scanning, scans = stage.addon_scanning(), stage.addon_scans()
    gate = stage.Gate("scan")
    bpy.context.scene.bonemesh.ct_directory = ct
    gate.wait_until_reached()
    scan = scans.known(scanning.request_of(bpy.context.scene.bonemesh))
    open_soon(gate)
    if how == "disable":
        bpy.ops.preferences.addon_disable(module=stage.MODULE)
    return {
        "running": scan.job.is_running(),
        "timer": bpy.app.timers.is_registered(scanning._tick),
    }
