"""A job can be watched, cancelled and waited for (needs no Blender)."""

import threading
from types import ModuleType

import pytest


@pytest.fixture
def job(bonemesh: ModuleType) -> ModuleType:
    from blender_addon.jobs import job

    return job


def test_a_job_returns_what_its_work_returns(job: ModuleType) -> None:
    work = job.Job("work", lambda _job: 7)
    work.start()
    assert work.wait(10.0)
    assert work.result() == 7
    assert job.running() is None


def test_a_job_raises_what_its_work_raises(job: ModuleType) -> None:
    def fail(_job: object) -> None:
        raise OSError("the disk is full")

    work = job.Job("work", fail)
    work.start()
    assert work.wait(10.0)
    with pytest.raises(OSError, match="full"):
        work.result()


def test_progress_is_seen_from_outside(job: ModuleType) -> None:
    noted, go_on = threading.Event(), threading.Event()

    def report(running: object) -> None:
        running.note_progress("edges", 0.25)
        noted.set()
        go_on.wait(10.0)

    work = job.Job("work", report)
    work.start()
    assert noted.wait(10.0)
    assert work.progress == ("edges", 0.25)
    assert job.running() is work
    go_on.set()
    assert work.wait(10.0)


def test_a_second_job_is_refused_until_the_first_has_ended(job: ModuleType) -> None:
    go_on = threading.Event()
    first = job.Job("first", lambda _job: go_on.wait(10.0))
    first.start()
    second = job.Job("second", lambda _job: 2)
    with pytest.raises(job.BusyError, match="first is still running"):
        second.start()
    with pytest.raises(job.BusyError, match="first is still running"):
        second.run_here()
    go_on.set()
    assert first.wait(10.0)
    assert second.run_here() == 2


def test_a_cancelled_job_stops_between_two_calls(
    job: ModuleType, bonemesh: ModuleType
) -> None:
    cancelled = threading.Event()

    def work(running: object) -> None:
        cancelled.wait(10.0)
        running.stop_if_cancelled()

    one = job.Job("work", work)
    one.start()
    one.cancel()
    cancelled.set()
    assert one.wait(10.0)
    with pytest.raises(bonemesh.Cancelled):
        one.result()


def test_the_token_of_a_cancelled_job_stops_the_library(
    job: ModuleType, bonemesh: ModuleType, ct: str
) -> None:
    work = job.Job(
        "work",
        lambda j: bonemesh.render(ct, progress=j.note_progress, cancel=j.cancel_token),
    )
    work.cancel()
    with pytest.raises(bonemesh.Cancelled):
        work.run_here()


def test_stop_ends_whatever_runs(job: ModuleType) -> None:
    def forever(running: object) -> None:
        while not running.cancel_requested:
            threading.Event().wait(0.01)

    work = job.Job("work", forever)
    work.start()
    assert job.stop(10.0)
    assert not work.is_running()
    assert job.stop(10.0)
