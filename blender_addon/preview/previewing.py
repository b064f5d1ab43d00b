# SPDX-License-Identifier: GPL-3.0-or-later
"""When a series is read for its histogram and preview, and when the preview is seen.

A choice (a folder, a series, the slider, the switch) wants a preview. `step` compares what is wanted with
what is there and does what is next, never waiting: it asks a worker thread for a surface, or hands a
finished one to the scene. A timer calls it until nothing is left to do. The surface that is rendered,
another file and the switch end the preview; the next choice brings it back.
"""

from __future__ import annotations

import logging
from itertools import product
from typing import Any

import bpy
import numpy as np
from bpy.app.handlers import persistent
from mathutils import Vector

from ..jobs import last_messages
from ..scene import meshes
from ..series import scanning, scans
from ..views import views, window
from . import histogram_icon, previews, scene_preview
from .previews import Reading, SeriesRequest, Surface, Wanted

TICK_S = 0.01
PATIENCE_S = 5.0  # as for a job

log = logging.getLogger(__name__)


class State:
    """What is wanted and what is there."""

    is_wanted = False
    """Whether a choice was made that a preview answers."""
    surface: Surface | None = None
    """The newest surface of what is wanted."""
    is_shown = False
    """Whether it was handed to the scene, and nothing has undone that since."""
    is_framed = True
    """Whether the views were turned to it since images were chosen."""


state = State()


def choose(*, images: bool = False) -> None:
    """Called when something was chosen that the preview depends on; `images`: other ones than before."""
    if scanning.is_watched:
        state.is_wanted = True
        state.is_framed = state.is_framed and not images
        ask()
        watch()


def ask() -> None:
    """Asks for the wanted surface at once, where its series was read: `step` would do so a tick later."""
    properties = bpy.context.scene.bonemesh
    series = chosen_series(properties)
    reading = None if series is None else previews.known(series)
    if reading is not None and reading.preview is not None and properties.show_preview:
        wanted = wanted_of(properties, series)
        if previews.worker.asked != wanted:
            previews.worker.ask(reading.preview, wanted)


def wanted_of(properties: Any, series: SeriesRequest) -> Wanted:
    """The surface of a series at the threshold, in the crop box."""
    return Wanted(series, properties.hu_threshold, properties.crop.strip() or None)


def look_again(properties: Any) -> None:
    """The same when the files are looked at anew: what was read of them may be old."""
    request = scanning.request_of(properties)
    if request is not None:
        previews.forget(request.path)
    previews.worker.forget()
    choose()


def dismiss() -> None:
    """Takes the preview away until the next choice: the surface itself is there, or another file."""
    state.is_wanted = False
    drop()


def drop() -> None:
    """Takes the preview away."""
    previews.worker.forget()
    state.surface = None
    state.is_shown = False
    scene_preview.remove()


def watch() -> None:
    """Lets the timer call `step` until nothing is left to do."""
    if scanning.is_watched and not bpy.app.timers.is_registered(tick):
        # Persistent: opening another file must not leave the panel without news.
        bpy.app.timers.register(tick, first_interval=TICK_S, persistent=True)


def tick() -> float | None:
    """For the timer."""
    return TICK_S if step(bpy.context) else None


def step(context: Any) -> bool:
    """Does what is next; whether there is more to come."""
    properties = context.scene.bonemesh
    is_scanning = bool(scans.running())  # asked first: it may end meanwhile
    series = chosen_series(properties)
    if series is None:
        drop()
        return state.is_wanted and is_scanning
    reading = reading_of(series)
    if reading is None:
        return False
    is_other = state.surface is not None and state.surface.wanted.series != series
    is_awaited = state.is_wanted and properties.show_preview
    if is_other or not is_awaited:
        drop()
    if is_awaited and reading.preview is not None:
        wanted = wanted_of(properties, series)
        is_awaited = see(context, reading.preview, wanted)
    is_reading = reading.job.is_running()
    window.redraw_views(context)
    return is_reading or (is_awaited and reading.preview is not None)


