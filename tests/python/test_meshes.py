"""Mesh files, checks and regions, seen by other programs and by their definition."""

from __future__ import annotations

import errno

import bonemesh
import numpy as np
import pytest
import trimesh

TETRAHEDRON = (
    [[0, 0, 0], [3, 0, 0], [0, 3, 0], [0, 0, 3]],
    [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
)


@pytest.mark.parametrize("suffix", [".stl", ".ply"])
def test_trimesh_reads_the_same_mesh(mesh, tmp_path, suffix):
    file = tmp_path / f"mesh{suffix}"
    mesh.save(file)
    theirs = trimesh.load(file, process=False)
    corners = mesh.vertices[mesh.triangles]
    assert (theirs.triangles.astype(np.float32) == corners).all()
    merged = trimesh.load(file)
    assert merged.is_watertight and merged.is_winding_consistent
    ours = bonemesh.check(mesh)
    assert merged.volume == pytest.approx(ours["volume_mm3"], rel=1e-6)
    assert merged.area == pytest.approx(ours["area_mm2"], rel=1e-6)
    assert np.allclose(merged.bounds, ours["bounds_mm"])
    assert merged.body_count == ours["components"]


@pytest.mark.parametrize("suffix", [".stl", ".ply"])
def test_we_read_what_trimesh_writes(tmp_path, suffix):
    theirs = trimesh.creation.icosphere(subdivisions=3, radius=20)
    theirs.export(tmp_path / f"ball{suffix}")
    mesh = bonemesh.read_mesh(tmp_path / f"ball{suffix}")
    assert len(mesh.vertices) == len(theirs.vertices)
    corners = theirs.triangles.astype(np.float32)
    assert (mesh.vertices[mesh.triangles] == corners).all()
    report = bonemesh.check(mesh)
    assert report["watertight"] and report["manifold"] and report["consistent_winding"]
    assert report["volume_mm3"] == pytest.approx(theirs.volume, rel=1e-5)


def test_ascii_stl_is_read_too(tmp_path):
    theirs = trimesh.creation.box((1, 2, 3))
    theirs.export(tmp_path / "box.stl", file_type="stl_ascii")
    assert bonemesh.check(bonemesh.read_mesh(tmp_path / "box.stl"))["volume_mm3"] == 6


def test_reading_merges_vertices_in_file_order(mesh, tmp_path):
    mesh.save(tmp_path / "mesh.stl")
    read = bonemesh.read_mesh(tmp_path / "mesh.stl")
    corners = mesh.vertices[mesh.triangles].reshape(-1, 3)
    first_met = list(dict.fromkeys(map(tuple, corners.tolist())))
    assert read.vertices.tolist() == [list(v) for v in first_met]


def test_saving_what_was_read_writes_the_same_bytes(mesh, tmp_path):
    for suffix in (".stl", ".ply"):
        mesh.save(tmp_path / f"first{suffix}")
        bonemesh.read_mesh(tmp_path / f"first{suffix}").save(
            tmp_path / f"second{suffix}"
        )
        first = (tmp_path / f"first{suffix}").read_bytes()
        assert first == (tmp_path / f"second{suffix}").read_bytes()


def test_check_counts_what_is_wrong():
    vertices, triangles = TETRAHEDRON
    closed = bonemesh.check(bonemesh.Mesh(vertices, triangles))
    assert closed["watertight"] and closed["manifold"] and closed["consistent_winding"]
    assert closed["volume_mm3"] == 4.5 and closed["components"] == 1
    assert closed["bounds_mm"] == [[0, 0, 0], [3, 3, 3]]
    opened = bonemesh.check(bonemesh.Mesh(vertices, triangles[:3]))
    assert not opened["watertight"] and opened["boundary_edges"] == 3
    turned = bonemesh.check(
        bonemesh.Mesh(vertices, [triangles[0][::-1], *triangles[1:]])
    )
    assert turned["boundary_edges"] == 0 and not turned["consistent_winding"]
    tripled = bonemesh.check(
        bonemesh.Mesh([*vertices, [1, 1, -5]], [*triangles, [0, 1, 4]])
    )
    assert tripled["non_manifold_edges"] == 1 and not tripled["manifold"]
    twins = [[x + 10, y, z] for x, y, z in vertices]
    pair = bonemesh.Mesh(
        vertices + twins, triangles + [[i + 4 for i in t] for t in triangles]
    )
    assert bonemesh.check(pair)["components"] == 2


def test_an_empty_mesh_is_not_written(tmp_path):
    empty = bonemesh.Mesh(np.zeros((0, 3)), np.zeros((0, 3), int))
    assert bonemesh.check(empty)["triangles"] == 0
    with pytest.raises(bonemesh.MeshError, match="no triangles"):
        empty.save(tmp_path / "empty.stl")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("name", "error", "number"),
    [
        ("missing/mesh.stl", FileNotFoundError, errno.ENOENT),
        ("folder.stl", IsADirectoryError, errno.EISDIR),
        ("mesh.doc", bonemesh.ArgumentError, None),
        ("mesh", bonemesh.ArgumentError, None),
    ],
)
def test_unusable_targets(tmp_path, name, error, number):
    (tmp_path / "folder.stl").mkdir()
    mesh = bonemesh.Mesh(*TETRAHEDRON)
    with pytest.raises(error) as caught:
        mesh.save(tmp_path / name)
    assert name in str(caught.value) and "\n" not in str(caught.value)
    assert getattr(caught.value, "errno", None) == number


