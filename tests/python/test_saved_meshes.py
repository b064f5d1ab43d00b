"""Files in either frame of the patient, what is written beside them, and where meshes are at fault."""

import json
from pathlib import Path

import bonemesh
import numpy as np
import pytest
import trimesh

ENDINGS = ["stl", "ply", "obj", "3mf"]


@pytest.mark.parametrize("ending", ENDINGS)
def test_ras_is_lps_turned_and_not_mirrored(
    mesh: bonemesh.Mesh, tmp_path: Path, ending: str
) -> None:
    lps, ras = tmp_path / f"lps.{ending}", tmp_path / f"ras.{ending}"
    mesh.save(lps)
    mesh.save(ras, frame="RAS")
    a, b = bonemesh.read_mesh(lps), bonemesh.read_mesh(ras)
    np.testing.assert_array_equal(a.vertices * np.float32([-1, -1, 1]), b.vertices)
    np.testing.assert_array_equal(a.triangles, b.triangles)
    # Another reader sees the same body, outside out.
    other = trimesh.load(ras, force="mesh")
    assert other.volume == pytest.approx(bonemesh.check(a)["volume_mm3"], rel=1e-4)
    assert sorted(p.suffix for p in tmp_path.iterdir()) == [f".{ending}"] * 2


def test_another_frame_is_refused(mesh: bonemesh.Mesh, tmp_path: Path) -> None:
    with pytest.raises(bonemesh.ArgumentError, match="lps or ras"):
        mesh.save(tmp_path / "bone.stl", frame="scanner")
    assert not list(tmp_path.iterdir())


def test_a_sidecar_says_how_the_mesh_was_made_and_makes_it_again(
    ct_folder: Path, tmp_path: Path
) -> None:
    options = {
        "threshold_hu": 300,
        "cavities": "all",
        "crop": "2:60,0:60,3:30",
        "smooth_mm": 0.2,
    }
    bone = bonemesh.render(ct_folder, **options)
    bone.save(tmp_path / "bone.ply", frame="RAS", sidecar=True)
    assert sorted(p.name for p in tmp_path.iterdir()) == ["bone.ply", "bone.ply.json"]
    facts = json.loads((tmp_path / "bone.ply.json").read_text())
    assert (facts["file"], facts["unit"], facts["frame"]) == ("bone.ply", "mm", "RAS")
    for key in (
        "version",
        "method",
        "series_uid",
        "spacing_mm",
        "threshold_hu",
        "triangles",
    ):
        assert facts[key] == bone.report[key], key
    assert facts["options"] == bone.report["options"]
    again = bonemesh.render(ct_folder, **facts["options"])
    np.testing.assert_array_equal(again.vertices, bone.vertices)
    np.testing.assert_array_equal(again.triangles, bone.triangles)


@pytest.mark.parametrize(
    "options",
    [
        {
            "method": "alpha",
            "sample_percent": 50.0,
            "sampler": "random",
            "seed": 7,
            "sigma": 1.5,
        },
        {"method": "alpha", "alpha_mm": "auto"},
        {"method": "poisson", "depth": 5, "scale": 1.2},
        {"threshold_hu": "auto", "local_leeway_hu": 100.0, "true_edges": False},
        {"threshold_hu": "cortical", "keep_table": True, "damp_metal": True},
        {"islands": [[33.0, 0.0, 0.0]], "holes": 4.5, "triangles": 900},
        {"islands": "largest", "cavities": 20.0, "holes": "all", "decimate_mm": 0.1},
    ],
)
def test_the_options_of_a_report_make_the_same_mesh(
    ct_folder: Path, options: dict
) -> None:
    bone = bonemesh.render(ct_folder, **options)
    kept = json.loads(json.dumps(bone.report["options"]))
    for name, value in options.items():
        assert kept[name] == value, name
    again = bonemesh.render(ct_folder, **kept)
    assert again.report["options"] == bone.report["options"]
    np.testing.assert_array_equal(again.vertices, bone.vertices)


def test_a_sidecar_names_no_patient_folder_or_file(tmp_path: Path) -> None:
    folder = tmp_path / "Doe^John 1950"
    bonemesh.write_phantom("sphere-shell", folder, coarser=3.0)
    sorted(folder.rglob("*.dcm"))[4].unlink()
    bone = bonemesh.render(folder)
    assert bone.report["warnings"]
    bone.save(tmp_path / "bone.stl", sidecar=True)
    text = (tmp_path / "bone.stl.json").read_text()
    for word in ("Doe", "1950", ".dcm", str(tmp_path), "warnings", "seconds", "peak"):
        assert word not in text, word


def test_a_sidecar_that_cannot_be_written_leaves_no_mesh(
    mesh: bonemesh.Mesh, tmp_path: Path
) -> None:
    (tmp_path / "bone.stl.json").mkdir()
    with pytest.raises(OSError, match="bone.stl.json"):
        mesh.save(tmp_path / "bone.stl", sidecar=True)
    assert [p.name for p in tmp_path.iterdir()] == ["bone.stl.json"]


def test_the_command_writes_both(command, ct_folder: Path, tmp_path: Path) -> None:
    stl = tmp_path / "bone.stl"
    answer = command(
        "render", ct_folder, "-o", stl, "--frame", "ras", "--sidecar", "--json"
    )
    assert answer.code == 0, answer.err
    facts = json.loads((tmp_path / "bone.stl.json").read_text())
    assert facts["frame"] == "RAS" and facts["options"] == answer.json["options"]
    assert b"RAS" in stl.read_bytes()[:80]
    right = bonemesh.read_mesh(stl).vertices
    left = bonemesh.render(ct_folder).vertices
    np.testing.assert_array_equal(right.mean(axis=0)[0] > 0, left.mean(axis=0)[0] < 0)
    repaired = command("repair", stl, "-o", tmp_path / "other.obj", "--frame", "RAS")
    assert repaired.code == 0
    assert command("render", ct_folder, "-o", stl, "--frame", "xyz").code == 2


def test_faults_are_named_by_the_meshs_own_numbers() -> None:
    shell = bonemesh.render(bonemesh.phantom("sphere-shell", coarser=3.0))
    whole = bonemesh.faults(shell)
    assert all(len(found) == 0 for found in whole.values())
    opened = bonemesh.Mesh(shell.vertices, shell.triangles[5:])
    rim = bonemesh.faults(opened)["open_edges"]
    assert len(rim) == bonemesh.check(opened)["boundary_edges"]
    assert rim.dtype == np.uint32 and rim.shape[1] == 2
    gone = shell.triangles[:5]
    assert set(rim.ravel()) <= set(gone.ravel())
    both = bonemesh.Mesh(
        np.vstack([shell.vertices, shell.vertices + [5, 0, 0]]),
        np.vstack([shell.triangles, shell.triangles + len(shell.vertices)]),
    )
    meeting = bonemesh.faults(both)["intersecting_triangles"]
    assert len(meeting) == bonemesh.check(both)["intersecting_triangles"] > 0
    walls = bonemesh.wall_thickness(shell)
    middle = float(np.median(walls))
    thin = bonemesh.faults(shell, thinner_than_mm=middle)["thin_vertices"]
    np.testing.assert_array_equal(thin, np.flatnonzero(walls < middle))
    with pytest.raises(bonemesh.ArgumentError, match="thinner_than_mm"):
        bonemesh.faults(shell, thinner_than_mm=0.0)
