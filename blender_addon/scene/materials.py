# SPDX-License-Identifier: GPL-3.0-or-later
"""How bones and regions look; with meshes.py the only writer of Blender's data."""

from __future__ import annotations

import math
from typing import Any

import bpy

# As they look in daylight, for Material Preview and renders.
BONE_COLOUR = (0.80, 0.70, 0.54, 1.0)
REGION_COLOUR = (0.75, 0.12, 0.05, 1.0)
IN_SOLID = (
    1.25  # times as light there, where studio light is dim and ivory would be khaki
)
ROUGHNESS = 0.55
SPECULAR = 0.35
# Faces that meet at more than this are shown as an edge: the sides of a cut, not the grain of a surface.
SHARP = math.radians(50.0)


def material(name: str, colour: tuple[float, ...]) -> Any:
    """The shared material of that name, in `colour` in every kind of shading when it is new."""
    found = bpy.data.materials.get(name)
    if found is not None:
        return found
    made = bpy.data.materials.new(name)
    made.diffuse_color = [min(IN_SOLID * c, 1.0) for c in colour]
    made.roughness = ROUGHNESS
    made.use_nodes = True
    shader = made.node_tree.nodes.get("Principled BSDF")
    if shader is not None:
        shader.inputs["Base Color"].default_value = colour
        shader.inputs["Roughness"].default_value = ROUGHNESS
        shader.inputs["Specular IOR Level"].default_value = SPECULAR
    return made


def shade(mesh: Any) -> None:
    """Smooth, but for edges as sharp as those of a cut."""
    mesh.set_sharp_from_angle(angle=SHARP)
