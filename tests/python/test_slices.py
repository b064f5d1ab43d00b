"""Slices lie where their voxels are, and contours where the surface is."""

import bonemesh
import manifold3d
import numpy as np
import pytest

ORIENTATIONS = [
    "axial",
    "reversed",
    "sagittal",
    "coronal",
    "oblique",
    "tilted",
    "feet-first",
    "prone",
    "decubitus-left",
    "decubitus-right",
]
PLANES = ["axial", "coronal", "sagittal"]


def places(plane: bonemesh.SlicePlane, position_mm: float) -> np.ndarray:
    """Where in the patient each pixel's centre is, (rows, columns, 3)."""
    rows, columns = plane.shape
    right = (np.arange(columns) + 0.5 - columns / 2) * plane.pixel_mm
    up = (rows / 2 - 0.5 - np.arange(rows)) * plane.pixel_mm
    x, y = np.meshgrid(right, up)
    ends = np.stack([x, y, np.full_like(x, position_mm), np.ones_like(x)], axis=-1)
    return ends @ plane.patient_from_plane[:3].T


def at(volume: bonemesh.Volume, patient_mm: np.ndarray) -> np.ndarray:
    """Hounsfield units at places, by SciPy."""
    from scipy.ndimage import map_coordinates

    inverse = np.linalg.inv(volume.patient_from_voxel)
    index = patient_mm @ inverse[:3, :3].T + inverse[:3, 3]
    hu = volume.hu.astype(np.float64)
    return map_coordinates(
        hu, np.moveaxis(index[..., ::-1], -1, 0), order=1, mode="nearest"
    )


@pytest.mark.parametrize("orientation", ORIENTATIONS)
@pytest.mark.parametrize("name", PLANES)
def test_every_pixel_shows_what_is_at_its_place_in_the_patient(
    orientation: str, name: str
) -> None:
    volume = bonemesh.phantom("head", coarser=4.0, orientation=orientation)
    plane = volume.plane(name)
    low, high = plane.positions_mm
    for position in (low, (low + high) / 2 + 0.3):
        picture = volume.slice(name, position)
        assert picture.shape == plane.shape and picture.dtype == np.float32
        seen = np.isfinite(picture)
        assert seen.any()
        expected = at(volume, places(plane, position))
        np.testing.assert_allclose(picture[seen], expected[seen], atol=0.1)


@pytest.mark.parametrize(
    "orientation", ["axial", "reversed", "feet-first", "sagittal", "prone"]
)
def test_left_is_left_front_is_on_top_and_the_head_is_up(orientation: str) -> None:
    volume = bonemesh.phantom("head", coarser=4.0, orientation=orientation)
    axial, coronal, sagittal = map(volume.plane, PLANES)
    right, up = axial.patient_from_plane[:3, 0], axial.patient_from_plane[:3, 1]
    assert right[0] > 0.9 and up[1] < -0.9
    right, up = coronal.patient_from_plane[:3, 0], coronal.patient_from_plane[:3, 1]
    assert right[0] > 0.9 and up[2] > 0.9
    right, up = sagittal.patient_from_plane[:3, 0], sagittal.patient_from_plane[:3, 1]
    assert right[1] > 0.9 and up[2] > 0.9
    assert [axial.name, coronal.name, sagittal.name] == PLANES


def test_a_slice_of_the_volume_is_shown_voxel_for_voxel() -> None:
    volume = bonemesh.phantom("tube", coarser=2.0)
    low, _ = volume.plane("axial").positions_mm
    step = volume.plane("axial").step_mm
    for number in (0, 3):
        picture = volume.slice("axial", low + number * step)
        np.testing.assert_array_equal(picture, volume.hu[number])


def test_a_window_turns_units_into_greys() -> None:
    hu = np.array([[[-1000, 100, 400, 900, 3000]]], dtype=np.int16)
    volume = bonemesh.Volume(hu, np.eye(4))
    grey = volume.slice("axial", 0.0, window_hu=(400, 1000))
    assert grey.dtype == np.uint8
    assert grey[0].tolist() == [0, 51, 128, 255, 255]
    assert not volume.slice("axial", 9.0, window_hu=(400, 1000)).any()


