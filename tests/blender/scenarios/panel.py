"""What the panels show, read from a layout that takes notes instead of drawing."""

from functools import partial
from types import SimpleNamespace
from typing import Any

import bpy
import stage
from background import press, until_end


class Layout:
    """Notes every label, field and button in the order in which they are drawn; a box is a list of its own."""

    def __init__(self, shown: list[Any], buttons: list[Any]) -> None:
        self.shown = shown
        self.buttons = buttons

    def column(self, **_options: Any) -> "Layout":
        return self

    row = split = grid_flow = column

    def box(self) -> "Layout":
        self.shown.append([])
        return Layout(self.shown[-1], self.buttons)

    def separator(self, factor: float) -> None:
        pass

    def label(self, text: str, icon: str = "NONE", **_options: Any) -> None:
        self.shown.append(f"! {text}" if icon == "ERROR" else text)

    def prop(
        self, data: Any, name: str, text: str | None = None, **_options: Any
    ) -> None:
        shown = data.bl_rna.properties[name].name if text is None else text
        self.shown.append(f"{shown} [{name}]".lstrip())

    def operator(
        self,
        name: str,
        text: str | None = None,
        depress: bool = False,
        **_options: Any,
    ) -> Any:
        kind, verb = name.split(".")
        label = getattr(getattr(bpy.ops, kind), verb).get_rna_type().name
        self.shown.append(f"{'> ' if depress else ''}{text or label}")
        self.buttons.append(SimpleNamespace(idname=name))
        return self.buttons[-1]

    def template_icon(self, icon_value: int, scale: float) -> None:
        assert scale > 1.0
        self.shown.append("picture")

    def progress(self, factor: float, text: str, **_options: Any) -> None:
        assert 0.0 <= factor <= 1.0
        self.shown.append(f"progress: {text}")


def drawn(
    panel: str = "BONEMESH_PT_segment_ct", buttons: list[Any] | None = None
) -> list[Any]:
    """Everything that the panel shows now; the values of its buttons are added to `buttons`."""
    shown: list[Any] = []
    layout = Layout(shown, [] if buttons is None else buttons)
    cls = getattr(bpy.types, panel)
    stand_in = SimpleNamespace(layout=layout)
    if hasattr(cls, "draw_fields"):
        stand_in.draw_fields = partial(cls.draw_fields, stand_in)
    cls.draw(stand_in, bpy.context)
    return shown


def main(zip: str, out: str, ct: str) -> dict[str, Any]:
    """Says what is shown without a job and during one."""
    stage.install(zip)
    properties = stage.fill_panel(ct, out)
    panels = [
        bpy.types.BONEMESH_PT_segment_ct,
        bpy.types.BONEMESH_PT_crop,
        bpy.types.BONEMESH_PT_region,
        bpy.types.BONEMESH_PT_after_care,
        bpy.types.BONEMESH_PT_advanced,
    ]
    methods = properties.bl_rna.properties["method"]
    answer = {
        "tabs": [panel.bl_category for panel in panels],
        "closed": [
            "DEFAULT_CLOSED" in getattr(panel, "bl_options", ()) for panel in panels
        ],
        "main": drawn("BONEMESH_PT_segment_ct"),
        "advanced": drawn("BONEMESH_PT_advanced"),
        "crop": drawn("BONEMESH_PT_crop"),
        "methods": [item.identifier for item in methods.enum_items],
        "method": properties.method,
        "region": drawn("BONEMESH_PT_region"),
        "after_care": drawn("BONEMESH_PT_after_care"),
        "limits": {
            name: [field.hard_min, field.hard_max, field.default]
            for name in ("hu_threshold", "cut_thickness", "sample_percent", "sigma")
            for field in [properties.bl_rna.properties[name]]
        },
    }
    properties.fill_holes = "small"
    properties.remove_islands = properties.fill_cavities = "small"
    answer["after_care asked for"] = []
    for properties.reduce_triangles in ("number", "error"):
        answer["after_care asked for"].append(drawn("BONEMESH_PT_after_care"))
    operator, context, gate = press("render_surface_mesh", "render")
    answer["busy"] = drawn("BONEMESH_PT_segment_ct")
    gate.open()
    until_end(operator, context)
    return answer
