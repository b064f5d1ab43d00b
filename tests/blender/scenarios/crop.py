"""The crop box: shown, moved, scaled, edited, used by a rendering, removed, undone."""

from pathlib import Path
from typing import Any

import bpy
import numpy as np
import stage
from mathutils import Vector

OPS = bpy.ops.bonemesh


def box() -> Any:
    """The box in the scene."""
    return next(
        (o for o in bpy.context.scene.objects if "bonemesh_crop_box" in o), None
    )


def corners() -> list[list[float]]:
    """Its corners in the world."""
    bpy.context.view_layer.update()
    return [list(box().matrix_world @ v.co) for v in box().data.vertices]


def used() -> str:
    """The field Crop after Use Crop Box, or the refusal."""
    message = stage.message_of(OPS.use_crop_box)
    return message or bpy.context.scene.bonemesh.crop


def series_of(path: str, number: int = 1) -> Any:
    """What the scan says of a series."""
    bpy.context.scene.bonemesh.ct_directory = path
    bpy.context.scene.bonemesh.series = str(number)
    OPS.scan_ct_directory()
    scanning = stage.addon_scanning()
    scanning.is_watched = False
    return scanning.marked_series(bpy.context.scene.bonemesh)


def expected_corners(series: Any) -> list[list[float]]:
    """The outer faces of all voxels."""
    size = (series.columns, series.rows, series.slices)
    ends = [
        [(-0.5, n - 0.5)[e] for n, e in zip(size, at, strict=True)]
        for at in np.ndindex(2, 2, 2)
    ]
    affine = np.asarray(series.patient_from_voxel)
    return [(affine @ [*end, 1.0])[:3].tolist() for end in ends]


def shrink(slices: int) -> None:
    """Drags the upper face down to the middle, as its vertices do in Edit Mode."""
    placed = box()
    heights = [v.co.z for v in placed.data.vertices]
    middle = (min(heights) + max(heights)) / 2.0
    top = middle if slices % 2 == 0 else middle - 0.1
    for vertex in placed.data.vertices:
        if vertex.co.z > middle:
            vertex.co.z = top


def edited(slices: int) -> str:
    """What the box holds while it is in Edit Mode with another upper face."""
    OPS.show_crop_box()
    shrink(slices)
    bpy.ops.object.mode_set(mode="EDIT")
    text = used()
    bpy.ops.object.mode_set(mode="OBJECT")
    return text


def rendered(out: str) -> dict[str, Any]:
    """Renders with the panel as it is."""
    OPS.render_surface_mesh()
    bone = bpy.context.view_layer.objects.active
    return {
        "crop": bpy.context.scene.bonemesh.crop,
        "height_mm": bone.dimensions.z,
        "files": sorted(p.name for p in Path(out).glob("*.stl")),
    }


def undone() -> list[bool]:
    """Whether the box is there: shown, undone, done again."""
    bpy.ops.ed.undo_push(message="before")
    OPS.show_crop_box("EXEC_DEFAULT", True)
    there = [box() is not None]
    bpy.ops.ed.undo()
    there.append(box() is not None)
    bpy.ops.ed.redo()
    there.append(box() is not None)
    return there


def main(zip: str, out: str, ct: str, two: str) -> dict[str, Any]:
    """One after the other in one Blender."""
    stage.install(zip)
    properties = bpy.context.scene.bonemesh
    answer: dict[str, Any] = {"no images": stage.message_of(OPS.show_crop_box)}
    stage.fill_panel(ct, out)
    answer["not looked at"] = stage.message_of(OPS.show_crop_box)
    answer["no box to use"] = stage.message_of(OPS.use_crop_box)
    answer["no box to remove"] = stage.message_of(OPS.remove_crop_box)
    series = series_of(ct)
    answer["shape"] = [series.columns, series.rows, series.slices]
    answer["expected corners"] = expected_corners(series)
    OPS.show_crop_box()
    placed = box()
    answer["shown"] = {
        "name": placed.name,
        "active": bpy.context.view_layer.objects.active == placed,
        "rendered": not placed.hide_render,
        "corners": corners(),
        "crop": used(),
    }
    answer["checked"] = stage.message_of(OPS.check_mesh)
    placed.scale = (0.53, 1.0, 1.0)
    answer["scaled"] = used()
    middle, half = (series.columns - 1) / 2.0, 0.53 * series.columns / 2.0
    first, end = int(np.ceil(middle - half)), int(np.floor(middle + half)) + 1
    answer["expected scaled"] = f"{first}:{end},0:{series.rows},0:{series.slices}"
    placed.location += Vector((10_000.0, 0.0, 0.0))
    answer["moved away"] = used()
    properties.crop = ""
    answer["edited"] = edited(series.slices)
    properties.crop = ""
    answer["typed after it"] = rendered(out)
    OPS.show_crop_box()
    shrink(series.slices)
    answer["rendered"] = rendered(out)
    OPS.remove_crop_box()
    assert box() is None
    answer["rendered whole"] = rendered(out)
    series_of(two, 2)
    OPS.show_crop_box()
    answer["coronal"] = used()
    OPS.remove_crop_box()
    answer["undone"] = undone()
    return answer
