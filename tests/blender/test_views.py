"""Front shows the patient's face, left the left side; letters stand where they say, wherever the bone is."""

from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from conftest import Blender

# Right and up of each view, in the patient: x to the left, y to the back, z to the head.
SEEN = {
    "front": ((1, 0, 0), (0, 0, 1)),
    "back": ((-1, 0, 0), (0, 0, 1)),
    "left": ((0, 1, 0), (0, 0, 1)),
    "right": ((0, -1, 0), (0, 0, 1)),
    "top": ((-1, 0, 0), (0, -1, 0)),
    "bottom": ((1, 0, 0), (0, -1, 0)),
}
LETTERS = {
    "L": (0, 1),
    "R": (0, -1),
    "P": (1, 1),
    "A": (1, -1),
    "S": (2, 1),
    "I": (2, -1),
}


@pytest.fixture(scope="module")
def run(
    extension_zip: Path, bonemesh: ModuleType, tmp_path_factory: pytest.TempPathFactory
) -> dict[str, Any]:
    folder = tmp_path_factory.mktemp("views")
    head = folder / "head"
    bonemesh.write_phantom("head", head, coarser=3.0)
    answer = Blender(extension_zip, folder).run("views", ct=head)
    return answer | {"bone": bonemesh.render(head)}


@pytest.mark.parametrize("side", SEEN)
def test_views_look_at_the_side_they_are_named_after(
    run: dict[str, Any], side: str
) -> None:
    right, up = map(np.array, SEEN[side])
    view = run["in place"][side]
    np.testing.assert_allclose(view["right"], right, atol=1e-6)
    np.testing.assert_allclose(view["up"], up, atol=1e-6)
    np.testing.assert_allclose(view["looks"], -np.cross(right, up), atol=1e-6)


@pytest.mark.parametrize("state", ["in place", "hidden bone", "turned", "in edit mode"])
@pytest.mark.parametrize("side", SEEN)
def test_the_bone_is_in_the_middle_and_fills_the_view(
    run: dict[str, Any], state: str, side: str
) -> None:
    view = run[state][side]
    assert view["perspective"] == "ORTHO"
    np.testing.assert_allclose(view["off"], [0, 0], atol=0.1)
    assert max(view["fills"]) == pytest.approx(0.7, abs=0.01)


@pytest.mark.parametrize("state", ["turned", "in edit mode"])
@pytest.mark.parametrize("side", SEEN)
def test_views_follow_a_bone_that_was_turned(
    run: dict[str, Any], state: str, side: str
) -> None:
    turn = np.array(run["turn"])
    for axis, wanted in zip(("right", "up"), SEEN[side], strict=True):
        np.testing.assert_allclose(run[state][side][axis], turn @ wanted, atol=1e-5)


def test_a_rewritten_mesh_is_taken_as_it_lies(run: dict[str, Any]) -> None:
    for side, (right, up) in SEEN.items():
        np.testing.assert_allclose(run["applied"][side]["right"], right, atol=1e-6)
        np.testing.assert_allclose(run["applied"][side]["up"], up, atol=1e-6)


@pytest.mark.parametrize("letter", LETTERS)
def test_letters_stand_outside_of_the_bone_on_their_side(
    run: dict[str, Any], letter: str
) -> None:
    axis, sign = LETTERS[letter]
    vertices = run["bone"].vertices
    place = np.array(run["letters"][letter])
    end = (vertices[:, axis] * sign).max()
    assert end < sign * place[axis] < end + 60.0
    middle = (vertices.min(axis=0) + vertices.max(axis=0)) / 2
    beside = [a for a in range(3) if a != axis]
    np.testing.assert_allclose(place[beside], middle[beside], atol=0.01)
    moved = (
        np.array(run["turned letters"][letter])
        - run["turned letters"][
            {"L": "R", "R": "L", "A": "P", "P": "A", "S": "I", "I": "S"}[letter]
        ]
    )
    direction = np.array(run["turn"])[:, axis] * sign
    np.testing.assert_allclose(moved / np.linalg.norm(moved), direction, atol=1e-4)


def test_letters_that_would_be_read_on_the_wrong_side_are_left_out(
    run: dict[str, Any],
) -> None:
    assert run["hidden"] == {"front": "AP", "aslant": "LPS"}


def test_there_is_nothing_to_look_at_without_a_mesh(run: dict[str, Any]) -> None:
    assert run["poll"] is False
    assert Path(run["picture"]).stat().st_size > 1000
