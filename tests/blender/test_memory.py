"""Memory is estimated near what was measured, and a warning names the remedy (needs no Blender)."""

import pytest

from blender_addon.request import memory

MIB = 2.0**20


@pytest.mark.parametrize(
    ("method", "voxels", "measured_mib"),
    [
        ("isosurface", 36_700_160, 348),
        ("isosurface", 7_077_888, 115),
        ("labelled", 36_700_160, 756),
        ("labelled", 7_077_888, 208),
        ("alpha", 36_700_160, 326),
        ("alpha", 7_077_888, 119),
    ],
)
def test_the_estimate_is_near_what_was_measured(
    method: str, voxels: int, measured_mib: float
) -> None:
    estimated_mib = memory.needed_bytes(voxels, voxels, method) / MIB
    assert 0.95 < estimated_mib / measured_mib < 1.35


def test_a_part_needs_less_than_the_whole() -> None:
    whole = memory.needed_bytes(1_000_000, 1_000_000, "isosurface")
    part = memory.needed_bytes(1_000_000, 100_000, "isosurface")
    assert 2_000_000 < part < whole


def test_too_little_memory_is_said_with_its_remedy() -> None:
    text = memory.warning(6.0 * memory.GIB, 1.5 * memory.GIB)
    assert text is not None
    assert "6.0 GB" in text
    assert "1.5 GB" in text
    assert "crop box" in text
    assert memory.warning(1.0 * memory.GIB, 1.5 * memory.GIB) is None
    assert memory.warning(1.0 * memory.GIB, None) is None


def test_this_machine_tells_what_is_free() -> None:
    free = memory.free_bytes()
    assert free is not None
    assert 2**20 < free < 2**50
