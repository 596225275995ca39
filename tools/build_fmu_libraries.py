"""Compile the library of FMUs for other platforms than this one, from the sources of the native one, beside it.

Usage: PYTHON tools/build_fmu_libraries.py [PLATFORM ...], such as aarch64-linux; all of them without a name. The
compiler is that of the WebAssembly (the extra `wasm`). docs/guide/fmu.md
"""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from pathlib import Path

from build_wasm import FLAGS, HOT, generated, zig

ROOT = Path(__file__).resolve().parent.parent
MADE = ROOT / "build" / "fmu"
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


def library(platform: str, where: Path) -> Path:
    """Compile and link one library into a folder."""
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
    path = where / f"{platform}{ending}"
    exports = ROOT / "interfaces" / "fmi" / "exports.map"
    plain = ["-s", "-Wl,--gc-sections", f"-Wl,--version-script={exports}"]
    sections = plain if ending == ".so" else ["-s"] if ending == ".dll" else []
    zig("-target", target, "-shared", *sections, *objects, "-o", path)
    # the linker of Windows leaves lists for programs that link with it
    for spare in (*where.glob("*.lib"), *where.glob("*.pdb")):
        spare.unlink()
    return path


def built(platforms: list[str]) -> Iterator[str]:
    """Make the libraries; yields what to report."""
    sys.path.insert(0, str(ROOT / "src"))
    from clutchwork.fmu.libraries import folder

    unknown = [name for name in platforms if name not in TARGETS]
    if unknown:
        raise SystemExit(f"{unknown[0]} is not a platform: {', '.join(TARGETS)}")
    where = folder()
    here = {path.stem for path in where.glob("*-*.*")}
    for platform in platforms or [name for name in TARGETS if name not in here]:
        began = time.monotonic()
        path = library(platform, where)
        yield f"{path.name}: {path.stat().st_size / 1e6:.1f} MB, {time.monotonic() - began:.0f} s"


if __name__ == "__main__":
    for line in built(sys.argv[1:]):
        print(line, flush=True)
