# SPDX-License-Identifier: GPL-3.0-or-later
"""The stages of a rendering in their order, with their usual parts of the time. Knows no bpy.

Seconds that they took on a skull in 140 slices of 512 x 512 (scripts/memory prints them); on other scans
the parts differ, which is why time left is told in round numbers.
"""

from __future__ import annotations

from typing import Any

CLOSED = {
    "parts": 0.21,
    "containment": 0.66,
    "check": 0.42,
}
DECIMATED = {
    "decimate": 10.0,
    "sort triangles": 0.15,
    "intersections": 0.46,
    "deviation": 0.50,
}
WRITTEN = {"write": 0.10}
STAGES = {
    "isosurface": {
        "scan": 0.05,
        "read": 0.37,
        "metal": 0.11,
        "edges": 3.01,
        "surface": 0.30,
        "smooth": 1.07,
        **CLOSED,
    },
    "labelled": {
        "scan": 0.05,
        "read": 0.37,
        "metal": 0.11,
        "edges": 2.77,
        "distances": 2.37,
        "tetrahedra": 5.79,
        "borders": 1.27,
        "labels": 2.26,
        "surface": 7.09,
        **CLOSED,
    },
    "alpha": {
        "scan": 0.05,
        "read": 0.37,
        "metal": 0.11,
        "threshold": 0.11,
        "edges": 0.16,
        "cloud": 0.10,
        "neighbours": 0.84,
        "tetrahedra": 4.28,
        "surface": 0.06,
        "check": 0.30,
    },
}
# What takes a time of its own in stages that come before, or under the same name once more.
UNFORESEEN = ("holes", "cavities", "smooth_mm", "islands", "sample_percent")


def of_rendering(options: dict[str, Any]) -> dict[str, float] | None:
    """Of a rendering with these keyword arguments; None where they make its time unforeseeable."""
    stages = STAGES.get(options["method"])
    is_foreseen = not options.get("damp_metal") and all(
        options.get(name) is None for name in UNFORESEEN
    )
    if stages is None or not is_foreseen:
        return None
    is_reduced = any(
        options.get(name) is not None for name in ("triangles", "decimate_mm")
    )
    return {**stages, **(DECIMATED if is_reduced else {}), **WRITTEN}
