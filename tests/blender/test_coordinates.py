"""A region is cut out in the patient's coordinates to the last bit, whatever was done to the object."""

from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from conftest import Blender

# Puts the mesh's centre away from the patient's origin, where a subtraction costs last bits.
CROP = "0:74,0:74,0:24"


@pytest.fixture(scope="module")
def readings(
    extension_zip: Path, ct: Path, tmp_path_factory: pytest.TempPathFactory
) -> dict[str, Any]:
    answer = Blender(extension_zip, tmp_path_factory.mktemp("coordinates")).run(
        "coordinates", ct=ct, crop=CROP
    )
    answer.pop("log")
    return {
        case: {**np.load(read["file"]), "selected": read["selected"]}
        for case, read in answer.items()
    }


@pytest.fixture(scope="module")
def vertices(bonemesh: ModuleType, ct: Path) -> np.ndarray:
    return bonemesh.render(ct, crop=CROP, method="alpha").vertices


@pytest.mark.parametrize("case", ["as made", "in edit mode", "moved and turned"])
def test_coordinates_are_the_renderings_bit_for_bit(
    readings: dict[str, Any], vertices: np.ndarray, case: str
) -> None:
    assert np.array_equal(readings[case]["vertices"], vertices)
    assert 0 < readings[case]["selected"] < len(vertices)


def test_the_object_alone_would_not_give_them(
    readings: dict[str, Any], vertices: np.ndarray
) -> None:
    """The reason for the attribute: the sum of origin and local coordinate misses last bits."""
    centre = readings["as made"]["location"].astype(np.float32)
    local = (vertices.astype(float) - centre).astype(np.float32)
    assert not np.array_equal(local + centre, vertices)


def test_a_moved_object_is_followed(
    readings: dict[str, Any], vertices: np.ndarray
) -> None:
    read = readings["moved and turned"]
    centre = readings["as made"]["location"]
    turn = read["matrix"][:3, :3]
    expected = (vertices - centre) @ turn.T + centre + [100.0, 0.0, 0.0]
    assert not np.allclose(turn, np.eye(3))
    assert np.allclose(vertices @ turn.T + read["matrix"][:3, 3], expected, atol=1e-3)


def test_an_edited_vertex_is_where_it_was_put_and_the_others_stay_exact(
    readings: dict[str, Any], vertices: np.ndarray
) -> None:
    got = readings["one vertex edited"]["vertices"]
    assert np.array_equal(got[1:], vertices[1:])
    assert np.allclose(got[0], vertices[0] + [0.0, 0.0, 0.25], atol=1e-4)


def test_after_applying_transforms_the_world_counts(
    readings: dict[str, Any], vertices: np.ndarray
) -> None:
    moved, applied = readings["moved and turned"], readings["transforms applied"]
    world = vertices @ moved["matrix"][:3, :3].T + moved["matrix"][:3, 3]
    assert np.allclose(applied["vertices"][1:], world[1:], atol=1e-3)
    assert np.array_equal(applied["matrix"], np.eye(4))


def test_a_foreign_mesh_is_taken_from_the_world(
    readings: dict[str, Any], vertices: np.ndarray
) -> None:
    foreign = readings["foreign"]["vertices"]
    assert len(np.unique(foreign[:, 2])) == len(np.unique(vertices[:, 2]))
    assert np.allclose(
        sorted(map(tuple, foreign)), sorted(map(tuple, vertices)), atol=1e-4
    )
    assert np.array_equal(readings["foreign"]["matrix"], np.eye(4))


def test_faces_with_four_corners_are_cut_into_triangles(
    readings: dict[str, Any],
) -> None:
    cube = readings["cube"]
    assert cube["triangles"].shape == (12, 3)
    assert np.allclose(cube["vertices"].min(axis=0), [3.0, -1.0, -1.0])
    assert np.allclose(cube["vertices"].max(axis=0), [7.0, 1.0, 1.0])
