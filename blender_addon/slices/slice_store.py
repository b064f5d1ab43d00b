# SPDX-License-Identifier: GPL-3.0-or-later
"""The CT volume whose slices are shown, and the surface whose contours are. Knows no bpy.

A volume is kept as long as its slices are shown, so that moving a slice needs no reading; another one
takes its place, and disabling the add-on or opening a file lets it go.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import bonemesh
import numpy as np
from numpy.typing import NDArray

PLANES = ("axial", "coronal", "sagittal")
AXES = {"sagittal": 0, "coronal": 1, "axial": 2}
"""Which axis of the stack (left, back, head) stands on each plane."""
MIB = 2.0**20


@dataclass
class Shown:
    """A volume with its planes."""

    source: tuple[object, ...]
    """What it was read from, to know it again."""
    volume: bonemesh.Volume
    planes: dict[str, bonemesh.SlicePlane] = field(init=False)
    patient_from_stack: NDArray[np.float64] = field(init=False)
    """(3, 3): the stack's directions to the left, the back and the head, as columns."""
    surface: bonemesh.Mesh | None = None
    """What is cut by the planes, in patient coordinates."""

    def __post_init__(self) -> None:
        self.planes = {name: self.volume.plane(name) for name in PLANES}
        normals = {name: self.planes[name].patient_from_plane[:3, 2] for name in PLANES}
        self.patient_from_stack = np.stack(
            [normals["sagittal"], normals["coronal"], normals["axial"]], axis=1
        )

    def middle_mm(self, name: str) -> float:
        """The position in the middle of a plane's range, on one of the volume's own slices."""
        low, _ = self.planes[name].positions_mm
        return low + self.planes[name].step_mm * ((self.slices(name) - 1) // 2)

    def slices(self, name: str) -> int:
        """How many slices of its own the volume has along a plane's normal."""
        plane = self.planes[name]
        low, high = plane.positions_mm
        return 1 + round((high - low) / plane.step_mm)

    def slice_number(self, name: str, position_mm: float) -> int:
        """The nearest of them, from 1."""
        plane = self.planes[name]
        number = 1 + round((position_mm - plane.positions_mm[0]) / plane.step_mm)
        return min(max(number, 1), self.slices(name))

    def stack_from_plane(self, name: str, position_mm: float) -> NDArray[np.float64]:
        """(4, 4): where a picture's middle is in the stack's frame, and how it is turned; right-handed."""
        matrix = self.planes[name].patient_from_plane
        place = matrix[:3, :3] @ (0.0, 0.0, position_mm) + matrix[:3, 3]
        right, up = matrix[:3, 0], matrix[:3, 1]
        turned = np.stack([right, up, np.cross(right, up)], axis=1)
        placed = np.eye(4)
        placed[:3, :3] = self.patient_from_stack.T @ turned
        placed[:3, 3] = self.patient_from_stack.T @ place
        return placed

    def contours(self, name: str, position_mm: float) -> list[NDArray[np.float64]]:
        """The surface's lines in a plane, each (N, 3) in the stack's frame."""
        if self.surface is None:
            return []
        matrix = self.planes[name].patient_from_plane
        normal = matrix[:3, 2]
        point = matrix[:3, 3] + position_mm * normal
        lines = bonemesh.section(self.surface, point, normal)
        return [line @ self.patient_from_stack for line in lines]

    def memory_text(self) -> str:
        """How large the volume is, and the memory that it takes."""
        slices, rows, columns = self.volume.hu.shape
        return f"{columns} x {rows} x {slices} voxels, {self.volume.hu.nbytes / MIB:,.0f} MiB in memory"


_current: Shown | None = None


def current() -> Shown | None:
    """What is shown."""
    return _current


def keep(shown: Shown | None) -> None:
    """Makes `shown` what is kept; the volume before it is let go."""
    global _current
    _current = shown
