"""A coarse surface follows the slider, gets into nobody's way, and is gone when it has to be."""

from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from conftest import Blender

GONE = -1


@pytest.fixture(scope="module")
def answers(
    extension_zip: Path, ct: Path, two: Path, tmp_path_factory: pytest.TempPathFactory
) -> dict[str, Any]:
    folder = tmp_path_factory.mktemp("preview")
    return Blender(extension_zip, folder).run("preview", ct=ct, two=two)


def test_choosing_images_is_enough_to_see_their_bone(
    answers: dict[str, Any], ct: Path, bonemesh: ModuleType
) -> None:
    assert answers["nothing chosen"] == GONE
    first = answers["first"]
    assert first["name"] == "Bonemesh Preview"
    assert first["vertices"][0] == first["vertices"][1]
    rendered = bonemesh.render(ct, threshold_hu=350)
    assert np.allclose(first["lowest"], rendered.vertices.min(axis=0), atol=2.0)
    assert np.allclose(first["highest"], rendered.vertices.max(axis=0), atol=2.0)
    assert first["unit"] == "MILLIMETERS"
    assert first["timer"]


def test_it_is_seen_but_neither_selected_nor_rendered(answers: dict[str, Any]) -> None:
    first = answers["first"]
    assert first["visible"]
    assert not first["selectable"]
    assert not first["selected"]
    assert not first["rendered"]


def test_the_histogram_and_its_thresholds_are_shown_each_a_button(
    answers: dict[str, Any], ct: Path, bonemesh: ModuleType
) -> None:
    panel = answers["panel"]
    suggestions = bonemesh.suggest_thresholds(bonemesh.read_series(ct))
    assert panel["thresholds"] == [round(s["threshold_hu"]) for s in suggestions]
    for title, suggestion in zip(panel["titles"], suggestions, strict=True):
        assert suggestion["reason"] in title
    fold, picture, *buttons = panel["open"]
    assert fold == "Histogram [show_histogram]"
    assert picture == "picture"
    assert len(buttons) == len(suggestions)
    assert [b for b in buttons if b.startswith("> ")] == ["> Skull 350"]


def test_folded_in_the_recommended_threshold_is_at_hand(
    answers: dict[str, Any],
) -> None:
    fold, button = answers["panel"]["closed"]
    assert fold == "Histogram [show_histogram]"
    assert button in answers["panel"]["open"]


@pytest.mark.parametrize("how", ["slider", "pressed", "crop", "again"])
def test_it_follows_the_threshold_and_the_crop_box(
    answers: dict[str, Any], how: str
) -> None:
    shown, expected = answers["moved"][how]
    assert shown == expected > 0


@pytest.mark.parametrize(
    ("how", "words"), [("no box", "left half"), ("nothing", "threshold")]
)
def test_where_there_is_nothing_to_see_the_reason_is_said(
    answers: dict[str, Any], how: str, words: str
) -> None:
    shown, said = answers["moved"][how]
    assert shown == GONE
    assert words in said
    assert answers["moved"]["no problem"]
    assert any(line.startswith("! ") for line in answers["moved"]["said"])


def test_it_can_be_switched_off(answers: dict[str, Any]) -> None:
    switched = answers["switched"]
    assert switched["off"] == [GONE, [], GONE]
    assert switched["on"][0] == switched["on"][1] > 0


def test_who_deletes_it_gets_it_back_with_the_slider(answers: dict[str, Any]) -> None:
    assert answers["deleted"] == {"gone": GONE, "back": True, "during": True}


def test_undo_and_redo_leave_the_preview_of_the_threshold(
    answers: dict[str, Any],
) -> None:
    undone = answers["undone"]
    assert all(shown == expected > 0 for shown, expected in undone["steps"])
    shown, expected, mode = undone["edit mode"]
    assert shown == expected > 0
    assert mode == "EDIT_MESH"
    assert undone["undone in edit mode"][0] > 0


def test_no_file_holds_it(answers: dict[str, Any]) -> None:
    saved = answers["saved"]
    assert saved["before"] == saved["after"] > 0
    assert saved["inside"] == []
    assert saved["opened"] == [GONE, False]


def test_other_images_take_it_away_and_bring_theirs(answers: dict[str, Any]) -> None:
    assert answers["folder"] == {
        "seen": [True, GONE, True, True, True],
        "none chosen": GONE,
    }


def test_the_surface_itself_takes_its_place(answers: dict[str, Any]) -> None:
    assert answers["rendered"] == {"before": True, "after": GONE, "slider": True}


NOTHING = {"objects": 0, "data": [], "running": 0, "timer": False}


@pytest.mark.parametrize("when", ["reading", "shown"])
def test_disabling_the_addon_takes_everything_away(
    blender: Blender, ct: Path, when: str
) -> None:
    answer = blender.run("preview_interrupted", ct=ct, how=f"disable {when}")
    del answer["log"]
    assert answer == NOTHING | {"handlers": 0}


@pytest.mark.parametrize("when", ["reading", "shown"])
@pytest.mark.parametrize("what", ["home", "open"])
def test_another_file_ends_it_even_if_its_images_are_gone(
    blender: Blender, ct: Path, what: str, when: str
) -> None:
    answer = blender.run("preview_interrupted", ct=ct, how=f"{what} {when}")
    assert answer["objects"] == answer["running"] == 0


@pytest.mark.parametrize("when", ["reading", "shown"])
def test_another_scene_has_none(blender: Blender, ct: Path, when: str) -> None:
    answer = blender.run("preview_interrupted", ct=ct, how=f"scene {when}")
    assert answer["objects"] == answer["running"] == 0


@pytest.mark.parametrize("when", ["reading", "shown"])
def test_quitting_during_it_is_clean(blender: Blender, ct: Path, when: str) -> None:
    answer = blender.run("preview_interrupted", ct=ct, how=f"quit {when}")
    assert answer["objects"] == (1 if when == "shown" else 0)
    assert [p.name for p in blender.out.iterdir()] == ["preview_interrupted.json"]
