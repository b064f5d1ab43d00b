# SPDX-License-Identifier: GPL-3.0-or-later
"""The active object's mesh in patient coordinates, and which of its vertices are selected.

An object's origin is at its geometry's centre, so Blender holds each vertex less that centre,
rounded to 32 bits; adding the centre again misses the patient coordinate by a last bit. That is
enough to change how ties between points are broken, so meshes.py keeps the exact coordinates as the
mesh attribute PATIENT_MM, and they count wherever the vertex is still where it was put.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from mathutils import Matrix, Vector
from numpy.typing import NDArray

from ..request.inputs import RefusalError

PATIENT_MM = "patient_mm"
CENTRE_MM = "bonemesh_centre_mm"
LEAST_SCALE = 1e-12  # of a volume: a thousandth of a thousandth along each axis does


@dataclass(frozen=True)
class Source:
    """What a region is cut out of; holds copies, so the object may change or go meanwhile."""

    name: str
    vertices: NDArray[np.float32]
    """(N, 3), patient millimetres (for a foreign mesh: the world's)."""
    triangles: NDArray[np.uint32]
    selected: NDArray[np.int64]
    """Indices of the selected vertices, ascending."""
    world_from_patient: Matrix
    collection: str
    properties: dict[str, Any]
    """The object's own `bonemesh_...` properties."""

    def patient_direction(self, world: Any) -> tuple[float, float, float] | None:
        """A direction of the world in the patient's frame."""
        if world is None:
            return None
        patient_from_world = np.linalg.inv(
            np.asarray(self.world_from_patient, dtype=np.float64)
        )
        x, y, z = patient_from_world[:3, :3] @ np.asarray(world, dtype=np.float64)
        return (float(x), float(y), float(z))


def read(active: Any, depsgraph: Any = None) -> Source:
    """Copies from a mesh object, in Edit Mode or not; with `depsgraph` from what its modifiers make of it."""
    if active.mode == "EDIT":
        active.update_from_editmode()
    if abs(active.matrix_world.determinant()) < LEAST_SCALE:
        raise RefusalError(
            f'"{active.name}" is scaled to nothing; set its Scale to 1 (in the tab Item)'
        )
    shown = active if depsgraph is None else active.evaluated_get(depsgraph)
    # A mesh in Edit Mode hides its attributes; this momentary copy, which shares their memory, does not.
    mesh = shown.to_mesh(preserve_all_data_layers=True, depsgraph=depsgraph)
    try:
        vertices, world_from_patient = patient_coordinates(active, mesh)
        return Source(
            name=active.name,
            vertices=vertices,
            triangles=triangles(mesh),
            selected=selected_vertices(mesh),
            world_from_patient=world_from_patient,
            collection=active.users_collection[0].name
            if active.users_collection
            else "",
            properties=own_properties(active),
        )
    finally:
        shown.to_mesh_clear()


def read_with_selection(active: Any) -> Source:
    """What a file of the object would hold, but for modifiers, where something must be selected."""
    source = as_exported(active, None)
    if len(source.selected) == 0:
        raise RefusalError(
            f'no vertex of "{source.name}" is selected; select some in Edit Mode, for example with the lasso'
        )
    return source


def as_exported(active: Any, depsgraph: Any, *, as_placed: bool = False) -> Source:
    """What a file of the object would hold: with its size and, with `depsgraph`, its modifiers.

    A mesh that was at most moved and turned keeps its exact coordinates in the patient, which do not
    change what it is as a body; unless it is asked for `as_placed` in the world.
    """
    source = read(active, depsgraph)
    matrix = np.asarray(source.world_from_patient, dtype=np.float64)
    linear = matrix[:3, :3]
    vertices, faces = source.vertices, source.triangles
    is_mirrored = active.matrix_world.is_negative
    is_rigid = np.allclose(linear @ linear.T, np.eye(3), atol=1e-5)
    if as_placed or is_mirrored or not is_rigid:
        world = vertices.astype(np.float64) @ linear.T + matrix[:3, 3]
        vertices = world.astype(np.float32)
        source = replace(source, world_from_patient=Matrix.Identity(4))
    if is_mirrored:  # Blender turns the faces of such an object round as it shows it
        faces = np.ascontiguousarray(faces[:, ::-1])
    return replace(source, vertices=vertices, triangles=faces)


def patient_coordinates(placed: Any, mesh: Any) -> tuple[NDArray[np.float32], Matrix]:
    """(N, 3) coordinates, and the matrix that takes them to where the object is in the world."""
    position = mesh.attributes.get("position")
    if position is None:  # a mesh that never had a vertex
        return np.empty((0, 3), dtype=np.float32), Matrix.Identity(4)
    local = vectors(position)
    attribute = mesh.attributes.get(PATIENT_MM)
    if attribute is not None and CENTRE_MM in placed and is_point_vector(attribute):
        centre = np.asarray(placed[CENTRE_MM], dtype=np.float64)
        exact = vectors(attribute)
        unmoved = np.all(relative_to(exact, centre) == local, axis=1)
        # Applying a rotation or scale rewrites every vertex: then the attribute says nothing.
        if np.count_nonzero(unmoved) > len(unmoved) / 2:
            moved = (local.astype(np.float64) + centre).astype(np.float32)
            vertices = np.where(unmoved[:, np.newaxis], exact, moved)
            return vertices, placed.matrix_world @ Matrix.Translation(-Vector(centre))
    matrix = np.asarray(placed.matrix_world, dtype=np.float64)
    world = local.astype(np.float64) @ matrix[:3, :3].T + matrix[:3, 3]
    return world.astype(np.float32), Matrix.Identity(4)


def own_properties(placed: Any) -> dict[str, Any]:
    """The object's `bonemesh_...` properties as plain values, which outlive the object."""
    return {
        key: value.to_list() if hasattr(value, "to_list") else value
        for key, value in placed.items()
        if key.startswith("bonemesh_")
    }


def selected_vertices(mesh: Any) -> NDArray[np.int64]:
    """Indices of the selected vertices, ascending."""
    selected = np.zeros(len(mesh.vertices), dtype=bool)
    mesh.vertices.foreach_get("select", selected)
    return np.flatnonzero(selected)


def relative_to(
    vertices: NDArray[np.float32], centre: NDArray[np.float64]
) -> NDArray[np.float32]:
    """`vertices` less `centre`; the one rounding that both writing and reading rely on."""
    return (vertices.astype(np.float64) - centre).astype(np.float32)


def is_point_vector(attribute: Any) -> bool:
    """Whether `attribute` has one 3D vector a vertex."""
    return attribute.domain == "POINT" and attribute.data_type == "FLOAT_VECTOR"


def vectors(attribute: Any) -> NDArray[np.float32]:
    """A vector attribute as (N, 3)."""
    values = np.empty(3 * len(attribute.data), dtype=np.float32)
    attribute.data.foreach_get("vector", values)
    return values.reshape(-1, 3)


def triangles(mesh: Any) -> NDArray[np.uint32]:
    """(M, 3) vertex indices; larger faces are cut into triangles."""
    mesh.calc_loop_triangles()
    corners = np.empty(3 * len(mesh.loop_triangles), dtype=np.int32)
    mesh.loop_triangles.foreach_get("vertices", corners)
    return corners.view(np.uint32).reshape(-1, 3)
