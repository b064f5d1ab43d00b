"""What the scenarios share: installing, the panel's fields, looking at objects, a window that is none."""

import threading
from importlib import import_module
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import bpy
import numpy as np

MODULE = "bl_ext.user_default.bonemesh"
WALL_MM = 9.0  # a little more than the wall of the phantom tube


def install(path: str) -> None:
    """Installs the extension from disk and enables it, as a user does."""
    bpy.ops.extensions.package_install_files(
        filepath=path, repo="user_default", enable_on_install=True
    )


def clear_scene() -> None:
    """Takes the cube away that a new file begins with: it would be the active mesh."""
    for placed in tuple(bpy.data.objects):
        bpy.data.objects.remove(placed)


def fill_panel(ct: str, out: str, **fields: Any) -> Any:
    """Sets every field that a rendering needs, and those named."""
    properties = bpy.context.scene.bonemesh
    properties.ct_directory = ct
    properties.mesh_directory = out
    properties.mesh_name = "bone"
    properties.roi_name = "region"
    properties.cut_thickness = WALL_MM
    for name, value in fields.items():
        setattr(properties, name, value)
    return properties


def message_of(operator: Any, *arguments: Any, **keywords: Any) -> str:
    """The error that a script gets from an operator, or an empty string."""
    try:
        operator(*arguments, **keywords)
    except RuntimeError as error:
        return str(error).removeprefix("Error: ").strip()
    return ""


def save_mesh(target: Path, placed: Any) -> str:
    """Writes the object's arrays as Blender holds them; returns the file's name."""
    mesh = placed.to_mesh(preserve_all_data_layers=True)
    local = np.empty(3 * len(mesh.vertices), dtype=np.float32)
    mesh.vertices.foreach_get("co", local)
    exact = np.empty_like(local)
    mesh.attributes["patient_mm"].data.foreach_get("vector", exact)
    corners = np.empty(len(mesh.loops), dtype=np.int32)
    mesh.loops.foreach_get("vertex_index", corners)
    selected = np.empty(len(mesh.vertices), dtype=bool)
    mesh.vertices.foreach_get("select", selected)
    np.savez(
        target,
        local=local.reshape(-1, 3),
        patient=exact.reshape(-1, 3),
        triangles=corners.reshape(-1, 3),
        selected=selected,
        matrix=np.array(placed.matrix_world),
    )
    return str(target)


def custom_properties(placed: Any) -> dict[str, Any]:
    """The object's own properties as plain values."""
    return {
        key: value.to_list() if hasattr(value, "to_list") else value
        for key, value in placed.items()
    }


class FakeWindowManager:
    """Blender's window manager, but with the modal handlers and windows that a background lacks."""

    def __init__(self) -> None:
        self.handlers: list[object] = []
        self.windows: list[object] = []
        self.timers = 0

    def event_timer_add(self, step: float, window: object) -> object:
        assert window is not None
        self.timers += 1
        return bpy.context.window_manager.event_timer_add(
            step, window=bpy.context.window
        )

    def event_timer_remove(self, timer: object) -> None:
        self.timers -= 1
        bpy.context.window_manager.event_timer_remove(timer)

    def modal_handler_add(self, operator: object) -> None:
        self.handlers.append(operator)


class FakeContext:
    """Blender's context, but with a window: modal operators need one and a background has none."""

    def __init__(self) -> None:
        self.window = SimpleNamespace()
        self.window_manager = FakeWindowManager()
        self.status: list[str] = []
        self.workspace = SimpleNamespace(status_text_set=self.status.append)

    def __getattr__(self, name: str) -> Any:
        return getattr(bpy.context, name)


class Gate:
    """Holds a function of the library at its first sign of progress, until it is opened."""

    def __init__(self, name: str) -> None:
        self._reached, self._opened = threading.Event(), threading.Event()
        self._library, self._name = import_module("bonemesh"), name
        self._real = getattr(self._library, name)
        setattr(self._library, name, self._held)

    def _held(self, *arguments: Any, progress: Any, **keywords: Any) -> Any:
        def wait(stage: str, fraction: float) -> None:
            progress(stage, fraction)
            self._reached.set()
            assert self._opened.wait(60.0), "the gate was never opened"

        return self._real(*arguments, progress=wait, **keywords)

    def wait_until_reached(self) -> None:
        """Returns when the function is held."""
        assert self._reached.wait(60.0), f"{self._name} showed no progress"

    def let_others_pass(self) -> None:
        """Later calls are not held."""
        setattr(self._library, self._name, self._real)

    def open(self) -> None:
        """Lets the function go on; later calls are not held."""
        self.let_others_pass()
        self._opened.set()


def pressed(name: str) -> Any:
    """A stand-in for the operator that a button press makes, with the real one's methods."""
    operators = import_module(f"{MODULE}.operators")
    real = getattr(operators, f"BONEMESH_OT_{name}")

    # The real one's methods without Blender's own type, which makes no instances.
    inherited = tuple(base for base in real.__bases__ if base is not bpy.types.Operator)

    class Pressed(*inherited):
        prepare = real.prepare
        finish = real.finish

        def __init__(self) -> None:
            self.reports: list[tuple[str, str]] = []

        def report(self, kind: set[str], text: str) -> None:
            self.reports.append((next(iter(kind)), text))

    return Pressed()


def event(kind: str, value: str = "NOTHING") -> Any:
    """An event as Blender hands it to a modal operator."""
    return SimpleNamespace(type=kind, value=value)


def addon_job() -> Any:
    """The add-on's module of running jobs."""
    return import_module(f"{MODULE}.jobs.job")


def addon_watches() -> list[Any]:
    """The add-on's list of jobs that have a timer."""
    return import_module(f"{MODULE}.operators.background").watches


def addon_scans() -> Any:
    """The add-on's module of scans."""
    return import_module(f"{MODULE}.series.scans")


def addon_scanning() -> Any:
    """The add-on's module that begins scans, as it is where there is a window."""
    scanning = import_module(f"{MODULE}.series.scanning")
    scanning.is_watched = True
    return scanning


def addon_previewing() -> Any:
    """The add-on's module of the preview, as it is where there is a window."""
    addon_scanning()
    return import_module(f"{MODULE}.preview.previewing")


def front(placed: Any) -> Any:
    """Which vertices are on a patch of the tube's outer front; looked at in Object Mode."""
    mesh = placed.data
    local = np.empty(3 * len(mesh.vertices), dtype=np.float32)
    mesh.vertices.foreach_get("co", local)
    x, y, z = local.reshape(-1, 3).T
    radius = np.hypot(x, y)
    patch = (radius > 0.85 * radius.max()) & (y < -0.8 * radius) & (abs(z) < 15.0)
    assert patch.any()
    return patch


def select_front(placed: Any) -> None:
    """Selects the front patch, in Object Mode."""
    mesh = placed.data
    mesh.vertices.foreach_set("select", front(placed))
    mesh.edges.foreach_set("select", np.zeros(len(mesh.edges), dtype=bool))
    mesh.polygons.foreach_set("select", np.zeros(len(mesh.polygons), dtype=bool))
