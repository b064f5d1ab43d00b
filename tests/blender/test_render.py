"""Rendering through the operator gives what the API gives, and puts it where a user expects it."""

import json
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from conftest import Blender

from blender_addon.reports.findings import of_rendering

SETTINGS = {"hu_threshold": 400}


def test_the_operator_gives_the_same_mesh_as_the_api(
    blender: Blender, bonemesh: ModuleType, ct: Path, tmp_path: Path
) -> None:
    answer = blender.run("render", ct=ct, fields=SETTINGS)
    assert answer["result"] == ["FINISHED"]
    expected = bonemesh.render(ct, threshold_hu=400.0, method="isosurface")
    got = np.load(answer["mesh"])
    assert np.array_equal(got["patient"], expected.vertices)
    assert np.array_equal(got["triangles"], expected.triangles)
    assert not got["selected"].any()

    expected.save(tmp_path / "api.stl")
    assert answer["files"] == ["bone.stl", "bone.stl.json"]
    assert (blender.out / "bone.stl").read_bytes() == (
        tmp_path / "api.stl"
    ).read_bytes()


def test_the_object_is_in_its_place_and_says_where_it_comes_from(
    blender: Blender, bonemesh: ModuleType, ct: Path
) -> None:
    answer = blender.run("render", ct=ct, fields=SETTINGS)
    got = np.load(answer["mesh"])
    centre = got["matrix"][:3, 3]
    assert np.allclose(got["matrix"][:3, :3], np.eye(3))
    assert np.allclose(centre, got["patient"].mean(axis=0, dtype=float), atol=1e-3)
    assert np.allclose(got["local"] + centre, got["patient"], atol=1e-3)

    assert answer["name"] == "bone"
    assert answer["selected"] == ["bone"]
    assert answer["units"] == ["METRIC", pytest.approx(0.001), "MILLIMETERS"]
    assert answer["clips"]
    assert all(start >= 0.5 and end >= 5000 for start, end in answer["clips"])
    (series,) = bonemesh.find_series(ct)
    properties = answer["properties"]
    assert properties["bonemesh_threshold_hu"] == 400.0
    assert properties["bonemesh_method"] == "isosurface"
    assert properties["bonemesh_series_uid"] == series.uid
    assert properties["bonemesh_version"] == bonemesh.__version__
    assert len(properties["bonemesh_spacing_mm"]) == 3


def test_center_in_world_moves_the_object_and_not_its_file(
    blender: Blender, ct: Path
) -> None:
    centred = blender.run("render", ct=ct, fields={"center_in_world": True})
    stl = (blender.out / "bone.stl").read_bytes()
    got = np.load(centred["mesh"])
    assert np.array_equal(got["matrix"], np.eye(4))
    blender.run("render", ct=ct, fields={"center_in_world": False})
    assert (blender.out / "bone.stl").read_bytes() == stl


@pytest.mark.parametrize(
    ("fields", "keywords"),
    [
        ({"crop": "4:60, 8:64, 2:20"}, {"crop": "4:60, 8:64, 2:20"}),
        (
            {"sample_percent": 40.0, "sampler": "uniform"},
            {"sample_percent": 40.0, "sampler": "uniform"},
        ),
        (
            {"sample_percent": 33.3, "sampler": "random"},
            {"sample_percent": 33.3, "sampler": "random"},
        ),
        (
            {"sample_percent": 50.0, "sampler": "thesis-uniform"},
            {"sample_percent": 50.0, "sampler": "thesis-uniform"},
        ),
        (
            {"sample_percent": 40.0, "sampler": "targeted"},
            {"sample_percent": 40.0, "sampler": "targeted"},
        ),
        (
            {"sample_percent": 40.0, "sampler": "thesis-targeted"},
            {"sampler": "thesis-targeted"},
        ),
        ({"sampler": "random"}, {}),
        ({"sampler": "thesis-targeted"}, {}),
        ({"series": "1"}, {"series": 1}),
        ({"sigma": 2.2}, {"sigma": 2.2}),
        ({"method": "labelled"}, {"method": "labelled"}),
    ],
)
def test_every_advanced_setting_reaches_the_api(
    blender: Blender, bonemesh: ModuleType, ct: Path, fields: dict, keywords: dict
) -> None:
    answer = blender.run("render", ct=ct, fields={"method": "alpha", **fields})
    expected = bonemesh.render(ct, **{"method": "alpha", **keywords})
    got = np.load(answer["mesh"])
    assert np.array_equal(got["patient"], expected.vertices)
    assert np.array_equal(got["triangles"], expected.triangles)


@pytest.mark.parametrize(
    ("fields", "keywords"),
    [
        (
            {"remove_islands": "others", "smooth_mm": 0.2},
            {"islands": "largest", "smooth_mm": 0.2},
        ),
        (
            {
                "remove_islands": "small",
                "islands_mm3": 50.0,
                "reduce_triangles": "error",
            },
            {"islands": 50.0, "decimate_mm": 0.05},
        ),
        (
            {"leave_out_table": False, "remove_islands": "none"},
            {"keep_table": True, "islands": 0.0},
        ),
        (
            {"fill_cavities": "all", "reduce_triangles": "number", "triangles": 4000},
            {"cavities": "all", "triangles": 4000},
        ),
    ],
)
def test_after_care_reaches_the_api_and_what_it_did_stays_with_the_object(
    blender: Blender, bonemesh: ModuleType, ct: Path, fields: dict, keywords: dict
) -> None:
    answer = blender.run("render", ct=ct, fields=fields)
    expected = bonemesh.render(ct, method="isosurface", **keywords)
    got = np.load(answer["mesh"])
    assert np.array_equal(got["patient"], expected.vertices)
    assert np.array_equal(got["triangles"], expected.triangles)
    done = json.loads(answer["properties"]["bonemesh_after_care"])
    assert without_times(done) == without_times(of_rendering(expected.report))


def test_without_after_care_nothing_is_said_of_it(blender: Blender, ct: Path) -> None:
    answer = blender.run("render", ct=ct, fields={})
    assert "bonemesh_after_care" not in answer["properties"]


def without_times(report: dict) -> dict:
    """What does not differ from one run to the next."""
    return {name: value for name, value in report.items() if name != "seconds"}


def test_a_series_is_chosen_by_its_uid(
    blender: Blender, bonemesh: ModuleType, ct: Path
) -> None:
    (series,) = bonemesh.find_series(ct)
    answer = blender.run("render", ct=ct, fields={"series": series.uid})
    assert answer["properties"]["bonemesh_series_uid"] == series.uid
