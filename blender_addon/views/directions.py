# SPDX-License-Identifier: GPL-3.0-or-later
"""The letters around a bone that say where the patient's left, back and head are.

They are drawn over the view, not put into the scene: so they can be read from every side, are in the way
of no selection, and get into no file.
"""

from __future__ import annotations

from typing import Any

import blf
import bpy
import numpy as np
from bpy.props import BoolProperty
from bpy_extras.view3d_utils import location_3d_to_region_2d
from mathutils import Vector

from . import patient, window
from .patient import LETTERS

FONT = 0
SIZE_POINTS = 18.0
COLOUR = (1.0, 0.82, 0.25, 1.0)
SHADOW = (0.0, 0.0, 0.0, 0.9)
BESIDE = 0.12  # of the box's mean side: how far outside of it the letters stand
# Cosines between a letter's direction and the look. One right before the bone would cover it; one behind
# it would be read on the side that is seen, which is the other one.
BEFORE, BEHIND = -0.95, 0.2

_handle: Any = None


def places(placed: Any) -> dict[str, Vector]:
    """Where each letter stands in the world."""
    corners, world_from_patient = patient.box(placed)
    middle, half = corners.mean(axis=0), np.ptp(corners, axis=0) / 2.0
    beside = BESIDE * 2.0 * half.mean()
    return {
        letter: world_from_patient
        @ Vector(middle + np.array(direction) * (half + beside))
        for letter, direction in LETTERS.items()
    }


def seen_letters(placed: Any, looks: Vector) -> dict[str, Vector]:
    """The letters that say something to whoever looks along `looks`, a direction of the world."""
    turn = patient.world_from_patient(placed).to_3x3().normalized()
    return {
        letter: place
        for letter, place in places(placed).items()
        if BEFORE < (turn @ Vector(LETTERS[letter])).dot(looks) < BEHIND
    }


def draw() -> None:
    """Called by Blender after it has drawn a 3D view."""
    context = bpy.context
    if not context.window_manager.bonemesh_directions:
        return
    view, region = context.region_data, context.region
    placed = patient.lettered_mesh(context)
    if placed is None or view is None or not context.space_data.overlay.show_overlays:
        return
    scale = context.preferences.system.ui_scale or 1.0
    blf.size(FONT, SIZE_POINTS * scale)
    blf.color(FONT, *COLOUR)
    blf.enable(FONT, blf.SHADOW)
    blf.shadow(FONT, 5, *SHADOW)
    blf.shadow_offset(FONT, 1, -1)
    looks = view.view_rotation @ Vector((0.0, 0.0, -1.0))
    for letter, place in seen_letters(placed, looks).items():
        pixel = location_3d_to_region_2d(region, view, place)
        if pixel is not None:
            width, height = blf.dimensions(FONT, letter)
            blf.position(FONT, pixel.x - width / 2.0, pixel.y - height / 2.0, 0.0)
            blf.draw(FONT, letter)
    blf.disable(FONT, blf.SHADOW)


def switched(_window_manager: Any, context: Any) -> None:
    """Shows the change at once."""
    window.redraw_views(context)


def register() -> None:
    """Begins to draw, where there is a window."""
    global _handle
    bpy.types.WindowManager.bonemesh_directions = BoolProperty(
        name="Patient Directions",
        description="Letters around the active bone: R and L the patient's right and left, A and P front and back, S and I head and feet",
        default=True,
        update=switched,
    )
    if not bpy.app.background:
        _handle = bpy.types.SpaceView3D.draw_handler_add(
            draw, (), "WINDOW", "POST_PIXEL"
        )


def unregister() -> None:
    """Draws no longer."""
    global _handle
    if _handle is not None:
        bpy.types.SpaceView3D.draw_handler_remove(_handle, "WINDOW")
        _handle = None
    del bpy.types.WindowManager.bonemesh_directions
