"""What the panels show, read from a layout that takes notes instead of drawing."""

from importlib import import_module
from types import SimpleNamespace
from typing import Any

import bpy
import stage
from background import press, until_end


class Layout:
    """Notes every label, field and button in the order in which they are drawn."""

    def __init__(self, shown: list[str]) -> None:
        self.shown = shown

    def column(self, **_options: Any) -> "Layout":
        return self

    row = column

    def label(self, text: str, **_options: Any) -> None:
        self.shown.append(text)

    def prop(
        self, data: Any, name: str, text: str | None = None, **_options: Any
    ) -> None:
        field = data.bl_rna.properties[name]
        self.shown.append(f"[{name}]" if text == "" else f"{field.name} [{name}]")

    def operator(self, name: str, **_options: Any) -> None:
        kind, verb = name.split(".")
        self.shown.append(getattr(getattr(bpy.ops, kind), verb).get_rna_type().name)

    def progress(self, factor: float, text: str, **_options: Any) -> None:
        assert 0.0 <= factor <= 1.0
        self.shown.append(f"progress: {text}")


def drawn(panel: str) -> list[str]:
    """Everything that the panel shows now."""
    shown: list[str] = []
    getattr(bpy.types, panel).draw(SimpleNamespace(layout=Layout(shown)), bpy.context)
    return shown


def main(zip: str, out: str, ct: str) -> dict[str, Any]:
    """Says what is shown without a job and during one."""
    stage.install(zip)
    properties = stage.fill_panel(ct, out)
    panels = [bpy.types.BONEMESH_PT_segment_ct, bpy.types.BONEMESH_PT_advanced]
    suggest = import_module(f"{stage.MODULE}.properties").suggest_series
    answer = {
        "tabs": [panel.bl_category for panel in panels],
        "closed": [
            "DEFAULT_CLOSED" in getattr(panel, "bl_options", ()) for panel in panels
        ],
        "main": drawn("BONEMESH_PT_segment_ct"),
        "advanced": drawn("BONEMESH_PT_advanced"),
        "series": list(suggest(properties, bpy.context, "")),
        "limits": {
            name: [field.hard_min, field.hard_max, field.default]
            for name in ("hu_threshold", "cut_thickness", "sample_percent", "sigma")
            for field in [properties.bl_rna.properties[name]]
        },
    }
    properties.ct_directory = "there/is/nothing/here"
    answer["no series"] = list(suggest(properties, bpy.context, ""))
    properties.ct_directory = ct
    operator, context, gate = press("render_surface_mesh", "render")
    answer["busy"] = drawn("BONEMESH_PT_segment_ct")
    gate.open()
    until_end(operator, context)
    return answer
