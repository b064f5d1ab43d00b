# SPDX-License-Identifier: GPL-3.0-or-later
"""Looking at a bone from one of the patient's sides, all of it in the view."""

from __future__ import annotations

from itertools import product
from typing import Any

from mathutils import Matrix, Quaternion, Vector

from . import patient, window
from .patient import Side

# What a 3D view's lens sees at its distance: twice a sensor of 36 mm.
SEEN_MM = 72.0
FILLS = 0.7  # of what is free of the view: letters stand around the bone


def rotation(placed: Any, side: Side) -> Quaternion:
    """How a view is turned that looks at the patient's side, however the object was turned."""
    looks, up = Vector(side.looks), Vector(side.up)
    seen = Matrix((looks.cross(up), up, -looks)).transposed()
    turn = patient.world_from_patient(placed).to_quaternion()
    return turn @ seen.to_quaternion()


def covered_px(area: Any) -> tuple[int, int]:
    """How much of a 3D view lies under the toolbar on its left and the sidebar on its right."""
    main = next(r for r in area.regions if r.type == "WINDOW")
    widths = {
        r.type: r.width if r.x < main.x + main.width and r.x + r.width > main.x else 0
        for r in area.regions
        if r.width > 1
    }
    return widths.get("TOOLS", 0), widths.get("UI", 0)


def look(placed: Any, side: Side, area: Any) -> None:
    """Turns a 3D view to the patient's side, without perspective, and fits the object into what is free of it."""
    view = area.spaces.active.region_3d
    corners, world_from_patient = patient.box(placed)
    view.view_perspective = "ORTHO"
    view.view_rotation = rotation(placed, side)
    fit(area, [world_from_patient @ Vector(corner) for corner in product(*corners.T)])


def frame(context: Any, placed: Any) -> None:
    """Fits the object into every 3D view of the current window, which stays turned as it is."""
    corners = [placed.matrix_world @ Vector(corner) for corner in placed.bound_box]
    frame_places(context, corners)


def frame_places(context: Any, places: list[Vector]) -> None:
    """The same for places of the world, where no object need be."""
    for window_of_view, area in window.views(context):
        if window_of_view == context.window:
            if area.spaces.active.region_3d.view_perspective == "CAMERA":
                area.spaces.active.region_3d.view_perspective = "PERSP"
            fit(area, places)


def fit(area: Any, places: list[Vector]) -> None:
    """Moves a 3D view so that places of the world fill what is free of it."""
    space = area.spaces.active
    view = space.region_3d
    region = next(r for r in area.regions if r.type == "WINDOW")
    left_px, right_px = covered_px(area)
    free_px = max(region.width - left_px - right_px, region.width // 4, 1)
    seen = [view.view_rotation.inverted() @ place for place in places]
    lowest, highest = (
        Vector([pick(p[axis] for p in seen) for axis in range(3)])
        for pick in (min, max)
    )
    sides = highest - lowest
    # Millimetres that a pixel must show, for the tighter of the two sides.
    mm = max(sides.x / free_px, sides.y / max(region.height, 1)) / FILLS
    middle = (lowest + highest) / 2.0
    middle.x += mm * (right_px - left_px) / 2.0
    view.view_location = view.view_rotation @ middle
    longer_px = max(region.width, region.height)
    # With perspective what is in front of the middle looks larger: it is looked at from farther off.
    nearer = sides.z / 2.0 if view.view_perspective == "PERSP" else 0.0
    view.view_distance = max(mm * longer_px * space.lens / SEEN_MM + nearer, 1.0)
