"""Install, use, and install a newer version in the same session, with `ct` while it renders."""

import atexit
import os
from pathlib import Path
from typing import Any

import bpy
import stage
from background import press
from enabled import described
from interrupted import open_soon


def main(zip: str, out: str, newer: str, ct: str = "") -> dict[str, Any]:
    """Describes the extension before and after."""
    if bpy.app.version < (5, 0):
        # As a module (not as a program) Blender ends when Python lets go of `bpy`. Installing anew takes
        # the add-on's modules out of Python's sight, and whatever still refers to one of them keeps
        # `bpy`: Blender never ends, and at the process's end 4.2 dies of that and 4.5 waits for ever.
        atexit.register(os._exit, 0)
    stage.install(zip)
    before = described()
    was_running = bool(ct) and begin(ct, out)
    stage.install(newer)
    return {
        "before": before,
        "was_running": was_running,
        "after": described(),
        "files": sorted(p.name for p in Path(out).glob("*.stl")),
    }


def begin(ct: str, out: str) -> bool:
    """Presses Render Surface Mesh; whether it runs."""
    stage.fill_panel(ct, out)
    *_, gate = press("render_surface_mesh", "render")
    open_soon(gate)
    return stage.addon_job().running() is not None
