"""A region cut with values that the operator is given, as Adjust Last Operation gives them."""

from pathlib import Path
from typing import Any

import bpy
import stage


def regions() -> dict[str, Any]:
    """How the regions in the scene were cut, by name."""
    return {
        o.name: [o["bonemesh_thickness_mm"], o["bonemesh_direction"]]
        for o in bpy.context.scene.objects
        if "bonemesh_source" in o
    }


def done_again(properties: Any) -> dict[str, Any]:
    """As the window does it, with the name that an empty field stands for being another by then."""
    made = {"made": "region", "file": "region"}
    properties.roi_name = "free by now"
    bpy.ops.bonemesh.select_roi(thickness=2.5, direction="through", **made)
    return regions()


def main(zip: str, out: str, ct: str) -> dict[str, Any]:
    """Cuts less deep than the panel says, and straight through; then once more by the panel."""
    stage.install(zip)
    properties = stage.fill_panel(ct, out, cut_thickness=3.0)
    bpy.ops.bonemesh.render_surface_mesh("EXEC_DEFAULT", True)
    stage.select_front(bpy.context.view_layer.objects.active)
    bpy.ops.bonemesh.select_roi(thickness=2.0, direction="through")
    adjusted = done_again(properties)
    properties.roi_name = "second"
    bpy.ops.bonemesh.select_roi()
    return {
        "adjusted": adjusted,
        "files": sorted(p.name for p in Path(out).glob("region*.stl")),
        "regions": regions(),
        "options": sorted(bpy.types.BONEMESH_OT_select_roi.bl_options),
    }
