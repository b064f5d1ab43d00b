"""The add-on is disabled, another file opened, or Blender quits while a series is read or its surface made."""

import time
from pathlib import Path
from typing import Any

import bpy
import stage
from interrupted import open_soon
from preview import leftovers, previews, until_done


def begin(ct: str, hold: bool) -> tuple[Any, stage.Gate | None]:
    """Chooses images; their reading is held, or their preview shown."""
    previewing = stage.addon_previewing()
    gate = stage.Gate("read_series") if hold else None
    bpy.context.scene.bonemesh.ct_directory = ct
    if gate is None:
        until_done(previewing)
        assert previews()
        return previewing, None
    while not previewing.previews.running():
        previewing.tick()
        time.sleep(0.01)
    gate.wait_until_reached()
    return previewing, gate


def until_ended(previewing: Any) -> None:
    """Until nothing is left to do, and nothing is read any more."""
    until_done(previewing)
    for reading in previewing.previews.running():
        assert reading.job.wait(60.0)


def left(previewing: Any) -> dict[str, Any]:
    """What is left of it."""
    return {
        "objects": len(previews()),
        "data": leftovers(),
        "running": len(previewing.previews.running()),
        "timer": bpy.app.timers.is_registered(previewing.tick),
        "handlers": sum(
            handler.__module__.startswith(stage.MODULE)
            for name in previewing.HANDLERS
            for handler in getattr(bpy.app.handlers, name)
        ),
    }


def main(zip: str, out: str, ct: str, how: str) -> dict[str, Any]:
    """`how`: what happens, and whether it does while the series is read or when the preview is shown."""
    stage.install(zip)
    what, when = how.split()
    previewing, gate = begin(ct, hold=when == "reading")
    if gate is not None and what in ("disable", "quit"):
        open_soon(gate)  # the add-on waits for the reading
    if what == "disable":
        bpy.ops.preferences.addon_disable(module=stage.MODULE)
    elif what == "home":
        bpy.ops.wm.read_homefile()
        if gate is not None:
            gate.open()
        until_ended(previewing)
    elif what == "open":
        file = str(Path(out) / "scene.blend")
        bpy.context.scene.bonemesh.ct_directory = str(Path(out) / "moved away")
        bpy.ops.wm.save_as_mainfile(filepath=file, copy=True)
        bpy.context.scene.bonemesh.ct_directory = ct
        bpy.ops.wm.open_mainfile(filepath=file)
        if gate is not None:
            gate.open()
        until_ended(previewing)
    elif what == "scene":
        bpy.context.window.scene = bpy.data.scenes.new("second")
        if gate is not None:
            gate.open()
        until_ended(previewing)
    return left(previewing)
