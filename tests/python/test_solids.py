"""Regions as solids, their other sides, and planes of symmetry."""

import math

import bonemesh
import numpy as np
import pytest

# Between the two surfaces of the shell, of 30 and 36 mm.
MIDDLE = 33.0


@pytest.fixture(scope="module")
def shell() -> bonemesh.Mesh:
    return bonemesh.render(bonemesh.phantom("sphere-shell", coarser=1.5))


@pytest.fixture(scope="module")
def cap(shell: bonemesh.Mesh) -> np.ndarray:
    """Vertices of the outer surface on the left side."""
    radius = np.linalg.norm(shell.vertices, axis=1)
    outer = radius > MIDDLE
    return np.flatnonzero(outer & (shell.vertices[:, 0] > 0.85 * radius))


def certificate(mesh):
    check = bonemesh.check(mesh)
    assert check["watertight"] and check["manifold"], check["reasons"]
    assert check["self_intersections"] == 0
    return check


def test_the_solid_is_closed_and_its_front_is_the_meshs_own(shell, cap):
    solid = bonemesh.select_roi(shell, cap, thickness_mm=3)
    check = certificate(solid)
    report = solid.report
    assert report["method"] == "solid" and report["direction"] == "normal"
    assert report["thickness_mm"] == 3 and report["selected"] == len(cap)
    assert report["volume_mm3"] == pytest.approx(check["volume_mm3"], rel=1e-6)
    # Below a sphere of 36 mm the areas get smaller.
    mean_area = (1 + 33 / 36 + (33 / 36) ** 2) / 3 * report["patch_mm2"]
    assert report["volume_mm3"] == pytest.approx(3 * mean_area, rel=0.05)
    assert report["inward"][0] == pytest.approx(-1, abs=0.02)
    own = set(map(tuple, shell.vertices.tolist()))
    front = [tuple(v) in own for v in solid.vertices.tolist()]
    assert sum(front) > 0.5 * len(cap)


def test_a_triangle_that_faces_the_wrong_way_is_turned_first(shell, cap):
    wrong = shell.triangles.copy()
    near = np.flatnonzero(np.isin(wrong, cap).all(axis=1))[3]
    wrong[near] = wrong[near, ::-1]
    solid = bonemesh.select_roi(
        bonemesh.Mesh(shell.vertices, wrong), cap, thickness_mm=3
    )
    certificate(solid)
    assert solid.report["turned_triangles"] == 1
    sound = bonemesh.select_roi(shell, cap, thickness_mm=3)
    assert solid.report["volume_mm3"] == pytest.approx(sound.report["volume_mm3"])


@pytest.mark.parametrize(
    "direction", ["normal", "through", "outward", (-1.0, 0.0, 0.0)]
)
@pytest.mark.parametrize("turned", ["all", "every seventh"])
def test_a_mesh_that_faces_the_wrong_way_is_turned_first(shell, cap, turned, direction):
    wrong = shell.triangles.copy()
    which = slice(None) if turned == "all" else slice(None, None, 7)
    wrong[which] = wrong[which, ::-1]
    options = {"thickness_mm": 3, "direction": direction}
    solid = bonemesh.select_roi(bonemesh.Mesh(shell.vertices, wrong), cap, **options)
    certificate(solid)
    assert solid.report["turned_triangles"] == len(wrong[which])
    sound = bonemesh.select_roi(shell, cap, **options)
    assert solid.report["volume_mm3"] == pytest.approx(
        sound.report["volume_mm3"], rel=1e-3
    )


def test_an_inside_out_mesh_with_a_hole_is_closed_and_turned(shell):
    torn = bonemesh.Mesh(shell.vertices, shell.triangles[5:, ::-1])
    whole = bonemesh.face_outward(bonemesh.fill_holes(torn))
    assert bonemesh.check(whole)["printable"]


def test_mirrored_pieces_of_both_sides_are_both_cut(shell, cap):
    radius = np.linalg.norm(shell.vertices, axis=1)
    outer = radius > MIDDLE
    front = np.flatnonzero(outer & (shell.vertices[:, 1] < -0.95 * radius))
    options = {"thickness_mm": 3, "mirror": "x"}
    apart = [bonemesh.select_roi(shell, part, **options) for part in (cap, front)]
    both = bonemesh.select_roi(shell, np.union1d(cap, front), **options)
    certificate(both)
    volume = sum(solid.report["volume_mm3"] for solid in apart)
    assert both.report["volume_mm3"] == pytest.approx(volume, rel=1e-6)
    assert both.report["dropped_pieces"] == 0


