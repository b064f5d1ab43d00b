# SPDX-License-Identifier: GPL-3.0-or-later
"""What a user sees of a job while it runs, and where the view looks afterwards."""

from __future__ import annotations

from collections.abc import Iterator
from types import TracebackType
from typing import Any, Self

import bpy
from mathutils import Vector

from ..jobs.job import Progress


def views(context: Any) -> Iterator[tuple[Any, Any]]:
    """Every 3D view that is open, with its window."""
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                yield window, area


def redraw_views(context: Any) -> None:
    """Lets the panels show the newest progress."""
    for _, area in views(context):
        area.tag_redraw()


def view_direction(context: Any) -> Any:
    """Where the user looks, in the world, in the view that was pressed in or else the first; None without one."""
    view = getattr(context, "region_data", None)
    if view is None:
        view = next((area.spaces.active.region_3d for _, area in views(context)), None)
    return None if view is None else view.view_rotation @ Vector((0.0, 0.0, -1.0))


def show_status(context: Any, text: str) -> None:
    """Shows `text` in the status bar."""
    context.workspace.status_text_set(text)


def clear_status(context: Any) -> None:
    """Gives the status bar back, in every workspace that was looked at meanwhile."""
    for workspace in bpy.data.workspaces:
        with context.temp_override(workspace=workspace):
            workspace.status_text_set(None)


def clear_status_soon() -> None:
    """The same once Blender is done with what it is doing, such as closing the window that a job was begun in."""
    if not bpy.app.background and not bpy.app.timers.is_registered(_clear_status):
        # Persistent: opening another file must not leave the text there.
        bpy.app.timers.register(_clear_status, first_interval=0.0, persistent=True)


def stop() -> None:
    """Ends the timer: it may not outlive the add-on or Blender."""
    if bpy.app.timers.is_registered(_clear_status):
        bpy.app.timers.unregister(_clear_status)


def _clear_status() -> None:
    clear_status(bpy.context)


def frame_selected(context: Any) -> None:
    """Turns every 3D view of the current window to the selected object."""
    for window, area in views(context):
        if window != context.window:
            continue
        region = next((r for r in area.regions if r.type == "WINDOW"), None)
        if region is not None:
            with context.temp_override(window=window, area=area, region=region):
                bpy.ops.view3d.view_selected()


class CursorProgress:
    """The number beside the mouse pointer while a script's call blocks the window."""

    def __init__(self, context: Any) -> None:
        self._window_manager = context.window_manager

    def __enter__(self) -> Self:
        self._window_manager.progress_begin(0, 100)
        return self

    def __exit__(
        self,
        _kind: type[BaseException] | None,
        _error: BaseException | None,
        _trace: TracebackType | None,
    ) -> None:
        self._window_manager.progress_end()

    def show(self, progress: Progress) -> None:
        """Shows the done part of the current stage."""
        self._window_manager.progress_update(round(100 * progress.fraction))
