# SPDX-License-Identifier: GPL-3.0-or-later
"""What stands in the fields for names and folder as long as they are empty: shown in grey, and used.

Only where there is a window, in which the user sees it; a script says what it wants.
"""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any, ClassVar

import bpy

from ..scene.selection import CENTRE_MM
from ..series import scanning
from . import naming
from .inputs import RefusalError, file_stem

ASKED_EVERY_S = (
    2.0  # the panel is drawn far more often, and a folder may be on a slow network
)


class Filled:
    """A group of properties, such as `scene.bonemesh`, with other values for some."""

    def __init__(self, properties: Any, **filled: Any) -> None:
        self._properties = properties
        self._filled = filled

    def __getattr__(self, name: str) -> Any:
        if name in self._filled:
            return self._filled[name]
        return getattr(self._properties, name)


class Seen:
    """What was found on the disk last, and when."""

    answers: ClassVar[dict[Any, tuple[float, Any]]] = {}


def filled(context: Any, *, anew: bool = False) -> Any:
    """`scene.bonemesh`, completed; `anew` looks at the disk now, before something is written to it."""
    properties = context.scene.bonemesh
    if not scanning.is_watched:
        return properties
    if anew:
        forget()
    folder = properties.mesh_directory.strip() or mesh_folder(properties)
    mesh_name = properties.mesh_name.strip() or free_mesh_name(properties, folder)
    roi_name = properties.roi_name.strip() or free_roi_name(context, folder)
    return Filled(
        properties, mesh_directory=folder, mesh_name=mesh_name, roi_name=roi_name
    )


def forget() -> None:
    """Forgets what was found on the disk: something was written to it."""
    Seen.answers.clear()


def mesh_folder(properties: Any) -> str:
    """A folder that the user will look into; empty as long as there is neither a file nor images."""
    images = bpy.path.abspath(properties.ct_directory)
    places = naming.candidates(bpy.data.filepath, images, Path.home())
    return lately(("folder", *places), lambda: naming.folder(places))


def free_mesh_name(properties: Any, folder: str) -> str:
    """After what the marked series shows; empty as long as it is not known."""
    series = scanning.marked_series(properties)
    if series is None or not folder:
        return ""
    return free(naming.stem_of(series.description), folder)


def free_roi_name(context: Any, folder: str) -> str:
    """After the mesh that it is cut from."""
    active = context.active_object
    is_mesh = active is not None and active.type == "MESH"
    # Not the cube that a new scene begins with.
    is_meant = is_mesh and (active.mode == "EDIT" or CENTRE_MM in active)
    if not is_meant or not folder:
        return ""
    return free(f"{naming.as_stem(active.name)} region", folder)


def mirrored_name(context: Any, folder: str) -> str:
    """After the mesh whose other side it is; empty for a script, which names what it makes."""
    if not scanning.is_watched:
        return ""
    return free(f"{naming.as_stem(context.active_object.name)} mirrored", folder)


def export_name(context: Any, folder: str) -> str:
    """What an exported file is called where no name is typed: after its object and frame, replacing none."""
    output, active = context.scene.bonemesh_output, context.active_object
    if active is None or output.file_name.strip() or not scanning.is_watched:
        return ""
    stem = naming.as_stem(active.name)
    if output.frame != "LPS":
        stem += f" {output.frame}"
    return naming.free(stem, lambda name: is_there(folder, name, output.format))


def free(stem: str, folder: str) -> str:
    """A name that no file in the folder and no object has."""

    def is_taken(name: str) -> bool:
        return name in bpy.data.objects or is_there(folder, name)

    return naming.free(stem, is_taken)


def is_there(folder: str, name: str, ending: str = "stl") -> bool:
    """Whether the folder has the file of that name."""
    try:
        stem = file_stem(name, "")
    except RefusalError:
        return False
    path = Path(bpy.path.abspath(folder), f"{stem}.{ending}")
    return bool(lately(("file", path), path.exists))


def lately(key: Any, ask: Any) -> Any:
    """The answer to `ask`, or the one of a moment ago."""
    now_s = time.monotonic()
    asked_s, answer = Seen.answers.get(key, (-ASKED_EVERY_S, None))
    if now_s - asked_s >= ASKED_EVERY_S:
        answer = ask()
        Seen.answers[key] = (now_s, answer)
    return answer
