"""Of the surfaces that are asked for while one is made only the newest counts (needs no Blender)."""

import threading
import time
from collections.abc import Iterator
from types import ModuleType, SimpleNamespace
from typing import Any

import numpy as np
import pytest


@pytest.fixture
def previews(bonemesh: ModuleType) -> Iterator[ModuleType]:
    from blender_addon.preview import previews

    yield previews
    assert previews.stop_all(10.0)


class Held:
    """A preview whose surfaces are made when the gate is opened."""

    def __init__(self) -> None:
        self.gate = threading.Event()
        self.begun: list[int] = []

    def surface(self, threshold_hu: int, *, crop: Any, cancel: Any) -> Any:
        self.begun.append(threshold_hu)
        assert self.gate.wait(10.0), "the gate was never opened"
        if threshold_hu > 3000:
            raise ValueError("nothing there")
        return SimpleNamespace(
            threshold_hu=threshold_hu,
            vertices=np.zeros((3, 3), dtype=np.float32),
            triangles=np.array([[0, 1, 2]], dtype=np.uint32),
        )


def wanted(previews: ModuleType, threshold_hu: int) -> Any:
    series = previews.SeriesRequest("folder", False, 1)
    return previews.Wanted(series, threshold_hu, None)


def until_taken(worker: Any) -> Any:
    for _ in range(1000):
        taken = worker.take()
        if taken is not None:
            return taken
        time.sleep(0.01)
    raise AssertionError("no surface was made")


def until_begun(preview: Held, count: int) -> None:
    for _ in range(1000):
        if len(preview.begun) == count:
            return
        time.sleep(0.01)
    raise AssertionError("no surface was begun")


def test_asking_does_not_wait_and_of_many_wishes_the_newest_is_made(
    previews: ModuleType,
) -> None:
    preview, worker = Held(), previews.SurfaceWorker()
    begin = time.perf_counter()
    worker.ask(preview, wanted(previews, 0))
    until_begun(preview, 1)
    for threshold in range(1, 100):
        worker.ask(preview, wanted(previews, threshold))
    assert time.perf_counter() - begin < 5.0
    assert worker.take() is None
    preview.gate.set()
    while until_taken(worker).wanted.threshold_hu != 99:
        pass
    assert preview.begun == [0, 99]


def test_what_fails_says_why_and_the_next_is_made(previews: ModuleType) -> None:
    preview, worker = Held(), previews.SurfaceWorker()
    preview.gate.set()
    worker.ask(preview, wanted(previews, 3001))
    failed = until_taken(worker)
    assert failed.mesh is None
    assert str(failed.error) == "nothing there"
    worker.ask(preview, wanted(previews, 10))
    assert until_taken(worker).mesh.threshold_hu == 10


def test_what_is_forgotten_does_not_come_and_the_next_does(
    previews: ModuleType,
) -> None:
    preview, worker = Held(), previews.SurfaceWorker()
    worker.ask(preview, wanted(previews, 1))
    until_begun(preview, 1)
    worker.forget()
    worker.ask(preview, wanted(previews, 2))
    preview.gate.set()
    assert until_taken(worker).mesh.threshold_hu == 2
    assert worker.stop(10.0)
    assert worker.take() is None


def test_a_reading_gives_preview_thresholds_and_histogram(
    previews: ModuleType, ct: Any
) -> None:
    request = previews.SeriesRequest(str(ct), False, 1)
    reading = previews.begin(request)
    assert previews.known(request) is reading
    assert reading.job.wait(60.0)
    assert reading.error is None
    assert reading.preview is not None
    assert reading.histogram.voxels > 0
    assert any(suggestion["recommended"] for suggestion in reading.suggestions)


def test_a_newer_reading_stops_the_one_before(previews: ModuleType, ct: Any) -> None:
    first = previews.begin(previews.SeriesRequest(str(ct), False, 1))
    second = previews.begin(previews.SeriesRequest(str(ct), True, 1))
    assert first.job.wait(60.0)
    assert second.job.wait(60.0)
    assert second.histogram is not None
    if first.histogram is None:
        assert previews.known(first.request) is None


def test_a_folder_that_is_looked_at_anew_is_read_anew(
    previews: ModuleType, ct: Any
) -> None:
    request = previews.SeriesRequest(str(ct), False, 1)
    assert previews.begin(request).job.wait(60.0)
    previews.forget(str(ct))
    assert previews.known(request) is None


def test_what_cannot_be_read_says_why(previews: ModuleType, tmp_path: Any) -> None:
    reading = previews.begin(previews.SeriesRequest(str(tmp_path), False, 1))
    assert reading.job.wait(60.0)
    assert reading.preview is None
    assert "empty" in str(reading.error)
