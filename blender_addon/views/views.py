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
# Of what is free of the view, for letters stand around the bone; a box seen askew has corners far
# outside of the bone in it.
FILLS = 0.7
FILLS_DEEP = 0.9


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
    middle = (lowest + highest) / 2.0
    # What a pixel shows of the plane through the middle, for each millimetre that it is away.
    mm = SEEN_MM / (space.lens * max(region.width, region.height, 1))
    halves_px = free_px / 2.0, max(region.height, 1) / 2.0
    distance = 1.0
    for place in seen:
        beside = place - middle
        needed = max(
            abs(b) / (mm * px) for b, px in zip(beside.xy, halves_px, strict=True)
        )
        if view.view_perspective == "ORTHO":
            distance = max(distance, needed / FILLS)
        else:  # what is nearer looks larger
            distance = max(distance, needed / FILLS_DEEP + beside.z)
    middle.x += mm * distance * (right_px - left_px) / 2.0
    view.view_location = view.view_rotation @ middle
    view.view_distance = distance
