"""Meshes and volumes show their arrays as read-only views."""

import gc
import sys
import weakref

import bonemesh
import numpy as np
import pytest

TETRAHEDRON = [[0, 0, 0], [3, 0, 0], [0, 3, 0], [0, 0, 3]]
FACES = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]


def views(mesh: bonemesh.Mesh, volume: bonemesh.Volume) -> list[np.ndarray]:
    return [mesh.vertices, mesh.triangles, volume.hu]


def test_arrays_have_the_promised_types(mesh, volume):
    assert mesh.vertices.dtype == np.float32 and mesh.vertices.shape[1] == 3
    assert mesh.triangles.dtype == np.uint32 and mesh.triangles.shape[1] == 3
    assert volume.hu.dtype == np.int16 and volume.hu.ndim == 3
    assert volume.patient_from_voxel.dtype == np.float64
    assert volume.patient_from_voxel.shape == (4, 4)


def test_every_look_shows_the_same_memory(mesh, volume):
    for first, second in zip(views(mesh, volume), views(mesh, volume), strict=True):
        assert first.__array_interface__["data"] == second.__array_interface__["data"]
        assert not first.flags.owndata


def test_views_cannot_be_written_to_nor_made_writeable(mesh, volume):
    for view in views(mesh, volume):
        with pytest.raises(ValueError, match="read-only"):
            view[0] = 0
        with pytest.raises(ValueError, match="WRITEABLE"):
            view.flags.writeable = True


def test_a_view_outlives_its_mesh():
    mesh = bonemesh.Mesh(TETRAHEDRON, FACES)
    vertices, triangles = mesh.vertices, mesh.triangles
    del mesh
    gc.collect()
    noise = [np.full(1000, 7.0, np.float32) for _ in range(100)]
    assert vertices.tolist() == TETRAHEDRON
    assert triangles.tolist() == FACES
    del noise


def test_a_mesh_lives_exactly_as_long_as_somebody_looks_at_it():
    mesh = bonemesh.Mesh(TETRAHEDRON, FACES)
    before = sys.getrefcount(mesh)
    view = mesh.vertices
    assert sys.getrefcount(mesh) == before + 1
    slice_of_view = view[1:]
    del view
    assert sys.getrefcount(mesh) == before + 1
    del slice_of_view
    assert sys.getrefcount(mesh) == before


def test_inputs_are_copied():
    vertices = np.array(TETRAHEDRON, np.float32)
    hu = np.zeros((2, 2, 2), np.int16)
    mesh = bonemesh.Mesh(vertices, FACES)
    volume = bonemesh.Volume(hu, np.eye(4))
    gone = weakref.ref(vertices)
    vertices[:] = 9
    hu[:] = 9
    assert mesh.vertices.tolist() == TETRAHEDRON
    assert not volume.hu.any()
    del vertices
    assert gone() is None


def test_objects_cannot_be_changed(mesh, volume):
    for thing, name in [(mesh, "vertices"), (mesh, "report"), (volume, "hu")]:
        with pytest.raises(AttributeError):
            setattr(thing, name, None)
    with pytest.raises(AttributeError):
        mesh.anything = 1


def test_a_report_is_a_new_dict_each_time(mesh):
    mesh.report["points"] = "changed"
    assert isinstance(mesh.report["points"], int)


@pytest.mark.parametrize("order", ["C", "F"])
@pytest.mark.parametrize(
    "dtype", ["float16", "float32", "float64", ">f8", "int32", "uint8"]
)
def test_any_number_type_and_memory_order_makes_a_mesh(dtype, order):
    vertices = np.array(TETRAHEDRON, dtype, order=order)
    for triangles in [np.array(FACES, "int64", order=order), np.array(FACES, "uint32")]:
        mesh = bonemesh.Mesh(vertices[::1], triangles)
        assert mesh.vertices.tolist() == TETRAHEDRON
        assert mesh.triangles.tolist() == FACES


def test_strided_and_misaligned_arrays_are_read_right():
    wide = np.zeros((4, 6))
    wide[:, ::2] = TETRAHEDRON
    bytes_before = np.frombuffer(b"x" + np.array(TETRAHEDRON, "f8").tobytes(), np.uint8)
    misaligned = bytes_before[1:].view("f8").reshape(4, 3)
    assert not misaligned.flags.aligned
    for vertices in [wide[:, ::2], wide[::-1, ::2][::-1], misaligned]:
        assert bonemesh.Mesh(vertices, FACES).vertices.tolist() == TETRAHEDRON


def test_a_volume_keeps_whole_numbers_in_16_bits():
    values = [[[-1024, 3071]]]
    for dtype in ["int16", "int8", "uint8", "int32", "int64"]:
        hu = (
            np.array(values)
            .clip(np.iinfo(dtype).min, np.iinfo(dtype).max)
            .astype(dtype)
        )
        volume = bonemesh.Volume(hu, np.eye(4))
        assert volume.hu.dtype == np.int16
        assert (volume.hu == hu).all()
    assert bonemesh.Volume([[[0, 40000]]], np.eye(4)).hu.dtype == np.float32
    assert (
        bonemesh.Volume(np.array(values, float) / 2, np.eye(4)).hu.dtype == np.float32
    )


def test_a_volume_keeps_its_place_in_the_patient():
    affine = np.array([[0, 0.5, 0, 10], [0.25, 0, 0, -20], [0, 0, 2, 30], [0, 0, 0, 1]])
    volume = bonemesh.Volume(np.zeros((2, 3, 4), np.int16), affine)
    assert (volume.patient_from_voxel == affine).all()
    assert volume.spacing_mm == (0.25, 0.5, 2.0)
    assert volume.warnings == []


def test_single_precision_is_all_that_a_mesh_has(tmp_path):
    vertices = np.array(TETRAHEDRON) + 0.1
    mesh = bonemesh.Mesh(vertices, FACES)
    assert (mesh.vertices == vertices.astype(np.float32)).all()
    mesh.save(tmp_path / "mesh.ply")
    again = bonemesh.read_mesh(tmp_path / "mesh.ply")
    assert (again.vertices == mesh.vertices).all()
    assert (again.triangles == mesh.triangles).all()


def test_results_own_their_memory(volume):
    points = bonemesh.point_cloud(volume)
    assert points.dtype == np.float64 and points.shape[1] == 3
    points[:] = 0  # the caller's to change
    cells = bonemesh.tetrahedralize(np.random.default_rng(1).random((9, 3)))
    assert cells.dtype == np.uint32 and cells.shape[1] == 4
    kept = bonemesh.sample(np.random.default_rng(1).random((50, 3)), percent=10)
    assert kept.dtype == np.uint32 and kept.ndim == 1
    assert bonemesh.canny(np.zeros((4, 5), bool)).shape == (4, 5)
    assert bonemesh.canny(np.zeros((3, 4, 5), bool)).shape == (3, 4, 5)


def test_objects_introduce_themselves(mesh, volume, ct_folder):
    assert str(len(mesh.vertices)) in repr(mesh)
    assert "30 slices" in repr(volume)
    found = bonemesh.scan(ct_folder.parent)
    assert "1 series" in repr(found) and "30 slices" in repr(found.series[0])
    assert "truth.json" in repr(found.left_out[0])
    assert "not thrown" in repr(bonemesh.Cancel())
