"""What becomes of a result that cannot be saved, of a bone that is made anew, of another scene, of other images."""

import shutil
from pathlib import Path
from typing import Any

import bpy
import stage
from background import press, until_end

OPS = bpy.ops.bonemesh


def not_saved(out: str) -> dict[str, Any]:
    """The folder goes while the surface is made; it is back for what comes next."""
    properties = bpy.context.scene.bonemesh
    folder = Path(out) / "meshes"
    properties.mesh_directory, before = str(folder), properties.mesh_directory
    folder.mkdir()
    operator, context, gate = press("render_surface_mesh", "render")
    shutil.rmtree(folder)
    gate.open()
    ended = until_end(operator, context)
    properties.mesh_directory = before
    bone = bpy.data.objects["bone"]
    answer = {
        "ended": ended,
        "said": operator.reports,
        "faces": len(bone.data.polygons),
    }
    bpy.data.objects.remove(bone)
    return answer


def made_anew() -> dict[str, Any]:
    """Twice under one name, with a region of the first."""
    OPS.render_surface_mesh()
    first = bpy.context.view_layer.objects.active
    stage.select_front(first)
    OPS.select_roi()
    bpy.context.scene.bonemesh.hu_threshold = 500
    OPS.render_surface_mesh()
    second = bpy.context.view_layer.objects.active
    return {
        "names": [first.name, second.name],
        "seen": [first.visible_get(), second.visible_get()],
        "source": bpy.data.objects["region"]["bonemesh_source"],
    }


def from_another_scene() -> list[str]:
    """The names of the scenes that a bone is in which was begun in the first of two."""
    first = bpy.context.scene
    bpy.context.scene.bonemesh.mesh_name = "elsewhere"
    operator, context, gate = press("render_surface_mesh", "render")
    bpy.context.window.scene = bpy.data.scenes.new("second")
    gate.open()
    until_end(operator, context)
    found = [s.name for s in bpy.data.scenes if "elsewhere" in s.objects]
    bpy.context.window.scene = first
    return found


def other_images(ct: str, two: str) -> dict[str, Any]:
    """What is left in the panel of the images before, and what a slice stands for."""
    properties = bpy.context.scene.bonemesh
    properties.ct_directory, properties.crop, properties.series = ct, "0:9,0:9,0:9", "1"
    properties.ct_directory = two
    slice_of_it = next(Path(ct).rglob("*.dcm"))
    answer = {"crop": properties.crop, "series": properties.series}
    properties.ct_directory = str(slice_of_it)
    return {
        **answer,
        "folder": properties.ct_directory,
        "expected": str(slice_of_it.parent),
    }


def main(zip: str, out: str, ct: str, two: str) -> dict[str, Any]:
    """One after the other in one Blender."""
    stage.install(zip)
    stage.clear_scene()
    stage.fill_panel(ct, out)
    return {
        "not saved": not_saved(out),
        "made anew": made_anew(),
        "another scene": from_another_scene(),
        "first scene": bpy.context.scene.name,
        "other images": other_images(ct, two),
    }
