"""What the operators besides Render Surface Mesh and Select Region of Interest refuse."""

import json
import os
from importlib import import_module
from pathlib import Path
from typing import Any

import bpy
import stage
from background import press

OPS = bpy.ops.bonemesh
FAR_MM = 1.0e6


def empty_scene() -> None:
    """Nothing is in the scene, and nothing is chosen."""
    for placed in tuple(bpy.data.objects):
        bpy.data.objects.remove(placed)


def cube(name: str) -> Any:
    """A new mesh, the only one that is selected."""
    bpy.ops.mesh.primitive_cube_add()
    placed = bpy.context.view_layer.objects.active
    placed.name = name
    return placed


def without_anything() -> dict[str, str]:
    """What is said where there is no object at all."""
    empty_scene()
    named = {
        "nothing to compare": OPS.compare_meshes,
        "nothing to export": OPS.export_mesh,
        "nothing with faults": OPS.select_faults,
        "nothing to render again": OPS.render_again,
        "nothing to look at": OPS.view_patient,
        "no slices to remove": OPS.hide_slices,
        "no crop box to use": OPS.use_crop_box,
        "no crop box to remove": OPS.remove_crop_box,
    }
    return {case: stage.message_of(operator) for case, operator in named.items()}


def without_images() -> dict[str, str]:
    """What is said where no images are chosen."""
    properties = bpy.context.scene.bonemesh
    before, properties.ct_directory = properties.ct_directory, ""
    named = {
        "no images for a crop box": OPS.show_crop_box,
        "no images for slices": OPS.show_slices,
        "no images to look at again": OPS.scan_ct_directory,
    }
    answers = {case: stage.message_of(operator) for case, operator in named.items()}
    properties.ct_directory = before
    return answers


def crop_box() -> dict[str, str]:
    """What the crop box refuses."""
    empty_scene()
    answers = {
        "images for a crop box not looked at": stage.message_of(OPS.show_crop_box)
    }
    OPS.scan_ct_directory()
    OPS.show_crop_box()
    placed = bpy.context.view_layer.objects.active
    placed.location.x = FAR_MM
    answers["crop box away from the images"] = stage.message_of(OPS.use_crop_box)
    placed.data.vertices[0].co.x = float("nan")
    answers["crop box without a place"] = stage.message_of(OPS.use_crop_box)
    bpy.data.objects.remove(placed)
    return answers


def comparison() -> dict[str, str]:
    """What comparing refuses."""
    empty_scene()
    meshes = [cube(name) for name in ("one", "two", "three")]
    answers = {"compared with nothing": stage.message_of(OPS.compare_meshes)}
    for placed in meshes:
        placed.select_set(True)
    answers["compared with two"] = stage.message_of(OPS.compare_meshes)
    bpy.ops.object.mode_set(mode="EDIT")
    answers["compared in Edit Mode"] = stage.message_of(OPS.compare_meshes)
    bpy.ops.object.mode_set(mode="OBJECT")
    meshes[0].select_set(False)
    answers["compared and changed"] = changed_meanwhile("compare_meshes")
    return answers


def faults() -> dict[str, str]:
    """What selecting faults refuses."""
    empty_scene()
    cube("one")
    return {"faults of a changed mesh": changed_meanwhile("select_faults")}


def changed_meanwhile(name: str) -> str:
    """The refusal where the active mesh loses its vertices while the button's work is done."""
    operator = stage.pressed(name)
    operator.kind = "open_edges"
    result = operator.prepare(bpy.context).run_here()
    bpy.context.view_layer.objects.active.data.clear_geometry()
    try:
        operator.finish(bpy.context, result)
    except Exception as error:  # noqa: BLE001 - its class is the add-on's
        assert type(error).__name__ == "RefusalError", error
        return str(error)
    return ""