def test_mirrored_sides_whose_solids_would_meet_are_cut_as_one(tmp_path):
    hu = np.zeros((40, 40, 70), dtype=np.int16)
    for low, high in [(8, 14), (56, 62)]:
        hu[5:35, 5:35, low:high] = 1000
    pair = bonemesh.render(bonemesh.Volume(hu, np.eye(4)), method="isosurface")
    x, y, z = pair.vertices.T
    near = (np.abs(y - 19.5) < 8) & (np.abs(z - 19.5) < 8)
    # Both faces of the left plate: each would be cut to the far side, which is the other's.
    both = np.flatnonzero(near & (x > 35))
    plane = (1.0, 0.0, 0.0, 34.5)
    solid = bonemesh.select_roi(pair, both, thickness_mm=9, mirror=plane)
    certificate(solid)
    assert solid.report["volume_mm3"] == pytest.approx(16 * 16 * 6, rel=0.1)
    assert solid.vertices[:, 0].max() < 20


def test_directions(shell, cap):
    middle = np.linalg.norm(shell.vertices[cap], axis=1).mean()
    plate = bonemesh.select_roi(
        shell, cap, thickness_mm=2, direction="outward", clearance_mm=1
    )
    certificate(plate)
    radii = np.linalg.norm(plate.vertices, axis=1)
    assert radii.min() == pytest.approx(middle + 1, abs=0.15)
    assert radii.max() == pytest.approx(middle + 3, abs=0.2)
    through = bonemesh.select_roi(shell, cap, thickness_mm=90, direction="through")
    assert certificate(through)["components"] == 2
    assert through.vertices[:, 0].min() < 0 < through.vertices[:, 0].max()
    straight = bonemesh.select_roi(
        shell, cap, thickness_mm=90, direction=np.array([-2.0, 0, 0])
    )
    assert certificate(straight)["components"] == 1
    assert straight.vertices[:, 0].min() > 0


def test_hidden_pieces_are_left_out_unless_asked_for(shell, cap):
    sideways = np.hypot(shell.vertices[:, 1], shell.vertices[:, 2])
    both = np.flatnonzero(sideways < 10)
    seen = bonemesh.select_roi(shell, both, thickness_mm=2, direction=(-1, 0, 0))
    assert seen.vertices[:, 0].min() > 0 and seen.report["dropped_pieces"] > 0
    all_of_it = bonemesh.select_roi(shell, both, thickness_mm=2, hidden=True)
    assert certificate(all_of_it)["components"] >= 2


def test_pieces_that_do_not_touch_can_be_solids_of_their_own(shell, cap):
    left, front = shell.vertices[cap], np.roll(shell.vertices, -1, axis=1)
    radius = np.linalg.norm(shell.vertices, axis=1)
    outer = radius > MIDDLE
    before = np.flatnonzero(outer & (front[:, 0] < -0.95 * radius))
    both = np.concatenate([before, cap])
    one = bonemesh.select_roi(shell, both, thickness_mm=2, hidden=True)
    assert certificate(one)["components"] == 2
    large, small = bonemesh.select_roi(
        shell, both, thickness_mm=2, hidden=True, separate=True
    )
    assert certificate(large)["components"] == certificate(small)["components"] == 1
    assert large.vertices[:, 0].min() > 0.8 * left[:, 0].min()
    assert small.vertices[:, 1].max() < 0
    volumes = [mesh.report["volume_mm3"] for mesh in (large, small)]
    assert sum(volumes) == pytest.approx(one.report["volume_mm3"], rel=0.01)
    assert volumes[0] > volumes[1]


@pytest.mark.parametrize(
    "plane",
    ["x", (1, 0, 0, 0), (2, 0, 0, 0), np.array([[0, 0, 0], [0, 1, 0], [0, 0, 1]])],
)
def test_the_other_side_is_taken_and_put_where_asked(shell, cap, plane):
    here = bonemesh.select_roi(shell, cap, thickness_mm=3)
    other = bonemesh.select_roi(shell, cap, thickness_mm=3, mirror=plane)
    certificate(other)
    assert other.vertices[:, 0].max() < 0
    assert other.report["mirror"]["normal"] == pytest.approx([1, 0, 0], abs=1e-6)
    back = bonemesh.select_roi(
        shell, cap, thickness_mm=3, mirror=plane, mirror_back=True
    )
    certificate(back)
    assert back.vertices[:, 0].min() > 0
    assert back.report["volume_mm3"] == pytest.approx(
        here.report["volume_mm3"], rel=0.1
    )


