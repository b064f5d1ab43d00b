"""What is missing and what is next is said in plain words (needs no Blender)."""

from types import ModuleType, SimpleNamespace
from typing import Any

import pytest


@pytest.fixture(scope="module")
def steps(bonemesh: ModuleType) -> ModuleType:
    from blender_addon.request import steps

    return steps


FILLED = {
    "ct_directory": "/ct",
    "mesh_directory": "/out",
    "mesh_name": "bone",
    "roi_name": "region",
}


def fields(**changes: str) -> Any:
    return SimpleNamespace(**(FILLED | changes))


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("ct_directory", "Select File Directory of CT Images"),
        ("mesh_name", "Mesh Filename is empty"),
        ("mesh_directory", "Select File Location to Save Mesh"),
    ],
)
def test_a_surface_needs_images_a_name_and_a_folder(
    steps: ModuleType, name: str, words: str
) -> None:
    assert steps.missing_for_surface(fields()) is None
    assert words in steps.missing_for_surface(fields(**{name: " "}))


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("roi_name", "Segmented Mesh Filename is empty"),
        ("mesh_directory", "Select File Location to Save Mesh"),
    ],
)
def test_a_region_needs_a_name_and_a_folder(
    steps: ModuleType, name: str, words: str
) -> None:
    assert steps.missing_for_region(fields()) is None
    assert words in steps.missing_for_region(fields(**{name: ""}))


def test_a_selection_is_missed_only_where_blender_counts_it(steps: ModuleType) -> None:
    def mesh(mode: str, selected: int) -> Any:
        return SimpleNamespace(mode=mode, data=SimpleNamespace(total_vert_sel=selected))

    assert "lasso" in steps.missing_selection(mesh("EDIT", 0))
    assert steps.missing_selection(mesh("EDIT", 3)) is None
    assert steps.missing_selection(mesh("OBJECT", 0)) is None


def test_the_next_step_leads_from_the_folder_to_the_print(steps: ModuleType) -> None:
    empty = steps.Scene(
        has_images=True,
        has_bone=False,
        active="",
        is_edited=False,
        selected=0,
        is_cut=False,
    )
    bone = empty._replace(has_bone=True, active="bone")
    edited = bone._replace(is_edited=True)
    said = [
        steps.next_step(fields(ct_directory=""), empty),
        steps.next_step(fields(mesh_name=""), empty._replace(has_images=False)),
        steps.next_step(fields(mesh_name=""), empty._replace(active="crop")),
        steps.next_step(fields(mesh_name="", mesh_directory=""), empty),
        steps.next_step(fields(mesh_directory=""), empty),
        steps.next_step(fields(), empty),
        steps.next_step(fields(), bone._replace(active="mesh")),
        steps.next_step(fields(), bone),
        steps.next_step(fields(roi_name=""), edited),
        steps.next_step(fields(roi_name=""), edited._replace(selected=5)),
        steps.next_step(fields(), edited._replace(selected=5)),
        steps.next_step(fields(), edited._replace(selected=5, is_cut=True)),
        steps.next_step(fields(), bone._replace(active="region")),
    ]
    words = [
        "folder of CT images",
        "a folder that holds CT images",
        "Move and scale the box",
        "Mesh Filename",
        "where to save",
        "Render Surface Mesh",
        "Click the bone",
        "Select with Lasso",
        "Draw around",
        "Segmented Mesh Filename",
        "Select Region of Interest",
        "F9",
        "Check Mesh",
    ]
    for text, word in zip(said, words, strict=True):
        assert word in text
    assert len(set(said)) == len(said)
