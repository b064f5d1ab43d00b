"""A rendering beside the window: watched, refused twice, cancelled, finished."""

import time
from pathlib import Path
from typing import Any

import bpy
import stage


def files(out: str) -> list[str]:
    """What was written."""
    return sorted(p.name for p in Path(out).iterdir())


def press(name: str, function: str) -> tuple[Any, Any, stage.Gate]:
    """Presses a button; returns the operator, its context, and the gate at which its work is held."""
    operator, context, gate = (
        stage.pressed(name),
        stage.FakeContext(),
        stage.Gate(function),
    )
    assert operator.invoke(context, stage.event("LEFTMOUSE")) == {"RUNNING_MODAL"}, (
        operator.reports
    )
    gate.wait_until_reached()
    return operator, context, gate


def until_end(operator: Any, context: Any) -> list[str]:
    """Ticks until the operator ends; returns how it did."""
    for _ in range(3000):
        result = operator.modal(context, stage.event("TIMER"))
        if result != {"PASS_THROUGH"}:
            return sorted(result)
        time.sleep(0.02)
    raise AssertionError("the job did not end")


def remains(operator: Any, context: Any, out: str) -> dict[str, Any]:
    """What is left after the end."""
    manager = context.window_manager
    return {
        "reports": operator.reports,
        "timers": manager.timers,
        "handlers": len(manager.handlers),
        "status": [text for text in context.status if text],
        "objects": sorted(
            o.name for o in bpy.data.objects if o.name.startswith(("bone", "region"))
        ),
        "files": files(out),
        "running": stage.addon_job().running() is not None,
    }


def finished(out: str) -> dict[str, Any]:
    """Lets a job end; other events pass, a second job is refused."""
    operator, context, gate = press("render_surface_mesh", "render")
    operator.modal(context, stage.event("TIMER"))
    passed = [
        sorted(operator.modal(context, stage.event(kind)))
        for kind in ("MOUSEMOVE", "A", "LEFTMOUSE")
    ]
    second = stage.pressed("render_surface_mesh")
    refused = second.invoke(stage.FakeContext(), stage.event("LEFTMOUSE"))
    by_script = stage.message_of(bpy.ops.bonemesh.render_surface_mesh)
    gate.open()
    end = until_end(operator, context)
    return {
        "passed": passed,
        "second": [sorted(refused), second.reports],
        "second_by_script": by_script,
        "end": end,
        **remains(operator, context, out),
    }


def cancelled(out: str, how: str) -> dict[str, Any]:
    """Stops a job with Esc, with the button, or as Blender does when a file is opened."""
    operator, context, gate = press("render_surface_mesh", "render")
    operator.modal(context, stage.event("TIMER"))
    if how == "escape":
        assert operator.modal(context, stage.event("ESC", "PRESS")) == {"RUNNING_MODAL"}
    elif how == "button":
        assert bpy.ops.bonemesh.cancel() == {"FINISHED"}
    else:
        operator.cancel(context)
    gate.open()
    if how == "blender":
        assert stage.addon_job().stop(60.0)
        end = []
    else:
        end = until_end(operator, context)
    return {"end": end, **remains(operator, context, out)}


def failed(ct: str, out: str) -> dict[str, Any]:
    """A job whose work fails says so."""
    empty = Path(out).parent / "nothing"
    empty.mkdir()
    bpy.context.scene.bonemesh.ct_directory = str(empty)
    operator, context = stage.pressed("render_surface_mesh"), stage.FakeContext()
    assert operator.invoke(context, stage.event("LEFTMOUSE")) == {"RUNNING_MODAL"}
    end = until_end(operator, context)
    bpy.context.scene.bonemesh.ct_directory = ct
    return {"end": end, **remains(operator, context, out)}


def main(zip: str, out: str, ct: str) -> dict[str, Any]:
    """One after the other in one Blender: nothing of the one before may be in the way."""
    stage.install(zip)
    meshes = Path(out) / "meshes"
    meshes.mkdir()
    stage.fill_panel(ct, str(meshes))
    answer = {
        how: cancelled(str(meshes), how) for how in ("escape", "button", "blender")
    }
    answer["failed"] = failed(ct, str(meshes))
    answer["finished"] = finished(str(meshes))
    answer["nothing_to_cancel"] = sorted(bpy.ops.bonemesh.cancel())
    return answer
