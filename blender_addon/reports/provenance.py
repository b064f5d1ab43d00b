# SPDX-License-Identifier: GPL-3.0-or-later
"""How a bone was rendered, and the panel's fields that render it so again. Knows no bpy.

Facts are the report of the library's `render`: on the object its parts, beside a mesh file all of it as
JSON. What they say of options are the keyword arguments of `render`; this is the way back from
`inputs.RenderInputs`.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from ..request.inputs import RefusalError

Facts = dict[str, Any]

MOST_BYTES = 1_000_000  # a file beside a mesh has a few thousand
# Options that the panel has no field for, with the values it renders with.
WITHOUT_FIELD = {
    "local_leeway_hu": None,
    "seed": 0,
    "alpha_mm": None,
    "radii_mm": None,
    "depth": 8,
    "scale": 1.1,
    "true_edges": True,
}


def read_sidecar(path: Path) -> Facts:
    """The facts in the file beside a mesh."""
    try:
        with path.open(encoding="utf-8") as file:
            facts = json.loads(file.read(MOST_BYTES))
    except ValueError:
        facts = None
    if not isinstance(facts, dict) or not isinstance(facts.get("options"), dict):
        raise RefusalError(
            f"{path} does not say how a bone was rendered; choose a file such as bone.stl.json, which was saved beside a mesh"
        )
    return facts


def remove_sidecar(mesh: Path) -> None:
    """Takes away what tells of the mesh that a file held before; any other file of that name stays."""
    path = Path(f"{mesh}.json")
    try:
        with path.open(encoding="utf-8") as file:
            facts = json.loads(file.read(MOST_BYTES))
        if isinstance(facts, dict) and facts.get("file") == mesh.name:
            path.unlink()
    except (OSError, ValueError):
        return  # there is none, or it is somebody else's


def fields(facts: Facts) -> dict[str, Any]:
    """The fields of `scene.bonemesh`, by name, as they were for this rendering."""
    options = facts["options"]
    threshold = facts.get("threshold_hu", options.get("threshold_hu"))
    if not is_number(threshold):
        threshold = options.get("threshold_hu")
    values = {
        "hu_threshold": round(threshold) if is_number(threshold) else None,
        "method": options.get("method"),
        "series": facts.get("series_uid") or "",
        "one_series": bool(options.get("one_series")),
        "crop": options.get("crop") or "",
        "damp_metal": bool(options.get("damp_metal")),
        "leave_out_table": not options.get("keep_table"),
        "sigma": options.get("sigma"),
        "sampler": options.get("sampler"),
        # Below 100 the published targeted sampling is used; its own percentages decide.
        "sample_percent": options.get("sample_percent")
        or (50.0 if options.get("sampler") == "thesis-targeted" else 100.0),
        **after_care_fields(options),
    }
    return {name: value for name, value in values.items() if value is not None}


def after_care_fields(options: dict[str, Any]) -> dict[str, Any]:
    """Those of the panel's part After-Care."""
    holes, islands = options.get("holes"), options.get("islands")
    cavities, smooth_mm = options.get("cavities"), options.get("smooth_mm")
    triangles, decimate_mm = options.get("triangles"), options.get("decimate_mm")
    values: dict[str, Any] = {"smooth_mm": smooth_mm or 0.0}
    values |= choice(
        "fill_holes", "holes_mm", holes, words={None: "none", "all": "all"}
    )
    values |= choice(
        "fill_cavities", "cavities_mm3", cavities, words={None: "none", "all": "all"}
    )
    values |= choice(
        "remove_islands",
        "islands_mm3",
        islands,
        words={None: "specks", "largest": "others", 0.0: "none"},
    )
    values["reduce_triangles"] = "none"
    if triangles is not None:
        values |= {"reduce_triangles": "number", "triangles": triangles}
    elif decimate_mm is not None:
        values |= {"reduce_triangles": "error", "decimate_mm": decimate_mm}
    return values


def choice(
    field: str, number_field: str, value: Any, words: dict[Any, str]
) -> dict[str, Any]:
    """A field of names, and the number that goes with its name "small"."""
    if isinstance(value, list):  # places, which the panel cannot give
        return {}
    if value in words:
        return {field: words[value]}
    return {field: "small", number_field: value}


def without_field(facts: Facts) -> list[str]:
    """What was chosen for the rendering and has no field in the panel, as `name = value`."""
    options = facts["options"]
    chosen = {
        name: options[name]
        for name, usual in WITHOUT_FIELD.items()
        if options.get(name, usual) != usual
    }
    if isinstance(options.get("islands"), list):
        chosen["islands"] = options["islands"]
    return [f"{name} = {value}" for name, value in chosen.items()]


def is_number(value: Any) -> bool:
    """Whether it is one; True and False are none."""
    return isinstance(value, (int, float)) and not isinstance(value, bool)
