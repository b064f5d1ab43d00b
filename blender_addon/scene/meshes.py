# SPDX-License-Identifier: GPL-3.0-or-later
"""The only writer of Blender's data, with materials.py and the modules named scene_: meshes into objects, units, clipping, selection."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import bpy
import numpy as np
from mathutils import Matrix, Vector
from numpy.typing import NDArray

from ..reports.findings import of_rendering
from ..request.inputs import RefusalError
from . import materials
from .materials import BONE_COLOUR, REGION_COLOUR
from .mesh_edges import Edges
from .selection import CENTRE_MM, PATIENT_MM, Source, relative_to

if TYPE_CHECKING:
    import bonemesh

MM_IN_METRES = 0.001
# A body is two metres long and is looked at from a few times that; the ratio of far to near stays
# within what a 24-bit depth buffer tells apart.
CLIP_START_MM = 1.0
CLIP_END_MM = 20_000.0

# Keys of the reports kept with an object, and in that of a check, of what the object was then.
AFTER_CARE = "after_care"
CHECK = "check"
# How a bone was rendered: the keyword arguments of the library's `render`.
OPTIONS = "options"
STATE = "state"

REGIONS = "Regions of Interest"
SOURCE = "bonemesh_source"
# How a region is cut, by the library's names.
REGION_OPTIONS = (
    "direction",
    "clearance_mm",
    "hidden",
    "separate",
    "mirror",
    "mirror_back",
)


def use_millimetres(context: Any) -> None:
    """One Blender unit is one millimetre, and every 3D view sees a whole body."""
    units = context.scene.unit_settings
    units.system = "METRIC"
    units.scale_length = MM_IN_METRES
    units.length_unit = "MILLIMETERS"
    for screen in bpy.data.screens:
        for area in screen.areas:
            for space in area.spaces:
                if space.type == "VIEW_3D":
                    space.clip_start = max(space.clip_start, CLIP_START_MM)
                    space.clip_end = max(space.clip_end, CLIP_END_MM)


def add_bone(
    context: Any, name: str, bone: bonemesh.Mesh, *, in_world_centre: bool
) -> Any:
    """Adds a rendered mesh, at its place in the patient or at the world's centre."""
    retire(context, name)
    placed = add_object(context, name, bone, "Bonemesh Bone", BONE_COLOUR)
    if in_world_centre:
        placed.location = (0.0, 0.0, 0.0)
    link(context, placed, context.collection)
    report = bone.report
    keep(placed, "version", report["version"])
    keep(placed, "method", report["method"])
    keep(placed, "threshold_hu", report["threshold_hu"])
    keep(placed, "series_uid", report["series_uid"])
    keep(placed, "spacing_mm", report["spacing_mm"])
    keep_report(placed, OPTIONS, report["options"])
    keep_report(placed, AFTER_CARE, of_rendering(report))
    context.view_layer.update()
    return placed


def retire(context: Any, name: str) -> None:
    """Hides a bone of that name, which is made anew, under another name; its regions go on knowing it."""
    old = context.view_layer.objects.get(name)
    is_bone = old is not None and f"bonemesh_{OPTIONS}" in old and SOURCE not in old
    if not is_bone or old.mode == "EDIT" or old.library is not None:
        return
    old.name = f"{name} before"
    for region in bpy.data.objects:
        if region.get(SOURCE) == name:
            region[SOURCE] = old.name
    old.hide_set(True)


def add_region(
    context: Any,
    name: str,
    region: bonemesh.Mesh,
    source: Source,
    options: dict[str, Any],
) -> Any:
    """Adds a region where it lies in its source, however that was moved, to the regions' own collection.

    All that it was made of is kept with it: a script can make it again.
    """
    placed = add_object(context, name, region, "Bonemesh Region", REGION_COLOUR)
    placed.matrix_world = source.world_from_patient @ placed.matrix_world
    # Its front is the bone's own surface: without this, which of the two is drawn is up to chance.
    placed.show_in_front = True
    link(context, placed, regions(context))
    for key in ("bonemesh_threshold_hu", "bonemesh_series_uid", "bonemesh_spacing_mm"):
        if key in source.properties:
            placed[key] = source.properties[key]
    keep(placed, "version", region.report["version"])
    keep(placed, "method", region.report["method"])
    keep(placed, "thickness_mm", region.report["thickness_mm"])
    placed[SOURCE] = source.name
    keep(placed, "selected", [int(vertex) for vertex in source.selected])
    for key in REGION_OPTIONS:
        keep(placed, key, options.get(key))
    return placed


