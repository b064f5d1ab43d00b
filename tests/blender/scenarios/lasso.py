"""Select with Lasso: what is hidden in Edit Mode, what a selection is worth, and that all of it is back afterwards."""

from typing import Any

import bmesh
import bpy
import numpy as np
import stage


def hidden(placed: Any) -> dict[str, Any]:
    """What is hidden, in Edit Mode or after it."""
    data = placed.data
    if placed.mode == "EDIT":
        mesh = bmesh.from_edit_mesh(data)
        kinds = {"vertices": mesh.verts, "edges": mesh.edges, "faces": mesh.faces}
    else:
        kinds = {
            "vertices": data.vertices,
            "edges": data.edges,
            "faces": data.polygons,
        }
    answer = {kind: sum(e.hide for e in of_kind) for kind, of_kind in kinds.items()}
    return answer | {
        "of edges": len(kinds["edges"]),
        "mode": placed.mode,
        "modes": list(bpy.context.tool_settings.mesh_select_mode),
    }


def select_faces(placed: Any, patch: Any) -> int:
    """Selects the faces between vertices of the patch, as the lasso does; how many vertices that are."""
    mesh = bmesh.from_edit_mesh(placed.data)
    for face in mesh.faces:
        face.select_set(all(patch[v.index] for v in face.verts))
    mesh.select_flush_mode()
    bmesh.update_edit_mesh(placed.data)
    return placed.data.total_vert_sel


def main(zip: str, out: str, ct: str) -> dict[str, Any]:
    """In from Object Mode, and from an Edit Mode that was there before."""
    stage.install(zip)
    stage.fill_panel(ct, out, cut_thickness=4.0)
    bpy.ops.bonemesh.render_surface_mesh()
    bone = bpy.context.view_layer.objects.active
    patch = stage.front(bone)
    answer: dict[str, Any] = {"result": sorted(bpy.ops.bonemesh.start_lasso())}
    answer["drawing"] = hidden(bone)
    answer["selected"] = select_faces(bone, patch)
    answer["again"] = sorted(bpy.ops.bonemesh.start_lasso())
    answer["still selected"] = bone.data.total_vert_sel
    answer["cut"] = sorted(bpy.ops.bonemesh.select_roi())
    answer["region"] = len(bpy.data.objects["region"].data.polygons)
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.context.view_layer.update()
    answer["after"] = hidden(bone)
    selected = np.zeros(len(bone.data.vertices), dtype=bool)
    bone.data.vertices.foreach_get("select", selected)
    answer["selected after"] = int(selected.sum())
    bpy.ops.object.mode_set(mode="EDIT")
    answer["by tab"] = hidden(bone)
    bpy.ops.bonemesh.start_lasso()
    answer["from edit mode"] = hidden(bone)
    bpy.ops.bonemesh.check_mesh()
    answer["checked"] = bone["bonemesh_check"][:40]
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.context.view_layer.update()
    answer["names"] = sorted(bone.data.keys()) + sorted(
        a.name for a in bone.data.attributes if "hide" in a.name
    )
    return answer
