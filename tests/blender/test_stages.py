"""The stages that progress counts on are those that the library reports, in their order (needs no Blender)."""

from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

from blender_addon.jobs import stages
from blender_addon.jobs.timeline import Timeline


@pytest.mark.parametrize("options", [{}, {"triangles": 500}])
@pytest.mark.parametrize("method", stages.STAGES)
def test_a_rendering_goes_through_its_stages_in_order(
    bonemesh: ModuleType, ct: Path, tmp_path: Path, method: str, options: dict[str, Any]
) -> None:
    weights = stages.of_rendering({"method": method, **options})
    assert weights is not None
    seen: list[str] = []

    def note(stage: str, _fraction: float) -> None:
        seen.append(stage)

    mesh = bonemesh.render(ct, method=method, progress=note, **options)
    mesh.save(tmp_path / "bone.stl", progress=note)
    order = list(weights)
    # What is checked once more after triangles were taken away may be too quick to be seen before.
    repeated = {"check"} if options else set()
    first_seen = dict.fromkeys(s for s in seen if s in weights and s not in repeated)
    places = [order.index(stage) for stage in first_seen]
    assert len(places) >= 2
    assert places == sorted(places)
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
