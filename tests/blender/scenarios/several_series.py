"""Renders from a folder with two series: as a script does, as a button does, and by a click on the list."""

import shutil
from pathlib import Path
from typing import Any

import bpy
import stage
from background import until_end
from contents import rows, until_scanned


def press_render() -> list[list[str]]:
    """Presses the button; returns what is reported."""
    operator, context = stage.pressed("render_surface_mesh"), stage.FakeContext()
    result = operator.invoke(context, stage.event("LEFTMOUSE"))
    assert result == {"RUNNING_MODAL"}, operator.reports
    until_end(operator, context)
    return [list(report) for report in operator.reports]


def rendered(folder: Path, name: str) -> str:
    """Saves the arrays of the object `name`."""
    return stage.save_mesh(folder / f"{name}.npz", bpy.data.objects[name])


def main(zip: str, out: str, two: str, own_uids: str) -> dict[str, Any]:
    """Says which series was rendered in each case."""
    folder = Path(out)
    stage.install(zip)
    properties = stage.fill_panel(two, out)
    by_script = stage.message_of(bpy.ops.bonemesh.render_surface_mesh)
    unseen = press_render()
    until_scanned()
    properties.mesh_name = "marked"
    marked = press_render()
    properties.mesh_name = "clicked"
    row = rows()[1]
    bpy.ops.bonemesh.choose_series(number=row.number, title=row.title)
    clicked = press_render()
    changing = folder / "changing"
    shutil.copytree(two, changing)
    properties.ct_directory = str(changing)
    until_scanned()
    properties.mesh_name = "renumbered"
    bpy.ops.bonemesh.choose_series(number=2)
    for file in sorted((changing / "first").rglob("*.dcm"))[:30]:
        file.unlink()  # the second series is the larger one now
    renumbered = press_render()
    properties.mesh_name = "one"
    properties.ct_directory = own_uids
    each = until_scanned()
    properties.one_series = True
    as_one = until_scanned()
    bpy.ops.bonemesh.render_surface_mesh()
    return {
        "by script": by_script,
        "unseen": unseen,
        "marked": [marked, rendered(folder, "marked")],
        "clicked": [clicked, rendered(folder, "clicked")],
        "renumbered": [renumbered, rendered(folder, "renumbered")],
        "each": each,
        "as one": [as_one, rendered(folder, "one")],
    }
