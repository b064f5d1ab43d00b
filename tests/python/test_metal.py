"""Metal is told of every rendering, and its streaks are damped when asked for."""

from __future__ import annotations

import bonemesh
import numpy as np
import pytest

SHAPE = (24, 80, 80)


@pytest.fixture(scope="module")
def jaw() -> np.ndarray:
    """A ring of bone in soft tissue, without metal."""
    rows, columns = np.mgrid[: SHAPE[1], : SHAPE[2]]
    away = np.hypot(rows - 40, columns - 40)
    tissue = np.select([(away >= 15) & (away < 20), away < 36], [1200, 40], -1000)
    noise = (5 * columns + 3 * rows) % 13
    return np.broadcast_to(tissue + noise, SHAPE).astype(np.int16)


@pytest.fixture(scope="module")
def crowned(jaw: np.ndarray) -> np.ndarray:
    """The same with a crown in slices 10 to 13 and a streak across."""
    hu = jaw.copy()
    rows, columns = np.mgrid[: SHAPE[1], : SHAPE[2]]
    is_streaked = (np.abs(rows - 24) < 2) & (jaw[0] > -500)
    hu[10:14, is_streaked] += 420
    hu[10:14, np.hypot(rows - 24, columns - 28) < 4] = 3071
    return hu


def volume(hu: np.ndarray) -> bonemesh.Volume:
    return bonemesh.Volume(hu, np.diag([0.6, 0.6, 1.0, 1.0]))


def test_a_report_tells_of_metal(crowned):
    report = bonemesh.render(volume(crowned)).report
    metal = report["metal"]
    assert metal["pieces"] == 1 and metal["slices"] == [10, 13]
    assert metal["z_mm"] == pytest.approx([10, 13])
    assert metal["volume_mm3"] == pytest.approx((crowned >= 3000).sum() * 0.36)
    assert metal["damped"] is False
    assert any("metal" in note for note in report["warnings"])


def test_damping_takes_most_of_the_false_bone_of_a_streak_away(jaw, crowned):
    usual = bonemesh.render(volume(crowned))
    clean = bonemesh.render(volume(jaw))
    damped = bonemesh.render(volume(crowned), damp_metal=True)
    assert damped.report["metal"]["damped"] is True

    def false_mm3(mesh: bonemesh.Mesh) -> float:
        return mesh.report["volume_mm3"] - clean.report["volume_mm3"]

    assert false_mm3(usual) > 100
    assert 2 * abs(false_mm3(damped)) < false_mm3(usual)


def test_values_that_are_no_hounsfield_units_are_no_metal(jaw):
    bright = volume(np.where(jaw > -500, 30_000, -1000).astype(np.int16))
    assert bonemesh.render(bright).report["metal"] is None


def test_without_metal_damping_changes_nothing(jaw):
    usual = bonemesh.render(volume(jaw))
    damped = bonemesh.render(volume(jaw), damp_metal=True)
    assert usual.report["metal"] is None and damped.report["metal"] is None
    assert (usual.vertices == damped.vertices).all()
    assert (usual.triangles == damped.triangles).all()
