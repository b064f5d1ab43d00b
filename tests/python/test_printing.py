"""Whether a mesh can be printed, beside what trimesh and Manifold say of it; the formats they share with us."""

from __future__ import annotations

import zipfile

import bonemesh
import manifold3d
import numpy as np
import pytest
import trimesh

BODIES = {
    "ball": trimesh.creation.icosphere(subdivisions=3, radius=20),
    "block": trimesh.creation.box((30, 20, 10)),
    "ring": trimesh.creation.torus(30, 8),
    "pipe": trimesh.creation.annulus(10, 14, 40),
    "rod": trimesh.creation.capsule(50, 6),
}


def ours(body: trimesh.Trimesh) -> bonemesh.Mesh:
    return bonemesh.Mesh(body.vertices, body.faces)


def manifold(mesh: bonemesh.Mesh) -> manifold3d.Manifold:
    vertices, triangles = mesh.vertices.copy(), mesh.triangles.copy()
    return manifold3d.Manifold(manifold3d.Mesh(vertices, triangles))


def as_trimesh(mesh: bonemesh.Mesh) -> trimesh.Trimesh:
    return trimesh.Trimesh(mesh.vertices, mesh.triangles, process=False)


@pytest.mark.parametrize("name", BODIES)
def test_good_bodies_are_good_to_all(name):
    mesh = ours(BODIES[name])
    check = bonemesh.check(mesh)
    assert check["printable"] is True and check["reasons"] == []
    assert check["self_intersections"] == 0 and check["intersections"] == []
    assert check["outward"] and check["inconsistent_edges"] == 0
    assert as_trimesh(mesh).is_volume
    theirs = manifold(mesh)
    assert theirs.status() == manifold3d.Error.NoError
    assert theirs.volume() == pytest.approx(check["volume_mm3"], rel=1e-5)
    assert theirs.surface_area() == pytest.approx(check["area_mm2"], rel=1e-5)


def test_what_manifold_makes_is_printable_and_its_parts_side_by_side_are_not():
    ball = ours(BODIES["ball"])
    moved = bonemesh.Mesh(ball.vertices + np.float32([11, 3, 1]), ball.triangles)
    together = bonemesh.Mesh(
        np.concatenate([ball.vertices, moved.vertices]),
        np.concatenate([ball.triangles, moved.triangles + len(ball.vertices)]),
    )
    check = bonemesh.check(together)
    assert check["watertight"] and check["manifold"] and not check["printable"]
    assert check["components"] == 2 and len(check["reasons"]) == 1
    assert "pass through" in check["reasons"][0]
    assert 100 < check["self_intersections"] < 1000
    first = check["intersections"][0]
    low, high = first["triangles"]
    assert low < len(ball.triangles) <= high
    for centre in ([0, 0, 0], [11, 3, 1]):
        distance = np.linalg.norm(np.subtract(first["place_mm"], centre))
        assert 19.5 < distance < 20.01, "the place is on both balls"
    united = (manifold(ball) + manifold(moved)).to_mesh()
    whole = bonemesh.check(bonemesh.Mesh(united.vert_properties, united.tri_verts))
    assert whole["printable"] and whole["components"] == 1


def test_pairs_are_those_of_an_independent_test():
    """Edges of one ball through triangles of the other, in double precision."""
    ball = trimesh.creation.icosphere(subdivisions=2, radius=20)
    other = ball.copy()
    other.apply_translation([11.3, 3.7, 1.9])
    ball, other = (as_trimesh(ours(body)) for body in (ball, other))
    pairs = through(ball, other, False) | through(other, ball, True)
    together = trimesh.util.concatenate([ball, other])
    check = bonemesh.check(ours(together))
    assert check["self_intersections"] == len(pairs)
    found = {tuple(place["triangles"]) for place in check["intersections"]}
    expected = {(i, j + len(ball.faces)) for i, j in pairs}
    assert len(found) == 20 and found == set(sorted(expected)[:20])


def through(
    pierced: trimesh.Trimesh, piercing: trimesh.Trimesh, swapped: bool
) -> set[tuple[int, int]]:
    """Pairs (triangle of the first body, of the second) where an edge of `piercing` goes through `pierced`."""
    pairs = set()
    a, b, c = (pierced.triangles[:, i] for i in range(3))
    normal = np.cross(b - a, c - a)
    for number, corners in enumerate(piercing.triangles):
        for i in range(3):
            p, q = corners[i], corners[(i + 1) % 3]
            from_p, from_q = (np.einsum("ij,ij->i", normal, x - a) for x in (p, q))
            inside = from_p * from_q < 0
            share = from_p / np.where(inside, from_p - from_q, 1)
            place = p + share[:, None] * (q - p)
            for u, v in ((a, b), (b, c), (c, a)):
                side = np.cross(v - u, place - u)
                inside &= np.einsum("ij,ij->i", normal, side) > 0
            hits = np.flatnonzero(inside)
            pairs |= {(number, int(h)) if swapped else (int(h), number) for h in hits}
    return pairs


