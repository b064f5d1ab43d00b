"""Exports in every format and frame, in place and as placed; selects what a check finds."""

from pathlib import Path
from typing import Any

import bmesh
import bpy
import numpy as np
import stage
from check_mesh import box, cube, without_a_face

FORMATS = ("stl", "3mf", "ply", "obj")


def export(name: str, **fields: Any) -> str:
    """Exports the active mesh with these fields; the error, or nothing."""
    properties = bpy.context.scene.bonemesh_output
    properties.file_name = name
    for field, value in fields.items():
        setattr(properties, field, value)
    return stage.message_of(bpy.ops.bonemesh.export_mesh)


def exported(bone: Any, out: str) -> dict[str, Any]:
    """The bone in every way."""
    answer = {}
    bone.location = (1000.0, 0.0, 0.0)
    bone.rotation_euler = (0.0, 0.0, np.pi / 2)
    for kind in FORMATS:
        for frame in ("LPS", "RAS"):
            name = f"{kind}-{frame}"
            answer[name] = export(name, format=kind, frame=frame, as_placed=False)
    answer["placed"] = export("placed", format="ply", frame="LPS", as_placed=True)
    bpy.context.view_layer.update()
    answer["matrix"] = np.array(bone.matrix_world).tolist()
    bone.modifiers.new("half", "DECIMATE").ratio = 0.5
    answer["own name"] = export("", format="stl", as_placed=False)
    bone.modifiers.clear()
    answer["bad name"] = export("a/b")
    bpy.context.scene.bonemesh.mesh_directory = ""
    answer["no folder"] = export("bone")
    bpy.context.scene.bonemesh.mesh_directory = out
    return answer


def selected(kind: str) -> dict[str, Any]:
    """Selects one kind of places; what is selected then, seen in Object Mode."""
    placed = bpy.context.view_layer.objects.active
    result = sorted(bpy.ops.bonemesh.select_faults(kind=kind))
    mode = placed.mode
    modes = list(bpy.context.tool_settings.mesh_select_mode)
    if mode == "EDIT":
        bpy.ops.object.mode_set(mode="OBJECT")
    data = placed.data
    return {
        "result": result,
        "mode": mode,
        "modes": modes,
        "vertices": [v.index for v in data.vertices if v.select],
        "edges": sorted(sorted(e.vertices) for e in data.edges if e.select),
        "faces": [p.index for p in data.polygons if p.select],
    }


def joined(placed: Any, vertices: list[tuple], faces: list[tuple]) -> Any:
    """Adds vertices and faces (whose numbers may be those of old vertices) to a mesh."""
    mesh = bmesh.new()
    mesh.from_mesh(placed.data)
    for place in vertices:
        mesh.verts.new(place)
    mesh.verts.ensure_lookup_table()
    for face in faces:
        mesh.faces.new([mesh.verts[number] for number in face])
    mesh.to_mesh(placed.data)
    mesh.free()
    return placed


def faults() -> dict[str, Any]:
    """Meshes that a user made, with one kind of fault each."""
    cube("whole")
    answer = {"whole": selected("open_edges")}
    bpy.ops.bonemesh.check_mesh()
    answer["whole box"] = box()
    thin = bpy.context.scene.bonemesh_output
    thin.thin_mm = 2.5
    answer["thin"] = selected("thin_vertices")
    thin.thin_mm = 1.5
    answer["thick"] = selected("thin_vertices")
    opened = without_a_face(cube("open"))
    bpy.ops.bonemesh.check_mesh()
    answer["open box"] = box()
    answer["open"] = selected("open_edges")
    bpy.ops.object.mode_set(mode="EDIT")
    answer["open, from edit mode"] = selected("open_edges")
    opened.modifiers.new("wall", "SOLIDIFY").thickness = 0.5
    answer["open, with a modifier"] = selected("open_edges")
    # A fin along the cube's edge from its vertex 0 to 1.
    joined(cube("fin"), [(5, 5, 5)], [(0, 1, 8)])
    answer["fin"] = selected("non_manifold_edges")
    # A cube through the first one.
    bpy.ops.mesh.primitive_cube_add(size=1.0, location=(1.0, 0.1, 0.2))
    other = bpy.context.view_layer.objects.active
    through = cube("through")
    other.select_set(True)
    bpy.ops.object.join()
    answer["through"] = selected("intersecting_triangles")
    answer["through sides"] = len(through.data.polygons)
    return answer


def main(zip: str, out: str, ct: str) -> dict[str, Any]:
    """Everything in one Blender."""
    stage.install(zip)
    stage.fill_panel(ct, out)
    bpy.ops.bonemesh.render_surface_mesh()
    bone = bpy.context.view_layer.objects.active
    answer = {"exported": exported(bone, out)}
    answer["files"] = sorted(p.name for p in Path(out).iterdir())
    return answer | {"faults": faults()}
