"""Each edge of a mesh is found once, and each corner knows its own (needs no Blender)."""

import numpy as np
import pytest

from blender_addon.scene import mesh_edges


def triangles(kind: str) -> np.ndarray:
    """Of a closed body, an open strip, an edge of three triangles, and nothing."""
    meshes = {
        "closed": [(0, 1, 2), (0, 2, 3), (0, 3, 1), (1, 3, 2)],
        "open": [(0, 1, 2), (2, 1, 3), (2, 3, 4)],
        "three": [(0, 1, 2), (0, 1, 3), (1, 0, 4)],
        "none": [],
    }
    return np.array(meshes[kind], dtype=np.uint32).reshape(-1, 3)


@pytest.mark.parametrize("kind", ["closed", "open", "three", "none"])
@pytest.mark.parametrize("most_bits", [64, 1])
def test_every_edge_is_there_once(
    monkeypatch: pytest.MonkeyPatch, kind: str, most_bits: int
) -> None:
    monkeypatch.setattr(mesh_edges, "MOST_BITS", most_bits)
    mesh = triangles(kind)
    edges = mesh_edges.edges_of(mesh, 5)
    sides = [
        tuple(sorted((int(t[i]), int(t[(i + 1) % 3])))) for t in mesh for i in range(3)
    ]
    ends = [tuple(int(v) for v in pair) for pair in edges.ends]
    assert ends == sorted(set(sides))
    assert [ends[i] for i in edges.of_corners] == sides
    assert edges.ends.dtype == edges.of_corners.dtype == np.int32


def test_many_and_few_are_found_alike() -> None:
    mesh = np.random.default_rng(1).integers(0, 3000, (5000, 3), dtype=np.uint32)
    few = mesh_edges.edges_of(mesh, 3000)
    begins = mesh.astype(np.uint64)
    many = mesh_edges.edges_of_many(begins, np.roll(begins, -1, axis=1))
    np.testing.assert_array_equal(few.ends, many.ends)
    np.testing.assert_array_equal(few.of_corners, many.of_corners)