def see(context: Any, preview: Any, wanted: Wanted) -> bool:
    """Brings the wanted surface nearer to the scene; whether it is not there yet."""
    if previews.worker.asked != wanted:
        previews.worker.ask(preview, wanted)
    newest = previews.worker.take()
    if newest is not None and newest.wanted.series == wanted.series:
        # One of an earlier place of the slider is shown, too: the view follows the hand.
        state.surface, state.is_shown = newest, False
    if state.surface is not None and not state.is_shown:
        hand_over(context, state.surface)
    return state.surface is None or state.surface.wanted != wanted


def hand_over(context: Any, surface: Surface) -> None:
    """Puts a surface into the scene, or takes the last one away where there is none."""
    state.is_shown = True
    if surface.mesh is None:
        scene_preview.remove()
        return
    scene_preview.show(context, surface.mesh, surface.edges)
    if not state.is_framed:
        state.is_framed = True
        meshes.use_millimetres(context)
        vertices = surface.mesh.vertices
        ends = np.stack([vertices.min(axis=0), vertices.max(axis=0)])
        views.frame_places(context, [Vector(corner) for corner in product(*ends.T)])


def chosen_series(properties: Any) -> SeriesRequest | None:
    """The series that the panel marks; None as long as it is not known."""
    request = scanning.request_of(properties)
    choice = scanning.marked_choice(properties)
    if request is None or choice is None:
        return None
    return SeriesRequest(request.path, request.one_series, choice)


def reading_of(series: SeriesRequest) -> Reading | None:
    """The reading of a series, begun if a choice was made or nothing else is being read."""
    reading = previews.known(series)
    if reading is None and (state.is_wanted or not previews.running()):
        reading = previews.begin(series)
        watch()
    return reading


def shown(properties: Any) -> Reading | None:
    """The reading for the panel, begun if need be; None where the series is not known yet."""
    series = chosen_series(properties)
    if series is None or not scanning.is_watched:
        return None if series is None else previews.known(series)
    return reading_of(series)


def problem() -> BaseException | None:
    """Why there is no preview of what is wanted."""
    return None if state.surface is None else state.surface.error


@persistent
def after_undo(*_: Any) -> None:
    """Undo and redo put the scene of another moment in place, with its preview or without."""
    state.is_shown = False
    if state.is_wanted:
        watch()
    else:
        scene_preview.remove()


@persistent
def before_saving(*_: Any) -> None:
    """The preview is in no file."""
    scene_preview.remove()


@persistent
def after_saving(*_: Any) -> None:
    """Puts it back."""
    surface = state.surface
    if state.is_shown and surface is not None and surface.mesh is not None:
        scene_preview.show(bpy.context, surface.mesh, surface.edges)


@persistent
def after_loading(*_: Any) -> None:
    """Another file: nothing was chosen in it yet; one that Blender saved by itself may hold a preview."""
    state.is_framed = True
    last_messages.clear()
    scans.forget()  # folders may have gone since
    for reading in previews.running():
        reading.job.cancel()
        previews.forget(reading.request.path)
    dismiss()


HANDLERS = {
    "undo_post": after_undo,
    "redo_post": after_undo,
    "save_pre": before_saving,
    "save_post": after_saving,
    "save_post_fail": after_saving,
    "load_post": after_loading,
}


def register() -> None:
    """Adds the handlers."""
    for name, handler in HANDLERS.items():
        getattr(bpy.app.handlers, name).append(handler)


def unregister() -> None:
    """Takes the preview and the handlers away."""
    for name, handler in HANDLERS.items():
        handlers = getattr(bpy.app.handlers, name)
        if handler in handlers:
            handlers.remove(handler)
    scene_preview.remove()
    histogram_icon.remove()


def stop() -> None:
    """Ends what is at work and the timer: neither may outlive the add-on or Blender."""
    if bpy.app.timers.is_registered(tick):
        bpy.app.timers.unregister(tick)
    state.is_wanted = False
    state.surface = None
    if not previews.stop_all(PATIENCE_S):
        log.warning("Bonemesh: a preview did not stop within %s s", PATIENCE_S)
