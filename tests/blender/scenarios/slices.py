"""CT slices with contours: placed, moved, windowed, turned with the bone, saved, undone, taken away."""

import shutil
from importlib import import_module
from pathlib import Path
from typing import Any

import bpy
import numpy as np
import stage
from background import press, until_end
from panel import drawn

PLANES = ("axial", "coronal", "sagittal")


def addon(name: str) -> Any:
    """A module of the add-on."""
    return import_module(f"{stage.MODULE}.{name}")


def kind(name: str) -> Any:
    """The object of that kind."""
    return addon("slices.scene_slices").found(name)


def greys(name: str) -> np.ndarray:
    """What a slice shows, (rows, columns) of 0 to 255, the top row first."""
    image = kind(name).data
    columns, rows = image.size
    values = np.empty(4 * rows * columns, dtype=np.float32)
    image.pixels.foreach_get(values)
    return np.round(255 * values.reshape(rows, columns, 4)[::-1, :, 0]).astype(np.uint8)


def contour(name: str) -> np.ndarray:
    """The contour's points in the world, one (N, 3) after the other."""
    placed = kind(f"{name} contour")
    points = [p.co[:3] for s in placed.data.splines for p in s.points]
    matrix = np.array(placed.matrix_world)
    return np.array(points).reshape(-1, 3) @ matrix[:3, :3].T + matrix[:3, 3]


def slices(out: str, label: str) -> dict[str, Any]:
    """Where the slices are and what they show."""
    bpy.context.view_layer.update()
    saved = {}
    for name in PLANES:
        saved[f"{name} grey"] = greys(name)
        saved[f"{name} matrix"] = np.array(kind(name).matrix_world)
        saved[f"{name} contour"] = contour(name)
    file = Path(out) / f"{label}.npz"
    np.savez(file, **saved)
    return {
        "file": str(file),
        "positions": {n: addon("slices.scene_slices").position_mm(n) for n in PLANES},
        "sizes": {n: kind(n).empty_display_size for n in PLANES},
    }


def moved(out: str) -> dict[str, Any]:
    """By a slider, by hand, beyond the end; with other greys."""
    properties = bpy.context.scene.bonemesh_slices
    properties.axial = 25.0
    answer = {"slider": slices(out, "slider"), "percent": properties.axial}
    kind("coronal").location.y += 3.25
    answer["by hand"] = slices(out, "by_hand")
    properties.centre_hu, properties.width_hu = 40.0, 400.0
    answer["soft tissue"] = slices(out, "soft")
    properties.centre_hu, properties.width_hu = 400.0, 1800.0
    properties.show_axial = False
    hidden = [kind(n).hide_viewport for n in ("axial", "axial contour", "coronal")]
    properties.show_axial = True
    return answer | {"hidden": hidden, "shown": properties.show_axial}


def bone_moved(bone: Any, out: str) -> dict[str, Any]:
    """The bone turned and moved, then back."""
    before = bone.matrix_world.copy()
    bone.rotation_euler = (0.3, -0.2, 0.5)
    bone.location = (10.0, 20.0, 30.0)
    answer = {"turned": slices(out, "turned")}
    answer["matrix"] = np.array(bone.matrix_world).tolist()
    answer["centre"] = list(bone["bonemesh_centre_mm"])
    bone.matrix_world = before
    bpy.context.view_layer.update()
    return answer


def edited(bone: Any) -> list[int]:
    """How many points the axial contour has: as it is, with half of the bone gone, and after undoing that."""
    counts = [len(contour("axial"))]
    data = bone.data.copy()
    x = np.array([v.co.x for v in bone.data.vertices])
    bone.data.clear_geometry()
    bpy.context.view_layer.update()
    counts.append(len(contour("axial")))
    bone.data = data
    bpy.context.view_layer.update()
    addon("slices.slice_updates").take_surface(bone)
    addon("slices.slice_updates").draw_all()
    counts.append(len(contour("axial")))
    assert len(x)
    return counts


def saved(out: str) -> dict[str, Any]:
    """A file is saved with slices; what is in it, and what is still shown."""
    file = Path(out) / "saved.blend"
    before = greys("axial")
    bpy.ops.wm.save_as_mainfile(filepath=str(file), compress=False)
    answer = {
        "bytes": file.stat().st_size,
        "dirty": [i.name for i in bpy.data.images if i.is_dirty],
        "as before": bool(np.array_equal(before, greys("axial"))),
    }
    copy = shutil.copy(file, file.with_name("copy.blend"))
    with bpy.data.libraries.load(str(copy)) as (inside, _):
        answer["images"] = list(inside.images)
        answer["objects"] = sorted(inside.objects)
    bpy.ops.wm.open_mainfile(filepath=str(file))
    answer["opened"] = {
        "memory": addon("slices.slice_store").current() is None,
        "pictures": [kind(n).data is None for n in PLANES],
        "panel": drawn("BONEMESH_PT_slices"),
    }
    bpy.context.view_layer.objects.active = bpy.data.objects["bone"]
    bpy.ops.bonemesh.show_slices()
    answer["again"] = bool(np.array_equal(before, greys("axial")))
    return answer


def main(zip: str, out: str, ct: str) -> dict[str, Any]:
    """Everything in one Blender."""
    stage.install(zip)
    stage.clear_scene()
    stage.fill_panel(ct, out)
    answer: dict[str, Any] = {"panel before": drawn("BONEMESH_PT_slices")}
    directory, properties = ct, bpy.context.scene.bonemesh
    properties.ct_directory = ""
    answer["refused"] = stage.message_of(bpy.ops.bonemesh.show_slices)
    properties.ct_directory = directory
    bpy.ops.bonemesh.show_slices()
    answer["without a bone"] = slices(out, "alone")
    bpy.ops.bonemesh.hide_slices()
    bpy.ops.bonemesh.render_surface_mesh()
    bone = bpy.context.view_layer.objects.active
    bpy.ops.ed.undo_push(message="rendered")
    operator, context, gate = press("show_slices", "read_series")
    gate.open()
    answer["end"] = [until_end(operator, context), operator.reports]
    bone = bpy.data.objects["bone"]
    answer["shown"] = slices(out, "shown")
    answer["panel"] = drawn("BONEMESH_PT_slices")
    answer["locks"] = {n: list(kind(n).lock_location) for n in PLANES}
    answer |= {"moved": moved(out), "bone": bone_moved(bone, out)}
    answer["edited"] = edited(bone)
    kept = addon("slices.slice_store").current()
    bpy.ops.bonemesh.show_slices()
    answer["read once"] = addon("slices.slice_store").current() is kept
    answer["saved"] = saved(out)
    properties = bpy.context.scene.bonemesh
    bpy.data.objects["bone"]["bonemesh_series_uid"] = "1.2.3"
    answer["another series"] = stage.message_of(bpy.ops.bonemesh.show_slices)
    bpy.ops.bonemesh.hide_slices()
    answer["left"] = [
        [o.name for o in bpy.data.objects if "Slice" in o.name or "Contour" in o.name],
        [i.name for i in bpy.data.images if i.name.startswith("CT")],
        addon("slices.slice_store").current() is None,
    ]
    handlers = bpy.app.handlers.depsgraph_update_post
    count = len(handlers)
    bpy.ops.preferences.addon_disable(module=stage.MODULE)
    answer["handlers"] = count - len(handlers)
    return answer