@pytest.mark.parametrize(
    ("keywords", "word"),
    [
        ({"name": "diagonal"}, "axial, coronal, sagittal"),
        ({"position_mm": float("nan")}, "position_mm"),
        ({"window_hu": (400.0, 0.0)}, "window"),
    ],
)
def test_what_is_no_slice_is_refused(keywords: dict, word: str) -> None:
    volume = bonemesh.phantom("tube", coarser=3.0)
    with pytest.raises(bonemesh.ArgumentError, match=word):
        volume.slice(**{"name": "axial", "position_mm": 0.0, **keywords})


def area_mm2(line: np.ndarray, normal: np.ndarray) -> float:
    """What a closed line encloses, counted counter-clockwise seen against the normal."""
    rays = line - line[0]
    return 0.5 * float(np.cross(rays[:-1], rays[1:]).sum(axis=0) @ normal)


@pytest.mark.parametrize("normal", [(0, 0, 1), (0.3, -0.5, 0.8)])
def test_contours_enclose_what_another_library_cuts(normal: tuple) -> None:
    mesh = bonemesh.render(bonemesh.phantom("femur", coarser=2.0))
    normal = np.array(normal) / np.linalg.norm(normal)
    middle = mesh.vertices.mean(axis=0, dtype=float)
    lines = bonemesh.section(mesh, middle, normal)
    assert lines
    for line in lines:
        assert np.array_equal(line[0], line[-1])
        assert abs((line - middle) @ normal).max() < 1e-6
    area = sum(area_mm2(line, normal) for line in lines)
    # Turned so that the normal points up.
    side = np.cross(normal, [1.0, 0.0, 0.0])
    side /= np.linalg.norm(side)
    turn = np.stack([np.cross(side, normal), side, normal])
    turned = (mesh.vertices - middle) @ turn.T
    turned = np.ascontiguousarray(turned, dtype=np.float32)
    triangles = np.array(mesh.triangles)
    other = manifold3d.Manifold(manifold3d.Mesh(turned, triangles))
    assert area == pytest.approx(other.slice(0.0).area(), rel=1e-4)


def test_the_contour_lies_where_the_image_is_grey() -> None:
    volume = bonemesh.phantom("tube", coarser=1.0)
    mesh = bonemesh.render(volume, true_edges=False, threshold_hu=400)
    plane = volume.plane("axial")
    position = float(np.mean(plane.positions_mm))
    origin = plane.patient_from_plane @ (0, 0, position, 1)
    lines = bonemesh.section(mesh, origin[:3], plane.patient_from_plane[:3, 2])
    points = np.vstack(lines)
    assert abs(at(volume, points) - 400).mean() < 40


@pytest.mark.parametrize(
    ("point", "normal"),
    [((0, 0), (0, 0, 1)), ((0, 0, 0), (0, 0, 0)), ((0, 0, np.nan), (0, 0, 1))],
)
def test_what_is_no_plane_is_refused(point: tuple, normal: tuple) -> None:
    mesh = bonemesh.render(bonemesh.phantom("tube", coarser=3.0))
    with pytest.raises(bonemesh.ArgumentError):
        bonemesh.section(mesh, point, normal)


def test_a_section_does_not_depend_on_those_before() -> None:
    mesh = bonemesh.render(bonemesh.phantom("femur", coarser=3.0))
    middle = mesh.vertices.mean(axis=0, dtype=float)
    first = bonemesh.section(mesh, middle, (0, 0, 1))
    bonemesh.section(mesh, middle, (1, 0, 0))
    again = bonemesh.section(mesh, middle, (0, 0, 1))
    fresh = bonemesh.Mesh(mesh.vertices, mesh.triangles)
    for lines in (again, bonemesh.section(fresh, middle, (0, 0, 1))):
        assert len(lines) == len(first) > 0
        for one, other in zip(lines, first, strict=True):
            np.testing.assert_array_equal(one, other)
