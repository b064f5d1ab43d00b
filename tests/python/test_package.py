"""What is in the package besides the functions."""

from __future__ import annotations

import inspect
import re
import subprocess
import sys
from importlib import metadata, resources

import bonemesh


def test_the_version_is_the_packages():
    assert bonemesh.__version__ == metadata.version("bonemesh")


def test_everything_public_is_exported_and_has_a_docstring():
    public = {name for name in dir(bonemesh) if not name.startswith("_")}
    assert public == set(bonemesh.__all__) - {"__version__"}
    for name in public:
        thing = getattr(bonemesh, name)
        assert inspect.getdoc(thing), name
        assert thing.__module__ == "bonemesh" or inspect.isbuiltin(thing)


def test_the_exceptions_form_one_family():
    for kind in ("ArgumentError", "DicomError", "MeshError", "Cancelled"):
        assert issubclass(getattr(bonemesh, kind), bonemesh.BonemeshError)
    assert issubclass(bonemesh.ArgumentError, ValueError)
    assert not issubclass(bonemesh.BonemeshError, OSError)


def test_the_licences_travel_along():
    licences = resources.files(bonemesh) / "licenses"
    ours = (licences / "LICENSE-MIT").read_text("utf-8")
    assert "Permission is hereby granted" in ours
    assert "Apache License" in (licences / "LICENSE-APACHE").read_text("utf-8")
    others = (licences / "THIRD_PARTY_LICENSES.txt").read_text("utf-8")
    for package in ("rayon ", "dicom-object ", "pyo3 ", "numpy ", "kiddo ", "clap "):
        assert f"\n{package}" in others
    for notice in (
        "Redistribution and use in source and binary forms",
        "Permission is hereby",
    ):
        assert notice in others
    # What only builds or tests Bonemesh stays behind.
    for package in ("proptest ", "pyo3-build-config ", "criterion "):
        assert f"\n{package}" not in others


# Licences that ask for no more than their notice.
FREE = {"0BSD", "Apache-2.0", "BSD-2-Clause", "BSD-3-Clause", "CC0-1.0", "IJG", "ISC"}
FREE |= {"BSL-1.0", "MIT", "Unicode-3.0", "Unlicense", "Zlib"}


def is_free(expression: str) -> bool:
    """Whether an SPDX expression leaves a choice that is free."""

    def word(match: re.Match[str]) -> str:
        text = match[0]
        return {"AND": "and", "OR": "or"}.get(text, str(text in FREE))

    # An exception (WITH) only ever permits more.
    plain = re.sub(r" WITH [\w.-]+", "", expression).replace("/", " OR ")
    return eval(re.sub(r"[\w.+-]+", word, plain), {})


def test_everything_inside_may_be_passed_on():
    licences = resources.files(bonemesh) / "licenses"
    text = (licences / "THIRD_PARTY_LICENSES.txt").read_text("utf-8")
    listed = text.partition("=" * 80)[0]
    packages = re.findall(
        r"^(\S+) \d\S+: (.*?)(?: https?://\S+)?$", listed, re.MULTILINE
    )
    assert len(packages) > 50
    assert [package for package in packages if not is_free(package[1].strip())] == []
    assert not is_free("GPL-3.0-or-later") and not is_free("MIT AND GPL-2.0")
    assert is_free("(GPL-2.0 OR MIT) AND Zlib")


def test_it_is_marked_as_typed():
    package = resources.files(bonemesh)
    assert (package / "py.typed").is_file() and (package / "__init__.pyi").is_file()


def test_importing_it_does_not_import_numpy():
    """The command starts at once, and a program's own NumPy is taken only when arrays are."""
    code = "import sys, bonemesh; sys.exit('numpy' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
