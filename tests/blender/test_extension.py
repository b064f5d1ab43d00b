"""The extension as a whole: installing, enabling, disabling, undo, a library that does not load."""

import re
import zipfile
from pathlib import Path

import pytest
from conftest import Blender


def test_it_can_be_disabled_and_enabled_again(blender: Blender, ct: Path) -> None:
    blender.run("render", ct=ct, fields={})
    answer = blender.run("enable_again", ct=ct)
    assert answer["seen"] == [False, True, False, True, False]
    assert answer["enabled"]
    assert answer["result"] == ["FINISHED"]


@pytest.mark.parametrize("edit", [False, True])
def test_both_steps_can_be_undone_and_redone(
    blender: Blender, ct: Path, edit: bool
) -> None:
    answer = blender.run("undo", ct=ct, edit=edit)
    seen = answer["seen"]
    assert seen["done"] == ["bone", "region"]
    assert seen[f"undo {answer['steps']}"] == []
    assert seen[f"redo {answer['steps']}"] == ["bone", "region"]


def test_a_library_that_does_not_load_is_explained_in_the_panel(
    blender: Blender,
) -> None:
    answer = blender.run("broken_library")
    assert "restart Blender" in answer["said"]["missing"]
    assert "0.0.1" in answer["said"]["other version"]
    assert "Restart Blender" in answer["said"]["other version"]
    assert answer["whole"]
    assert not answer["stand_in"]


def test_the_zip_brings_the_guide_with_its_pictures_and_no_links_that_lead_nowhere(
    extension_zip: Path,
) -> None:
    with zipfile.ZipFile(extension_zip) as extension:
        names = set(extension.namelist())
        page = extension.read("guide/index.html").decode()
    pictures = re.findall(r'src="([^"]+)"', page)
    assert len(pictures) > 3
    assert {f"guide/{picture}" for picture in pictures} <= names
    links = re.findall(r'href="([^"]+)"', page)
    assert [link for link in links if not link.startswith(("https://", "#"))] == []
    anchors = set(re.findall(r'id="([^"]+)"', page))
    assert {link[1:] for link in links if link.startswith("#")} <= anchors


def test_the_zip_brings_its_wheel_its_licences_its_guide_and_nothing_else(
    extension_zip: Path,
) -> None:
    with zipfile.ZipFile(extension_zip) as extension:
        names = extension.namelist()
    assert "LICENSE" in names
    assert any(name.startswith("licenses/") for name in names)
    assert [n for n in names if n.endswith(".whl") and "-abi3-" in n]
    expected = (".py", ".toml", ".whl", "LICENSE")
    assert all(
        n.endswith(expected) or n.startswith(("licenses/", "guide/")) or n.endswith("/")
        for n in names
    )
