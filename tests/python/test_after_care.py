"""What is done to finished meshes: holes, islands, cavities, smoothing, fewer triangles."""

import bonemesh
import numpy as np
import pytest


@pytest.fixture(scope="module")
def shell() -> bonemesh.Mesh:
    """A sphere's shell: one island with one cavity."""
    volume = bonemesh.phantom("sphere-shell", coarser=2.0)
    return bonemesh.render(volume, method="isosurface")


def is_printable(mesh: bonemesh.Mesh) -> bool:
    return bonemesh.check(mesh)["printable"]


def test_a_filled_shell_is_a_ball(shell: bonemesh.Mesh) -> None:
    ball = bonemesh.fill_cavities(shell)
    assert ball.report["removed_cavities"] == 1
    assert bonemesh.check(ball)["components"] == 1
    assert len(bonemesh.fill_cavities(shell, cavities=0.0).triangles) == len(
        shell.triangles
    )


def test_holes_are_filled_up_to_a_size(shell: bonemesh.Mesh) -> None:
    ball = bonemesh.fill_cavities(shell)
    middles = ball.vertices[ball.triangles].mean(axis=1)
    middle = (middles.min(axis=0) + middles.max(axis=0)) / 2
    right = middles - [middles[:, 0].max(), middle[1], middle[2]]
    top = middles - [middle[0], middle[1], middles[:, 2].max()]
    is_gone = (np.linalg.norm(right, axis=1) < 4) | (np.linalg.norm(top, axis=1) < 12)
    torn = bonemesh.Mesh(ball.vertices, ball.triangles[~is_gone])
    assert not is_printable(torn)
    whole = bonemesh.fill_holes(torn)
    assert (whole.report["filled_holes"], whole.report["left_holes"]) == (2, 0)
    assert is_printable(whole)
    kept = len(torn.triangles)
    np.testing.assert_array_equal(whole.triangles[:kept], torn.triangles)
    small = bonemesh.fill_holes(torn, holes=12.0)
    assert (small.report["filled_holes"], small.report["left_holes"]) == (1, 1)
    (left,) = small.report["largest_left_holes"]
    assert left["extent_mm"] > 12 and left["reason"] == "larger than asked for"
    assert left["place_mm"][:2] == pytest.approx(middle[:2], abs=2)


def test_what_faces_the_wrong_way_is_turned(shell: bonemesh.Mesh) -> None:
    wrong = shell.triangles.copy()
    wrong[5:7] = wrong[5:7, ::-1]
    turned = bonemesh.face_outward(bonemesh.Mesh(shell.vertices, wrong))
    assert turned.report["turned_triangles"] == 2
    assert is_printable(turned)
    inside_out = bonemesh.Mesh(shell.vertices, shell.triangles[:, ::-1])
    assert not is_printable(inside_out)
    assert is_printable(bonemesh.face_outward(inside_out))


def test_triangles_without_area_or_given_twice_are_taken_out(
    shell: bonemesh.Mesh,
) -> None:
    # One side of an edge has a corner on it that the other has not; a triangle without area lies between.
    from_, to, tip = shell.triangles[40]
    middle = shell.vertices[[from_, to]].astype(np.float64).mean(axis=0)
    on_edge = len(shell.vertices)
    vertices = np.vstack([shell.vertices, middle])
    more = [[from_, on_edge, tip], [on_edge, to, tip], [from_, to, on_edge]]
    torn = np.delete(shell.triangles, 40, axis=0)
    broken = bonemesh.Mesh(
        vertices, np.vstack([torn, more, torn[7:9], [[3, 3, 4]]]).astype(np.uint32)
    )
    assert not is_printable(broken)
    cleaned = bonemesh.clean(broken)
    assert cleaned.report["removed_doubled"] == 2
    assert cleaned.report["removed_degenerate"] >= 1
    assert bonemesh.check(cleaned)["self_intersections"] == 0
    assert bonemesh.check(cleaned)["watertight"]


@pytest.mark.parametrize("few", [0, 3])
def test_fewer_triangles_than_enclose_anything_are_refused(
    shell: bonemesh.Mesh, few: int
) -> None:
    with pytest.raises(bonemesh.BonemeshError, match="at least 4"):
        bonemesh.decimate(shell, triangles=few)
    volume = bonemesh.phantom("tube", coarser=4.0)
    with pytest.raises(bonemesh.BonemeshError, match="at least 4"):
        bonemesh.render(volume, triangles=few)


