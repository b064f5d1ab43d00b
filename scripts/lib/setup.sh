# Functions that the scripts share: what a bare machine lacks is installed or named with its remedy.
# Source it from a script that has done `set -euo pipefail`.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
rust_minimum=$(sed -n 's/^rust-version = "\(.*\)"/\1/p' "$root/Cargo.toml")

say() { printf '\n== %s\n' "$*" >&2; }
fail() { printf 'error: %s\n' "$*" >&2; exit 1; }

# Rust at least as new as the workspace asks for.
need_rust() {
    local remedy="install it with rustup (https://rustup.rs), then: rustup update stable"
    command -v cargo >/dev/null || fail "cargo is missing; $remedy"
    local have
    have=$(rustc --version | cut -d' ' -f2)
    [ "$(printf '%s\n%s\n' "$rust_minimum" "$have" | sort -V | head -n1)" = "$rust_minimum" ] ||
        fail "rustc $have is too old, $rust_minimum or newer is needed; $remedy"
}

# missing_packages PACKAGE...: prints the Debian packages that are not installed.
missing_packages() {
    command -v dpkg-query >/dev/null || return 0
    local package
    for package in "$@"; do
        dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || echo "$package"
    done
}

install_packages() {
    say "installing $*"
    apt-get update -qq && DEBIAN_FRONTEND=noninteractive apt-get install -qq -y --no-install-recommends "$@" >/dev/null
}

# need_packages PACKAGE...: Debian packages, installed when this is root and they are missing.
need_packages() {
    local missing
    missing=$(missing_packages "$@" | xargs)
    [ -z "$missing" ] && return 0
    [ "$(id -u)" = 0 ] || fail "missing packages; run: sudo apt-get install $missing"
    install_packages $missing
}

# want_packages PACKAGE...: the same for those that only some tests need, which are skipped without.
want_packages() {
    local missing
    missing=$(missing_packages "$@" | xargs)
    [ -z "$missing" ] && return 0
    if [ "$(id -u)" = 0 ] && install_packages $missing; then return 0; fi
    say "skipped: tests that need $missing (run: sudo apt-get install $missing)"
}

# CMake, which builds the decoders that are C and C++ (CharLS, libjpeg-turbo).
need_cmake() {
    command -v cmake >/dev/null && return 0
    need_packages cmake
    command -v cmake >/dev/null || fail "cmake is missing; install it (https://cmake.org/download) and try again"
}

# find_python VERSION: prints a working interpreter of that version, or fails.
find_python() {
    local candidate
    for candidate in "python$1" "$HOME"/.pyenv/versions/"$1".*/bin/python3 /usr/bin/"python$1" python3 python; do
        if "$candidate" -c "import ensurepip, sys, venv; sys.exit('%d.%d' % sys.version_info[:2] != '$1')" 2>/dev/null; then
            echo "$candidate"
            return 0
        fi
    done
    return 1
}

# any_python: prints the newest interpreter from 3.11 on that can make environments.
any_python() {
    local version
    for version in 3.11 3.12 3.13 3.14; do find_python "$version" && return 0; done
    fail "Python 3.11 or newer with venv is missing; run: apt-get install python3 python3-venv"
}

# python_of DIR: the interpreter of a virtual environment; Windows has it in another folder.
python_of() { if [ -d "$1/Scripts" ]; then echo "$1/Scripts/python.exe"; else echo "$1/bin/python"; fi; }

# venv DIR PYTHON REQUIREMENTS: a virtual environment with the requirements, made once and kept
# until the requirements or the interpreter change.
venv() {
    local dir=$1 python=$2 requirements=$3 stamp
    stamp="$("$python" --version) $(cksum <"$requirements")"
    [ "$(cat "$dir/.stamp" 2>/dev/null)" = "$stamp" ] && return 0
    say "setting up $(basename "$dir") with $("$python" --version)"
    rm -rf "$dir"
    "$python" -m venv "$dir"
    "$(python_of "$dir")" -m pip install --quiet --disable-pip-version-check --upgrade pip
    "$(python_of "$dir")" -m pip install --quiet --disable-pip-version-check -r "$requirements" ||
        fail "pip could not install $requirements; is the network there?"
    echo "$stamp" >"$dir/.stamp"
}