def test_mirrored_meshes_keep_their_outside(shell):
    mirrored = bonemesh.mirror(shell, (0, 0, 2, 20))
    assert mirrored.vertices[:, 2].mean() == pytest.approx(20, abs=0.5)
    assert mirrored.report["offset_mm"] == pytest.approx(10)
    before, after = bonemesh.check(shell), bonemesh.check(mirrored)
    assert after["volume_mm3"] == pytest.approx(before["volume_mm3"], rel=1e-5)
    assert after["printable"] == before["printable"]


def test_the_heads_own_plane_is_found_tilted_and_shifted():
    head = bonemesh.render(bonemesh.phantom("head", coarser=3.0))
    angle = math.radians(17)
    turn = np.array(
        [
            [math.cos(angle), -math.sin(angle), 0],
            [math.sin(angle), math.cos(angle), 0],
            [0, 0, 1],
        ]
    )
    tilted = bonemesh.Mesh(head.vertices @ turn.T + [30, -20, 500], head.triangles)
    *normal, offset = bonemesh.symmetry_plane(tilted)
    expected = turn @ [1, 0, 0]
    sign = np.sign(np.dot(normal, expected))
    degrees = math.degrees(math.acos(min(1, abs(np.dot(normal, expected)))))
    assert degrees < 0.3
    assert sign * offset == pytest.approx(expected @ [30, -20, 500], abs=0.3)


def test_the_thickness_under_a_selection(shell, cap):
    found = bonemesh.local_thickness(shell, cap)
    radii = np.sort(np.linalg.norm(shell.vertices, axis=1))
    wall = radii[-100] - radii[100]
    assert found["min_mm"] <= found["median_mm"] <= found["max_mm"]
    assert found["median_mm"] == pytest.approx(wall, abs=0.3)
    inside_out = bonemesh.Mesh(shell.vertices, shell.triangles[:, ::-1])
    assert bonemesh.local_thickness(inside_out, cap) == pytest.approx(found)
    flat = bonemesh.Mesh([[0, 0, 0], [9, 0, 0], [0, 9, 0]], [[0, 1, 2]])
    assert bonemesh.local_thickness(flat, [0, 1, 2]) is None


@pytest.mark.parametrize(
    ("keywords", "says"),
    [
        ({"direction": "down"}, "normal, through, outward"),
        ({"direction": (0, 0, 0)}, "not all 0"),
        ({"direction": 5}, "three numbers"),
        ({"clearance_mm": -1, "direction": "outward"}, "0 to 20"),
        ({"clearance_mm": 1}, "outward"),
        ({"mirror": "w"}, "auto"),
        ({"mirror": (0, 0, 0, 1)}, "not 0"),
        ({"mirror": 3}, "nx, ny, nz, d"),
        ({"mirror_back": True}, "mirror"),
        ({"method": "thesis", "hidden": True}, "solid"),
        ({"method": "thesis", "mirror": "x"}, "solid"),
        ({"method": "thesis", "separate": True}, "solid"),
        ({"thickness_mm": 1e-4}, "larger thickness"),
    ],
)
def test_choices_that_cannot_be(shell, cap, keywords, says):
    with pytest.raises(bonemesh.BonemeshError) as caught:
        bonemesh.select_roi(shell, cap, **{"thickness_mm": 3, **keywords})
    assert says in str(caught.value) and "\n" not in str(caught.value)


def test_a_hole_in_the_mesh_is_filled_first_and_told(shell, cap):
    whole = bonemesh.select_roi(shell, cap, thickness_mm=2)
    assert whole.report["filled_holes"] == 0
    middle = cap[np.argmax(shell.vertices[cap, 0])]
    is_cut = (shell.triangles == middle).any(axis=1)
    opened = bonemesh.Mesh(shell.vertices, shell.triangles[~is_cut])
    solid = bonemesh.select_roi(opened, cap, thickness_mm=2)
    certificate(solid)
    assert solid.report["filled_holes"] == 1
    assert solid.report["volume_mm3"] == pytest.approx(
        whole.report["volume_mm3"], rel=0.02
    )


def test_triangles_that_share_no_vertices_are_joined_first(shell, cap):
    corners = shell.vertices[shell.triangles].reshape(-1, 3)
    soup = bonemesh.Mesh(corners, np.arange(len(corners)).reshape(-1, 3))
    selected = np.flatnonzero(np.isin(shell.triangles.ravel(), cap))
    solid = bonemesh.select_roi(soup, selected, thickness_mm=2)
    certificate(solid)
    assert solid.report["filled_holes"] == 0
    whole = bonemesh.select_roi(shell, cap, thickness_mm=2)
    assert solid.report["volume_mm3"] == pytest.approx(whole.report["volume_mm3"])
