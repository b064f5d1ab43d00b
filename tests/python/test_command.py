"""The command `bonemesh`: its answers, and that Python gives the same."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import bonemesh
import numpy as np
import pytest

DONE, FAILED, USAGE = 0, 1, 2

TIMES = {"seconds", "peak_mib"}


def untimed(report: dict) -> dict:
    return {key: value for key, value in report.items() if key not in TIMES}


def test_version_and_help(command):
    assert command("--version").out == f"bonemesh {bonemesh.__version__}\n"
    assert "Usage: bonemesh" in command("--help").out
    as_module = subprocess.run(
        [sys.executable, "-m", "bonemesh", "--version"],
        check=True,
        capture_output=True,
        text=True,
    )
    assert as_module.stdout == f"bonemesh {bonemesh.__version__}\n"


@pytest.mark.parametrize(
    "arguments",
    [
        [],
        ["magic"],
        ["render"],
        ["render", "folder"],
        ["render", "folder", "-o", "x.stl", "--hu", "bone"],
        ["render", "folder", "-o", "x.stl", "--hu", "nan"],
        ["render", "folder", "-o", "x.stl", "--sigma", "-1"],
        ["render", "folder", "-o", "x.stl", "--crop", "all"],
        ["render", "folder", "-o", "x.stl", "--sample", "0"],
        ["render", "folder", "-o", "x.stl", "--sample", "101"],
        ["render", "folder", "-o", "x.stl", "--sampler", "magic", "--sample", "10"],
        ["render", "folder", "-o", "x.stl", "--method", "magic"],
        ["render", "folder", "-o", "x.stl", "--alpha", "0"],
        ["render", "folder", "-o", "x.stl", "--threads", "0"],
        ["render", "folder", "-o", "x.stl", "--series", "head"],
        ["roi", "x.stl", "--selection", "s", "--thickness", "0", "-o", "y.stl"],
        ["roi", "x.stl", "--selection", "s", "--thickness", "-5", "-o", "y.stl"],
        ["roi", "x.stl", "--selection", "s", "--thickness", "nan", "-o", "y.stl"],
        ["roi", "x.stl", "--thickness", "5", "-o", "y.stl"],
        ["phantom", "elephant", "folder"],
    ],
)
def test_unusable_arguments_end_with_2(command, arguments, tmp_path):
    answer = command(*arguments, cwd=tmp_path)
    assert answer.code == USAGE
    assert answer.out == "" and answer.err
    assert list(tmp_path.iterdir()) == []


def test_info_tells_what_is_there(command, ct_folder):
    report = command("info", ct_folder.parent, "--json").json
    found = bonemesh.scan(ct_folder.parent)
    assert len(report["series"]) == len(found.series) == 1
    assert report["series"][0]["uid"] == found.series[0].uid
    assert report["series"][0]["slices"] == found.series[0].slices == 30
    assert tuple(report["series"][0]["spacing_mm"]) == found.series[0].spacing_mm
    assert [Path(f["path"]) for f in report["left_out"]] == [found.left_out[0].path]
    text = command("info", ct_folder).out
    assert "30" in text and "88" in text


def test_rendering_writes_what_python_writes(command, ct_folder, stl, tmp_path):
    answer = command(
        "render", ct_folder, "-o", tmp_path / "again.stl", "--method", "alpha", "--json"
    )
    assert answer.code == DONE
    mesh = bonemesh.render(ct_folder, method="alpha")
    mesh.save(tmp_path / "python.stl")
    written = stl.read_bytes()
    assert (tmp_path / "again.stl").read_bytes() == written
    assert (tmp_path / "python.stl").read_bytes() == written
    said = untimed(answer.json)
    assert said.pop("output") == str(tmp_path / "again.stl")
    assert said == untimed(mesh.report)
    promised = {
        "points",
        "alpha_mm",
        "tetrahedra",
        "vertices",
        "triangles",
        "watertight",
    }
    promised |= {"manifold", "components", "volume_mm3", "seconds", "peak_mib"}
    assert promised <= answer.json.keys()
    steps = {
        "read",
        "edges",
        "cloud",
        "neighbours",
        "tetrahedra",
        "surface",
        "write",
        "total",
    }
    assert steps <= answer.json["seconds"].keys()


def test_all_settings_mean_the_same_to_both(command, ct_folder, tmp_path):
    file = tmp_path / "sampled.ply"
    answer = command(
        *("render", ct_folder, "-o", file, "--json"),
        *("--hu", "500", "--sigma", "1.5", "--crop", "0:44,4:84,3:27", "--series", "1"),
        *("--sample", "60", "--sampler", "random", "--seed", "4", "--alpha", "7.5"),
    )
    mesh = bonemesh.render(
        ct_folder,
        threshold_hu=500,
        sigma=1.5,
        crop=[(0, 44), (4, 84), (3, 27)],
        series=bonemesh.find_series(ct_folder)[0].uid,
        sample_percent=60,
        sampler="random",
        seed=4,
        alpha_mm=7.5,
    )
    mesh.save(tmp_path / "python.ply")
    assert file.read_bytes() == (tmp_path / "python.ply").read_bytes()
    assert untimed(answer.json)["points"] == mesh.report["points"]


def test_clouds_and_their_meshes(command, ct_folder, tmp_path):
    volume = bonemesh.read_series(ct_folder)
    for frame in ("patient", "image"):
        file = tmp_path / f"{frame}.npy"
        answer = command("cloud", ct_folder, "-o", file, "--frame", frame, "--json")
        points = bonemesh.point_cloud(volume, frame=frame)
        assert answer.json["points"] == len(points)
        assert (np.load(file) == points).all()
    answer = command(
        "mesh", tmp_path / "patient.npy", "-o", tmp_path / "mesh.stl", "--json"
    )
    assert answer.code == DONE
    alpha = bonemesh.mean_neighbour_distance(np.load(tmp_path / "patient.npy"))
    assert answer.json["alpha_mm"] == alpha
    bonemesh.alpha_surface(
        points=np.load(tmp_path / "patient.npy"), alpha_mm=alpha
    ).save(tmp_path / "python.stl")
    assert (tmp_path / "mesh.stl").read_bytes() == (
        tmp_path / "python.stl"
    ).read_bytes()


def test_regions_are_the_same_to_both(command, stl, selection, tmp_path):
    file = tmp_path / "region.stl"
    answer = command(
        *(
            "roi",
            stl,
            "--selection",
            selection,
            "--thickness",
            "8",
            "-o",
            file,
            "--json",
        )
    )
    assert answer.code == DONE, answer.err
    numbers = np.loadtxt(selection, dtype=int)
    region = bonemesh.select_roi(bonemesh.read_mesh(stl), numbers, thickness_mm=8)
    region.save(tmp_path / "python.stl")
    assert file.read_bytes() == (tmp_path / "python.stl").read_bytes()
    said = untimed(answer.json)
    said.pop("output")
    assert said == untimed(region.report)
    assert region.report["selected"] == len(numbers)
    assert region.report["volume_mm3"] > 0


def test_checks_are_the_same_to_both(command, stl):
    answer = command("check", stl, "--json")
    assert answer.json == bonemesh.check(bonemesh.read_mesh(stl))
    assert answer.json["watertight"] is True
    assert "watertight" in command("check", stl).out


def test_phantoms(command, tmp_path):
    answer = command("phantom", "tube", tmp_path / "tube", "--coarser", "3", "--json")
    assert answer.code == DONE, answer.err
    volume = bonemesh.read_series(answer.json["series"])
    assert (volume.hu == bonemesh.phantom("tube", coarser=3).hu).all()
    assert (tmp_path / "tube" / "truth.json").is_file()


def test_a_phantom_is_scanned_as_asked(command, tmp_path):
    voxels = ["--pixel", "1", "--slice", "2.5"]
    noise = ["--blur", "0.5", "--noise", "7", "--seed", "3"]
    folder = tmp_path / "tube"
    answer = command("phantom", "tube", folder, *voxels, *noise, "--json")
    assert answer.code == DONE, answer.err
    volume = bonemesh.read_series(answer.json["series"])
    same = bonemesh.phantom(
        "tube", pixel_mm=1, slice_mm=2.5, psf_px=0.5, noise_hu=7, seed=3
    )
    assert (volume.hu == same.hu).all()
    odd = command("phantom", "tube", tmp_path / "odd", "--noise", "-1")
    assert odd.code != DONE and not (tmp_path / "odd").exists()


def test_progress_and_json_never_mix(command, ct_folder, tmp_path):
    answer = command("render", ct_folder, "-o", tmp_path / "x.stl", "--json")
    assert answer.out.count("\n") == 1 and answer.out.startswith("{")
    assert answer.err == ""
