"""Comparing meshes: volumes beside Manifold, distances beside trimesh, edge midpoints by their definition."""

from __future__ import annotations

import bonemesh
import numpy as np
import pytest
from scipy.spatial import KDTree


@pytest.fixture(scope="module")
def skulls() -> tuple[bonemesh.Mesh, bonemesh.Mesh]:
    """The bone of the phantom head at two thresholds: closed, rough, nearly the same."""
    head = bonemesh.phantom("head", coarser=2.0)
    low, high = (
        bonemesh.render(head, threshold_hu=hu, true_edges=False) for hu in (300, 600)
    )
    return low, high


def moved(mesh: bonemesh.Mesh, by: tuple[float, float, float]) -> bonemesh.Mesh:
    return bonemesh.Mesh(mesh.vertices + np.float32(by), mesh.triangles)


def residual_by_manifold(first: bonemesh.Mesh, second: bonemesh.Mesh) -> float:
    manifold3d = pytest.importorskip("manifold3d")

    def body(mesh: bonemesh.Mesh):
        arrays = mesh.vertices.copy(), mesh.triangles.copy()
        made = manifold3d.Manifold(manifold3d.Mesh(*arrays))
        assert made.status() == manifold3d.Error.NoError
        return made

    a, b = body(first), body(second)
    return (a + b).volume() - (a ^ b).volume()


def test_the_residual_volume_is_manifolds(skulls):
    low, high = skulls
    for other in (high, moved(low, (0.7, -0.4, 1.1))):
        expected = residual_by_manifold(low, other)
        found = bonemesh.compare(low, other, samples=100)["residual_volume_mm3"]
        assert expected > 100
        assert found == pytest.approx(expected, rel=1e-3)


def test_the_residual_volume_of_a_real_scan_is_manifolds(real_ct):
    volume = bonemesh.read_series(real_ct("cranium"))
    low, high = (
        bonemesh.render(volume, threshold_hu=hu, true_edges=False) for hu in (300, 400)
    )
    expected = residual_by_manifold(low, high)
    found = bonemesh.compare(low, high, samples=1000)
    assert found["residual_volume_mm3"] == pytest.approx(expected, rel=1e-3)


def test_distances_are_trimeshs(skulls):
    trimesh = pytest.importorskip("trimesh")
    low, high = skulls
    reference = trimesh.Trimesh(high.vertices, high.triangles, process=False)
    some = low.vertices[::997].astype(float)
    _, expected, _ = trimesh.proximity.closest_point_naive(reference, some)
    found = bonemesh.signed_distances(some, high)
    assert np.allclose(np.abs(found), expected, rtol=0, atol=1e-6)
    inside = reference.contains(some)
    clear = expected > 1e-3
    assert ((found < 0) == inside)[clear].all()


def test_every_vertex_has_its_distance_and_the_summary_is_theirs(skulls):
    low, high = skulls
    every = bonemesh.signed_distances(low.vertices, high)
    assert every.shape == (len(low.vertices),)
    found = bonemesh.compare(low, high, residual=False)
    assert found["residual_volume_mm3"] is None
    assert found["hausdorff_mm"] >= np.abs(every).max() - 1e-9
    # The bone above the lower threshold is the larger.
    assert found["to_reference"]["signed_mean_mm"] > 0
    assert found["from_reference"]["signed_mean_mm"] < 0
    once = bonemesh.compare(low, high, residual=False, threads=1)
    assert once == found


