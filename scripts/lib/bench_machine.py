"""Says on what machine the figures were made, without names that tell whose it is."""

import os
import platform
import re
import subprocess
from pathlib import Path


def processor() -> str:
    """The processor's name."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        lines = []
    names = [line.split(":", 1)[1].strip() for line in lines if "model name" in line]
    return names[0] if names else platform.processor() or platform.machine()


def system() -> str:
    """The operating system's name and version."""
    try:
        return platform.freedesktop_os_release()["PRETTY_NAME"]
    except (OSError, KeyError):
        return f"{platform.system()} {platform.release()}"


def compiler(command: str) -> str:
    """A compiler's name and version."""
    try:
        said = subprocess.run(
            [command, "--version"], capture_output=True, text=True, check=True
        )
    except (OSError, subprocess.CalledProcessError):
        return f"no {command}"
    number = re.search(r"\d+(\.\d+)+", said.stdout)
    return f"{command} {number[0] if number else ''}".strip()


def machine() -> dict[str, str | int]:
    """All of it."""
    return {
        "processor": processor(),
        "cores": os.cpu_count() or 1,
        "system": system(),
        "rust": compiler("rustc"),
        "cpp": compiler("g++"),
    }
