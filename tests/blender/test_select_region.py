"""A lassoed selection becomes the region that the API gives for the same vertices."""

from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from conftest import Blender


@pytest.mark.parametrize("in_world_centre", [False, True])
def test_a_lassoed_region_is_the_apis(
    blender: Blender,
    bonemesh: ModuleType,
    ct: Path,
    tmp_path: Path,
    in_world_centre: bool,
) -> None:
    # The crop puts the centre away from the patient's origin, where moving there and back costs bits.
    crop = "0:74,0:74,0:24"
    fields = {
        "cut_thickness": 8.4,
        "center_in_world": in_world_centre,
        "crop": crop,
    }
    answer = blender.run("select_region", ct=ct, fields=fields)
    assert answer["result"] == ["FINISHED"]
    assert answer["in_front"]  # else the bone's own surface would cover it
    bone, region = np.load(answer["before"]), np.load(answer["region"])
    selected = np.flatnonzero(bone["selected"])
    assert 0 < len(selected) < len(bone["selected"])

    whole = bonemesh.render(ct, crop=crop, method="alpha")
    assert np.array_equal(whole.vertices, bone["patient"])
    expected = bonemesh.select_roi(whole, selected, thickness_mm=8.4)
    assert np.array_equal(region["patient"], expected.vertices)
    assert np.array_equal(region["triangles"], expected.triangles)
    expected.save(tmp_path / "api.stl")
    saved = (blender.out / "region.stl").read_bytes()
    assert saved == (tmp_path / "api.stl").read_bytes()

    # Beside its source: what was at one place in the patient is at one place in the world.
    shift = bone["matrix"][:3, 3] - bone["patient"].mean(axis=0, dtype=float)
    world = region["local"] + region["matrix"][:3, 3]
    assert np.allclose(world, region["patient"] + shift, atol=1e-3)
    assert np.allclose(shift, 0.0, atol=1e-3) is not in_world_centre


def test_the_source_stays_as_it_was_and_the_user_goes_on(
    blender: Blender, ct: Path
) -> None:
    answer = blender.run("select_region", ct=ct, fields={})
    before, after = np.load(answer["before"]), np.load(answer["after"])
    for array in ["local", "patient", "triangles", "matrix"]:
        assert np.array_equal(before[array], after[array]), array
    assert answer["mode"] == "EDIT"
    assert answer["active"] == "bone"
    assert answer["again"] == ["FINISHED"]
    assert {"bone", "region", "second"} <= set(answer["objects"])
    assert (blender.out / "second.stl").exists()


def test_a_region_says_where_it_comes_from(
    blender: Blender, bonemesh: ModuleType, ct: Path
) -> None:
    properties = blender.run("select_region", ct=ct, fields={})["properties"]
    assert properties["bonemesh_thickness_mm"] == 9.0
    assert properties["bonemesh_threshold_hu"] == 350.0
    assert properties["bonemesh_method"] == "solid"
    assert properties["bonemesh_direction"] == "normal"
    assert len(properties["bonemesh_selected"]) > 3
    assert properties["bonemesh_source"] == "bone"
    assert properties["bonemesh_version"] == bonemesh.__version__
    (series,) = bonemesh.find_series(ct)
    assert properties["bonemesh_series_uid"] == series.uid


def test_a_region_can_be_adjusted(blender: Blender, ct: Path) -> None:
    # That the window's Adjust Last Operation does it is part of the real window's story.
    answer = blender.run("adjust", ct=ct)
    assert answer["options"] == ["REGISTER", "UNDO"]
    # What the operator was given once is not taken again when the button is pressed.
    assert answer["regions"] == {"region": [2.5, "through"], "second": [3.0, "normal"]}
    # What is adjusted takes the place of what was there, in the scene and on the disk.
    assert answer["adjusted"] == {"region": [2.5, "through"]}
    assert answer["files"] == ["region.stl"]
