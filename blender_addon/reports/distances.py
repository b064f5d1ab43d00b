# SPDX-License-Identifier: GPL-3.0-or-later
"""How far one mesh lies from another: in words for the panel, and as colours. Knows no bpy."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

# As light is added up, not as it is stored: so halfway between two is halfway for the eye, too.
NEAR = np.array([0.80, 0.80, 0.80, 1.0], dtype=np.float32)
OUTSIDE = np.array([0.70, 0.02, 0.02, 1.0], dtype=np.float32)
INSIDE = np.array([0.02, 0.10, 0.70, 1.0], dtype=np.float32)


def colours(signed_mm: NDArray[np.float32], full_mm: float) -> NDArray[np.float32]:
    """(N, 4): grey where the meshes meet, red outside and blue inside of the other, in full from `full_mm` on."""
    part = np.clip(signed_mm / np.float32(full_mm), -1.0, 1.0)[:, np.newaxis]
    mixed = NEAR + np.maximum(part, 0.0) * (OUTSIDE - NEAR)
    return np.asarray(mixed + np.maximum(-part, 0.0) * (INSIDE - NEAR), np.float32)


def report(
    signed_mm: NDArray[np.float64], compared: dict[str, Any], reference: str
) -> dict[str, Any]:
    """What is kept with the mesh: of its own vertices, and of places all over the other."""
    apart_mm = np.abs(signed_mm)
    median_mm, most_mm = np.percentile(apart_mm, [50.0, 95.0])
    back = compared["from_reference"]
    return {
        "reference": reference,
        "median_mm": float(median_mm),
        "p95_mm": float(most_mm),
        "max_mm": float(apart_mm.max()),
        "from_reference": {key: back[key] for key in ("p95_mm", "max_mm")},
    }


def lines(found: dict[str, Any], name: str) -> list[str]:
    """The same in words."""
    other, back = found["reference"], found["from_reference"]
    return [
        f"Half of its vertices are within {found['median_mm']:.2f} mm of {other}",
        f"95 % within {found['p95_mm']:.2f} mm, all within {found['max_mm']:.2f} mm",
        f"95 % of {other} are within {back['p95_mm']:.2f} mm of {name}, all within {back['max_mm']:.2f} mm",
    ]
