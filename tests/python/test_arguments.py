"""Arguments that cannot be used: one line, the remedy, the right exception; never a panic."""

from __future__ import annotations

import itertools

import bonemesh
import numpy as np
import pytest

NAN = float("nan")
INF = float("inf")
TRIANGLE = ([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
CUBE = list(itertools.product([0.0, 1.0], repeat=3))


def refusal(function, *args, **keywords) -> str:
    """The message of the `ArgumentError` that the call raises."""
    with pytest.raises(bonemesh.ArgumentError) as caught:
        function(*args, **keywords)
    assert isinstance(caught.value, ValueError) and isinstance(
        caught.value, bonemesh.BonemeshError
    )
    message = str(caught.value)
    assert message and "\n" not in message
    return message


@pytest.mark.parametrize(
    ("vertices", "triangles", "says"),
    [
        ([[0, 0], [1, 0]], [[0, 1, 1]], r"(2, 2)"),
        ([0, 1, 2], [[0, 0, 0]], "(N, 3)"),
        ([[0, 0, 0], [1, 0]], [[0, 0, 0]], "vertices"),
        ([["a", "b", "c"]], [[0, 0, 0]], "numbers"),
        ([[0j, 0, 0]], [[0, 0, 0]], "numbers"),
        ([[True, False, True]], [[0, 0, 0]], "numbers"),
        ([[None, 0, 0]], [[0, 0, 0]], "numbers"),
        ([[0, NAN, 0]], [[0, 0, 0]], "row 0"),
        ([[0, 0, 0], [0, -INF, 0]], [[0, 0, 0]], "row 1"),
        ([[1e300, 0, 0]], [[0, 0, 0]], "finite"),
        (TRIANGLE[0], [[0, 1, 3]], "vertex 3"),
        (TRIANGLE[0], [[0, 1, -1]], "-1"),
        (TRIANGLE[0], [[0, 1, 2**32]], "4294967296"),
        (TRIANGLE[0], np.array([[0, 1, 2**64 - 1]], np.uint64), "18446744073709551615"),
        (TRIANGLE[0], [[0.0, 1.0, 2.0]], "whole numbers"),
        (TRIANGLE[0], [0, 1, 2], "(M, 3)"),
        (TRIANGLE[0], [[0, 1, 2, 2]], "(M, 3)"),
        (TRIANGLE[0], None, "triangles"),
    ],
)
def test_a_mesh_of_unusable_arrays(vertices, triangles, says):
    assert says in refusal(bonemesh.Mesh, vertices, triangles)


@pytest.mark.parametrize(
    ("hu", "affine", "says"),
    [
        (np.zeros((2, 2)), np.eye(4), "[slice, row, column]"),
        (np.zeros((2, 2, 2), bool), np.eye(4), "int16 or float32"),
        (np.zeros((0, 2, 2)), np.eye(4), "at least one"),
        (np.full((1, 1, 1), NAN), np.eye(4), "nan_to_num"),
        (np.full((1, 1, 1), INF), np.eye(4), "nan_to_num"),
        (np.zeros((1, 1, 1)), np.eye(3), "4x4"),
        (np.zeros((1, 1, 1)), np.zeros((4, 4)), "0, 0, 0, 1"),
        (np.zeros((1, 1, 1)), np.diag([1, 1, 0, 1]), "degenerate"),
        (np.zeros((1, 1, 1)), np.diag([1, NAN, 1, 1]), "degenerate"),
        (np.zeros((1, 70000, 1), np.int8), np.eye(4), "65535"),
    ],
)
def test_a_volume_of_unusable_arrays(hu, affine, says):
    assert says in refusal(bonemesh.Volume, hu, affine)


@pytest.mark.parametrize(
    ("keywords", "says"),
    [
        ({"threshold_hu": NAN}, "350"),
        ({"threshold_hu": INF}, "350"),
        ({"method": "magic"}, "alpha"),
        ({"sigma": -1.0}, "sigma"),
        ({"sigma": NAN}, "sigma"),
        ({"sampler": "magic"}, "thesis-uniform"),
        ({"sample_percent": 0}, "above 0"),
        ({"sample_percent": 101}, "100"),
        ({"sample_percent": NAN}, "percentage"),
        ({"alpha_mm": 0}, "above 0"),
        ({"alpha_mm": -1}, "above 0"),
        ({"alpha_mm": NAN}, "above 0"),
        ({"threads": 0}, "threads"),
        ({"threads": -1}, "threads"),
        ({"threads": 10**9}, "1024"),
        ({"threads": 10**60}, "1024"),
        ({"threads": True}, "threads"),
        ({"threads": 1.0}, "threads"),
        ({"seed": -1}, "seed"),
        ({"seed": 2**64}, "seed"),
        ({"crop": "all"}, "0:256"),
        ({"crop": "0:1,0:1"}, "0:256"),
        ({"crop": "5:5,0:1,0:1"}, "columns"),
        ({"crop": "0:1,0:9999,0:1"}, "rows"),
        ({"crop": [(0, 1), (0, 1)]}, "three pairs"),
        ({"crop": [(0, 1), (0, 1), (-1, 1)]}, "three pairs"),
        ({"crop": [(0, 1), (0, 1), (0, 1.5)]}, "three pairs"),
        ({"crop": 7}, "three pairs"),
        ({"series": 1}, "volume"),
        ({"series": 0}, "1 is the largest"),
        ({"series": "head"}, "UID"),
        ({"series": True}, "1 is the largest"),
        ({"series": 1.0}, "1 is the largest"),
        ({"progress": 1}, "function"),
    ],
)
def test_rendering_with_unusable_settings(volume, keywords, says):
    assert says in refusal(bonemesh.render, volume, **keywords)


def test_only_a_path_or_a_volume_is_rendered():
    for source in [None, 7, [1], np.zeros((2, 2, 2))]:
        assert "bonemesh.Volume" in refusal(bonemesh.render, source)


@pytest.mark.parametrize(
    ("selected", "says"),
    [
        (np.zeros(4, bool), "flatnonzero"),
        ([0.0, 1.0], "whole numbers"),
        ([[0, 1]], "one-dimensional"),
        ([-1], "from 0"),
        ([2**32], "from 0"),
        (["a"], "whole numbers"),
        (3, "one-dimensional"),
    ],
)
def test_an_unusable_selection(mesh, selected, says):
    assert says in refusal(bonemesh.select_roi, mesh, selected, thickness_mm=5)


@pytest.mark.parametrize("thickness", [0, -1, NAN, INF])
def test_an_unusable_thickness(mesh, patch, thickness):
    assert "thickness" in refusal(
        bonemesh.select_roi, mesh, patch, thickness_mm=thickness
    )


def test_an_unknown_region_method(mesh, patch):
    says = refusal(bonemesh.select_roi, mesh, patch, thickness_mm=5, method="magic")
    assert "solid, thesis" in says


@pytest.mark.parametrize("selected", [[], [3], [2**31]])
def test_a_selection_without_a_region(mesh, selected):
    with pytest.raises(bonemesh.BonemeshError) as caught:
        bonemesh.select_roi(mesh, selected, thickness_mm=5)
    assert "select" in str(caught.value) and "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("points", "keywords", "says"),
    [
        ([[0, 0]], {}, "(N, 3)"),
        ([[0.0, 0.0, NAN]], {}, "row 0"),
        (np.array([[2**31, 0, 0]]), {}, "32 bits"),
        (CUBE, {"spacing_mm": (0, 1, 1)}, "three lengths"),
        (CUBE, {"spacing_mm": (1, 1)}, "three lengths"),
        (CUBE, {"spacing_mm": 1}, "three lengths"),
        (CUBE, {"spacing_mm": (0.3, 1, 1)}, "lattice"),
    ],
)
def test_unusable_points(points, keywords, says):
    assert says in refusal(bonemesh.tetrahedralize, points, **keywords)
    assert says in refusal(bonemesh.alpha_surface, points, 1.0, **keywords)
    assert says in refusal(bonemesh.mean_neighbour_distance, points, **keywords)
    assert says in refusal(bonemesh.sample, points, percent=10, **keywords)


@pytest.mark.parametrize(
    ("points", "says"),
    [
        (np.zeros((0, 3)), "4"),
        (CUBE[:3], "4"),
        ([CUBE[0]] * 9, "4"),
        ([(float(i), 0, 0) for i in range(9)], "line"),
        ([(float(i), float(i * i), 0) for i in range(9)], "plane"),
        (np.array([(i, i * i, 0) for i in range(9)]), "plane"),
    ],
)
def test_points_without_volume(points, says):
    with pytest.raises(bonemesh.BonemeshError) as caught:
        bonemesh.tetrahedralize(points)
    assert says in str(caught.value) and "\n" not in str(caught.value)


@pytest.mark.parametrize("alpha", [0, -1, NAN])
def test_an_unusable_alpha(alpha):
    assert "alpha" in refusal(bonemesh.alpha_surface, CUBE, alpha)


def test_an_alpha_that_keeps_nothing():
    with pytest.raises(bonemesh.BonemeshError, match="raise alpha"):
        bonemesh.alpha_surface(CUBE, 0.1)


@pytest.mark.parametrize("k", [0, 1, -1, 10**30])
def test_an_unusable_number_of_neighbours(k):
    with pytest.raises(bonemesh.BonemeshError, match="neighbours"):
        bonemesh.mean_neighbour_distance(CUBE, k=k)


@pytest.mark.parametrize(
    ("image", "keywords", "says"),
    [
        (np.zeros(4), {}, "[row, column]"),
        (np.zeros((1, 2, 3, 4)), {}, "[row, column]"),
        (np.zeros((4, 4), np.int64), {}, "32-bit"),
        (np.zeros((4, 4), complex), {}, "bool"),
        (np.array([["a"]]), {}, "bool"),
        (np.zeros((4, 4)), {"sigma": -1}, "sigma"),
        (np.zeros((4, 4)), {"low": 0.3}, "low"),
        (np.zeros((4, 4)), {"low": -0.1}, "low"),
        (np.zeros((4, 4)), {"high": NAN}, "high"),
    ],
)
def test_canny_of_unusable_images(image, keywords, says):
    assert says in refusal(bonemesh.canny, image, **keywords)


def test_images_without_pixels_have_no_edges():
    for shape in [(0, 0), (0, 5), (5, 0), (0, 4, 4), (2, 0, 4), (1, 1), (2, 2)]:
        for dtype in [bool, float, np.uint8]:
            edges = bonemesh.canny(np.zeros(shape, dtype))
            assert edges.shape == shape and not edges.any()


def test_unknown_phantoms_and_orientations(tmp_path):
    assert "sphere-shell" in refusal(bonemesh.phantom, "elephant")
    assert "axial" in refusal(bonemesh.phantom, "tube", orientation="sideways")
    assert "coarser" in refusal(bonemesh.phantom, "tube", coarser=0)
    assert "noise_hu" in refusal(bonemesh.phantom, "tube", noise_hu=-1)
    assert "elephant" in refusal(bonemesh.write_phantom, "elephant", tmp_path / "x")
    assert list(tmp_path.iterdir()) == []


def test_an_unknown_frame(volume):
    assert "patient" in refusal(bonemesh.point_cloud, volume, frame="table")


@pytest.mark.parametrize("threshold", [-2000, 5000])
def test_a_threshold_with_nothing_on_one_side(volume, threshold):
    with pytest.raises(bonemesh.BonemeshError, match="HU"):
        bonemesh.render(volume, threshold_hu=threshold)


def test_arguments_of_a_wrong_type_are_type_errors(mesh, volume, tmp_path):
    for call in [
        lambda: bonemesh.check(None),
        lambda: bonemesh.check(volume),
        lambda: bonemesh.point_cloud(mesh),
        lambda: bonemesh.select_roi(volume, [0], thickness_mm=1),
        lambda: bonemesh.select_roi(mesh, [0]),
        lambda: bonemesh.select_roi(mesh, [0], 5.0),
        lambda: bonemesh.render(volume, sigma="1"),
        lambda: bonemesh.render(volume, cancel=True),
        lambda: bonemesh.render(volume, magic=1),
        lambda: bonemesh.read_mesh(None),
        lambda: bonemesh.find_series(3.5),
        lambda: mesh.save(None),
        lambda: bonemesh.Mesh(),
        lambda: bonemesh.phantom(None),
    ]:
        with pytest.raises(TypeError) as caught:
            call()
        assert "\n" not in str(caught.value)


ODD = [
    None,
    True,
    -1,
    0,
    3,
    10**40,
    1.5,
    NAN,
    -INF,
    "",
    "a\0b",
    "\ud800",
    b"bytes",
    [],
    [[]],
    {},
    object(),
    np.zeros((0, 3)),
    np.zeros((3, 3)),
    np.zeros((2, 3), np.int8),
    np.full((5, 3), 1e308),
    np.full((5, 3), 1e-308),
    np.zeros((4, 3), "datetime64[s]"),
    np.zeros(3, "i4,f4"),
    np.ma.masked_array(np.zeros((4, 3)), mask=True),
    np.float32(2),
    np.array(7),
    lambda *_: None,
]


def test_odd_values_never_panic(mesh, volume):
    """Every function with every odd value in every place: an exception of the right kind, or none."""
    shell = bonemesh.PhantomSurface("sphere-shell")
    calls = {
        bonemesh.Mesh: [2, []],
        bonemesh.Volume: [2, []],
        bonemesh.canny: [1, ["sigma", "low", "high", "threads", "progress", "cancel"]],
        bonemesh.tetrahedralize: [1, ["spacing_mm", "threads", "progress"]],
        bonemesh.alpha_surface: [2, ["spacing_mm", "threads"]],
        bonemesh.mean_neighbour_distance: [1, ["k", "include_self", "spacing_mm"]],
        bonemesh.sample: [1, ["percent", "sampler", "seed", "spacing_mm"]],
        bonemesh.point_cloud: [1, ["threshold_hu", "sigma", "frame"]],
        bonemesh.render: [
            1,
            ["threshold_hu", "crop", "series", "seed", "sample_percent"],
        ],
        bonemesh.select_roi: [2, ["thickness_mm", "method"]],
        bonemesh.histogram: [1, ["bin_hu", "crop", "threads"]],
        bonemesh.suggest_thresholds: [1, ["crop", "threads"]],
        bonemesh.label_components: [1, ["connectivity", "threads"]],
        bonemesh.check: [1, ["progress", "cancel"]],
        bonemesh.wall_thickness: [1, ["progress", "cancel"]],
        bonemesh.find_series: [1, ["threads"]],
        bonemesh.read_series: [2, []],
        bonemesh.read_mesh: [1, []],
        bonemesh.phantom: [1, ["coarser", "orientation", "psf_px", "noise_hu", "seed"]],
        shell.nearest: [1, ["crease_mm", "threads"]],
        shell.samples: [1, ["seed", "threads"]],
        bonemesh.PhantomSurface: [1, []],
    }
    good = {
        bonemesh.Mesh: [*TRIANGLE],
        bonemesh.Volume: [np.zeros((2, 2, 2)), np.eye(4)],
        bonemesh.canny: [np.zeros((9, 9), bool)],
        bonemesh.tetrahedralize: [CUBE],
        bonemesh.alpha_surface: [CUBE, 2.0],
        bonemesh.mean_neighbour_distance: [CUBE],
        bonemesh.sample: [CUBE],
        bonemesh.point_cloud: [volume],
        bonemesh.render: [volume],
        bonemesh.select_roi: [mesh, [0, 1, 2]],
        bonemesh.histogram: [volume],
        bonemesh.suggest_thresholds: [volume],
        bonemesh.label_components: [np.ones((3, 3, 3), bool)],
        bonemesh.check: [mesh],
        bonemesh.wall_thickness: [mesh],
        bonemesh.find_series: ["no such folder"],
        bonemesh.read_series: ["no such folder", 1],
        bonemesh.read_mesh: ["no such file.stl"],
        bonemesh.phantom: ["curved"],
        shell.nearest: [CUBE],
        shell.samples: [3],
        bonemesh.PhantomSurface: ["tube"],
    }
    needed = {
        bonemesh.sample: {"percent": 50},
        bonemesh.select_roi: {"thickness_mm": 1.0},
    }
    expected = (bonemesh.BonemeshError, TypeError, ValueError, OSError, OverflowError)
    for function, (places, names) in calls.items():
        for odd in ODD:
            for place in [*range(places), *names]:
                args = list(good[function])
                keywords = dict(needed.get(function, {}))
                if isinstance(place, int):
                    args[place] = odd
                else:
                    keywords[place] = odd
                try:
                    function(*args, **keywords)
                except expected as error:
                    # The last word on a panic in a worker thread; it must never be heard.
                    assert "bug" not in str(error), (function, place, odd)
