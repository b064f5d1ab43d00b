"""Exported files hold the mesh in the frame asked for; faulty places are selected, and nothing else."""

from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from conftest import Blender

FORMATS = ["stl", "3mf", "ply", "obj"]


@pytest.fixture(scope="module")
def run(
    extension_zip: Path, bonemesh: ModuleType, tmp_path_factory: pytest.TempPathFactory
) -> dict[str, Any]:
    folder = tmp_path_factory.mktemp("outputs")
    femur = folder / "femur"
    bonemesh.write_phantom("femur", femur, coarser=3.0)
    blender = Blender(extension_zip, folder)
    answer = blender.run("outputs", ct=femur)
    return answer | {"out": blender.out, "bone": bonemesh.render(femur)}


@pytest.mark.parametrize("ending", FORMATS)
@pytest.mark.parametrize(("frame", "signs"), [("LPS", (1, 1, 1)), ("RAS", (-1, -1, 1))])
def test_a_moved_bone_is_written_at_its_place_in_the_patient(
    run: dict[str, Any], bonemesh: ModuleType, ending: str, frame: str, signs: tuple
) -> None:
    assert run["exported"][f"{ending}-{frame}"] == ""
    file = run["out"] / f"{ending}-{frame}.{ending}"
    written, bone = bonemesh.read_mesh(file), run["bone"]
    bone.save(run["out"] / f"api.{ending}", frame=frame)
    assert file.read_bytes() == (run["out"] / f"api.{ending}").read_bytes()
    low = (bone.vertices * np.float32(signs)).min(axis=0)
    np.testing.assert_array_equal(written.vertices.min(axis=0), low)
    volume = bonemesh.check(written)["volume_mm3"]
    assert (
        volume == pytest.approx(bonemesh.check(bone)["volume_mm3"], rel=1e-6)
        and volume > 0
    )


def test_as_placed_is_where_the_scene_shows_it(
    run: dict[str, Any], bonemesh: ModuleType
) -> None:
    assert run["exported"]["placed"] == ""
    written = bonemesh.read_mesh(run["out"] / "placed.ply").vertices
    matrix = np.array(run["exported"]["matrix"])
    bone = run["bone"].vertices
    local = bone - bone.mean(axis=0, dtype=np.float64)
    places = local @ matrix[:3, :3].T + matrix[:3, 3]
    np.testing.assert_allclose(written, places, atol=2e-3)


def test_modifiers_count_and_the_object_names_the_file(
    run: dict[str, Any], bonemesh: ModuleType
) -> None:
    assert run["exported"]["own name"] == ""
    written = bonemesh.read_mesh(run["out"] / "bone.stl")
    assert len(written.triangles) < 0.6 * len(run["bone"].triangles)


def test_unusable_names_and_folders_are_refused(run: dict[str, Any]) -> None:
    assert "no plain file name" in run["exported"]["bad name"]
    assert "no folder for the meshes" in run["exported"]["no folder"]
    assert not [name for name in run["files"] if name.startswith(".")]


def test_a_whole_mesh_has_no_places_and_stays_as_it_is(run: dict[str, Any]) -> None:
    whole = run["faults"]["whole"]
    assert (whole["result"], whole["mode"]) == (["FINISHED"], "OBJECT")
    text = " ".join(run["faults"]["whole box"])
    assert "Thin Below (mm) [thin_mm] Select Thin Walls" in text
    assert "Select Open Edges" not in text


@pytest.mark.parametrize(
    "case", ["open", "open, from edit mode", "open, with a modifier"]
)
def test_the_rim_of_a_hole_is_selected(run: dict[str, Any], case: str) -> None:
    found = run["faults"][case]
    assert found["mode"] == "EDIT"
    assert found["modes"] == [False, True, False]
    assert len(found["edges"]) == len(found["vertices"]) == 4
    assert found["faces"] == []
    assert "Select Open Edges (4)" in run["faults"]["open box"]


def test_an_edge_of_three_faces_is_selected(run: dict[str, Any]) -> None:
    assert run["faults"]["fin"]["edges"] == [[0, 1]]


def test_faces_that_pass_through_one_another_are_selected(run: dict[str, Any]) -> None:
    found = run["faults"]["through"]
    assert found["modes"] == [False, False, True]
    # Of the cubes one side, and four that reach through it.
    assert len(found["faces"]) == 5
    assert run["faults"]["through sides"] == 12


def test_thin_walls_are_selected_where_they_are_thinner_than_asked(
    run: dict[str, Any],
) -> None:
    assert len(run["faults"]["thin"]["vertices"]) == 8
    assert run["faults"]["thick"]["mode"] == "OBJECT"
