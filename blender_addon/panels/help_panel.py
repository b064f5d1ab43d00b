# SPDX-License-Identifier: GPL-3.0-or-later
"""The part "Help" of the tab: the keys one has to know, and the guide, which is in the extension itself."""

from pathlib import Path

import bpy
from bpy.types import Context, Panel, UILayout

from ..library import addon_version
from .part import Part
from .text import draw_text

GUIDE = Path(__file__).parents[1] / "guide" / "index.html"
KEYS = (
    (
        "MOUSE_MMB_DRAG",
        "Turn the view: drag with the middle mouse button; the wheel comes nearer",
    ),
    (
        "MOUSE_LMB_DRAG",
        "Lasso: press Select with Lasso and drag with the left mouse button; Tab ends it",
    ),
    ("EVENT_ESC", "Stop what is running"),
)
NOTICE = "Not a medical device: look at every result beside the images it was made of"


class BONEMESH_PT_help(Part, Panel):
    """Where to find help; nothing of it needs a network."""

    bl_label = "Help"

    def draw_fields(self, context: Context, layout: UILayout) -> None:
        """Draws the guide's button, the keys and the notice."""
        if GUIDE.is_file():
            guide = layout.operator("wm.url_open", text="Open the Guide", icon="HELP")
            guide.url = GUIDE.as_uri()
        for icon, text in KEYS:
            draw_text(layout, context, text, icon=icon)
        draw_text(layout, context, NOTICE, icon="INFO")
        layout.label(text=f"Bonemesh {addon_version()}", icon="BLANK1")


def register() -> None:
    """Adds the part below the others."""
    bpy.utils.register_class(BONEMESH_PT_help)


def unregister() -> None:
    """Takes it away."""
    bpy.utils.unregister_class(BONEMESH_PT_help)