def test_broken_bodies_are_broken_to_all():
    ball = BODIES["ball"]
    turned = ball.faces.copy()
    turned[7] = turned[7][::-1]
    for faces, word in [
        (ball.faces[1:], "open edges"),
        (turned, "opposite ways"),
        (ball.faces[:, ::-1], "inside out"),
    ]:
        mesh = bonemesh.Mesh(ball.vertices, faces)
        check = bonemesh.check(mesh)
        assert not check["printable"] and word in check["reasons"][0]
        assert not as_trimesh(mesh).is_volume
    for faces in (ball.faces[1:], turned):
        theirs = manifold(bonemesh.Mesh(ball.vertices, faces))
        assert theirs.status() == manifold3d.Error.NotManifold


def test_walls_are_as_thick_as_they_are():
    outer = trimesh.creation.icosphere(subdivisions=4, radius=20)
    inner = trimesh.creation.icosphere(subdivisions=4, radius=18.5)
    inner.invert()
    shell = ours(trimesh.util.concatenate([outer, inner]))
    walls = bonemesh.wall_thickness(shell)
    assert walls.shape == (len(shell.vertices),) and walls.dtype == np.float64
    assert (abs(walls - 1.5) < 0.05).all()
    check = bonemesh.check(shell)
    assert check["printable"] and check["components"] == 2
    # The middles of triangles are looked at, too: the facets are nearer to one another than the corners.
    thinnest = check["thinnest_wall_mm"]
    assert walls.min() - 0.02 < thinnest <= walls.min()
    assert check["wall_5_percent_mm"] >= thinnest
    radius = np.linalg.norm(check["thinnest_wall_place_mm"])
    assert min(abs(radius - 20.0), abs(radius - 18.5)) < 0.1
    opened = bonemesh.Mesh(shell.vertices, shell.triangles[1:])
    assert bonemesh.check(opened)["thinnest_wall_mm"] is None


@pytest.mark.parametrize("suffix", [".obj", ".3mf"])
def test_trimesh_reads_the_same_mesh(mesh, tmp_path, suffix):
    file = tmp_path / f"mesh{suffix}"
    mesh.save(file)
    theirs = trimesh.load_mesh(file, process=False)
    corners = mesh.vertices[mesh.triangles]
    assert (theirs.triangles.astype(np.float32) == corners).all()
    if suffix == ".3mf":
        assert theirs.units in ("mm", "millimeters", "millimeter")
    again = bonemesh.read_mesh(file)
    assert (again.vertices == mesh.vertices).all()
    assert (again.triangles == mesh.triangles).all()


@pytest.mark.parametrize("suffix", [".obj", ".3mf"])
def test_we_read_what_trimesh_writes(tmp_path, suffix):
    theirs = BODIES["ring"]
    theirs.export(tmp_path / f"ring{suffix}")
    mesh = bonemesh.read_mesh(tmp_path / f"ring{suffix}")
    check = bonemesh.check(mesh)
    assert check["printable"] and check["triangles"] == len(theirs.faces)
    assert check["volume_mm3"] == pytest.approx(theirs.volume, rel=1e-5)


def test_a_3mf_says_unit_and_frame(mesh, tmp_path):
    mesh.save(tmp_path / "mesh.3mf")
    with zipfile.ZipFile(tmp_path / "mesh.3mf") as archive:
        assert archive.testzip() is None
        model = archive.read("3D/3dmodel.model").decode()
    assert 'unit="millimeter"' in model and "patient space LPS" in model


def test_render_writes_every_format(command, ct_folder, tmp_path):
    volumes = set()
    for ending in ("stl", "ply", "obj", "3mf"):
        file = tmp_path / f"bone.{ending}"
        assert command("render", ct_folder, "-o", file).code == 0
        check = command("check", file, "--json").json
        volumes.add((round(check["volume_mm3"], 3), check["triangles"]))
    assert len(volumes) == 1
    text = command("check", file).out
    assert "printable" in text and "self-intersections" in text
