"""Suggested names say what the images show, hold nobody's name, and are free; folders are such as can be written to (needs no Blender)."""

import os
from pathlib import Path

import pytest

from blender_addon.request import naming


@pytest.mark.parametrize(
    ("description", "stem"),
    [
        ("HEAD 0.75 H60s", "head"),
        ("Phantom head", "phantom head"),
        ("MÜLLER^HANS Schädel 1,0", "schädel"),
        ("Left_Knee, left knee", "left knee"),
        ("Doe Jane 1975-03-02", "bone"),
        ("", "bone"),
        ("head neck chest pelvis knee", "head neck chest pelvis"),
    ],
)
def test_a_name_is_made_of_words_that_name_nobody(description: str, stem: str) -> None:
    assert naming.stem_of(description) == stem


def test_a_name_that_is_taken_gets_a_number() -> None:
    taken = {"head", "head-2"}
    assert naming.free("head", taken.__contains__) == "head-3"
    assert naming.free("knee", taken.__contains__) == "knee"


@pytest.mark.parametrize(
    ("name", "stem"),
    [("skull.001", "skull.001"), ("a/b: c. ", "a-b- c"), ("..", "bone")],
)
def test_any_object_can_give_its_name_to_a_file(name: str, stem: str) -> None:
    assert naming.as_stem(name) == stem


def test_meshes_go_to_the_scene_or_beside_the_images_or_to_the_documents(
    tmp_path: Path,
) -> None:
    home, images, scene = tmp_path / "me", tmp_path / "a" / "ct", tmp_path / "b"
    for folder in (home / "Documents", images, scene):
        folder.mkdir(parents=True)

    def suggested(blend: str, ct: str) -> str:
        return naming.folder(naming.candidates(blend, ct, home))

    assert suggested(str(scene / "plan.blend"), str(images)) == str(scene)
    assert suggested("", str(images)) == str(images.parent)
    assert suggested("", str(images) + os.sep) == str(images.parent)
    assert suggested("", str(tmp_path / "gone" / "ct")) == str(home / "Documents")
    assert suggested("", f"{Path(tmp_path.anchor) / 'ct'}") == str(home / "Documents")
    assert suggested("", "") == ""
