# SPDX-License-Identifier: GPL-3.0-or-later
"""How much memory a rendering needs and the machine has. Knows no bpy.

Voxels and triangles are what takes room. Surfaces grow as the two-thirds power of volumes: scans of heads
and skulls from 0.4 to 37 million voxels have 14 to 17 triangles for each voxel ** (2 / 3), and the peaks
that scripts/memory measures on them follow from the numbers below within a fourth or are lower.
"""

from __future__ import annotations

import ctypes
import os
import sys
from pathlib import Path

# By method: of each voxel that is used, and of each voxel of a surface as large as theirs.
BYTES = {"isosurface": (6.0, 2100.0), "labelled": (9.0, 4200.0)}
BYTES_OF_EDGE_POINTS = (4.0, 2700.0)
BYTES_STORED = 2.0  # of each voxel that is read but left out
GIB = float(1 << 30)


def needed_bytes(voxels: int, used_voxels: int, method: str) -> float:
    """About what a rendering takes at its worst."""
    of_voxels, of_surface = BYTES.get(method, BYTES_OF_EDGE_POINTS)
    left_out = BYTES_STORED * voxels if used_voxels < voxels else 0.0
    return left_out + of_voxels * used_voxels + of_surface * used_voxels ** (2.0 / 3.0)


def warning(needed: float, free: float | None) -> str | None:
    """One line with the remedy, if there is less than what is needed."""
    if free is None or needed <= free:
        return None
    return (
        f"Rendering needs about {needed / GIB:.1f} GB of memory, {free / GIB:.1f} GB are free: "
        "close other programs, or show the crop box and render a part"
    )


def free_bytes() -> float | None:
    """What programs may still take; None where the system does not tell."""
    try:
        if sys.platform == "win32":
            return free_on_windows()
        if sys.platform == "darwin":
            # macOS makes room by packing what other programs hold; all of it is what there is to gain.
            return float(os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE"))
        lines = Path("/proc/meminfo").read_text(encoding="ascii").splitlines()
        line = next(line for line in lines if line.startswith("MemAvailable:"))
        return float(line.split()[1]) * 1024.0
    except (OSError, ValueError, StopIteration, AttributeError):
        return None


def free_on_windows() -> float | None:
    """Physical memory that is free, as Windows says."""

    class Status(ctypes.Structure):
        _fields_ = (
            ("length", ctypes.c_uint32),
            ("load", ctypes.c_uint32),
            ("total_physical", ctypes.c_uint64),
            ("free_physical", ctypes.c_uint64),
            ("total_page", ctypes.c_uint64),
            ("free_page", ctypes.c_uint64),
            ("total_virtual", ctypes.c_uint64),
            ("free_virtual", ctypes.c_uint64),
            ("free_extended", ctypes.c_uint64),
        )

    status = Status(length=ctypes.sizeof(Status))
    kernel = ctypes.windll.kernel32  # type: ignore[attr-defined]
    is_told = kernel.GlobalMemoryStatusEx(ctypes.byref(status))
    return float(status.free_physical) if is_told else None
