"""What the panel says where the compiled part does not load, by what each system's loader says (needs no Blender)."""

import pytest

from blender_addon import library


@pytest.mark.parametrize(
    ("said", "remedy"),
    [
        (
            "/lib/x86_64-linux-gnu/libc.so.6: version `GLIBC_2.34' not found (required by /home/a/_native.abi3.so)",
            "glibc 2.28",
        ),
        (
            (
                "dlopen(/Users/a/_native.abi3.so, 0x0002): tried: '/Users/a/_native.abi3.so' (mach-o file, but is an "
                "incompatible architecture (have 'arm64', need 'x86_64'))"
            ),
            "another kind of processor",
        ),
        (
            (
                "dlopen(/Users/a/_native.abi3.so, 0x0002): tried: '/Users/a/_native.abi3.so' (code signature in <A> "
                "not valid for use in process: library load disallowed by system policy)"
            ),
            "xattr -dr com.apple.quarantine",
        ),
        (
            "DLL load failed while importing _native: The specified module could not be found.",
            "Visual C++",
        ),
        (
            "DLL load failed while importing _native: %1 is not a valid Win32 application.",
            "another kind of processor",
        ),
        (
            "/home/a/_native.abi3.so: failed to map segment from shared object",
            "noexec",
        ),
        ("/home/a/_native.abi3.so: invalid ELF header", "another kind of processor"),
        ("No module named 'numpy'", "NumPy"),
        ("No module named 'bonemesh'", "file for this system"),
    ],
)
def test_what_the_loader_says_has_its_remedy(said: str, remedy: str) -> None:
    assert remedy in library.remedy(said)
