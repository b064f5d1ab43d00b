"""The live preview: begun, moved, switched off, replaced, deleted, undone, saved, ended by the surface itself."""

import time
from pathlib import Path
from typing import Any

import bpy
import numpy as np
import stage
from panel import drawn

TAG = "bonemesh_preview"


def previews() -> list[Any]:
    """The previews that are in the file."""
    return [o for o in bpy.data.objects if TAG in o]


def vertices() -> int:
    """How many vertices the preview has; -1 without one."""
    shown = previews()
    assert len(shown) <= 1
    return len(shown[0].data.vertices) if shown else -1


def until_done(previewing: Any) -> int:
    """Ticks until nothing is left to do; returns what is shown then."""
    for _ in range(6000):
        if previewing.tick() is None:
            return vertices()
        time.sleep(0.01)
    raise AssertionError("the preview did not come to an end")


def of_library(threshold_hu: int, crop: str | None = None) -> int:
    """How many vertices the library's preview of the chosen series has."""
    previewing = stage.addon_previewing()
    series = previewing.chosen_series(bpy.context.scene.bonemesh)
    reading = previewing.previews.known(series)
    return len(reading.preview.surface(threshold_hu, crop=crop).vertices)


def leftovers() -> list[str]:
    """What the preview is made of and is still in the file."""
    data = [*bpy.data.meshes, *bpy.data.materials]
    return sorted(d.name for d in data if d.name.startswith("Bonemesh Preview"))


def first(previewing: Any) -> dict[str, Any]:
    """What is shown when images were chosen."""
    shown = until_done(previewing)
    placed = previews()[0]
    local = np.empty(3 * shown, dtype=np.float32)
    placed.data.vertices.foreach_get("co", local)
    return {
        "name": placed.name,
        "selectable": not placed.hide_select,
        "rendered": not placed.hide_render,
        "visible": placed.visible_get(),
        "selected": placed.select_get(),
        "vertices": [shown, of_library(350)],
        "lowest": local.reshape(-1, 3).min(axis=0).tolist(),
        "highest": local.reshape(-1, 3).max(axis=0).tolist(),
        "unit": bpy.context.scene.unit_settings.length_unit,
        "timer": bpy.app.timers.is_registered(previewing.tick),
    }


def at_the_threshold(buttons: list[Any] | None = None) -> list[Any]:
    """What is between the slider and the mesh's name, boxes laid open."""
    shown = drawn(buttons=buttons)
    first, last = shown.index("[show_preview]") + 1, shown.index("Mesh Filename")
    rows = ([row] if isinstance(row, str) else row for row in shown[first:last])
    return [row for several in rows for row in several]


def panel() -> dict[str, Any]:
    """The thresholds, folded in and out."""
    folds = bpy.context.window_manager.bonemesh_folds
    answer: dict[str, Any] = {"closed": at_the_threshold()}
    folds.show_histogram = True
    buttons: list[Any] = []
    answer["open"] = at_the_threshold(buttons)
    folds.show_histogram = False
    thresholds = [b for b in buttons if b.idname == "bonemesh.use_threshold"]
    return answer | {
        "thresholds": [button.hu for button in thresholds],
        "titles": [button.title for button in thresholds],
    }


def moved(properties: Any, previewing: Any) -> dict[str, Any]:
    """The slider, a button of the list, the crop, and thresholds that leave nothing."""
    answer: dict[str, Any] = {}
    for hu in (200, 500, 800):
        properties.hu_threshold = hu
        previewing.tick()
    answer["slider"] = [until_done(previewing), of_library(800)]
    answer["button"] = sorted(bpy.ops.bonemesh.use_threshold(hu=600, title="600 HU"))
    answer["pressed"] = [until_done(previewing), of_library(600)]
    series = previewing.scanning.marked_series(properties)
    crop = f"0:{series.columns},0:{series.rows},0:{series.slices // 2}"
    properties.crop = crop
    answer["crop"] = [until_done(previewing), of_library(600, crop)]
    properties.crop = "left half"
    answer["no box"] = [until_done(previewing), str(previewing.problem())]
    answer["said"] = at_the_threshold()
    properties.crop = ""
    properties.hu_threshold = 3071
    answer["nothing"] = [until_done(previewing), str(previewing.problem())]
    properties.hu_threshold = 350
    answer["again"] = [until_done(previewing), of_library(350)]
    answer["no problem"] = previewing.problem() is None
    return answer


def switched(properties: Any, previewing: Any) -> dict[str, Any]:
    """Off and on again."""
    properties.show_preview = False
    off = until_done(previewing)
    left = leftovers()
    properties.hu_threshold = 300
    still_off = until_done(previewing)
    properties.show_preview = True
    on = until_done(previewing)
    return {"off": [off, left, still_off], "on": [on, of_library(300)]}


