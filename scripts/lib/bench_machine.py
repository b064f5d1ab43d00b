"""Says on what machine the figures were made, without names that tell whose it is."""

import os
import platform
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
    """First line of what a compiler says of its version."""
    try:
        said = subprocess.run(
            [command, "--version"], capture_output=True, text=True, check=True
        )
    except (OSError, subprocess.CalledProcessError):
        return f"no {command}"
    return said.stdout.splitlines()[0]


def machine() -> dict[str, str | int]:
    """All of it."""
    return {
        "processor": processor(),
        "cores": os.cpu_count() or 1,
        "system": system(),
        "rust": " ".join(compiler("rustc").split()[:2]),
        "cpp": compiler("g++"),
    }
