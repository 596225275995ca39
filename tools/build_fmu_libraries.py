"""Compile the library of FMUs for other platforms, from the sources of the native one, into src/clutchwork/fmu/static.

Usage: PYTHON tools/build_fmu_libraries.py [PLATFORM ...], such as aarch64-linux; all of them without a name. The
compiler is that of the WebAssembly (the extra `wasm`). They go into the wheel, and into each FMU that is made beside
them. docs/guide/fmu.md
"""

from __future__ import annotations

import gzip
import re
import sys
import time
from collections.abc import Iterator
from pathlib import Path

from build_wasm import FLAGS, HOT, generated, zig

ROOT = Path(__file__).resolve().parent.parent
MADE = ROOT / "build" / "fmu"
WHERE = ROOT / "src" / "clutchwork" / "fmu" / "static"
NAMES = ("c_api", "components", "local", "lanes", "phases_small", "phases_sparse", "phases_full", "fixed_steps")
# those of the WebAssembly, and what a shared library needs; own allocation stays inside; one run at a time
MORE = ("-O2", "-ffunction-sections", "-fvisibility-global-new-delete-hidden", "-DCLUTCHWORK_ALONE")
# by platform: what the compiler calls it, and how the file ends; glibc of 2012
TARGETS = {
    "x86_64-linux": ("x86_64-linux-gnu.2.17", ".so"),
    "aarch64-linux": ("aarch64-linux-gnu.2.17", ".so"),
    "x86_64-windows": ("x86_64-windows-gnu", ".dll"),
    "aarch64-darwin": ("aarch64-macos", ".dylib"),
    "x86_64-darwin": ("x86_64-macos", ".dylib"),
}


def library(platform: str) -> Path:
    """Compile, link and pack one library."""
    target, ending = TARGETS[platform]
    folder = MADE / platform
    folder.mkdir(parents=True, exist_ok=True)
    sources = [ROOT / "cpp" / "src" / f"{name}.cpp" for name in NAMES]
    sources += sorted((ROOT / "interfaces" / "fmi").glob("*.cpp"))
    places = (ROOT / "cpp" / "include", ROOT / "cpp" / "src", generated())
    flags, objects = (*FLAGS, *MORE, *(f"-I{place}" for place in places)), list[Path]()
    for source in sources:
        made = folder / f"{source.stem}.o"
        inlined = () if source.stem in HOT else ("-DCLUTCHWORK_HOT=inline",)
        zig("-target", target, *flags, *inlined, "-c", source, "-o", made)
        objects.append(made)
    path = folder / f"{platform}{ending}"
    exports = ROOT / "interfaces" / "fmi" / "exports.map"
    plain = ["-s", "-Wl,--gc-sections", f"-Wl,--version-script={exports}"]
    # an archive gives it another name and place; Apple's linker would note the folder of this build
    apple = ["-Wl,-install_name,@rpath/clutchwork.dylib"]
    sections = plain if ending == ".so" else ["-s"] if ending == ".dll" else apple
    zig("-target", target, "-shared", *sections, *objects, "-o", path)
    packed = WHERE / f"{platform}.{schema()}{ending}.gz"
    WHERE.mkdir(exist_ok=True)
    for old in WHERE.glob(f"{platform}.*"):
        old.unlink()
    packed.write_bytes(gzip.compress(path.read_bytes(), mtime=0))
    return packed


def schema() -> str:
    """What the library reads, as src/clutchwork/fmu/libraries.py has it in the names of files."""
    header = (generated() / "clutchwork" / "layout.gen.hpp").read_text(encoding="utf-8")
    found = re.search(r"schema_hash = (-?\d+)ll", header)
    return f"{int(found[1]) & (2**64 - 1):016x}" if found else ""


def built(platforms: list[str]) -> Iterator[str]:
    """Make the libraries; yields what to report."""
    unknown = [name for name in platforms if name not in TARGETS]
    if unknown:
        raise SystemExit(f"{unknown[0]} is not a platform: {', '.join(TARGETS)}")
    for platform in platforms or TARGETS:
        began = time.monotonic()
        path = library(platform)
        yield f"{path.name}: {path.stat().st_size / 1e6:.1f} MB, {time.monotonic() - began:.0f} s"


if __name__ == "__main__":
    for line in built(sys.argv[1:]):
        print(line, flush=True)
