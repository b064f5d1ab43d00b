"""A newer zip over an older one: it asks for a restart, after which everything is the newer one's."""

import re
import zipfile
from pathlib import Path

import pytest
from conftest import Blender

NEWER = "99.0.0"


@pytest.fixture
def newer_zip(extension_zip: Path, tmp_path: Path) -> Path:
    """The built extension as a later version of itself."""
    target = tmp_path / "newer.zip"
    with (
        zipfile.ZipFile(extension_zip) as old,
        zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED) as new,
    ):
        manifest = old.read("blender_manifest.toml").decode()
        version = re.search(r'^version = "(.*)"$', manifest, re.MULTILINE)[1]
        for name in old.namelist():
            content = old.read(name)
            if name == "blender_manifest.toml":
                content = manifest.replace(version, NEWER).encode()
            elif name.endswith(".whl"):
                packed = tmp_path / "newer.whl"
                raise_version(old, name, packed, version)
                name, content = name.replace(version, NEWER), packed.read_bytes()
            new.writestr(name, content)
    return target


def raise_version(
    extension: zipfile.ZipFile, name: str, target: Path, version: str
) -> None:
    """Writes the extension's wheel as one of version NEWER."""
    info = f"bonemesh-{version}.dist-info"
    with (
        extension.open(name) as packed,
        zipfile.ZipFile(packed) as old,
        zipfile.ZipFile(target, "w") as new,
    ):
        for member in old.namelist():
            content = old.read(member)
            if member.startswith(info):
                content = content.replace(version.encode(), NEWER.encode())
            if member == "bonemesh/__init__.py":
                content += f'\n__version__ = "{NEWER}"\n'.encode()
            new.writestr(member.replace(version, NEWER), content)


def test_an_update_asks_for_a_restart_and_is_whole_after_it(
    blender: Blender, extension_zip: Path, newer_zip: Path
) -> None:
    updated = blender.run("update", newer=newer_zip)
    assert updated["before"]["has_fields"]
    assert updated["after"]["manifest"] == NEWER
    assert "Restart Blender" in updated["after"]["said"]
    assert NEWER in updated["after"]["said"]
    assert not updated["after"]["has_fields"]
    restarted = blender.run("enabled")
    assert restarted == restarted | {"said": "", "has_fields": True, "manifest": NEWER}
    assert restarted["library"] == NEWER


def test_an_update_during_a_rendering_stops_it_first(
    blender: Blender, ct: Path, newer_zip: Path
) -> None:
    updated = blender.run("update", newer=newer_zip, ct=ct)
    assert updated["was_running"]
    assert "Restart Blender" in updated["after"]["said"]
    assert updated["files"] == []
