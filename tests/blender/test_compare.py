"""Compare Meshes: distances as the API has them, on the mesh, in colours and in words."""

from typing import Any

import numpy as np
import pytest
from conftest import Blender


@pytest.fixture(scope="module")
def run(extension_zip: Any, tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    return Blender(extension_zip, tmp_path_factory.mktemp("compare")).run("compare")


def words(shown: list[Any]) -> str:
    """Everything in the panel as one text, boxes laid open."""
    rows = ([row] if isinstance(row, str) else row for row in shown)
    return " ".join(row for several in rows for row in several)


def test_a_ball_lies_inside_of_a_larger_one(run: dict[str, Any]) -> None:
    assert run["result"] == ["FINISHED"]
    low, high = run["compared"]["distances"]
    assert -0.51 < low <= high < -0.45


def test_the_colours_are_seen_and_follow_their_scale(run: dict[str, Any]) -> None:
    shown, grey, blue = run["compared"], np.array(run["grey"]), np.array(run["blue"])
    assert shown["active colour"] == "distance"
    assert shown["shading"] == "VERTEX"
    half = sum(shown["distances"]) / 2
    np.testing.assert_allclose(shown["colour"], grey - half * (blue - grey), atol=0.02)
    np.testing.assert_allclose(run["full colour"], blue, atol=1e-5)


def test_they_can_be_switched_off_and_on(run: dict[str, Any]) -> None:
    assert run["plain"] == ["MATERIAL", False]
    assert run["shown again"] == ["VERTEX", True]


def test_the_panel_tells_it_in_words(run: dict[str, Any]) -> None:
    told = words(run["compared"]["panel"])
    assert "first against other" in told
    assert "Half of its vertices are within 0.5 mm of other" in told.replace(
        "0.50", "0.5"
    )
    assert "95 % within 0.50 mm" in told
    assert "95 % of other are within" in told
    assert "Red lies outside of other, blue inside" in told


def test_what_was_moved_or_removed_since_is_not_told_as_true(
    run: dict[str, Any],
) -> None:
    for case in ("moved", "without the other"):
        assert "press Compare Meshes again" in words(run[case])
        assert "95 %" not in words(run[case])


def test_meshes_are_compared_where_they_are_in_the_scene(run: dict[str, Any]) -> None:
    low, high = run["compared anew"]
    assert low == pytest.approx(-1.5, abs=0.05)
    assert high == pytest.approx(0.5, abs=0.05)
    low, high = run["other way"]
    assert low == pytest.approx(-0.5, abs=0.05)
    assert high == pytest.approx(1.5, abs=0.05)


@pytest.mark.parametrize(
    ("case", "said"),
    [
        ("alone", "select the mesh to compare with"),
        ("three", "more than two meshes are selected"),
        ("edit mode", "leave Edit Mode first"),
        ("none active", "Select two meshes"),
        ("nothing there", "triangle"),
    ],
)
def test_refusals_name_the_remedy(run: dict[str, Any], case: str, said: str) -> None:
    assert said in run["refused"][case]
    assert "\n" not in run["refused"][case]


def test_it_runs_beside_the_window(run: dict[str, Any]) -> None:
    pressed = run["pressed"]
    assert "Compare Meshes" in pressed["busy"]
    end, ((kind, text),) = pressed["end"]
    assert (end, kind) == (["FINISHED"], "INFO")
    assert "95 % within" in text
    assert pressed["cancelled"] == [
        ["CANCELLED"],
        [["INFO", "Stopped; nothing was kept"]],
    ]
    end, ((kind, text),) = pressed["changed"]
    assert (end, kind) == (["CANCELLED"], "ERROR")
    assert "changed meanwhile" in text