def test_the_report_says_what_a_reduction_did(shell: bonemesh.Mesh) -> None:
    volume = bonemesh.check(shell)["volume_mm3"]
    fewer = bonemesh.decimate(shell, triangles=len(shell.triangles) // 8)
    change = 100 * (bonemesh.check(fewer)["volume_mm3"] / volume - 1)
    assert fewer.report["volume_change_percent"] == pytest.approx(change, abs=1e-3)
    away = np.abs(bonemesh.signed_distances(shell.vertices, fewer))
    assert fewer.report["largest_distance_mm"] == pytest.approx(away.max(), abs=1e-4)
    smoothed = bonemesh.smooth(shell, tolerance_mm=0.1)
    assert abs(smoothed.report["volume_change_percent"]) < 1
    assert smoothed.report["largest_distance_mm"] is None


@pytest.mark.parametrize("bad", ["every", -1.0, float("nan")])
def test_what_is_no_size_of_holes_is_refused(shell: bonemesh.Mesh, bad: object) -> None:
    with pytest.raises(bonemesh.BonemeshError):
        bonemesh.fill_holes(shell, holes=bad)


def test_an_island_stays_with_its_cavity(shell: bonemesh.Mesh) -> None:
    speck = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]) + 500
    faces = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    vertices = np.vstack([shell.vertices, speck])
    both = bonemesh.Mesh(
        vertices, np.vstack([shell.triangles, faces + len(shell.vertices)])
    )
    place = tuple(both.vertices[0])
    at_place = bonemesh.keep_islands(both, islands=[place])
    assert at_place.report["removed_islands"] == 1
    assert (at_place.vertices == place).all(axis=1).any()
    with pytest.raises(bonemesh.BonemeshError, match="not near the mesh"):
        bonemesh.keep_islands(both, islands=[(0.0, 1e4, 0.0)])
    for islands in ("largest", 1.0):
        kept = bonemesh.keep_islands(both, islands=islands)
        np.testing.assert_array_equal(kept.vertices, shell.vertices)
        assert kept.report["removed_islands"] == 1
    with pytest.raises(bonemesh.BonemeshError, match="ask for less"):
        bonemesh.keep_islands(both, islands=1e12)


def test_smoothing_moves_no_vertex_too_far(shell: bonemesh.Mesh) -> None:
    smoothed = bonemesh.smooth(shell, tolerance_mm=0.1)
    moves = np.linalg.norm(
        smoothed.vertices.astype(float) - shell.vertices.astype(float), axis=1
    )
    assert 0 < moves.max() <= 0.1
    assert smoothed.report["largest_move_mm"] == pytest.approx(moves.max())
    assert is_printable(smoothed)


def test_decimation_stops_at_the_number_or_the_error(shell: bonemesh.Mesh) -> None:
    fewer = bonemesh.decimate(shell, triangles=1000)
    assert len(fewer.triangles) == 1000
    assert is_printable(fewer)
    near = bonemesh.decimate(shell, error_mm=0.05)
    assert len(near.triangles) < len(shell.triangles)
    assert is_printable(near)
    with pytest.raises(bonemesh.ArgumentError, match="at least one"):
        bonemesh.decimate(shell)


def test_render_does_the_same(shell: bonemesh.Mesh) -> None:
    volume = bonemesh.phantom("sphere-shell", coarser=2.0)
    made = bonemesh.render(
        volume,
        method="isosurface",
        holes="all",
        cavities="all",
        smooth_mm=0.1,
        triangles=2000,
    )
    apart = bonemesh.decimate(
        bonemesh.smooth(bonemesh.fill_cavities(shell), tolerance_mm=0.1), triangles=2000
    )
    np.testing.assert_array_equal(made.vertices, apart.vertices)
    np.testing.assert_array_equal(made.triangles, apart.triangles)
    assert made.report["after_care"]["removed_cavities"] == 1
    assert shell.report["after_care"] is None


@pytest.mark.parametrize("bad", ["biggest", -1.0, float("nan")])
def test_what_is_no_volume_is_refused(shell: bonemesh.Mesh, bad: object) -> None:
    with pytest.raises(bonemesh.BonemeshError):
        bonemesh.keep_islands(shell, islands=bad)
    with pytest.raises(bonemesh.BonemeshError):
        bonemesh.fill_cavities(shell, cavities=bad)
