"""Measure, cut, mirror: the buttons of the panel's part Region."""

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import Blender


@pytest.fixture(scope="module")
def answer(
    extension_zip: Path, ct: Path, tmp_path_factory: pytest.TempPathFactory
) -> dict[str, Any]:
    blender = Blender(extension_zip, tmp_path_factory.mktemp("mirror"))
    return blender.run("mirror_region", ct=ct)


def places(answer: dict[str, Any], name: str) -> Any:
    return np.load(answer[name])["patient"].astype(float)


def test_the_thickness_under_the_selection_is_told(answer: dict[str, Any]) -> None:
    median, least, largest = map(
        float, re.findall(r"[0-9]+\.[0-9]+", answer["measured"])
    )
    assert 0.0 < least <= median <= largest < 20.0


def test_each_direction_lies_where_it_should(answer: dict[str, Any]) -> None:
    bone = np.load(answer["patch"])
    patch = bone["patient"][bone["selected"]].astype(float)
    front = patch[:, 1].min()
    inward, plate = places(answer, "inward"), places(answer, "plate")
    assert inward[:, 1].min() == pytest.approx(front, abs=0.3)
    assert inward[:, 1].max() > front + 3.0
    assert plate[:, 1].min() == pytest.approx(front - 4.5, abs=0.3)
    assert answer["plate properties"]["clearance_mm"] == pytest.approx(0.5)
    assert answer["thrice properties"]["direction"] == "through"


def test_the_template_is_the_other_side_brought_back(answer: dict[str, Any]) -> None:
    inward, other = places(answer, "inward"), places(answer, "other")
    template = places(answer, "template")
    assert other[:, 1].min() > 0 > template[:, 1].max()
    for axis in range(3):
        assert template[:, axis].min() == pytest.approx(inward[:, axis].min(), abs=1.0)
    assert answer["other properties"]["mirror"] == "y"
    assert answer["template properties"]["mirror_back"]


def test_regions_have_a_collection_of_their_own(answer: dict[str, Any]) -> None:
    for name in ("inward", "plate", "template"):
        assert answer[f"{name} collections"] == ["Regions of Interest"]


def test_a_plane_goes_through_three_vertices(answer: dict[str, Any]) -> None:
    assert "exactly three" in answer["two points"]
    assert answer["three points"] == ""
    kind, (x, y, z, offset) = answer["plane"]
    assert kind == "given"
    bone = np.load(answer["patch"])["patient"].astype(float)
    for vertex in (0, 500, 1000):
        assert bone[vertex] @ [x, y, z] == pytest.approx(offset, abs=1e-3)


def test_a_cut_along_the_view_goes_where_the_user_looks(
    answer: dict[str, Any],
) -> None:
    assert answer["view"] == pytest.approx([0.0, 1.0, 0.0], abs=1e-6)


def test_a_region_is_taken_up_again_with_its_selection_and_settings(
    answer: dict[str, Any],
) -> None:
    for name in ("plate", "template", "seen"):
        resumed = answer[f"{name} resumed"]
        assert resumed["mode"] == "EDIT_MESH"
        assert resumed["active"] == "bone"
        assert resumed["thickness"] == pytest.approx(4.0)
        assert resumed["same vertices"] and resumed["faces"] > 100
    plate, template, seen = (
        answer[f"{name} resumed"] for name in ("plate", "template", "seen")
    )
    assert plate["direction"][0] == "outward"
    assert plate["clearance"] == pytest.approx(0.5)
    assert template["plane"] == "y" and template["mirror_back"]
    kind, direction = seen["direction"]
    assert kind == "given"
    assert direction == pytest.approx([0.0, 1.0, 0.0], abs=1e-6)
    assert "renamed" not in answer["source gone"]
    assert "is gone" in answer["source gone"]
    assert "no longer says how" in answer["settings gone"]
