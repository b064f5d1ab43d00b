# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether the compiled library can be used, and the remedy where it cannot. Knows no bpy."""

import re
import tomllib
from pathlib import Path

OTHER_FILE = (
    "Remove the extension, download the file for this system, install that from disk "
    "and restart Blender."
)
REMEDIES = (
    # What the system's own loader says, in the order in which it is looked for.
    (
        r"GLIBC\w*_[\d.]+' not found",
        (
            "This Linux is older than the file was made for (glibc 2.28, as in RHEL 8, Debian 10 or Ubuntu 20.04, is the "
            "oldest for the published one). Install the published file, or build one on this machine "
            "with scripts/build_extension --fast."
        ),
    ),
    (
        r"quarantine|code signature|library load disallowed|Team ID",
        (
            "macOS holds back what was downloaded. Close Blender, run in Terminal: xattr -dr com.apple.quarantine "
            '"$HOME/Library/Application Support/Blender" and start Blender again.'
        ),
    ),
    (
        r"incompatible architecture|wrong ELF class|not a valid Win32|invalid ELF header|Exec format error",
        "The file is for another kind of processor. " + OTHER_FILE,
    ),
    (
        r"DLL load failed",
        (
            "A part of Windows is missing, or a virus scanner holds the file back. Install Microsoft's Visual C++ "
            "Redistributable (x64), allow the file and restart Blender."
        ),
    ),
    (
        r"Permission denied|failed to map segment|Operation not permitted",
        (
            "This folder may not hold programs (rights, or a disk mounted noexec): it is inside of Blender's "
            "own user folder. Ask whoever looks after this machine."
        ),
    ),
    (
        r"No module named '?numpy",
        "Blender's own NumPy is missing. Use Blender from blender.org, or install NumPy for its Python.",
    ),
    (r"", OTHER_FILE),
)


def addon_version() -> str:
    """Version of this add-on, as its manifest says."""
    manifest = (
        Path(__file__).with_name("blender_manifest.toml").read_text(encoding="utf-8")
    )
    return str(tomllib.loads(manifest)["version"])


def problem() -> str | None:
    """Why the library cannot be used, as one line with its remedy, or None when it can."""
    try:
        import bonemesh
    except Exception as error:  # noqa: BLE001 - whatever it is, the panel says it
        return f"Its compiled part does not load. {remedy(str(error))} ({error})"
    # A native module stays in memory until Blender ends, also when its extension is replaced.
    wanted = addon_version()
    if bonemesh.__version__ != wanted:
        return (
            f"Its compiled part {bonemesh.__version__} is still in memory, the add-on is {wanted}. "
            "Restart Blender."
        )
    return None


def remedy(said: str) -> str:
    """What helps where the library did not load and the system says this."""
    return next(text for pattern, text in REMEDIES if re.search(pattern, said))