def plane() -> dict[str, str]:
    """What a plane through vertices refuses besides their number."""
    empty_scene()
    placed = cube("line")
    placed.data.clear_geometry()
    placed.data.from_pydata([(0, 0, 0), (1, 1, 1), (2, 2, 2)], [], [(0, 1, 2)])
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    message = stage.message_of(OPS.plane_from_vertices)
    bpy.ops.object.mode_set(mode="OBJECT")
    return {"plane through a line": message}


def region_again(bone: Any) -> dict[str, str]:
    """What taking a region up again refuses, and a region along a view that is not there."""
    stage.select_front(bone)
    settings = bpy.context.scene.bonemesh_region
    settings.direction = "view"
    answers = {"no view to cut along": without_a_view(OPS.select_roi)}
    settings.direction = "normal"
    OPS.select_roi()
    region = next(o for o in bpy.data.objects if "bonemesh_source" in o)
    bpy.context.view_layer.objects.active = region
    kept = bone.data
    bone.data = bpy.data.meshes.new("less")
    answers["region of a mesh with fewer vertices"] = stage.message_of(OPS.resume_roi)
    bone.data = kept
    bone.name = "other"
    answers["region of a mesh that is gone"] = stage.message_of(OPS.resume_roi)
    del region["bonemesh_selected"]
    answers["region that does not say how"] = stage.message_of(OPS.resume_roi)
    return answers


def without_a_view(operator: Any) -> str:
    """The refusal where every 3D view shows something else."""
    screens = [window.screen for window in bpy.context.window_manager.windows]
    views = [a for screen in screens for a in screen.areas if a.type == "VIEW_3D"]
    for area in views:
        area.type = "INFO"
    message = stage.message_of(operator)
    for area in views:
        area.type = "VIEW_3D"
    return message


def settings_from_file(folder: Path) -> dict[str, str]:
    """What Settings from File refuses."""
    other = folder / "other.json"
    other.write_text("[]")
    newer = folder / "newer.stl.json"
    newer.write_text(json.dumps({"options": {"method": "newer"}}))
    elsewhere = folder / "elsewhere.stl.json"
    elsewhere.write_text(json.dumps({"options": {}, "series_uid": "1.2.3"}))
    paths = {
        "settings of other images": str(elsewhere),
        "settings of no file": "",
        "settings of a folder": str(folder),
        "settings of another file": str(other),
        "settings of another version": str(newer),
    }
    return {
        case: stage.message_of(OPS.read_sidecar, filepath=path)
        for case, path in paths.items()
    }


def names_and_folders() -> dict[str, str]:
    """Names that Windows keeps for itself, and folders that cannot be written to."""
    empty_scene()
    cube("one")
    output = bpy.context.scene.bonemesh_output
    output.file_name = "con"
    answers = {"exported as a device": stage.message_of(OPS.export_mesh)}
    output.file_name = 250 * "ä"
    answers["exported with a long name"] = stage.message_of(OPS.export_mesh)
    output.file_name = ""
    inputs = import_module(f"{stage.MODULE}.request.inputs")
    real, inputs.os.access = os.access, lambda *_: False  # who tests may be allowed all
    answers["exported where nothing can be written"] = stage.message_of(OPS.export_mesh)
    inputs.os.access = real
    bpy.context.view_layer.objects.active.scale.x = 0.0
    answers["a flat mesh"] = stage.message_of(OPS.export_mesh)
    return answers


def while_rendering() -> dict[str, str]:
    """What is said while a job runs."""
    empty_scene()
    cube("one")
    operator, context, gate = press("render_surface_mesh", "render")
    answers = {"checked while rendering": stage.message_of(OPS.check_mesh)}
    operator.cancel(context)
    gate.open()
    assert stage.addon_job().stop(60.0)
    return answers


def main(folder: Path, bone: Any) -> dict[str, str]:
    """All of them; `bone` is a rendered one, and what is in the scene goes."""
    return {
        **region_again(bone),
        **without_anything(),
        **without_images(),
        **crop_box(),
        **comparison(),
        **faults(),
        **plane(),
        **settings_from_file(folder),
        **names_and_folders(),
        **while_rendering(),
    }