def remove_region(name: str) -> None:
    """Takes a region away that is still in the scene."""
    region = bpy.data.objects.get(name)
    if region is not None and SOURCE in region:
        mesh = region.data
        bpy.data.objects.remove(region)
        if mesh.users == 0:
            bpy.data.meshes.remove(mesh)


def kept_facts(bone: Any) -> dict[str, Any]:
    """How a bone was rendered, by the names that the library's report has."""
    keys = ("version", "method", "threshold_hu", "series_uid")
    facts = {key: bone.get(f"bonemesh_{key}") for key in keys}
    return {**facts, OPTIONS: kept_report(bone, OPTIONS)}


def source_of(region: Any) -> Any:
    """The object that a region was cut from, if its vertices can still be those that were selected."""
    needed = ("selected", "thickness_mm", "method")
    if not all(f"bonemesh_{key}" in region for key in needed):
        raise RefusalError(
            f'"{region.name}" no longer says how it was cut; select on the bone anew'
        )
    name = region[SOURCE]
    source = bpy.data.objects.get(name)
    if source is None or source.type != "MESH":
        raise RefusalError(
            f'"{name}", which this region was cut from, is gone; undo its removal or its new name'
        )
    if max(region.get("bonemesh_selected", ()), default=0) >= len(source.data.vertices):
        raise RefusalError(
            f'"{name}", which this region was cut from, has fewer vertices now; select on it anew'
        )
    return source


def kept_settings(region: Any) -> dict[str, Any]:
    """What a region was cut with, by the names that the library has for it."""
    keys = ("selected", "thickness_mm", "method", *REGION_OPTIONS)
    kept = {key: region.get(f"bonemesh_{key}") for key in keys}
    plain = {
        key: value.to_list() if hasattr(value, "to_list") else value
        for key, value in kept.items()
    }
    return {key: value for key, value in plain.items() if value is not None}


def select_vertices(context: Any, placed: Any, vertices: list[int]) -> None:
    """These vertices of an object that is not in Edit Mode, and what lies between them alone."""
    data = placed.data
    is_selected = np.zeros(len(data.vertices), dtype=bool)
    is_selected[vertices] = True
    ends = np.empty(2 * len(data.edges), dtype=np.int32)
    data.edges.foreach_get("vertices", ends)
    corners = np.empty(len(data.loops), dtype=np.int32)
    data.loops.foreach_get("vertex_index", corners)
    starts = np.empty(len(data.polygons), dtype=np.int32)
    data.polygons.foreach_get("loop_start", starts)
    faces = np.logical_and.reduceat(is_selected[corners], starts) if len(starts) else []
    data.vertices.foreach_set("select", is_selected)
    data.edges.foreach_set("select", is_selected[ends].reshape(-1, 2).all(axis=1))
    data.polygons.foreach_set("select", faces)
    context.tool_settings.mesh_select_mode = (True, False, False)


def select_elements(
    context: Any, placed: Any, domain: str, numbers: NDArray[np.uint32]
) -> None:
    """These vertices, edges (as pairs of vertices) or triangles of an object that is not in Edit Mode, alone.

    `domain` is "VERT", "EDGE" or "FACE"; of triangles of a larger face, the face.
    """
    data = placed.data
    is_vertex = np.zeros(len(data.vertices), dtype=bool)
    is_edge = np.zeros(len(data.edges), dtype=bool)
    is_face = np.zeros(len(data.polygons), dtype=bool)
    if domain == "VERT":
        is_vertex[numbers] = True
    elif domain == "EDGE":
        ends = np.empty(2 * len(data.edges), dtype=np.int32)
        data.edges.foreach_get("vertices", ends)
        low_high = np.sort(ends.reshape(-1, 2), axis=1).astype(np.uint64)
        key = np.array([len(data.vertices), 1], dtype=np.uint64)
        is_edge = np.isin(low_high @ key, numbers.astype(np.uint64) @ key)
        is_vertex[numbers.ravel()] = True
    else:
        data.calc_loop_triangles()
        faces = np.empty(len(data.loop_triangles), dtype=np.int32)
        data.loop_triangles.foreach_get("polygon_index", faces)
        corners = np.empty(3 * len(faces), dtype=np.int32)
        data.loop_triangles.foreach_get("vertices", corners)
        is_face[faces[numbers]] = True
        is_vertex[corners.reshape(-1, 3)[numbers]] = True
    data.vertices.foreach_set("select", is_vertex)
    data.edges.foreach_set("select", is_edge)
    data.polygons.foreach_set("select", is_face)
    context.tool_settings.mesh_select_mode = tuple(
        domain == each for each in ("VERT", "EDGE", "FACE")
    )