def midpoints_by_definition(
    mesh: bonemesh.Mesh, reference: bonemesh.Mesh
) -> tuple[float, float, int]:
    """Edges within slices; the reference's ten nearest to the middle, if within half the length."""
    sides = mesh.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    edges = np.unique(np.sort(sides, axis=1), axis=0)
    ends = mesh.vertices.astype(float)[edges]
    ends = ends[ends[:, 0, 2] == ends[:, 1, 2]]
    others = reference.vertices.astype(float)
    everything, means = [], []
    for z in np.unique(ends[:, 0, 2]):
        level = others[others[:, 2] == z][:, :2]
        if not len(level):
            continue
        count = min(10, len(level))
        tree = KDTree(level)
        for a, b in ends[ends[:, 0, 2] == z][:, :, :2]:
            length = np.linalg.norm(b - a)
            away, near = tree.query((a + b) / 2, count)
            near = np.atleast_1d(near)[np.atleast_1d(away) <= length / 2 * (1 + 1e-9)]
            if len(near):
                u, w = (b - a) / length, level[near] - a
                distances = np.abs(w[:, 0] * u[1] - w[:, 1] * u[0])
                everything.extend(distances)
                means.append(distances.mean())
    return float(np.mean(everything)), float(np.mean(means)), len(means)


def test_edge_midpoints_by_their_definition(volume, mesh):
    points = bonemesh.point_cloud(volume)
    kept = bonemesh.sample(points, percent=30, sampler="thesis-uniform")
    coarse = bonemesh.alpha_surface(
        points[kept], bonemesh.mean_neighbour_distance(points[kept])
    )
    overall, midpoint, edges = midpoints_by_definition(coarse, mesh)
    found = bonemesh.compare(coarse, mesh, samples=100, residual=False)[
        "edge_midpoints"
    ]
    assert found["edges"] == edges
    # Of equally far vertices the tenth may be another.
    assert found["overall_mm"] == pytest.approx(overall, rel=1e-3)
    assert found["midpoint_mm"] == pytest.approx(midpoint, rel=1e-3)


def test_an_open_mesh_has_distances_and_a_word_on_its_volume(skulls):
    low, high = skulls
    open_mesh = bonemesh.Mesh(low.vertices, low.triangles[1:])
    found = bonemesh.compare(open_mesh, high, samples=1000)
    assert found["mean_mm"] > 0
    assert found["residual_volume_mm3"] is None
    assert "not closed" in found["warnings"][0]


def test_a_mesh_without_a_surface_is_refused(mesh):
    nothing = bonemesh.Mesh(np.zeros((3, 3)), [[0, 1, 2]])
    with pytest.raises(bonemesh.MeshError, match="no triangle"):
        bonemesh.compare(nothing, mesh)
    with pytest.raises(bonemesh.MeshError, match="no triangle"):
        bonemesh.signed_distances(mesh.vertices, nothing)
    with pytest.raises(bonemesh.ArgumentError, match="samples"):
        bonemesh.compare(mesh, mesh, samples=0)


def test_the_command_writes_heat_map_and_histogram(command, skulls, tmp_path):
    files = [tmp_path / "low.stl", tmp_path / "high.stl"]
    for mesh, file in zip(skulls, files, strict=True):
        mesh.save(file)
    heat, picture = tmp_path / "heat.ply", tmp_path / "h.png"
    options = ["--heat-map", heat, "--histogram", picture, "--json"]
    answer = command("compare", *files, *options)
    assert answer.code == 0, answer.err
    assert answer.json["residual_volume_mm3"] > 100
    head = heat.read_bytes()[:600].decode("latin-1")
    assert "property float distance_mm" in head
    assert "property uchar red" in head
    assert picture.read_bytes().startswith(b"\x89PNG")
    again = bonemesh.read_mesh(heat)
    assert len(again.triangles) == len(skulls[0].triangles)
    words = command("compare", *files, "--no-residual")
    assert "Hausdorff" in words.out
    assert "residual" not in words.out


def test_the_command_refuses_targets_before_the_work(command, stl, tmp_path):
    for option, name in (("--heat-map", "x.stl"), ("--histogram", "x.jpg")):
        answer = command("compare", stl, stl, option, tmp_path / name)
        assert answer.code == 1
        assert name in answer.err
    assert not list(tmp_path.iterdir())
    missing = command("compare", stl, tmp_path / "no.stl")
    assert missing.code == 1
    assert "no.stl" in missing.err
