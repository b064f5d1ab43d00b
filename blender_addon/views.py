# SPDX-License-Identifier: GPL-3.0-or-later
"""Looking at a bone from one of the patient's sides, all of it in the view."""

from __future__ import annotations

from itertools import product
from typing import Any

from mathutils import Matrix, Quaternion, Vector

from . import patient
from .patient import Side

# What a 3D view's lens sees at its distance: twice a sensor of 36 mm.
SEEN_MM = 72.0
FILLS = 0.8  # of the view: letters and panels stand around the bone


def rotation(placed: Any, side: Side) -> Quaternion:
    """How a view is turned that looks at the patient's side, however the object was turned."""
    looks, up = Vector(side.looks), Vector(side.up)
    seen = Matrix((looks.cross(up), up, -looks)).transposed()
    turn = patient.world_from_patient(placed).to_quaternion()
    return turn @ seen.to_quaternion()


def look(placed: Any, side: Side, space: Any, width_px: int, height_px: int) -> None:
    """Turns a 3D view to the patient's side, without perspective, and fits the object into it."""
    view = space.region_3d
    turned = rotation(placed, side)
    corners, world_from_patient = patient.box(placed)
    places = [
        turned.inverted() @ (world_from_patient @ Vector(corner))
        for corner in product(*corners.T)
    ]
    lowest, highest = (
        Vector([pick(p[axis] for p in places) for axis in range(3)])
        for pick in (min, max)
    )
    sides = highest - lowest
    # Millimetres that a pixel must show, for the tighter of the two sides.
    mm = max(sides.x / max(width_px, 1), sides.y / max(height_px, 1)) / FILLS
    view.view_perspective = "ORTHO"
    view.view_rotation = turned
    view.view_location = turned @ ((lowest + highest) / 2.0)
    view.view_distance = max(mm * max(width_px, height_px) * space.lens / SEEN_MM, 1.0)
