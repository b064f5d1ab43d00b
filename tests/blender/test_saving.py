"""No work is lost when a disk fails, a bone is made anew or another scene is looked at; other images begin afresh."""

import os
from typing import Any

import pytest
from conftest import Blender


@pytest.fixture(scope="module")
def run(
    extension_zip: Any, ct: Any, two: Any, tmp_path_factory: pytest.TempPathFactory
) -> Any:
    """One Blender for all."""
    blender = Blender(extension_zip, tmp_path_factory.mktemp("saving"))
    return blender.run("saving", ct=ct, two=two)


def test_what_cannot_be_saved_is_in_the_scene(run: dict[str, Any]) -> None:
    answer = run["not saved"]
    assert answer["ended"] == ["FINISHED"]
    assert answer["faces"] > 1000
    (why,) = [text for kind, text in answer["said"] if kind == "WARNING"]
    assert "Not saved" in why
    assert "Export saves it" in why
    assert "meshes" in why


def test_a_bone_that_is_made_anew_replaces_the_one_before(run: dict[str, Any]) -> None:
    answer = run["made anew"]
    assert answer["names"] == ["bone before", "bone"]
    assert answer["seen"] == [False, True]
    assert answer["source"] == "bone before"


def test_a_bone_comes_into_the_scene_it_was_begun_in(run: dict[str, Any]) -> None:
    assert run["another scene"] == [run["first scene"]]


def test_crop_and_series_are_of_the_images_they_were_chosen_in(
    run: dict[str, Any],
) -> None:
    assert run["other images"]["crop"] == ""
    assert run["other images"]["series"] == ""


def test_a_typed_slice_stands_for_its_folder(run: dict[str, Any]) -> None:
    answer = run["other images"]
    assert answer["folder"] == os.path.join(answer["expected"], "")
