"""Each scenario runs in a Blender of its own with empty user folders; results are compared with the API's.

Run with the Python of a Blender set-up (scripts/setup_blender) after scripts/build_extension:
`PYTHON -m pytest tests/blender`. BONEMESH_EXTENSION names another zip than the one in dist/.
"""

import importlib
import json
import os
import struct
import subprocess
import sys
import zipfile
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
TIMEOUT_S = 300

sys.path.insert(0, str(ROOT))  # for the add-on's modules that need no Blender


@pytest.fixture(scope="session")
def extension_zip() -> Path:
    """The built extension."""
    named = os.environ.get("BONEMESH_EXTENSION")
    found = [Path(named)] if named else sorted((ROOT / "dist").glob("bonemesh-*.zip"))
    if len(found) != 1 or not found[0].is_file():
        pytest.fail(
            f"{len(found)} extensions in dist/, one is needed; run scripts/build_extension"
        )
    return found[0].resolve()


@pytest.fixture(scope="session")
def bonemesh(
    extension_zip: Path, tmp_path_factory: pytest.TempPathFactory
) -> ModuleType:
    """The API from the wheel that is in the extension, imported without Blender."""
    folder = tmp_path_factory.mktemp("wheel")
    with zipfile.ZipFile(extension_zip) as extension:
        (wheel,) = (n for n in extension.namelist() if n.endswith(".whl"))
        with extension.open(wheel) as packed, zipfile.ZipFile(packed) as unpacked:
            unpacked.extractall(folder)
    sys.path.insert(0, str(folder))
    return importlib.import_module("bonemesh")


@pytest.fixture(scope="session")
def ct(bonemesh: ModuleType, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A CT series of a phantom."""
    folder = tmp_path_factory.mktemp("ct") / "phantom"
    bonemesh.write_phantom("tube", folder, coarser=1.3)
    return folder


@pytest.fixture(scope="session")
def two(bonemesh: ModuleType, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two CT series of other orientation and size, the second with a gap, and files that are none."""
    folder = tmp_path_factory.mktemp("two") / "Bärbel"
    bonemesh.write_phantom("tube", folder / "first", coarser=1.3)
    bonemesh.write_phantom(
        "box-with-hole", folder / "second", coarser=2.0, orientation="coronal"
    )
    slices = sorted((folder / "second").rglob("*.dcm"))
    slices[len(slices) // 2].unlink()
    (folder / "notes").mkdir()
    for number in range(25):
        (folder / "notes" / f"{number:02}.txt").write_text("no image")
    return folder


@pytest.fixture(scope="session")
def own_uids(bonemesh: ModuleType, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """One CT series whose slices were each given a series UID of their own."""
    folder = tmp_path_factory.mktemp("own_uids")
    bonemesh.write_phantom("tube", folder, coarser=2.0)
    (series,) = bonemesh.find_series(folder)
    uid = series.uid.encode()
    for number, file in enumerate(series.files):
        file.write_bytes(file.read_bytes().replace(uid, uid[:-2] + b"%02d" % number))
    return folder


@pytest.fixture(scope="session")
def nifti(bonemesh: ModuleType, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A NIfTI file of a phantom."""
    volume = bonemesh.phantom("tube", coarser=1.3)
    hu = volume.hu.astype("<i2")
    # NIfTI looks at the patient from the other side: left and front are negative.
    rows = np.diag([-1.0, -1.0, 1.0, 1.0]) @ volume.patient_from_voxel
    header = bytearray(352)
    struct.pack_into("<i", header, 0, 348)
    struct.pack_into("<4h", header, 40, 3, *hu.shape[::-1])
    struct.pack_into("<4h", header, 48, 1, 1, 1, 1)
    struct.pack_into("<2h", header, 70, 4, 16)  # int16
    struct.pack_into("<4f", header, 76, 1.0, *volume.spacing_mm)
    struct.pack_into("<3f", header, 108, 352.0, 1.0, 0.0)
    header[123] = 2  # mm
    struct.pack_into("<2h", header, 252, 0, 1)  # the rows below are the scanner's
    struct.pack_into("<12f", header, 280, *rows[:3].ravel())
    header[344:348] = b"n+1\0"
    file = tmp_path_factory.mktemp("nifti") / "head.nii"
    file.write_bytes(bytes(header) + hu.tobytes())
    return file


class Blender:
    """Runs scenarios, one process each, all with the same user folder."""

    def __init__(self, extension_zip: Path, folder: Path) -> None:
        self.extension_zip = extension_zip
        self.user = folder / "user"
        self.out = folder / "out"
        self.user.mkdir()
        self.out.mkdir()

    def run(self, scenario: str, **arguments: Any) -> dict[str, Any]:
        """What `main` of the scenario returns; fails when it ends otherwise."""
        answer = self.out / f"{scenario}.json"
        answer.unlink(missing_ok=True)
        request = {"zip": self.extension_zip, "out": self.out, **arguments}
        command = [
            sys.executable,
            str(HERE / "scenarios" / "run.py"),
            scenario,
            json.dumps(request, default=str),
        ]
        # The wheel that this process uses must not help Blender out.
        environment = {k: v for k, v in os.environ.items() if k != "PYTHONPATH"}
        environment["BLENDER_USER_RESOURCES"] = str(self.user)
        done = subprocess.run(
            command,
            env=environment,
            timeout=TIMEOUT_S,
            text=True,
            capture_output=True,
            check=False,
        )
        log = f"{done.stdout}\n{done.stderr}"
        assert done.returncode == 0, f"{scenario} ended with {done.returncode}:\n{log}"
        assert "Traceback" not in log, log
        return json.loads(answer.read_text()) | {"log": log}


@pytest.fixture
def blender(extension_zip: Path, tmp_path: Path) -> Blender:
    """A Blender that has never been started."""
    return Blender(extension_zip, tmp_path)


@pytest.fixture(scope="session")
def refusals(
    extension_zip: Path, ct: Path, tmp_path_factory: pytest.TempPathFactory
) -> dict[str, str]:
    """What Blender answers to each unusable request, by the request's name."""
    folder = tmp_path_factory.mktemp("refusals")
    return Blender(extension_zip, folder).run("refusals", ct=ct)["messages"]
