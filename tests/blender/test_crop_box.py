"""From voxels to a box in the patient and back, wherever the images lie."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import Blender

from blender_addon.crop import crop_box
from blender_addon.crop.crop_box import Grid
from blender_addon.request.inputs import RefusalError

AXIAL = np.diag([0.5, 0.5, 2.0, 1.0])


def turned(degrees: float) -> np.ndarray:
    angle = np.radians(degrees)
    oblique = np.eye(4)
    oblique[:2, :2] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
    oblique[:3, 3] = [10.0, -200.0, 33.3]
    return oblique


def sheared() -> np.ndarray:
    """Slices of a tilted gantry: each lies a little further down than the one before."""
    tilted = AXIAL.copy()
    tilted[1, 2] = 0.6
    return tilted


GRIDS = {
    "axial": AXIAL,
    "oblique": turned(33.0) @ AXIAL,
    "left-handed": AXIAL @ np.diag([1.0, 1.0, -1.0, 1.0]),
    "tilted": turned(-10.0) @ sheared(),
}


@pytest.fixture(params=GRIDS)
def grid(request: pytest.FixtureRequest) -> Grid:
    return Grid(GRIDS[request.param], (100, 120, 40))


@pytest.mark.parametrize(
    "box", [((0, 100), (0, 120), (0, 40)), ((3, 4), (17, 90), (39, 40))]
)
def test_a_box_comes_back_from_its_corners(grid: Grid, box: crop_box.Box) -> None:
    corners = crop_box.corners_mm(box, grid)
    assert crop_box.box_of(corners, grid) == box
    assert crop_box.box_of(corners.astype(np.float32), grid) == box


def test_corners_are_the_outer_faces_of_the_voxels() -> None:
    grid = Grid(AXIAL, (10, 10, 10))
    corners = crop_box.corners_mm(((0, 10), (2, 4), (5, 6)), grid)
    assert corners.min(axis=0).tolist() == [-0.25, 0.75, 9.0]
    assert corners.max(axis=0).tolist() == [4.75, 1.75, 11.0]


def test_the_frame_turns_with_the_images_and_is_no_mirror(grid: Grid) -> None:
    frame = crop_box.frame(grid)
    assert np.allclose(frame.T @ frame, np.eye(3))
    assert np.linalg.det(frame) == pytest.approx(1.0)
    along = grid.patient_from_voxel[:3, 0]
    assert frame[:, 0] @ along == pytest.approx(np.linalg.norm(along))


def test_a_box_beyond_the_images_is_cut_off_and_one_beside_them_refused(
    grid: Grid,
) -> None:
    corners = crop_box.corners_mm(((-50, 10), (0, 500), (-3, 400)), grid)
    assert crop_box.box_of(corners, grid) == ((0, 10), (0, 120), (0, 40))
    away = crop_box.corners_mm(((200, 300), (0, 5), (0, 5)), grid)
    with pytest.raises(RefusalError, match="Show Crop Box"):
        crop_box.box_of(away, grid)
    with pytest.raises(RefusalError, match="Show Crop Box"):
        crop_box.box_of(np.full((8, 3), np.nan), grid)


def test_the_typed_form_is_the_librarys(grid: Grid) -> None:
    box = ((3, 4), (17, 90), (0, 40))
    assert crop_box.written(box, grid) == "3:4,17:90,0:40"
    assert crop_box.read(" 3:4, 17 : 90,0:40 ", grid) == box
    assert crop_box.written(grid.whole, grid) == ""
    for unusable in ("", "left half", "5:5,0:1,0:1", "0:101,0:1,0:1", "1:2,3:4"):
        assert crop_box.read(unusable, grid) == grid.whole


@pytest.fixture(scope="module")
def answers(
    extension_zip: Path, ct: Path, two: Path, tmp_path_factory: pytest.TempPathFactory
) -> dict[str, Any]:
    folder = tmp_path_factory.mktemp("crop")
    return Blender(extension_zip, folder).run("crop", ct=ct, two=two)


def test_the_box_is_refused_until_the_images_are_known(answers: dict[str, Any]) -> None:
    assert "Select File Directory of CT Images" in answers["no images"]
    assert "Look Again" in answers["not looked at"]
    assert "Show Crop Box" in answers["no box to use"]
    assert "Show Crop Box" in answers["no box to remove"]


def test_the_box_is_shown_around_all_of_the_images(answers: dict[str, Any]) -> None:
    shown = answers["shown"]
    assert shown["name"] == "Bonemesh Crop Box"
    assert shown["active"]
    assert shown["rendered"] is False
    assert shown["crop"] == ""
    assert np.allclose(shown["corners"], answers["expected corners"], atol=1e-3)


def test_a_box_that_is_moved_scaled_or_edited_crops(answers: dict[str, Any]) -> None:
    columns, rows, slices = answers["shape"]
    assert answers["scaled"] == answers["expected scaled"]
    assert answers["edited"] == f"0:{columns},0:{rows},0:{slices // 2}"
    assert "Show Crop Box" in answers["moved away"]


def test_rendering_takes_the_box_as_it_is(answers: dict[str, Any]) -> None:
    rendered = answers["rendered"]
    assert rendered["crop"] == answers["edited"]
    assert rendered["height_mm"] < 0.6 * answers["rendered whole"]["height_mm"]
    assert answers["rendered whole"]["crop"] == ""


def test_a_field_that_was_set_after_the_box_counts(answers: dict[str, Any]) -> None:
    assert answers["typed after it"] == answers["rendered whole"]


def test_the_box_is_not_taken_for_a_bone(answers: dict[str, Any]) -> None:
    assert "active" in answers["checked"]


def test_the_box_of_oblique_images_fits_them(answers: dict[str, Any]) -> None:
    assert answers["coronal"] == ""


def test_undo_brings_the_box_back(answers: dict[str, Any]) -> None:
    assert answers["undone"] == [True, False, True]
