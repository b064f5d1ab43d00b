"""What the tests share: phantoms, real CT folders where there are some, the command."""

from __future__ import annotations

import json
import os
import subprocess
import sysconfig
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

# With AVX-512 NumPy's exp rounds otherwise, and so scikit-image, which results are compared with to the
# last bit, finds other edges where two gradients are equal.
os.environ.setdefault("NPY_DISABLE_CPU_FEATURES", "X86_V4 AVX512_ICL AVX512_SPR")

import bonemesh
import numpy as np
import pytest


@pytest.fixture(scope="session")
def volume() -> bonemesh.Volume:
    """A sphere of bone with a hollow: small, blurred, noisy."""
    return bonemesh.phantom("sphere-shell", coarser=2.0)


@pytest.fixture(scope="session")
def mesh(volume: bonemesh.Volume) -> bonemesh.Mesh:
    return bonemesh.render(volume, method="alpha")


@pytest.fixture(scope="session")
def ct_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The same sphere as a DICOM series."""
    folder = tmp_path_factory.mktemp("ct") / "sphere"
    written = bonemesh.write_phantom("sphere-shell", folder, coarser=2.0)
    return Path(written["series"])


@pytest.fixture(scope="session")
def patch(mesh: bonemesh.Mesh) -> np.ndarray:
    """Vertices of the sphere's outer surface, on its left side, in several slices."""
    x, y, z = mesh.vertices.T
    outer = np.hypot(np.hypot(x, y), z) > 33
    return np.flatnonzero(outer & (x > 24) & (abs(y) < 12) & (abs(z) < 10))


@pytest.fixture
def real_ct() -> Callable[[str], Path]:
    """Folders of real scans, which do not come with the project."""
    root = os.environ.get("BONEMESH_CT")
    if not root:
        pytest.skip("set BONEMESH_CT to the folder of the CT test data")
    return lambda name: Path(root) / name


@dataclass
class Answer:
    """How a command ended."""

    code: int
    out: str
    err: str

    @property
    def json(self) -> dict:
        return json.loads(self.out)


@pytest.fixture(scope="session")
def command() -> Callable[..., Answer]:
    """Runs the command that the package installed."""
    program = Path(sysconfig.get_path("scripts")) / "bonemesh"

    def run(*arguments: object, cwd: Path | None = None) -> Answer:
        words = [str(program), *map(str, arguments)]
        done = subprocess.run(
            words, check=False, capture_output=True, text=True, cwd=cwd, timeout=300
        )
        return Answer(done.returncode, done.stdout, done.stderr)

    return run


@pytest.fixture(scope="session")
def stl(command, ct_folder, tmp_path_factory) -> Path:
    file = tmp_path_factory.mktemp("command") / "sphere.stl"
    assert command("render", ct_folder, "-o", file, "--method", "alpha").code == 0
    return file


@pytest.fixture(scope="session")
def selection(stl) -> Path:
    """A file with the numbers of vertices on the left side of the sphere."""
    x, y, z = bonemesh.read_mesh(stl).vertices.T
    outer = np.hypot(np.hypot(x, y), z) > 33
    numbers = np.flatnonzero(outer & (x > 24) & (abs(y) < 12) & (abs(z) < 10))
    file = stl.with_name("selection.txt")
    file.write_text("".join(f"{n}\n" for n in numbers))
    return file