def regions(context: Any) -> Any:
    """The collection of the regions, made with the first of them."""
    collection = bpy.data.collections.get(REGIONS)
    if collection is None:
        collection = bpy.data.collections.new(REGIONS)
    if collection.name not in context.scene.collection.children:
        context.scene.collection.children.link(collection)
    return collection


def keep_check(name: str, report: dict[str, Any]) -> None:
    """Notes what a check found with the object of that name, if it is still there."""
    checked = bpy.data.objects.get(name)
    if checked is not None:
        keep_report(checked, CHECK, {**report, STATE: state(checked)})


def state(placed: Any) -> str:
    """What changes when the object does, as far as that is seen without going through its vertices."""
    data = placed.data
    modifiers = [m.type for m in placed.modifiers if m.show_viewport]
    matrix = placed.matrix_world
    scale = [f"{s:.4g}" for s in matrix.to_scale()]
    sizes = f"{len(data.vertices)} {len(data.polygons)}"
    return f"{sizes} {modifiers} {scale} {matrix.is_negative}"


def select_only(context: Any, placed: Any) -> bool:
    """Selects `placed` and makes it active, unless something is being edited, which goes on."""
    if context.mode != "OBJECT":
        return False
    for other in context.selected_objects:
        other.select_set(False)
    placed.select_set(True)
    context.view_layer.objects.active = placed
    return True


def add_object(
    context: Any,
    name: str,
    mesh: bonemesh.Mesh,
    material: str,
    colour: tuple[float, ...],
) -> Any:
    """An object with its origin at the mesh's centre, at its place in the patient; not linked yet."""
    vertices = mesh.vertices
    # Kept with the 32 bits of an object's location, so that location + local is the patient's place.
    centre = (
        vertices.mean(axis=0, dtype=np.float64).astype(np.float32).astype(np.float64)
    )
    data = bpy.data.meshes.new(name)
    fill(data, relative_to(vertices, centre), mesh.triangles)
    exact = data.attributes.new(PATIENT_MM, "FLOAT_VECTOR", "POINT")
    exact.data.foreach_set("vector", vertices.ravel())
    data.materials.append(materials.material(material, colour))
    materials.shade(data)
    placed = bpy.data.objects.new(name, data)
    placed.matrix_world = Matrix.Translation(Vector(centre))
    placed[CENTRE_MM] = centre.tolist()
    return placed


def fill(
    data: Any,
    vertices: NDArray[np.float32],
    triangles: NDArray[np.uint32],
    edges: Edges | None = None,
) -> None:
    """Vertices and triangles into an empty mesh, nothing selected; quicker with their edges.

    Through the attributes, which are copied as a whole; the older `vertices.foreach_set("co")` goes
    through them one at a time and takes twice as long.
    """
    corners = np.ascontiguousarray(triangles).view(np.int32).ravel()
    data.vertices.add(len(vertices))
    data.loops.add(len(corners))
    data.polygons.add(len(triangles))
    data.attributes["position"].data.foreach_set("vector", vertices.ravel())
    data.attributes[".corner_vert"].data.foreach_set("value", corners)
    data.polygons.foreach_set(
        "loop_start", np.arange(0, len(corners), 3, dtype=np.int32)
    )
    if edges is not None:
        data.edges.add(len(edges.ends))
        data.attributes[".edge_verts"].data.foreach_set("value", edges.ends.ravel())
        data.attributes[".corner_edge"].data.foreach_set("value", edges.of_corners)
    data.update(calc_edges=edges is None)
    # Blender makes new elements selected: the next region would begin with everything.
    for selection in (".select_vert", ".select_edge", ".select_poly"):
        attribute = data.attributes.get(selection)
        if attribute is not None:
            data.attributes.remove(attribute)


def link(context: Any, placed: Any, collection: Any) -> None:
    """Into `collection`, or into the scene's own where that one is not shown."""
    collection.objects.link(placed)
    context.view_layer.update()  # before that, nothing in a new collection counts as shown
    if context.view_layer.objects.get(placed.name) is None:
        collection.objects.unlink(placed)
        context.scene.collection.objects.link(placed)


def keep_report(placed: Any, key: str, report: dict[str, Any] | None) -> None:
    """A report as the text that the library's command prints, since a property holds no list of texts."""
    keep(placed, key, None if report is None else json.dumps(report))


def kept_report(placed: Any, key: str) -> dict[str, Any] | None:
    """The report kept under `key`; None where there is none or the user wrote something else there."""
    try:
        report = json.loads(placed.get(f"bonemesh_{key}", "null"))
    except (TypeError, ValueError):
        return None
    return report if isinstance(report, dict) else None


def keep(placed: Any, key: str, value: Any) -> None:
    """A custom property of the object; what is not known is left out."""
    if value is not None:
        placed[f"bonemesh_{key}"] = value
