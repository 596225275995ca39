"""Compile the core to WebAssembly, from the sources of the native one, into src/clutchwork/page/static/core.wasm.

docs/guide/wasm.md
"""

from __future__ import annotations

import gzip
import os
import re
import runpy
import subprocess
import sys
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
MADE = ROOT / "build" / "wasm"
WASM = ROOT / "src" / "clutchwork" / "page" / "static" / "core.wasm"
HEADER = ROOT / "cpp" / "include" / "clutchwork" / "c_api.h"

NAMES = ("components", "c_api", "fixed_steps", "phases_full", "phases_small", "phases_sparse")
SOURCES = [ROOT / "cpp" / "src" / f"{name}.cpp" for name in NAMES]
# what a step spends its time in is inlined by force, as in the native build
HOT = {"phases_small", "phases_sparse"}
# what a page has no use for: groups of runs, linearisation, what FMUs ask for
LEFT_OUT = re.compile(
    r"cw_(advance_group|group_size|read|local|local_size|advance_to_event|next_knot|copy|paste"
    r"|states|rates|margins|decide|place|place_size|place_input|single_size)"
)
FLAGS = [
    "-std=c++20",
    "-g0",
    "-ffp-contract=off",
    "-fno-math-errno",
    "-fno-exceptions",
    "-fno-rtti",
    "-fvisibility=hidden",
    # one step for all small sizes, to the bits of those that are compiled for each
    "-DCLUTCHWORK_ONE_SIZE",
]
SECTION = "clutchwork"
OPTIMISER = ROOT / "interfaces" / "page" / "node_modules" / "binaryen" / "bin" / "wasm-opt"
# what the compiler's target has, which the linked module does not say
FEATURES = ("bulk-memory", "sign-ext", "mutable-globals", "nontrapping-float-to-int", "multivalue")
# kinds that no page has room for, by role
KINDS_LEFT_OUT = runpy.run_path(str(ROOT / "src/clutchwork/page/left_out.py"))["LEFT_OUT"]


# small rather than fast, and as a whole: every part of the core is there once
TARGET = ("-target", "wasm32-wasi", "-Os", "-flto")


def exports() -> list[str]:
    """Functions of the C interface that the module has."""
    declared = re.findall(r"\b(cw_\w+)\(", HEADER.read_text(encoding="utf-8"))
    return [name for name in dict.fromkeys(declared) if not LEFT_OUT.fullmatch(name)]


def zig(*arguments: object, mode: str = "c++") -> None:
    """Call the compiler; SystemExit with what it said where it fails."""
    command = [sys.executable, "-m", "ziglang", mode, *map(str, arguments)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)  # noqa: S603 - the compiler
    if done.returncode != 0:
        raise SystemExit(f"{' '.join(command)}\n{done.stdout}{done.stderr}")


def generated() -> Path:
    """The folder of generated headers."""
    folder = MADE / "include" / "clutchwork"
    folder.mkdir(parents=True, exist_ok=True)
    generator = ROOT / "tools" / "gen_registry.py"
    subprocess.run([sys.executable, "-I", "-S", generator, ROOT, folder], check=True)  # noqa: S603 - our own tool
    return folder.parent


def masks() -> list[str]:
    """A flag for each role of which kinds are left out: a bit for each kind that is compiled, in their order."""
    sys.path.insert(0, str(ROOT / "src"))
    from clutchwork.declare.schema import Role, kinds

    found = ["-DCLUTCHWORK_NO_DRAWS"]
    for role, names in KINDS_LEFT_OUT.items():
        mask = sum(1 << place for place, kind in enumerate(kinds(Role(role))) if kind not in names)
        found.append(f"-DCLUTCHWORK_{role.upper()}={mask:#x}ull")
    return found


def compiled() -> list[Path]:
    """Objects of all sources, made side by side."""
    places = [ROOT / "cpp" / "include", ROOT / "cpp" / "src", generated()]
    includes = [f"-I{place}" for place in places]
    left_out = masks()
    folder = MADE / "objects"
    folder.mkdir(parents=True, exist_ok=True)

    def one(source: Path) -> Path:
        made = folder / f"{source.stem}.o"
        inlined = () if source.stem in HOT else ("-DCLUTCHWORK_HOT=inline",)
        zig(*TARGET, *FLAGS, *left_out, *inlined, *includes, "-c", source, "-o", made)
        return made

    # the longest first; linked in the order of the list, in which the module is smallest
    order = sorted(SOURCES, key=lambda source: source.stem not in {*HOT, "phases_full"})
    with ThreadPoolExecutor(int(os.environ.get("JOBS") or os.cpu_count() or 2)) as pool:
        made = dict(zip(order, pool.map(one, order), strict=True))
    return [made[source] for source in SOURCES]


def marked(module: bytes) -> bytes:
    """The module and its schema hash in a section of its own, which programs read that cannot run it."""
    layout = (MADE / "include" / "clutchwork" / "layout.gen.hpp").read_text(encoding="utf-8")
    found = re.search(r"schema_hash = (-?\d+)ll;", layout)
    if found is None:
        raise SystemExit("layout.gen.hpp has no schema_hash: correct tools/build_wasm.py")
    name, content = SECTION.encode(), found[1].encode()
    section = bytes([len(name)]) + name + content
    return module + b"\0" + bytes([len(section)]) + section


def shrunk(module: Path) -> Path:
    """The module as Binaryen makes it smaller, where the tools of the page are installed: the same bits, 5 % less."""
    if not OPTIMISER.is_file():
        return module
    made = module.with_name("shrunk.wasm")
    features = [f"--enable-{name}" for name in FEATURES]
    # -Oz leaves the numbering as it is: what is named most often gets numbers of one byte
    passes = ("-Oz", "--reorder-locals", "--reorder-functions")
    command: list[str | Path] = ["node", OPTIMISER, module, *passes, *features, "-o", made]
    subprocess.run(command, check=True)  # noqa: S603 - the optimiser
    return made


def wasm() -> Iterator[str]:
    """Make core.wasm; yields what to report."""
    began = time.monotonic()
    objects = compiled()
    names = [f"-Wl,--export={name}" for name in (*exports(), "__heap_base")]
    linked = MADE / "core.wasm"
    flags = ("-mexec-model=reactor", "-Wl,--no-entry", "-Wl,--gc-sections", "-Wl,--strip-all")
    # as C: the library of C++, which nothing needs, would be compiled first
    zig(*TARGET, *flags, *names, *objects, "-o", linked, mode="cc")
    module = marked(shrunk(linked).read_bytes())
    WASM.parent.mkdir(parents=True, exist_ok=True)
    WASM.write_bytes(module)
    packed = len(gzip.compress(module, 9))
    took = time.monotonic() - began
    yield f"{WASM.relative_to(ROOT)}: {len(module) / 1e3:.0f} kB, {packed / 1e3:.0f} kB as gzip, {took:.0f} s"


if __name__ == "__main__":
    print("\n".join(wasm()))
