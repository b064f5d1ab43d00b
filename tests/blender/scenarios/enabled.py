"""The extension that another process installed, enabled: which version it is and what its panel says."""

import importlib
from typing import Any

import bpy
import stage
from broken_library import panel_says


def main(zip: str, out: str) -> dict[str, Any]:
    """Enables and describes it."""
    bpy.ops.preferences.addon_enable(module=stage.MODULE)
    return described()


def described() -> dict[str, Any]:
    """What a user has of the extension now."""
    stands_in = hasattr(bpy.types, "BONEMESH_PT_without_library")
    return {
        "has_fields": hasattr(bpy.context.scene, "bonemesh"),
        "said": panel_says() if stands_in else "",
        "manifest": importlib.import_module(f"{stage.MODULE}.library").addon_version(),
        "library": importlib.import_module("bonemesh").__version__,
    }
