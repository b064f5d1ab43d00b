"""Long calls: the GIL, progress, cancel, Ctrl-C, exceptions of callbacks."""

import _thread
import signal
import threading
import time
from itertools import pairwise

import bonemesh
import numpy as np
import pytest

# Cancelling is promised within 0.2 s; a busy computer may take longer to give us the processor.
PROMPTLY = 2.0

# Enough points for several seconds of work.
MANY = np.random.default_rng(5).random((600_000, 3))


def long_call(**keywords):
    return bonemesh.tetrahedralize(MANY, threads=1, **keywords)


def test_other_threads_run_meanwhile():
    counted = 0
    done = threading.Event()

    def count():
        nonlocal counted
        while not done.is_set():
            counted += 1
            time.sleep(0)

    counter = threading.Thread(target=count)
    counter.start()
    cancel = bonemesh.Cancel()
    threading.Timer(0.5, cancel.cancel).start()
    at_start = counted
    with pytest.raises(bonemesh.Cancelled):
        long_call(cancel=cancel)
    during = counted - at_start
    done.set()
    counter.join()
    assert during > 100


def test_progress_comes_on_the_calling_thread_and_rises(volume):
    caller = threading.get_ident()
    calls = []

    def progress(stage, fraction):
        calls.append((threading.get_ident(), stage, fraction))

    bonemesh.render(volume, progress=progress)
    assert calls
    assert {ident for ident, _, _ in calls} == {caller}
    for _, stage, fraction in calls:
        assert isinstance(stage, str) and stage
        assert isinstance(fraction, float) and 0 <= fraction <= 1
    for (_, stage, fraction), (_, next_stage, next_fraction) in pairwise(calls):
        assert stage != next_stage or fraction <= next_fraction
    after = len(calls)
    time.sleep(0.2)
    assert len(calls) == after


def test_even_a_short_call_reports_its_end():
    calls = []
    bonemesh.canny(np.zeros((8, 8), bool), progress=lambda *args: calls.append(args))
    assert calls[-1] == ("edges", 1.0)


def test_progress_works_from_any_thread(volume):
    idents = set()

    def work():
        bonemesh.canny(
            volume.hu > 350, progress=lambda *_: idents.add(threading.get_ident())
        )

    worker = threading.Thread(target=work)
    worker.start()
    ident = worker.ident
    worker.join()
    assert idents == {ident}


def test_cancel_stops_promptly():
    cancel = bonemesh.Cancel()
    assert not cancel.is_cancelled
    thrown = []

    def throw():
        cancel.cancel()
        thrown.append(time.perf_counter())

    threading.Timer(0.3, throw).start()
    with pytest.raises(bonemesh.Cancelled, match="cancelled"):
        long_call(cancel=cancel)
    assert time.perf_counter() - thrown[0] < PROMPTLY
    assert cancel.is_cancelled


def test_a_thrown_switch_stops_the_next_call_at_once(volume, tmp_path):
    cancel = bonemesh.Cancel()
    cancel.cancel()
    calls = []
    with pytest.raises(bonemesh.Cancelled):
        bonemesh.render(
            volume, cancel=cancel, progress=lambda *args: calls.append(args)
        )
    mesh = bonemesh.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    with pytest.raises(bonemesh.Cancelled):
        mesh.save(tmp_path / "mesh.stl", cancel=cancel)
    assert calls == [] and list(tmp_path.iterdir()) == []


def test_cancel_from_the_progress_callback(volume):
    cancel = bonemesh.Cancel()
    with pytest.raises(bonemesh.Cancelled):
        long_call(cancel=cancel, progress=lambda *_: cancel.cancel())


def test_a_cancelled_call_leaves_no_file(ct_folder, tmp_path):
    cancel = bonemesh.Cancel()
    with pytest.raises(bonemesh.Cancelled):
        bonemesh.write_phantom(
            "head",
            tmp_path / "head",
            cancel=cancel,
            progress=lambda *_: cancel.cancel(),
        )
    assert list(tmp_path.iterdir()) == []


@pytest.fixture
def heeded_ctrl_c():
    """Where tests run in the background, a shell may have told them to ignore Ctrl-C."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.mark.usefixtures("heeded_ctrl_c")
def test_ctrl_c_stops_the_work_and_is_a_keyboard_interrupt():
    begun = time.perf_counter()
    threading.Timer(0.3, _thread.interrupt_main).start()
    with pytest.raises(KeyboardInterrupt):
        long_call()
    assert time.perf_counter() - begun < 0.3 + PROMPTLY
    # Nothing is left behind: the next call works.
    assert bonemesh.tetrahedralize(MANY[:10]).shape[1] == 4


def test_an_exception_of_the_callback_stops_the_work_and_comes_through():
    class Own(Exception):
        pass

    raised = Own("mine")

    def progress(stage, fraction):
        raise raised

    cancel = bonemesh.Cancel()
    begun = time.perf_counter()
    with pytest.raises(Own) as caught:
        long_call(progress=progress, cancel=cancel)
    assert caught.value is raised
    assert time.perf_counter() - begun < PROMPTLY
    assert not cancel.is_cancelled, "the caller's switch is the caller's"


def test_a_callback_that_fails_at_the_end_fails_the_call():
    def progress(stage, fraction):
        raise SystemExit(3)

    with pytest.raises(SystemExit):
        bonemesh.canny(np.zeros((8, 8), bool), progress=progress)


def test_calls_can_be_nested(volume):
    sizes = []

    def progress(stage, fraction):
        sizes.append(len(bonemesh.point_cloud(volume)))

    cloud = bonemesh.point_cloud(volume, progress=progress)
    assert sizes and set(sizes) == {len(cloud)}


def test_calls_run_side_by_side(volume):
    alone = bonemesh.render(volume)
    meshes = []
    workers = [
        threading.Thread(target=lambda: meshes.append(bonemesh.render(volume)))
        for _ in range(4)
    ]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    assert len(meshes) == 4
    for mesh in meshes:
        assert (mesh.vertices == alone.vertices).all()
        assert (mesh.triangles == alone.triangles).all()


def test_a_short_call_does_not_wait_for_the_next_look():
    image = np.zeros((8, 8), bool)

    def seconds():
        begun = time.perf_counter()
        bonemesh.canny(image, threads=1)
        return time.perf_counter() - begun

    # The waiting thread looks up every 0.05 s; the end of the work wakes it before.
    assert min(seconds() for _ in range(20)) < 0.04
