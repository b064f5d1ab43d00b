# SPDX-License-Identifier: GPL-3.0-or-later
"""Where a patient's directions point in the scene: as the object lies there, moved or not.

Patient coordinates are DICOM's (LPS): x to the left, y to the back, z to the head.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from mathutils import Matrix, Vector
from numpy.typing import NDArray

from ..preview import scene_preview
from ..scene.meshes import SOURCE
from ..scene.selection import CENTRE_MM, PATIENT_MM, is_point_vector, relative_to

PROBES = 32  # vertices looked at: whoever rewrites coordinates rewrites them all


class Side(NamedTuple):
    """A side of the patient: where one looks from there, and what is up then."""

    name: str
    looks: tuple[float, float, float]
    up: tuple[float, float, float]


# Top and bottom have the patient's front on top, as slices are shown.
SIDES = {
    "front": Side("Front", (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)),
    "back": Side("Back", (0.0, -1.0, 0.0), (0.0, 0.0, 1.0)),
    "left": Side("Left", (-1.0, 0.0, 0.0), (0.0, 0.0, 1.0)),
    "right": Side("Right", (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)),
    "top": Side("Top", (0.0, 0.0, -1.0), (0.0, -1.0, 0.0)),
    "bottom": Side("Bottom", (0.0, 0.0, 1.0), (0.0, -1.0, 0.0)),
}
LETTERS = {
    "L": (1.0, 0.0, 0.0),
    "R": (-1.0, 0.0, 0.0),
    "P": (0.0, 1.0, 0.0),
    "A": (0.0, -1.0, 0.0),
    "S": (0.0, 0.0, 1.0),
    "I": (0.0, 0.0, -1.0),
}


def world_from_patient(placed: Any) -> Matrix:
    """The matrix that takes a place in the patient to where the object shows it.

    For a mesh that is not ours, or whose coordinates were rewritten ("Apply Rotation"), the world's
    coordinates are taken for the patient's.
    """
    if CENTRE_MM not in placed or not still_holds(placed):
        return Matrix.Identity(4)
    return placed.matrix_world @ Matrix.Translation(-Vector(placed[CENTRE_MM]))


def still_holds(placed: Any) -> bool:
    """Whether the mesh is where its centre and its kept coordinates say; sampled, so that it is quick."""
    mesh = placed.data
    attribute = mesh.attributes.get(PATIENT_MM)
    if placed.mode == "EDIT":  # hides its attributes; nothing is applied meanwhile
        return True
    if attribute is None or not is_point_vector(attribute) or not len(attribute.data):
        return False
    step = max(1, len(attribute.data) // PROBES)
    probes = range(0, len(attribute.data), step)
    exact = np.array([attribute.data[i].vector for i in probes], dtype=np.float32)
    local = np.array([mesh.vertices[i].co for i in probes], dtype=np.float32)
    centre = np.asarray(placed[CENTRE_MM], dtype=np.float64)
    unmoved = np.all(relative_to(exact, centre) == local, axis=1)
    return bool(np.count_nonzero(unmoved) > len(unmoved) / 2)


def shown_mesh(context: Any) -> Any:
    """The mesh that is meant where none is named: the active one, or else one of ours.

    Also one that is hidden: its slices are looked at just then.
    """
    objects = context.view_layer.objects
    if objects.active is not None and objects.active.type == "MESH":
        return objects.active
    ours = [o for o in objects if o.type == "MESH" and CENTRE_MM in o]
    seen = (o for o in ours if o.visible_get())
    return next(seen, ours[0] if ours else None)


def lettered_mesh(context: Any) -> Any:
    """The mesh whose directions are known: the active one if it is ours, else another of ours, or the preview.

    Of a mesh from elsewhere, such as the cube that a new scene begins with, nobody said how it lies.
    """
    placed = shown_mesh(context)
    objects = context.view_layer.objects
    if placed is not None and CENTRE_MM in placed:
        # Around a region they would stand in the middle of its bone.
        bone = objects.get(placed.get(SOURCE, ""))
        return bone if bone is not None and bone.visible_get() else placed
    ours = (o for o in objects if CENTRE_MM in o or scene_preview.TAG in o)
    return next((o for o in ours if o.type == "MESH" and o.visible_get()), None)


def box(placed: Any) -> tuple[NDArray[np.float64], Matrix]:
    """Lowest and highest corner (2, 3) of an object's box in the patient, and the matrix to the world."""
    matrix = world_from_patient(placed)
    patient_from_local = matrix.inverted_safe() @ placed.matrix_world
    corners = [patient_from_local @ Vector(corner) for corner in placed.bound_box]
    places = np.array(corners, dtype=np.float64)
    return np.stack([places.min(axis=0), places.max(axis=0)]), matrix
