"""The box under CT Images: what is shown while a folder is scanned, after that, and of what cannot be."""

import time
from pathlib import Path
from typing import Any

import bpy
import stage
from panel import drawn

LONG_AGO = "there/is/nothing/here"


def box(buttons: list[Any] | None = None) -> list[str]:
    """What the box shows now."""
    shown = drawn(buttons=buttons)
    below = shown[shown.index("[ct_directory]") + 1]
    return below if isinstance(below, list) else []


def rows() -> list[Any]:
    """The buttons of the list of series."""
    buttons: list[Any] = []
    box(buttons)
    return [b for b in buttons if b.idname == "bonemesh.choose_series"]


def until_scanned() -> list[str]:
    """What the box shows when every scan has ended."""
    drawn()
    for _ in range(3000):
        if not stage.addon_scans().running():
            return box()
        time.sleep(0.02)
    raise AssertionError("the scan did not end")


def slow(properties: Any, path: str) -> dict[str, Any]:
    """Chooses a folder whose scan is held: the call returns all the same."""
    scanning = stage.addon_scanning()
    gate = stage.Gate("scan")
    properties.ct_directory = path
    gate.wait_until_reached()
    answer = {
        "held": box(),
        "timer": bpy.app.timers.is_registered(scanning._tick),
        "tick": scanning._tick(),
        "job": stage.addon_job().running() is not None,
    }
    gate.open()
    answer["ended"] = until_scanned()
    answer["last_tick"] = scanning._tick()
    return answer


def choosing(properties: Any) -> dict[str, Any]:
    """Goes through the list as a user does."""
    answer: dict[str, Any] = {
        "numbers": [row.number for row in rows()],
        "titles": [row.title for row in rows()],
    }
    second = rows()[1]
    answer["click"] = sorted(
        bpy.ops.bonemesh.choose_series(number=second.number, title=second.title)
    )
    answer["series"] = properties.series
    answer["second"] = box()
    folds = bpy.context.window_manager.bonemesh_folds
    folds.show_details = folds.show_left_out = True
    answer["unfolded"] = box()
    folds.show_details = folds.show_left_out = False
    scan = stage.addon_scans().known(stage.addon_scanning().request_of(properties))
    properties.series = scan.contents.series[1].uid
    answer["by uid"] = box()
    properties.series = "17"
    answer["unknown"] = box()
    return answer


def remembered(properties: Any, path: str, other: str) -> dict[str, Any]:
    """Which changes of the folder keep the chosen series."""
    properties.ct_directory, properties.series = path, "2"
    properties.ct_directory = f"{path}/"
    answer = {"same folder": properties.series}
    properties.ct_directory = other
    answer["other folder"] = properties.series
    properties.ct_directory, properties.series = path, "2"
    properties.one_series = True
    answer["one series"] = properties.series
    answer["as one"] = until_scanned()
    properties.one_series = False
    return answer


def replaced(properties: Any, path: str, other: str) -> dict[str, Any]:
    """A newer choice while a scan is held: the older result must not come back."""
    scans, scanning = stage.addon_scans(), stage.addon_scanning()
    gate = stage.Gate("scan")
    properties.ct_directory = path
    old = scanning.request_of(properties)
    gate.wait_until_reached()
    gate.let_others_pass()
    held = scans.known(old)
    properties.ct_directory = other
    before = until_scanned()
    gate.open()
    assert held.job.wait(60.0)
    return {
        "before": before,
        "after": box(),
        "kept": scans.known(old) is not None,
        "cancelled": type(held.error).__name__,
    }


def stopped(properties: Any, path: str) -> dict[str, Any]:
    """Stops a scan with its button, and looks again."""
    gate = stage.Gate("scan")
    properties.ct_directory = path
    gate.wait_until_reached()
    answer = {"stop": sorted(bpy.ops.bonemesh.stop_scan())}
    gate.open()
    answer["stopped"] = until_scanned()
    answer["again"] = sorted(bpy.ops.bonemesh.scan_ct_directory())
    answer["shown"] = box()
    return answer


def two_scenes(properties: Any, path: str, other: str) -> dict[str, Any]:
    """Two windows with a scene each: drawing one must not stop the other's scan."""
    scans, scanning = stage.addon_scans(), stage.addon_scanning()
    scans.stop_all(60.0)
    scanning.is_watched = False  # as after opening a file: nothing was chosen just now
    first, second = properties, bpy.data.scenes.new("second").bonemesh
    first.ct_directory, second.ct_directory = path, other
    gate = stage.Gate("scan")
    begun = scanning.shown(first)
    gate.wait_until_reached()
    waiting = [scanning.shown(second), scanning.shown(first)]
    gate.open()
    assert begun.job.wait(60.0)
    later = scanning.shown(second)
    assert later.job.wait(60.0)
    return {
        "waiting": [waiting[0] is None, waiting[1] is begun],
        "series": [len(scan.contents.series) for scan in (begun, later)],
        "still known": scanning.shown(first) is begun,
    }


def undone_and_opened(properties: Any, folder: Path, path: str) -> dict[str, Any]:
    """Undo and another file bring folders that nobody chose just now."""
    properties.ct_directory = path
    bpy.ops.ed.undo_push(message="chosen")
    bpy.context.scene.bonemesh.ct_directory = LONG_AGO
    bpy.ops.ed.undo_push(message="chosen again")
    bpy.ops.ed.undo()
    answer = {"undone": until_scanned()}
    file = str(folder / "scene.blend")
    bpy.ops.wm.save_as_mainfile(filepath=file)
    bpy.ops.wm.read_homefile()
    answer["new file"] = box()
    stage.addon_scans().stop_all(60.0)
    bpy.ops.wm.open_mainfile(filepath=file)
    answer["opened"] = until_scanned()
    return answer


def main(zip: str, out: str, ct: str, two: str, nifti: str) -> dict[str, Any]:
    """One after the other in one Blender."""
    stage.install(zip)
    folder = Path(out)
    (folder / "empty").mkdir()
    (folder / "note.txt").write_text("no image")
    properties = bpy.context.scene.bonemesh
    answer: dict[str, Any] = {
        "nothing chosen": box(),
        "nothing to look at": stage.message_of(bpy.ops.bonemesh.scan_ct_directory),
        "slow": slow(properties, two),
        "choosing": choosing(properties),
    }
    errors = {"missing": LONG_AGO, "empty": folder / "empty", "no volume": "note.txt"}
    for case, path in errors.items():
        properties.ct_directory = str(folder / path)
        answer[case] = until_scanned()
    answer["missing for a script"] = stage.message_of(
        bpy.ops.bonemesh.scan_ct_directory
    )
    properties.ct_directory = nifti
    answer["nifti"] = until_scanned()
    picked = bpy.ops.bonemesh.choose_ct_directory(filepath=nifti)
    answer["file picked"] = [sorted(picked), properties.ct_directory]
    one = next(Path(ct).rglob("*.dcm"))
    picked = bpy.ops.bonemesh.choose_ct_directory(filepath=str(one))
    answer["slice picked"] = [sorted(picked), properties.ct_directory]
    answer["remembered"] = remembered(properties, two, ct)
    answer["replaced"] = replaced(properties, two, ct)
    answer["stopped"] = stopped(properties, two)
    answer["two scenes"] = two_scenes(properties, two, ct)
    answer |= undone_and_opened(properties, folder, two)
    return answer
