"""Renders, changes every field, and brings them back from the object and from the file beside the STL."""

import json
from pathlib import Path
from typing import Any

import bpy
import stage

CHANGED = {
    "hu_threshold": 420,
    "damp_metal": True,
    "leave_out_table": False,
    "crop": "0:30,0:30,2:20",
    "fill_cavities": "small",
    "cavities_mm3": 250000.0,
    "smooth_mm": 0.125,
    "reduce_triangles": "number",
    "triangles": 2000,
}
OTHERS = {
    "hu_threshold": 100,
    "method": "alpha",
    "damp_metal": False,
    "leave_out_table": True,
    "crop": "",
    "fill_cavities": "none",
    "cavities_mm3": 1.0,
    "smooth_mm": 1.0,
    "reduce_triangles": "error",
    "triangles": 10,
    "mesh_name": "another",
    "series": "7",
}


def fields() -> dict[str, Any]:
    """The panel's fields."""
    properties = bpy.context.scene.bonemesh
    values = {name: getattr(properties, name) for name in OTHERS}
    return {k: round(v, 5) if isinstance(v, float) else v for k, v in values.items()}


def spoil() -> None:
    """Sets every field to something else."""
    for name, value in OTHERS.items():
        setattr(bpy.context.scene.bonemesh, name, value)


def counts(placed: Any) -> list[int]:
    """Vertices and triangles of a mesh."""
    return [len(placed.data.vertices), len(placed.data.polygons)]


def refused(bone: Any, out: str) -> dict[str, str]:
    """What is said where nothing can be restored."""
    read = bpy.ops.bonemesh.read_sidecar
    folder = Path(out)
    bpy.ops.mesh.primitive_cube_add()
    answer = {"a cube": stage.message_of(bpy.ops.bonemesh.render_again)}
    bpy.context.view_layer.objects.active = bone
    kept = bone["bonemesh_options"]
    bone["bonemesh_options"] = json.dumps({**json.loads(kept), "method": "newer"})
    answer["another version"] = stage.message_of(bpy.ops.bonemesh.render_again)
    bone["bonemesh_options"] = kept
    answer["no file"] = stage.message_of(read)
    answer["missing"] = stage.message_of(read, filepath=str(folder / "gone.json"))
    beside = str(folder / "region.stl.json")
    answer["a region's"] = stage.message_of(read, filepath=beside)
    return answer


def main(zip: str, out: str, ct: str) -> dict[str, Any]:
    """Everything in one Blender."""
    stage.install(zip)
    properties = stage.fill_panel(ct, out, **CHANGED)
    bpy.ops.bonemesh.render_surface_mesh()
    bone = bpy.context.view_layer.objects.active
    properties.series = bone["bonemesh_series_uid"]
    answer = {"rendered with": fields(), "first": counts(bone)}
    spoil()
    bpy.ops.bonemesh.render_again()
    answer["from the object"] = fields()
    bpy.ops.bonemesh.render_surface_mesh()
    again = bpy.context.view_layer.objects.active
    answer["second"] = counts(again)
    answer["properties"] = stage.custom_properties(again)
    bpy.context.view_layer.objects.active = bone
    spoil()
    bpy.ops.bonemesh.read_sidecar(filepath=str(Path(out) / "bone.stl.json"))
    answer["from the file"] = fields()
    stage.select_front(bone)
    properties.cut_thickness = 4.0
    bpy.ops.bonemesh.select_roi()
    answer["thickness_mm"] = 4.0
    answer["objects"] = [o.name for o in bpy.data.objects]
    answer["refused"] = refused(bone, out)
    spoil()
    before = fields()
    stage.message_of(
        bpy.ops.bonemesh.read_sidecar, filepath=str(Path(out) / "gone.json")
    )
    answer["kept"] = fields() == before
    return answer
