"""Labelled tetrahedra, as Python and the command see them: a choice like the isosurface."""

from __future__ import annotations

import bonemesh
import numpy as np
import pytest


@pytest.fixture(scope="module")
def thick() -> bonemesh.Volume:
    """The sphere in slices of 6 mm."""
    shell = bonemesh.phantom("sphere-shell", coarser=2.0)
    return bonemesh.Volume(
        shell.hu[::2], shell.patient_from_voxel @ np.diag([1, 1, 2, 1])
    )


@pytest.fixture(scope="module")
def labelled(thick) -> bonemesh.Mesh:
    return bonemesh.render(thick, method="labelled")


def test_the_name_is_offered_and_reported(labelled):
    assert "labelled" in bonemesh.methods()
    assert labelled.report["method"] == "labelled"
    assert labelled.report["tetrahedra"] > 1000
    assert labelled.report["filled_mm3"] >= 0
    assert labelled.report["alpha_mm"] is None and labelled.report["points"] is None


def test_it_can_be_printed_and_lies_on_the_bone(labelled):
    check = bonemesh.check(labelled)
    assert check["printable"], check["reasons"]
    away = bonemesh.PhantomSurface("sphere-shell").nearest(labelled.vertices)
    assert abs(away["distance_mm"]).mean() < 0.4
    assert abs(away["distance_mm"].mean()) < 0.15


def test_threads_change_no_byte(thick, labelled):
    for threads in (1, 2, 5):
        again = bonemesh.render(thick, method="labelled", threads=threads)
        assert (again.vertices == labelled.vertices).all()
        assert (again.triangles == labelled.triangles).all()


def test_the_command_writes_what_python_writes(command, ct_folder, tmp_path):
    written = tmp_path / "bone.stl"
    answer = command("render", ct_folder, "-o", written, "--method=labelled", "--json")
    assert answer.code == 0, answer.err
    assert answer.json["method"] == "labelled" and answer.json["manifold"]
    bonemesh.render(ct_folder, method="labelled").save(tmp_path / "python.stl")
    assert written.read_bytes() == (tmp_path / "python.stl").read_bytes()


@pytest.mark.parametrize("shape", [(1, 20, 20), (2, 64, 64), (1, 1, 20), (12, 64, 64)])
def test_flat_volumes_are_bodies_too(shape):
    hu = np.full(shape, 40, np.int16)
    hu[..., 5:15] = 1200
    volume = bonemesh.Volume(hu, np.diag([1, 1, 2, 1]))
    for method in ("isosurface", "labelled"):
        check = bonemesh.check(bonemesh.render(volume, method=method))
        assert check["printable"], (method, check["reasons"])


@pytest.mark.parametrize(
    ("hu", "says"), [(1200, "everything"), (40, "nothing"), (350, "nothing")]
)
def test_it_refuses_what_the_isosurface_refuses_in_the_same_words(hu, says):
    for shape in [(1, 1, 1), (1, 20, 20), (2, 64, 64), (1, 1, 20)]:
        volume = bonemesh.Volume(np.full(shape, hu, np.int16), np.diag([1, 1, 2, 1]))
        words = set()
        for method in ("isosurface", "labelled"):
            with pytest.raises(bonemesh.BonemeshError) as caught:
                bonemesh.render(volume, method=method)
            words.add(str(caught.value))
        assert len(words) == 1 and says in words.pop()


def test_choices_that_only_edge_points_have_are_refused(thick):
    for choice in ({"alpha_mm": 3.0}, {"sample_percent": 50}):
        with pytest.raises(bonemesh.BonemeshError, match="labelled"):
            bonemesh.render(thick, method="labelled", **choice)
