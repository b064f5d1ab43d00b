"""CT slices show the CT at its place, and the surface's contour on it, wherever slice and bone are moved."""

from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from conftest import Blender

PLANES = ("axial", "coronal", "sagittal")
AXIS = {"sagittal": 0, "coronal": 1, "axial": 2}
WINDOW_HU = (400.0, 1800.0)


@pytest.fixture(scope="module", params=["axial", "oblique", "tilted"])
def run(
    request: pytest.FixtureRequest,
    extension_zip: Path,
    bonemesh: ModuleType,
    tmp_path_factory: pytest.TempPathFactory,
) -> dict[str, Any]:
    folder = tmp_path_factory.mktemp("slices")
    head = folder / "head"
    bonemesh.write_phantom("head", head, coarser=3.0, orientation=request.param)
    answer = Blender(extension_zip, folder).run("slices", ct=head)
    return answer | {"volume": bonemesh.read_series(head), "ct": head}


def expected(
    volume: Any, name: str, position_mm: float, window: Any = WINDOW_HU
) -> Any:
    return volume.slice(name, position_mm, window_hu=window)


def worlds(state: dict[str, Any], arrays: Any, name: str) -> np.ndarray:
    """Where in the world Blender shows the corners of a slice: lower left, lower right, upper left."""
    rows, columns = arrays[f"{name} grey"].shape
    size = state["sizes"][name] / max(rows, columns)
    corners = (
        np.array([[-columns, -rows], [columns, -rows], [-columns, rows]]) * size / 2
    )
    ends = np.column_stack([corners, np.zeros(3), np.ones(3)])
    return ends @ arrays[f"{name} matrix"][:3].T


def corners(plane: Any, position_mm: float) -> np.ndarray:
    """The same in the patient, as the library says."""
    rows, columns = plane.shape
    halves = np.array([[-columns, -rows], [columns, -rows], [-columns, rows]])
    sides = halves * plane.pixel_mm / 2
    ends = np.column_stack([sides, np.full(3, position_mm), np.ones(3)])
    return ends @ plane.patient_from_plane[:3].T


@pytest.mark.parametrize("state", ["without a bone", "shown"])
@pytest.mark.parametrize("name", PLANES)
def test_slices_show_the_ct_at_its_place_in_the_patient(
    run: dict[str, Any], state: str, name: str
) -> None:
    shown, volume = run[state], run["volume"]
    arrays, position = np.load(shown["file"]), shown["positions"][name]
    plane = volume.plane(name)
    np.testing.assert_array_equal(
        arrays[f"{name} grey"], expected(volume, name, position)
    )
    # Single precision at some hundred mm.
    np.testing.assert_allclose(
        worlds(shown, arrays, name), corners(plane, position), atol=1e-3
    )
    low, high = plane.positions_mm
    assert low < position < high
    assert (position - low) / plane.step_mm == pytest.approx(
        round((position - low) / plane.step_mm), abs=1e-3
    )


@pytest.mark.parametrize("name", PLANES)
def test_contours_are_the_surfaces_in_the_plane(run: dict[str, Any], name: str) -> None:
    arrays = np.load(run["shown"]["file"])
    points, plane = arrays[f"{name} contour"], run["volume"].plane(name)
    assert len(points) > 50
    position = run["shown"]["positions"][name]
    normal = plane.patient_from_plane[:3, 2]
    np.testing.assert_allclose(points @ normal, position, atol=1e-3)
    assert not len(np.load(run["without a bone"]["file"])[f"{name} contour"])


def test_contours_go_where_the_image_is_bone(
    run: dict[str, Any], bonemesh: ModuleType
) -> None:
    bone = bonemesh.render(run["ct"])
    for name in PLANES:
        plane = run["volume"].plane(name)
        position = run["shown"]["positions"][name]
        origin = plane.patient_from_plane @ (0.0, 0.0, position, 1.0)
        lines = bonemesh.section(bone, origin[:3], plane.patient_from_plane[:3, 2])
        count = sum(len(line) - 1 for line in lines)
        points = np.load(run["shown"]["file"])[f"{name} contour"]
        assert abs(len(points) - count) <= 0.01 * count
        ends = points.min(axis=0), points.max(axis=0)
        places = np.vstack(lines)
        np.testing.assert_allclose(
            ends, [places.min(axis=0), places.max(axis=0)], atol=0.05
        )


def test_the_slider_goes_from_slice_to_slice(run: dict[str, Any]) -> None:
    moved, volume = run["moved"], run["volume"]
    state = moved["slider"]
    plane, position = volume.plane("axial"), state["positions"]["axial"]
    low, high = plane.positions_mm
    assert abs(position - (low + 0.25 * (high - low))) <= plane.step_mm / 2 + 1e-3
    assert moved["percent"] == pytest.approx(
        100 * (position - low) / (high - low), abs=0.01
    )
    grey = np.load(state["file"])["axial grey"]
    np.testing.assert_array_equal(grey, expected(volume, "axial", position))
    points = np.load(state["file"])["axial contour"]
    np.testing.assert_allclose(
        points @ plane.patient_from_plane[:3, 2], position, atol=1e-3
    )


