"""The stages that progress counts on are those that the library reports, in their order (needs no Blender)."""

from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

from blender_addon.jobs import stages
from blender_addon.jobs.timeline import Timeline

MOST_RUNS = 10


@pytest.fixture(scope="module")
def head(bonemesh: ModuleType, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A scan that is not done before a second look at its progress."""
    folder = tmp_path_factory.mktemp("head") / "phantom"
    bonemesh.write_phantom("head", folder, coarser=1.6)
    return folder


def stages_seen(
    bonemesh: ModuleType, ct: Path, target: Path, method: str, options: dict[str, Any]
) -> list[str]:
    """What progress was told of while a folder became a file."""
    seen: list[str] = []

    def note(stage: str, _fraction: float) -> None:
        seen.append(stage)

    mesh = bonemesh.render(ct, method=method, progress=note, **options)
    mesh.save(target, progress=note)
    return seen


@pytest.mark.parametrize("options", [{}, {"triangles": 500}])
@pytest.mark.parametrize("method", stages.STAGES)
def test_a_rendering_goes_through_its_stages_in_order(
    bonemesh: ModuleType,
    head: Path,
    tmp_path: Path,
    method: str,
    options: dict[str, Any],
) -> None:
    weights = stages.of_rendering({"method": method, **options})
    assert weights is not None
    order = list(weights)
    # What comes more than once when triangles are taken away may be too quick to be seen the first time.
    again = {"check", "decimate", "sort triangles", "intersections"}
    repeated = again if options else set()
    known: set[str] = set()
    # A fast machine may be done before a second look all the same: then it is rendered again.
    for _ in range(MOST_RUNS):
        seen = stages_seen(bonemesh, head, tmp_path / "bone.stl", method, options)
        first_seen = dict.fromkeys(
            s for s in seen if s in weights and s not in repeated
        )
        places = [order.index(stage) for stage in first_seen]
        assert places == sorted(places)
        known |= first_seen.keys()
        if len(known) >= 2:
            break
    assert len(known) >= 2
    timeline = Timeline(weights)
    assert timeline.done(seen[-1], 1.0) == pytest.approx(1.0)


@pytest.mark.parametrize(
    "options",
    [
        {"method": "poisson"},
        {"method": "isosurface", "damp_metal": True},
        {"method": "isosurface", "smooth_mm": 0.2},
        {"method": "alpha", "sample_percent": 10.0},
    ],
)
def test_where_the_time_cannot_be_foreseen_stages_stand_for_themselves(
    options: dict[str, Any],
) -> None:
    assert stages.of_rendering(options) is None
