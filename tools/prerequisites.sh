#!/bin/sh
# Checks what must be on the machine before `make setup`, and says how to get what is missing.
# Usage: prerequisites.sh PYTHON CXX
python=${1:-python3}
cxx=${2:-c++}
missing=0

complain() {
    missing=1
    printf '%s\n' "missing: $1" "         $2" >&2
}

# a Python that is new enough, can make virtual environments and can compile extensions
if ! command -v "$python" >/dev/null 2>&1; then
    complain "$python" "install Python 3.11 or newer (Debian, Ubuntu: apt install python3 python3-venv python3-dev)"
elif ! "$python" -c 'import sys; sys.exit(sys.version_info < (3, 11))'; then
    complain "Python 3.11 or newer ($python is $("$python" -c 'import platform; print(platform.python_version())'))" \
        "install a newer one and name it: make PYTHON=python3.12 ..."
else
    "$python" -c 'import ensurepip, venv' 2>/dev/null ||
        complain "the venv module of $python" "Debian, Ubuntu: apt install python3-venv"
    "$python" -c 'import os, sys, sysconfig
sys.exit(not os.path.exists(os.path.join(sysconfig.get_path("include"), "Python.h")))' ||
        complain "the C headers of $python (Python.h)" \
            "Debian, Ubuntu: apt install python3-dev; Fedora: dnf install python3-devel"
fi

# a compiler that knows C++20
if ! command -v "$cxx" >/dev/null 2>&1; then
    complain "a C++ compiler ($cxx)" \
        "Debian, Ubuntu: apt install g++; Fedora: dnf install gcc-c++; macOS: xcode-select --install; or make CXX=..."
else
    folder=$(mktemp -d) || exit 1
    trap 'rm -rf "$folder"' EXIT
    cat >"$folder/probe.cpp" <<'PROBE'
#include <concepts>
#include <span>
template <class T> concept Number = std::floating_point<T>;
template <Number T> T twice(std::span<const T> x) { return x[0] + x[0]; }
int main() { const double one[1] = {1.0}; return twice(std::span<const double>(one)) == 2.0 ? 0 : 1; }
PROBE
    "$cxx" -std=c++20 -o "$folder/probe" "$folder/probe.cpp" 2>/dev/null ||
        complain "C++20 ($cxx is $("$cxx" --version 2>&1 | head -n 1))" \
            "install g++ 11, clang 14 or newer, or name another compiler: make CXX=g++-12 ..."
fi

if [ "$missing" -ne 0 ]; then
    printf '%s\n' "clutchwork needs python3 (3.11 or newer), a C++20 compiler and make; nothing was changed." >&2
fi
exit "$missing"