def test_a_slice_that_is_moved_by_hand_is_drawn_anew(run: dict[str, Any]) -> None:
    before, after = run["moved"]["slider"], run["moved"]["by hand"]
    position = after["positions"]["coronal"]
    assert position == pytest.approx(before["positions"]["coronal"] + 3.25, abs=1e-3)
    grey = np.load(after["file"])["coronal grey"]
    np.testing.assert_array_equal(grey, expected(run["volume"], "coronal", position))
    free = {name: locks.index(False) for name, locks in run["locks"].items()}
    assert free == AXIS
    assert all(locks.count(True) == 2 for locks in run["locks"].values())


def test_the_window_changes_greys_alone(run: dict[str, Any]) -> None:
    soft = run["moved"]["soft tissue"]
    arrays, before = np.load(soft["file"]), np.load(run["moved"]["by hand"]["file"])
    for name in PLANES:
        picture = expected(run["volume"], name, soft["positions"][name], (40.0, 400.0))
        np.testing.assert_array_equal(arrays[f"{name} grey"], picture)
        np.testing.assert_array_equal(
            arrays[f"{name} contour"], before[f"{name} contour"]
        )


def test_slices_and_contours_can_be_hidden(run: dict[str, Any]) -> None:
    assert run["moved"]["hidden"] == [True, True, False]
    assert run["moved"]["shown"] is True


@pytest.mark.parametrize("name", PLANES)
def test_slices_stay_with_a_bone_that_is_moved(run: dict[str, Any], name: str) -> None:
    bone = run["bone"]
    state = bone["turned"]
    arrays, position = np.load(state["file"]), state["positions"][name]
    world_from_patient = np.array(bone["matrix"])
    world_from_patient[:3, 3] -= world_from_patient[:3, :3] @ bone["centre"]
    places = corners(run["volume"].plane(name), position)
    moved = places @ world_from_patient[:3, :3].T + world_from_patient[:3, 3]
    np.testing.assert_allclose(worlds(state, arrays, name), moved, atol=2e-3)


def test_contours_follow_a_surface_that_is_changed(run: dict[str, Any]) -> None:
    before, without, again = run["edited"]
    assert before == again > 0
    assert without == 0


def test_the_images_are_read_once_beside_the_window(run: dict[str, Any]) -> None:
    end, reports = run["end"]
    assert end == ["FINISHED"]
    ((level, text),) = reports
    assert level == "INFO" and text.endswith("MiB in memory")
    assert run["read once"]


def test_pictures_get_into_no_file_and_count_as_no_unsaved_work(
    run: dict[str, Any],
) -> None:
    saved = run["saved"]
    assert not [name for name in saved["images"] if name.startswith("CT")]
    assert saved["dirty"] == []
    assert saved["as before"]
    opened = saved["opened"]
    assert opened["memory"]
    assert opened["pictures"] == [True, True, True]
    assert "press Show CT Slices" in " ".join(opened["panel"])
    assert saved["again"]


def test_the_panel_says_where_the_slices_are(run: dict[str, Any]) -> None:
    assert run["panel before"] == ["Show CT Slices"]
    text = "\n".join(run["panel"])
    for name, letter in (("Axial", "z"), ("Coronal", "y"), ("Sagittal", "x")):
        assert f"{name} [{name.lower()}]" in text
        assert (
            f"{letter} = {run['shown']['positions'][name.lower()]:.1f} mm, slice"
            in text
        )
    assert "Contour of bone" in text
    assert "MiB in memory" in text.replace("\n", " ")
    assert run["panel"][-1] == "Remove CT Slices"


def test_what_cannot_be_shown_is_refused(run: dict[str, Any]) -> None:
    assert run["refused"].startswith("no folder of CT images is chosen")
    assert "1.2.3" in run["another series"]


def test_nothing_is_left_of_slices_that_are_taken_away(run: dict[str, Any]) -> None:
    assert run["left"] == [[], [], True]
    assert run["handlers"] == 2  # with the one that brings edges back after the lasso


@pytest.fixture(scope="module")
def undone(
    extension_zip: Path, bonemesh: ModuleType, tmp_path_factory: pytest.TempPathFactory
) -> dict[str, Any]:
    folder = tmp_path_factory.mktemp("slices_undo")
    bonemesh.write_phantom("head", folder / "head", coarser=3.0)
    return Blender(extension_zip, folder).run("slices_undo", ct=folder / "head")


def test_undo_brings_pictures_and_contours_back(undone: dict[str, Any]) -> None:
    assert undone["moved"]["grey"] != undone["shown"]["grey"]
    assert undone["move undone"] == undone["shown"]
    assert undone["move redone"] == undone["moved"]
    assert undone["all undone"]
    assert undone["shown again"] == undone["shown"]


def test_contours_stay_with_a_renamed_bone_and_go_with_a_deleted_one(
    undone: dict[str, Any],
) -> None:
    renamed, deleted = undone["renamed"], undone["deleted"]
    assert renamed["points"] > 0
    assert renamed["surface"] == "another name"
    assert deleted["points"] == 0
    assert deleted["grey"] == renamed["grey"]
    assert undone["panel"] == [True, [True, True, True]]
    assert undone["deletion undone"]["points"] == renamed["points"]
