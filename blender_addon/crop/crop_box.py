# SPDX-License-Identifier: GPL-3.0-or-later
"""The box of voxels that is rendered: between voxels of the images and a box in the patient. Knows no bpy.

A voxel is in the box if its centre is. The box in the patient goes to the voxels' outer faces, half a voxel
further than their centres. Slices may be oblique, and sheared where the gantry was tilted.
"""

from __future__ import annotations

import re
from itertools import product
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..request.inputs import RefusalError

Range = tuple[int, int]
Box = tuple[Range, Range, Range]
"""Columns, rows, slices, each (first, end), as the library counts them."""

WRITTEN = re.compile(r"\s*,\s*".join([r"\s*(\d{1,6})\s*:\s*(\d{1,6})\s*"] * 3))
FACES = [
    (0, 1, 3, 2),
    (4, 6, 7, 5),
    (0, 4, 5, 1),
    (2, 3, 7, 6),
    (0, 2, 6, 4),
    (1, 5, 7, 3),
]
"""Of the corners in the order of `corners_mm`."""


class Grid(NamedTuple):
    """Where the images lie in the patient."""

    patient_from_voxel: NDArray[np.float64]
    """(4, 4): (column, row, slice, 1) to millimetres."""
    shape: tuple[int, int, int]
    """Columns, rows, slices."""

    @property
    def whole(self) -> Box:
        """All voxels."""
        columns, rows, slices = self.shape
        return ((0, columns), (0, rows), (0, slices))


def written(box: Box, grid: Grid) -> str:
    """As it is typed in the panel; empty where it is all of the images."""
    if box == grid.whole:
        return ""
    return ",".join(f"{first}:{end}" for first, end in box)


def read(text: str, grid: Grid) -> Box:
    """What is typed in the panel, or all of the images where that is no box in them."""
    match = WRITTEN.fullmatch(text)
    if match is None:
        return grid.whole
    numbers = [int(number) for number in match.groups()]
    ranges = list(zip(numbers[::2], numbers[1::2], strict=True))
    fits = all(
        first < end <= size
        for (first, end), size in zip(ranges, grid.shape, strict=True)
    )
    return (ranges[0], ranges[1], ranges[2]) if fits else grid.whole


def corners_mm(box: Box, grid: Grid) -> NDArray[np.float64]:
    """(8, 3) corners in the patient, slices changing fastest."""
    ends = [(first - 0.5, end - 0.5) for first, end in box]
    voxels = np.array([(*corner, 1.0) for corner in product(*ends)])
    return (voxels @ grid.patient_from_voxel.T)[:, :3]


def frame(grid: Grid) -> NDArray[np.float64]:
    """(3, 3) rotation whose columns run along columns, rows and, but for a tilt, slices."""
    along_columns, along_rows = grid.patient_from_voxel[:3, :2].T
    x = along_columns / np.linalg.norm(along_columns)
    y = along_rows - x * np.dot(x, along_rows)
    y /= np.linalg.norm(y)
    return np.stack([x, y, np.cross(x, y)], axis=1)


def box_of(corners: NDArray[np.float64], grid: Grid) -> Box:
    """The voxels between (N, 3) places in the patient, those beyond the images left out."""
    voxel_from_patient = np.linalg.inv(grid.patient_from_voxel)
    places = np.c_[corners, np.ones(len(corners))] @ voxel_from_patient.T
    if not np.isfinite(places).all():
        raise RefusalError("the crop box is not a box any more; press Show Crop Box")
    size = np.array(grid.shape)
    lowest, highest = places[:, :3].min(axis=0), places[:, :3].max(axis=0)
    first = np.clip(np.ceil(lowest), 0, size).astype(int)
    end = np.clip(np.floor(highest) + 1, 0, size).astype(int)
    if (first >= end).any():
        raise RefusalError(
            "the crop box holds no voxel of the images; move it back to them or press Show Crop Box"
        )
    columns, rows, slices = ((int(a), int(b)) for a, b in zip(first, end, strict=True))
    return (columns, rows, slices)