def deleted(properties: Any, previewing: Any) -> dict[str, Any]:
    """By the user, while it is shown and while a newer one is made."""
    bpy.data.objects.remove(previews()[0])
    gone = until_done(previewing)
    properties.hu_threshold = 320
    back = until_done(previewing)
    properties.hu_threshold = 340
    previewing.tick()
    for placed in previews():
        bpy.data.objects.remove(placed)
    return {"gone": gone, "back": back > 0, "during": until_done(previewing) > 0}


def undone(properties: Any, previewing: Any) -> dict[str, Any]:
    """Undo and redo between moves of the slider, in Object Mode and while something is edited."""
    answer = {}
    bpy.ops.ed.undo_push(message="begin")
    bpy.ops.mesh.primitive_cube_add()
    bpy.ops.ed.undo_push(message="cube")
    for hu in (200, 700):
        properties.hu_threshold = hu
        until_done(previewing)
        bpy.ops.ed.undo_push(message=f"{hu} HU")
    steps = []
    for _ in range(2):
        bpy.ops.ed.undo()
        hu = bpy.context.scene.bonemesh.hu_threshold
        steps.append([until_done(previewing), of_library(hu)])
    for _ in range(2):
        bpy.ops.ed.redo()
        hu = bpy.context.scene.bonemesh.hu_threshold
        steps.append([until_done(previewing), of_library(hu)])
    answer["steps"] = steps
    bpy.context.view_layer.objects.active = bpy.data.objects["Cube"]
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.context.scene.bonemesh.hu_threshold = 400
    answer["edit mode"] = [until_done(previewing), of_library(400), bpy.context.mode]
    bpy.ops.mesh.select_all(action="DESELECT")
    bpy.ops.ed.undo_push(message="deselected")
    bpy.ops.ed.undo()
    answer["undone in edit mode"] = [until_done(previewing), previews() != []]
    bpy.ops.object.mode_set(mode="OBJECT")
    return answer


def saved(folder: Path, previewing: Any) -> dict[str, Any]:
    """Into a file and out of it, the images still where they were and moved away."""
    before = until_done(previewing)
    file = str(folder / "scene.blend")
    bpy.ops.wm.save_as_mainfile(filepath=file)
    answer = {"before": before, "after": vertices()}
    bpy.ops.wm.read_homefile()
    with bpy.data.libraries.load(file) as (inside, _):
        answer["inside"] = [
            f"{kind}: {name}"
            for kind in ("objects", "meshes", "materials")
            for name in getattr(inside, kind)
            if "Preview" in name
        ]
    bpy.ops.wm.open_mainfile(filepath=file)
    answer["opened"] = [until_done(previewing), previewing.state.is_wanted]
    return answer


def folder_changed(ct: str, two: str, previewing: Any) -> dict[str, Any]:
    """Other images: the old preview goes at once, the new one comes."""
    properties = bpy.context.scene.bonemesh
    properties.ct_directory = ct
    before = until_done(previewing)
    gate = stage.Gate("read_series")
    properties.ct_directory = two
    for _ in range(3000):
        previewing.tick()
        if not stage.addon_scans().running() and previewing.previews.running():
            break
        time.sleep(0.01)
    gate.wait_until_reached()
    previewing.tick()
    meanwhile = vertices()
    gate.open()
    after = until_done(previewing)
    properties.series = "2"
    second = until_done(previewing)
    properties.ct_directory = ""
    return {
        "seen": [before > 0, meanwhile, after > 0, second > 0, second != after],
        "none chosen": until_done(previewing),
    }


def rendered(ct: str, out: str, previewing: Any) -> dict[str, Any]:
    """The surface itself comes in its place; the slider brings it back."""
    properties = stage.fill_panel(ct, out)
    before = until_done(previewing)
    bpy.ops.bonemesh.render_surface_mesh()
    after = until_done(previewing)
    properties.hu_threshold = 500
    return {"before": before > 0, "after": after, "slider": until_done(previewing) > 0}


def main(zip: str, out: str, ct: str, two: str) -> dict[str, Any]:
    """One after the other in one Blender."""
    stage.install(zip)
    previewing = stage.addon_previewing()
    properties = bpy.context.scene.bonemesh
    nothing = until_done(previewing)
    properties.ct_directory = ct
    answer: dict[str, Any] = {"nothing chosen": nothing, "first": first(previewing)}
    answer["panel"] = panel()
    answer["moved"] = moved(properties, previewing)
    answer["switched"] = switched(properties, previewing)
    answer["deleted"] = deleted(properties, previewing)
    answer["undone"] = undone(properties, previewing)
    answer["saved"] = saved(Path(out), previewing)
    answer["folder"] = folder_changed(ct, two, previewing)
    answer["rendered"] = rendered(ct, out, previewing)
    return answer
