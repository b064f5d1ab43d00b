"""The compiled part is missing or of another version: the panel says so, nothing ends in a traceback."""

import sys
from types import ModuleType
from typing import Any

import bpy
import stage


def panel_says() -> str:
    """The text of the panel that stands in."""
    lines = []

    class Column:
        def column(self, align: bool = False) -> "Column":
            return self

        def label(self, text: str = "", icon: str = "NONE") -> None:
            lines.append(text)

    class Layout:
        def column(self, align: bool = False) -> Column:
            return Column()

    class Drawn:
        layout = Layout()

    bpy.types.BONEMESH_PT_without_library.draw(Drawn(), bpy.context)
    return " ".join(lines)


def main(zip: str, out: str) -> dict[str, Any]:
    """Says what the panel says in each case, and that a repaired one is whole again."""
    stage.install(zip)
    bpy.ops.preferences.addon_disable(module=stage.MODULE)
    whole = sys.modules.pop("bonemesh")
    said = {}
    other = ModuleType("bonemesh")
    other.__version__ = "0.0.1"
    for case, module in (("missing", None), ("other version", other)):
        sys.modules["bonemesh"] = module
        bpy.ops.preferences.addon_enable(module=stage.MODULE)
        said[case] = panel_says()
        bpy.ops.preferences.addon_disable(module=stage.MODULE)
    sys.modules["bonemesh"] = whole
    bpy.ops.preferences.addon_enable(module=stage.MODULE)
    return {
        "said": said,
        "whole": hasattr(bpy.context.scene, "bonemesh"),
        "stand_in": hasattr(bpy.types, "BONEMESH_PT_without_library"),
    }
