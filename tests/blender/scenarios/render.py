"""Install, enable, render."""

from pathlib import Path
from typing import Any

import bpy
import stage


def main(zip: str, out: str, ct: str, fields: dict[str, Any]) -> dict[str, Any]:
    """Renders with `fields` set in the panel; says what is in the scene."""
    stage.install(zip)
    stage.fill_panel(ct, out, **fields)
    result = bpy.ops.bonemesh.render_surface_mesh()
    bone = bpy.context.view_layer.objects.active
    units = bpy.context.scene.unit_settings
    clips = [
        (space.clip_start, space.clip_end)
        for screen in bpy.data.screens
        for area in screen.areas
        for space in area.spaces
        if space.type == "VIEW_3D"
    ]
    return {
        "result": sorted(result),
        "name": bone.name,
        "selected": [o.name for o in bpy.context.selected_objects],
        "mesh": stage.save_mesh(Path(out) / "bone.npz", bone),
        "properties": stage.custom_properties(bone),
        "units": [units.system, units.scale_length, units.length_unit],
        "clips": clips,
        "files": sorted(p.name for p in Path(out).iterdir() if p.suffix != ".npz"),
    }
