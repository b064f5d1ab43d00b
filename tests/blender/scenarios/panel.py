"""What the panels show, read from a layout that takes notes instead of drawing."""

import shutil
from functools import partial
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import bpy
import stage
from background import press, until_end


class Layout:
    """Notes every label, field and button in the order in which they are drawn; a box is a list of its own."""

    def __init__(
        self,
        shown: list[Any],
        buttons: list[Any],
        placeholders: dict[str, str] | None = None,
    ) -> None:
        self.shown = shown
        self.buttons = buttons
        self.placeholders = {} if placeholders is None else placeholders

    def column(self, **_options: Any) -> "Layout":
        return self

    row = split = grid_flow = column

    def box(self) -> "Layout":
        self.shown.append([])
        return Layout(self.shown[-1], self.buttons, self.placeholders)

    def separator(self, factor: float) -> None:
        pass

    def label(self, text: str, icon: str = "NONE", **_options: Any) -> None:
        self.shown.append(f"! {text}" if icon == "ERROR" else text)

    def prop(
        self,
        data: Any,
        name: str,
        text: str | None = None,
        placeholder: str = "",
        **_options: Any,
    ) -> None:
        self.placeholders[name] = placeholder
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
    panel: str = "BONEMESH_PT_segment_ct",
    buttons: list[Any] | None = None,
    placeholders: dict[str, str] | None = None,
) -> list[Any]:
    """Everything that the panel shows now; its buttons' values and its fields' placeholders are added to the others."""
    shown: list[Any] = []
    layout = Layout(shown, [] if buttons is None else buttons, placeholders)
    cls = getattr(bpy.types, panel)
    stand_in = SimpleNamespace(layout=layout)
    if hasattr(cls, "draw_fields"):
        stand_in.draw_fields = partial(cls.draw_fields, stand_in)
    cls.draw(stand_in, bpy.context)
    return shown


def placeholders() -> dict[str, str]:
    """What the empty fields of the panel show."""
    found: dict[str, str] = {}
    drawn(placeholders=found)
    return {name: found[name] for name in ("mesh_directory", "mesh_name", "roi_name")}


def picker(name: str) -> list[str]:
    """What a file browser says at its side."""
    shown: list[Any] = []
    cls = getattr(bpy.types, f"BONEMESH_OT_{name}")
    stand_in = SimpleNamespace(layout=Layout(shown, []), advice=cls.advice)
    cls.draw(stand_in, bpy.context)
    return shown


def empty_fields(ct: str, out: str) -> dict[str, Any]:
    """Presses Render Surface Mesh with no names and no folder, the images in a folder of their own."""
    beside = Path(out) / "beside"
    shutil.copytree(ct, beside / "images")
    properties = bpy.context.scene.bonemesh
    stage.addon_scanning()
    properties.mesh_name = properties.mesh_directory = properties.roi_name = ""
    properties.ct_directory = str(beside / "images")
    bpy.ops.bonemesh.scan_ct_directory()
    answer: dict[str, Any] = {"shown": placeholders(), "folder": str(beside)}
    bpy.ops.object.select_all(action="DESELECT")
    bone = bpy.context.view_layer.objects.active
    bpy.data.objects.remove(bone)
    answer["next"] = drawn()[0]
    operator, context, gate = press("render_surface_mesh", "render")
    gate.open()
    answer["end"] = until_end(operator, context)
    answer["files"] = sorted(p.name for p in beside.iterdir() if p.is_file())
    answer["then"] = placeholders()
    fields = ("mesh_name", "mesh_directory", "roi_name")
    answer["fields"] = [getattr(properties, name) for name in fields]
    return answer


def main(zip: str, out: str, ct: str) -> dict[str, Any]:
    """Says what is shown without a job and during one."""
    stage.install(zip)
    stage.clear_scene()
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
    answer["with a mesh"] = drawn("BONEMESH_PT_segment_ct")
    for name in ("ct picker", "mesh picker"):
        answer[name] = picker(f"choose_{name.split()[0]}_directory")
    properties.mesh_name = ""
    answer["empty for a script"] = stage.message_of(
        bpy.ops.bonemesh.render_surface_mesh
    )
    answer["empty"] = empty_fields(ct, out)
    return answer
