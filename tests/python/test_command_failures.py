"""The command `bonemesh` with bad input: one line with the remedy, exit code 1, nothing half-written."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
from contextlib import suppress
from pathlib import Path

import bonemesh
import numpy as np
import pytest

DONE, FAILED, USAGE = 0, 1, 2


def is_one_line(text: str) -> bool:
    return text.endswith("\n") and text.count("\n") == 1


def fails(answer, *says: str) -> None:
    """A failure: exit code 1, one line on stderr, nothing on stdout."""
    assert answer.code == FAILED, answer
    assert answer.out == ""
    assert is_one_line(answer.err) and answer.err.startswith("bonemesh: "), answer.err
    for words in says:
        assert words in answer.err


@pytest.mark.parametrize("what", ["render", "cloud", "info"])
def test_folders_without_a_scan(command, ct_folder, tmp_path, what):
    output = {"render": ["-o", "out.stl"], "cloud": ["-o", "out.npy"], "info": []}[what]
    empty = tmp_path / "empty"
    empty.mkdir()
    others = tmp_path / "others"
    others.mkdir()
    (others / "notes.txt").write_text("no scan")
    (others / "empty.dcm").write_bytes(b"")
    file = next(ct_folder.glob("*.dcm"))
    before = sorted(tmp_path.iterdir())
    for folder, *says in [
        (empty, "no CT series", "choose"),
        (others, "no CT series", "1 left out", "choose"),
        (file, "is a file", "folder"),
        (tmp_path / "missing", "does not exist", "check the path"),
    ]:
        fails(command(what, folder, *output, cwd=tmp_path), *says)
        fails(command(what, folder, *output, "--json", cwd=tmp_path), *says)
    assert sorted(tmp_path.iterdir()) == before


def damaged(ct_folder: Path, folder: Path, damage) -> Path:
    shutil.copytree(ct_folder, folder)
    for file in sorted(folder.glob("*.dcm"))[10:12]:
        damage(file)
    return folder


def cut(file: Path) -> None:
    file.write_bytes(file.read_bytes()[:-3000])


def cut_in_the_header(file: Path) -> None:
    file.write_bytes(file.read_bytes()[:200])


def forbid(file: Path) -> None:
    file.chmod(0)


@pytest.mark.parametrize("damage", [cut, cut_in_the_header, forbid])
def test_damaged_files_are_named_and_the_rest_still_loads(
    command, ct_folder, tmp_path, damage
):
    if damage is forbid and os.geteuid() == 0:
        pytest.skip("the superuser may read every file")
    folder = damaged(ct_folder, tmp_path / "damaged", damage)
    names = [file.name for file in sorted(folder.glob("*.dcm"))[10:12]]
    report = command("info", folder, "--json").json
    left_out = {Path(f["path"]).name: f["reason"] for f in report["left_out"]}
    assert sorted(left_out) == names
    assert report["series"][0]["slices_found"] == 28
    answer = command("render", folder, "-o", tmp_path / "out.stl", "--json")
    assert answer.code == DONE, answer.err
    assert answer.json["warnings"], "the missing slices are mentioned"


def test_a_series_of_damaged_files_only(command, ct_folder, tmp_path):
    folder = tmp_path / "damaged"
    shutil.copytree(ct_folder, folder)
    for file in folder.glob("*.dcm"):
        cut_in_the_header(file)
    fails(command("render", folder, "-o", tmp_path / "out.stl"), "no CT series", "30")
    assert not (tmp_path / "out.stl").exists()


@pytest.mark.parametrize(
    ("hu", "says"), [("5000", "nothing lies above"), ("-3000", "everything lies above")]
)
def test_thresholds_with_nothing_on_one_side(command, ct_folder, tmp_path, hu, says):
    for what, name in [("render", "out.stl"), ("cloud", "out.npy")]:
        answer = command(what, ct_folder, "--hu", hu, "-o", tmp_path / name)
        fails(answer, says, "choose a threshold")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("points", "says"),
    [
        (np.random.default_rng(0).random((3, 3)), "4"),
        (np.zeros((50, 3)), "4"),
        (np.random.default_rng(0).random((50, 3)) * [1, 1, 0], "plane"),
        (np.linspace([0, 0, 0], [1.0, 1, 1], 50), "line"),
        (np.zeros((0, 3)), ""),
    ],
)
def test_clouds_without_volume(command, tmp_path, points, says):
    np.save(tmp_path / "cloud.npy", points)
    answer = command(
        "mesh", tmp_path / "cloud.npy", "-o", tmp_path / "out.stl", "--alpha", 9
    )
    fails(answer, says)
    assert not (tmp_path / "out.stl").exists()


def test_files_that_are_no_clouds(command, tmp_path):
    np.save(tmp_path / "flat.npy", np.zeros(7))
    (tmp_path / "text.npy").write_text("no array")
    (tmp_path / "text.xyz").write_text("one two three\n")
    for name in ["flat.npy", "text.npy", "text.xyz", "missing.npy", "odd.doc"]:
        answer = command("mesh", tmp_path / name, "-o", tmp_path / "out.stl")
        fails(answer, name)
    assert not (tmp_path / "out.stl").exists()


def test_files_that_are_no_meshes(command, tmp_path):
    (tmp_path / "text.stl").write_text("no mesh\n")
    (tmp_path / "empty.stl").write_bytes(b"")
    (tmp_path / "cut.stl").write_bytes(
        bytes(80) + (7).to_bytes(4, "little") + bytes(60)
    )
    (tmp_path / "none.stl").write_bytes(bytes(84))
    (tmp_path / "text.ply").write_text("ply\nno header\n")
    (tmp_path / "mesh.doc").write_text("")
    (tmp_path / "folder.stl").mkdir()
    (tmp_path / "selection.txt").write_text("0\n1\n2\n")
    names = [file.name for file in tmp_path.iterdir() if file.suffix != ".txt"]
    for name in [*names, "missing.stl"]:
        fails(command("check", tmp_path / name), name)
        answer = command(
            *("roi", tmp_path / name, "--selection", tmp_path / "selection.txt"),
            *("--thickness", "5", "-o", tmp_path / "out.stl"),
        )
        fails(answer, name)
    assert not (tmp_path / "out.stl").exists()


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "no vertex"),
        ("7\n", "one vertex"),
        ("1\nx\n", "line 2"),
        ("1\n-2\n", "line 2"),
        ("1\n99999999\n", "99999999"),
        (None, "selection"),
    ],
)
def test_unusable_selections(command, stl, tmp_path, text, says):
    file = tmp_path / "selection.txt"
    if text is not None:
        file.write_text(text)
    answer = command(
        *(
            "roi",
            stl,
            "--selection",
            file,
            "--thickness",
            "5",
            "-o",
            tmp_path / "out.stl",
        )
    )
    fails(answer, says)
    assert not (tmp_path / "out.stl").exists()


def writers(ct_folder: Path, stl: Path, selection: Path) -> list[tuple[list, str]]:
    """Every command that writes a file, without its `-o`."""
    return [
        (["render", ct_folder], ".stl"),
        (["render", ct_folder], ".ply"),
        (["cloud", ct_folder], ".npy"),
        (["cloud", ct_folder], ".xyz"),
        (["roi", stl, "--selection", selection, "--thickness", "8"], ".stl"),
    ]


def test_outputs_into_folders_that_are_missing(
    command, ct_folder, stl, selection, tmp_path
):
    for words, suffix in writers(ct_folder, stl, selection):
        target = tmp_path / "missing" / f"out{suffix}"
        fails(command(*words, "-o", target), str(target))
    assert list(tmp_path.iterdir()) == []


def test_outputs_of_unknown_formats(command, ct_folder, stl, selection, tmp_path):
    for words, _ in writers(ct_folder, stl, selection):
        answer = command(*words, "-o", tmp_path / "out.doc")
        assert answer.code == USAGE, answer
        assert answer.out == ""
        assert "out.doc" in answer.err
    assert list(tmp_path.iterdir()) == []


@pytest.fixture
def small_disk(tmp_path):
    """Makes a disk of some bytes, read-only or not; only the superuser can."""
    mounted = []

    def make(options: str) -> Path:
        folder = tmp_path / f"disk{len(mounted)}"
        folder.mkdir()
        if os.geteuid() != 0 or not shutil.which("mount"):
            pytest.skip("only the superuser can make a small disk")
        words = ["mount", "-t", "tmpfs", "-o", options, "tmpfs", str(folder)]
        done = subprocess.run(words, check=False, capture_output=True, text=True)
        if done.returncode != 0:
            pytest.skip(f"a small disk cannot be made here: {done.stderr.strip()}")
        mounted.append(folder)
        return folder

    yield make
    for folder in mounted:
        subprocess.run(["umount", str(folder)], check=True)


def test_outputs_onto_a_full_disk(command, ct_folder, stl, selection, small_disk):
    disk = small_disk("size=8k")
    for words, suffix in writers(ct_folder, stl, selection):
        fails(command(*words, "-o", disk / f"out{suffix}"), f"out{suffix}")
        assert list(disk.iterdir()) == []
    fails(command("repair", stl, "-o", disk / "out.3mf"), "out.3mf")
    assert list(disk.iterdir()) == []
    fails(command("phantom", "tube", disk / "tube", "--coarser", "4"), "room")
    assert list(disk.iterdir()) == []


def test_outputs_onto_a_read_only_disk(command, ct_folder, stl, selection, small_disk):
    disk = small_disk("ro")
    for words, suffix in writers(ct_folder, stl, selection):
        fails(command(*words, "-o", disk / f"out{suffix}"), f"out{suffix}")
    fails(command("phantom", "tube", disk / "tube", "--coarser", "4"), str(disk))


def test_outputs_into_a_forbidden_folder(command, ct_folder, stl, selection, tmp_path):
    if os.geteuid() == 0:
        pytest.skip("the superuser may write into every folder")
    folder = tmp_path / "forbidden"
    folder.mkdir(mode=0o500)
    for words, suffix in writers(ct_folder, stl, selection):
        fails(command(*words, "-o", folder / f"out{suffix}"), f"out{suffix}")


def test_a_failed_run_leaves_the_old_file_alone(command, ct_folder, tmp_path):
    file = tmp_path / "out.stl"
    file.write_bytes(b"precious")
    fails(command("render", ct_folder, "--hu", "5000", "-o", file))
    assert file.read_bytes() == b"precious"
    assert list(tmp_path.iterdir()) == [file]


def test_a_phantom_does_not_write_over_files(command, tmp_path):
    (tmp_path / "mine.txt").write_text("precious")
    fails(command("phantom", "tube", tmp_path, "--coarser", "4"), "choose an empty")
    assert [file.name for file in tmp_path.iterdir()] == ["mine.txt"]


def test_a_closed_pipe_is_no_failure(ct_folder):
    program = [sys.executable, "-m", "bonemesh", "info", str(ct_folder)]
    with subprocess.Popen(
        program, stdout=subprocess.PIPE, stderr=subprocess.PIPE
    ) as run:
        assert run.stdout and run.stderr
        run.stdout.close()
        assert run.stderr.read() == b""
        assert run.wait(60) == DONE


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="looks into /proc")
def test_ctrl_c_ends_the_command_and_leaves_no_file(tmp_path):
    scan = bonemesh.write_phantom("sphere-shell", tmp_path / "sphere")["series"]
    target = tmp_path / "out"
    target.mkdir()
    words = [
        sys.executable,
        "-m",
        "bonemesh",
        "render",
        scan,
        "-o",
        str(target / "sphere.stl"),
    ]
    with subprocess.Popen(
        words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as run:
        while not any(name.startswith("bonemesh-") for name in threads_of(run.pid)):
            assert run.poll() is None
        run.send_signal(signal.SIGINT)
        out, err = run.communicate(timeout=60)
    assert run.returncode == FAILED
    assert (out, err) == ("", "bonemesh: cancelled\n")
    assert list(target.iterdir()) == []


def threads_of(process: int) -> list[str]:
    """Names of the threads of a process, as the system lists them."""
    names = []
    for file in Path(f"/proc/{process}/task").glob("*/comm"):
        with suppress(FileNotFoundError, ProcessLookupError):
            names.append(file.read_text())
    return names