@pytest.mark.parametrize(
    ("content", "error"),
    [
        (None, FileNotFoundError),
        (b"", bonemesh.MeshError),
        (b"solid nothing", bonemesh.MeshError),
        (bytes(84), bonemesh.MeshError),
        (bytes(80) + b"\xff\xff\xff\xff" + bytes(100), bonemesh.MeshError),
    ],
)
def test_unusable_files(tmp_path, content, error):
    file = tmp_path / "mesh.stl"
    if content is not None:
        file.write_bytes(content)
    with pytest.raises(error) as caught:
        bonemesh.read_mesh(file)
    assert "mesh.stl" in str(caught.value) and "\n" not in str(caught.value)


def test_a_region_is_the_bone_behind_the_selection(mesh, patch):
    region = bonemesh.select_roi(mesh, patch, thickness_mm=8, method="thesis")
    report = region.report
    assert report["selected"] == len(patch) and report["kept_points"] > 0
    assert report["thickness_mm"] == 8 and report["method"] == "thesis"
    assert report["vertices"] == len(region.vertices)
    assert report["triangles"] == len(region.triangles)
    original = set(map(tuple, mesh.vertices.tolist()))
    assert set(map(tuple, region.vertices.tolist())) <= original
    assert region.vertices[:, 0].min() > 0, "only bone of the left side"
    low, high = region.vertices[:, 2].min(), region.vertices[:, 2].max()
    assert -15 <= low < high <= 15
    assert bonemesh.check(region)["watertight"]
    volume = bonemesh.check(region)["volume_mm3"]
    assert volume == pytest.approx(report["volume_mm3"], rel=1e-5)


def test_the_order_and_repetition_of_a_selection_do_not_matter(mesh, patch):
    region = bonemesh.select_roi(mesh, patch, thickness_mm=8, method="thesis")
    repeated = np.concatenate([patch, patch[:5]])
    for selected in [
        patch.tolist(),
        repeated,
        patch.astype(np.uint16),
        patch[::1].copy(),
    ]:
        again = bonemesh.select_roi(mesh, selected, thickness_mm=8, method="thesis")
        assert (again.vertices == region.vertices).all()
        assert (again.triangles == region.triangles).all()


def test_a_region_of_the_file_is_the_region_of_the_mesh(mesh, patch, tmp_path):
    """The numbers change on the way through an STL file, the region does not."""
    mesh.save(tmp_path / "mesh.stl")
    read = bonemesh.read_mesh(tmp_path / "mesh.stl")
    numbers = {tuple(v): n for n, v in enumerate(read.vertices.tolist())}
    selected = [numbers[tuple(v)] for v in mesh.vertices[patch].tolist()]
    from_file = bonemesh.select_roi(read, selected, thickness_mm=8, method="thesis")
    from_memory = bonemesh.select_roi(mesh, patch, thickness_mm=8, method="thesis")

    def as_set(region):
        return {tuple(v) for v in region.vertices.tolist()}

    assert as_set(from_file) == as_set(from_memory)
    assert len(from_file.triangles) == len(from_memory.triangles)


def test_the_number_of_threads_changes_nothing(ct_folder, patch, mesh, tmp_path):
    for threads in (1, 3):
        rendered = bonemesh.render(ct_folder, method="alpha", threads=threads)
        rendered.save(tmp_path / f"mesh{threads}.stl")
        region = bonemesh.select_roi(
            mesh, patch, thickness_mm=8, method="thesis", threads=threads
        )
        region.save(tmp_path / f"region{threads}.stl")
    for name in ("mesh", "region"):
        one = (tmp_path / f"{name}1.stl").read_bytes()
        assert one == (tmp_path / f"{name}3.stl").read_bytes()
    volume = bonemesh.read_series(ct_folder, threads=3)
    assert (volume.hu == bonemesh.read_series(ct_folder, threads=1).hu).all()
    points = bonemesh.point_cloud(volume, threads=1)
    assert (points == bonemesh.point_cloud(volume, threads=3)).all()
    means = {bonemesh.mean_neighbour_distance(points, threads=n) for n in (1, 2, 3)}
    assert len(means) == 1
