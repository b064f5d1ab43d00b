# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures and contours follow the slices: moved by hand, by a slider or by undo, saved or opened.

Blender tells of every change of the scene; whatever moved a slice, its picture is drawn anew where it is
not the one drawn last.
"""

from __future__ import annotations

from typing import Any

import bonemesh
import bpy
from bpy.app.handlers import persistent

from ..scene import selection
from . import scene_slices, slice_store
from .slice_store import PLANES, Shown

_drawn_mm: dict[str, float] = {}
_is_drawing = False


def surface() -> Any:
    """The object whose contours are shown: that on which the slices hang, whatever its name is now."""
    stack = scene_slices.found("stack")
    placed = None if stack is None else stack.parent
    return placed if placed is not None and placed.type == "MESH" else None


def take_surface(placed: Any) -> None:
    """Copies a mesh object for the contours; None takes none."""
    shown = slice_store.current()
    if shown is None:
        return
    shown.surface = None
    if placed is not None:
        source = selection.read(placed)
        shown.surface = bonemesh.Mesh(source.vertices, source.triangles)


def draw_all() -> None:
    """Draws every slice anew: another volume, window or surface."""
    _drawn_mm.clear()
    draw_moved()


def draw_moved() -> None:
    """Draws the slices that are elsewhere than they were drawn."""
    global _is_drawing
    shown = slice_store.current()
    if shown is None or _is_drawing:
        return
    _is_drawing = True
    try:
        for name in PLANES:
            position = scene_slices.position_mm(name)
            if position is not None and _drawn_mm.get(name) != position:
                draw(shown, name, position)
                _drawn_mm[name] = position
    finally:
        _is_drawing = False


def draw(shown: Shown, name: str, position_mm: float) -> None:
    """The picture and the contour of one slice."""
    window = bpy.context.scene.bonemesh_slices
    grey = shown.volume.slice(
        name, position_mm, window_hu=(window.centre_hu, window.width_hu)
    )
    scene_slices.draw_picture(name, grey)
    scene_slices.draw_contour(name, shown.contours(name, position_mm))


def forget() -> None:
    """Lets the volume go."""
    slice_store.keep(None)
    _drawn_mm.clear()


@persistent
def on_change(_scene: Any, depsgraph: Any) -> None:
    """After every change: a slice may have been moved, or the surface edited or deleted."""
    shown = slice_store.current()
    if shown is None or _is_drawing:
        return
    placed = surface()
    if placed is None:
        is_stale = shown.surface is not None
    else:
        is_stale = placed.mode == "OBJECT" and is_edited(placed, depsgraph)
    if is_stale:
        take_surface(placed)
        draw_all()
    else:
        draw_moved()


def is_edited(placed: Any, depsgraph: Any) -> bool:
    """Whether the surface's mesh changed."""
    return any(
        update.is_updated_geometry and update.id.original == placed.data
        for update in depsgraph.updates
    )


@persistent
def on_undo(*_arguments: Any) -> None:
    """Undo brings objects back as they were, not what was drawn for them."""
    if slice_store.current() is not None:
        take_surface(surface())
        draw_all()


@persistent
def on_load(*_arguments: Any) -> None:
    """The volume belongs to the file that was left."""
    forget()


@persistent
def before_saving(*_arguments: Any) -> None:
    """Pictures are no part of the file: they are made of the CT images, and would be patient data in it."""
    scene_slices.take_pictures_off()


@persistent
def after_saving(*_arguments: Any) -> None:
    """The pictures come back."""
    if slice_store.current() is not None:
        draw_all()


HANDLERS = (
    ("depsgraph_update_post", on_change),
    ("undo_post", on_undo),
    ("redo_post", on_undo),
    ("load_post", on_load),
    ("save_pre", before_saving),
    ("save_post", after_saving),
    ("save_post_fail", after_saving),
)


def register() -> None:
    """Listens."""
    for name, handler in HANDLERS:
        getattr(bpy.app.handlers, name).append(handler)


def unregister() -> None:
    """Listens no longer, and lets the volume go."""
    for name, handler in HANDLERS:
        handlers = getattr(bpy.app.handlers, name)
        if handler in handlers:
            handlers.remove(handler)
    forget()
