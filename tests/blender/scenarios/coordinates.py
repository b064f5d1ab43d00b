"""What a region is cut out of, after the user moved, edited or remade the mesh."""

import math
from importlib import import_module
from pathlib import Path
from typing import Any

import bpy
import numpy as np
import stage


def reading(target: Path, placed: Any) -> dict[str, Any]:
    """What the add-on reads of the object, and where that puts it in the world."""
    bpy.context.view_layer.update()
    source = import_module(f"{stage.MODULE}.scene.selection").read(placed)
    np.savez(
        target,
        vertices=source.vertices,
        triangles=source.triangles,
        matrix=np.array(source.world_from_patient),
        location=np.array(placed.location),
    )
    return {"file": str(target), "selected": len(source.selected)}


def apply_transforms(placed: Any) -> None:
    """Object > Apply > All Transforms."""
    with bpy.context.temp_override(
        selected_editable_objects=[placed], active_object=placed, object=placed
    ):
        bpy.ops.object.transform_apply()


def remade(placed: Any, stl: Path) -> Any:
    """The mesh as its STL comes back, without anything of ours."""
    bpy.ops.wm.stl_import(filepath=str(stl))
    return bpy.context.view_layer.objects.active


def main(zip: str, out: str, ct: str, crop: str) -> dict[str, Any]:
    """Reads after each change."""
    folder = Path(out)
    stage.install(zip)
    stage.fill_panel(ct, out, crop=crop, method="alpha")
    bpy.ops.bonemesh.render_surface_mesh()
    bone = bpy.context.view_layer.objects.active
    stage.select_front(bone)
    answer = {"as made": reading(folder / "made.npz", bone)}

    bpy.ops.object.mode_set(mode="EDIT")
    answer["in edit mode"] = reading(folder / "edit.npz", bone)
    bpy.ops.object.mode_set(mode="OBJECT")

    bone.location.x += 100.0
    bone.rotation_euler = (0.0, 0.0, math.pi / 3)
    answer["moved and turned"] = reading(folder / "moved.npz", bone)

    bone.data.vertices[0].co.z += 0.25
    answer["one vertex edited"] = reading(folder / "vertex.npz", bone)

    apply_transforms(bone)
    answer["transforms applied"] = reading(folder / "applied.npz", bone)

    answer["foreign"] = reading(
        folder / "foreign.npz", remade(bone, folder / "bone.stl")
    )

    bpy.ops.mesh.primitive_cube_add(
        size=2.0, location=(5.0, 0.0, 0.0), scale=(2.0, 1.0, 1.0)
    )
    cube = bpy.context.view_layer.objects.active
    answer["cube"] = reading(folder / "cube.npz", cube)
    return answer
