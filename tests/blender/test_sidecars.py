"""An exported file that replaces a mesh takes away what told of that, and nothing else (needs no Blender)."""

import json
from pathlib import Path

import pytest

from blender_addon.reports.provenance import remove_sidecar


@pytest.mark.parametrize(
    ("text", "stays"),
    [
        (json.dumps({"file": "bone.stl", "unit": "mm"}), False),
        (json.dumps({"file": "other.stl"}), True),
        (json.dumps(["bone.stl"]), True),
        ("notes of mine", True),
    ],
)
def test_only_what_tells_of_the_mesh_goes(
    tmp_path: Path, text: str, stays: bool
) -> None:
    beside = tmp_path / "bone.stl.json"
    beside.write_text(text)
    remove_sidecar(tmp_path / "bone.stl")
    assert beside.exists() == stays


def test_none_is_no_error(tmp_path: Path) -> None:
    remove_sidecar(tmp_path / "bone.stl")
