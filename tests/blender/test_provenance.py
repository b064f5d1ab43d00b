"""A rendering's options and the panel's fields: there and back."""

import json
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

import pytest
from conftest import Blender

from blender_addon.reports import provenance
from blender_addon.request.inputs import RefusalError, RenderInputs

FIELDS = {
    "ct_directory": "",
    "mesh_directory": "",
    "mesh_name": "bone",
    "hu_threshold": 350,
    "method": "isosurface",
    "series": "",
    "one_series": False,
    "crop": "",
    "damp_metal": False,
    "leave_out_table": True,
    "sigma": 1.0,
    "sampler": "uniform",
    "sample_percent": 100.0,
    "fill_holes": "none",
    "holes_mm": 10.0,
    "remove_islands": "specks",
    "islands_mm3": 1000.0,
    "fill_cavities": "none",
    "cavities_mm3": 100.0,
    "smooth_mm": 0.0,
    "reduce_triangles": "none",
    "triangles": 200_000,
    "decimate_mm": 0.05,
}
CHANGES = [
    {},
    {"hu_threshold": 600, "damp_metal": True, "leave_out_table": False},
    {"crop": "0:40,0:40,2:20", "fill_cavities": "all", "fill_holes": "all"},
    {"fill_holes": "small", "holes_mm": 4.5, "remove_islands": "others"},
    {"remove_islands": "none", "fill_cavities": "small", "cavities_mm3": 12.5},
    {"remove_islands": "small", "islands_mm3": 30.0, "smooth_mm": 0.125},
    {"reduce_triangles": "number", "triangles": 3000},
    {"reduce_triangles": "error", "decimate_mm": 0.25},
    {"method": "alpha", "sigma": 1.5, "sample_percent": 33.3, "sampler": "random"},
]


@pytest.fixture(scope="module")
def phantom(bonemesh: ModuleType, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("provenance") / "Doe^John"
    bonemesh.write_phantom("sphere-shell", folder, coarser=3.0)
    return folder


@pytest.mark.parametrize("changes", CHANGES, ids=str)
def test_the_fields_come_back_from_what_the_library_reports(
    bonemesh: ModuleType, phantom: Path, tmp_path: Path, changes: dict[str, Any]
) -> None:
    fields = FIELDS | {"ct_directory": str(phantom), "mesh_directory": str(tmp_path)}
    if "crop" in changes:
        changes = changes | {"crop": "0:30,0:30,2:20"}
    properties = SimpleNamespace(**(fields | changes))
    inputs = RenderInputs.read(properties)
    mesh = bonemesh.render(inputs.ct_images, **inputs.options)
    mesh.save(inputs.output, sidecar=True)
    facts = provenance.read_sidecar(inputs.output.with_name("bone.stl.json"))
    assert not provenance.without_field(facts)
    found = provenance.fields(facts)
    again = SimpleNamespace(**(fields | found))
    wanted = dict(inputs.options)
    (series,) = bonemesh.find_series(phantom)
    assert found["series"] == series.uid
    wanted["series"] = series.uid
    assert RenderInputs.read(again).options == wanted


def test_what_has_no_field_is_named() -> None:
    facts = {"options": {"alpha_mm": "auto", "seed": 0, "islands": [[1, 2, 3]]}}
    assert provenance.without_field(facts) == [
        "alpha_mm = auto",
        "islands = [[1, 2, 3]]",
    ]
    assert "remove_islands" not in provenance.fields(facts)


def test_a_threshold_that_was_found_comes_back_as_its_number() -> None:
    facts = {"threshold_hu": 412.4, "options": {"threshold_hu": "auto"}}
    assert provenance.fields(facts)["hu_threshold"] == 412


@pytest.mark.parametrize("text", ["", "[]", "{}", '{"options": 3}', "{", "\x00\xff"])
def test_a_file_that_says_nothing_is_refused(tmp_path: Path, text: str) -> None:
    file = tmp_path / "other.json"
    file.write_text(text, encoding="latin-1")
    with pytest.raises(RefusalError, match=r"bone\.stl\.json"):
        provenance.read_sidecar(file)


@pytest.fixture(scope="module")
def run(
    extension_zip: Path, phantom: Path, tmp_path_factory: pytest.TempPathFactory
) -> dict[str, Any]:
    folder = tmp_path_factory.mktemp("again")
    blender = Blender(extension_zip, folder)
    return blender.run("provenance", ct=phantom) | {"folder": blender.out}


def test_render_again_sets_the_fields_as_they_were(run: dict[str, Any]) -> None:
    assert run["from the object"] == run["rendered with"]
    assert run["from the file"] == run["rendered with"]
    assert run["second"] == run["first"]


def test_the_object_and_the_file_say_the_same(run: dict[str, Any]) -> None:
    facts = json.loads((run["folder"] / "bone.stl.json").read_text())
    kept = run["properties"]
    assert json.loads(kept["bonemesh_options"]) == facts["options"]
    for key in ("version", "method", "threshold_hu", "series_uid", "spacing_mm"):
        assert kept[f"bonemesh_{key}"] == facts[key], key
    region = json.loads((run["folder"] / "region.stl.json").read_text())
    assert region["thickness_mm"] == run["thickness_mm"]


def test_nothing_names_the_patient(run: dict[str, Any]) -> None:
    told = json.dumps(run["properties"]) + json.dumps(run["objects"])
    for file in run["folder"].glob("*.json"):
        if file.name != "provenance.json":
            told += file.name + file.read_text()
    assert "Doe" not in told


def test_what_cannot_be_restored_is_refused(run: dict[str, Any]) -> None:
    refused = run["refused"]
    assert "Make a bone active" in refused["a cube"]
    assert "Method cannot be 'newer'" in refused["another version"]
    assert "no file is chosen" in refused["no file"]
    assert "does not exist" in refused["missing"]
    assert "does not say how a bone was rendered" in refused["a region's"]
    assert run["kept"]
