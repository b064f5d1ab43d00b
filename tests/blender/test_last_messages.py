"""What the last job said stays as long as it matters (needs no Blender)."""

from collections.abc import Iterator

import pytest

from blender_addon.jobs import last_messages


@pytest.fixture(autouse=True)
def nothing_said() -> Iterator[None]:
    last_messages.clear()
    yield
    last_messages.clear()


def texts(step: str) -> list[str]:
    return [message.text for message in last_messages.of_step(step)]


def test_an_error_is_forgotten_once_another_step_is_next() -> None:
    last_messages.say("ERROR", "no vertex is selected")
    assert texts("draw") == ["no vertex is selected"]
    assert texts("draw") == ["no vertex is selected"]
    assert texts("cut") == []


def test_results_and_warnings_stay() -> None:
    last_messages.say("WARNING", "slices are missing")
    last_messages.say("INFO", "bone.stl")
    assert texts("draw") == texts("cut") == ["slices are missing", "bone.stl"]


def test_the_error_of_a_later_job_is_seen_at_its_own_step() -> None:
    last_messages.say("ERROR", "first")
    assert texts("draw") == ["first"]
    last_messages.clear()
    last_messages.say("ERROR", "second")
    assert texts("cut") == ["second"]
