"""A second start of Blender: enable, disable, enable, render."""

import contextlib
from typing import Any

import addon_utils
import bpy
import stage


def there() -> bool:
    """Whether panel, properties and operators exist."""
    operators = []
    with contextlib.suppress(KeyError):
        operators = [bpy.ops.bonemesh.render_surface_mesh.get_rna_type()]
    panel = hasattr(bpy.types, "BONEMESH_PT_segment_ct")
    return panel and hasattr(bpy.context.scene, "bonemesh") and bool(operators)


def main(zip: str, out: str, ct: str) -> dict[str, Any]:
    """Says after each step whether the add-on is there."""
    seen = [there()]
    for _ in range(2):
        bpy.ops.preferences.addon_enable(module=stage.MODULE)
        seen.append(there())
        bpy.ops.preferences.addon_disable(module=stage.MODULE)
        seen.append(there())
    bpy.ops.preferences.addon_enable(module=stage.MODULE)
    stage.fill_panel(ct, out)
    result = sorted(bpy.ops.bonemesh.render_surface_mesh())
    return {
        "seen": seen,
        "enabled": addon_utils.check(stage.MODULE)[1],
        "result": result,
    }
