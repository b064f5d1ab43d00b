# SPDX-License-Identifier: GPL-3.0-or-later
"""Between the crop box in the scene and the field Crop of the panel."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..request.inputs import NO_CT_IMAGES, RefusalError
from ..series import scanning
from . import crop_box, scene_crop
from .crop_box import Grid

NO_BOX = "there is no crop box in the scene; press Show Crop Box"
NOT_SCANNED = "which images are meant is not known yet; wait until they are looked at, or press Look Again"


def grid_of(properties: Any) -> Grid:
    """Where the chosen series lies; refused as long as that is not known."""
    if not properties.ct_directory.strip():
        raise RefusalError(NO_CT_IMAGES)
    series = scanning.marked_series(properties)
    if series is None:
        raise RefusalError(NOT_SCANNED)
    affine = np.asarray(series.patient_from_voxel, dtype=np.float64)
    return Grid(affine, (series.columns, series.rows, series.slices))


def use_box(context: Any) -> str:
    """Writes what the box in the scene holds into the field Crop, and returns it; empty for all."""
    properties = context.scene.bonemesh
    placed = scene_crop.found(context.scene)
    if placed is None:
        raise RefusalError(NO_BOX)
    grid = grid_of(properties)
    box = crop_box.box_of(scene_crop.corners_mm(context, placed), grid)
    text = crop_box.written(box, grid)
    scene_crop.note_place(context, placed)
    if properties.crop != text:
        properties.crop = text
    return text


def forget(scene: Any) -> None:
    """Takes the crop and its box away: other images are chosen."""
    placed = scene_crop.found(scene)
    if placed is not None and placed.mode == "OBJECT":
        scene_crop.remove(placed)
    scene.bonemesh.crop = ""


def use_moved_box(context: Any) -> None:
    """The same before a rendering, if there is a box that was moved; else the field was set last, and counts."""
    placed = scene_crop.found(context.scene)
    if placed is not None and scene_crop.is_moved(context, placed):
        use_box(context)
