"""The sources of the core: beside the installed package, else in the checkout."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

from clutchwork.declare.core import core

# what the build installs beside the compiled core, CMakeLists.txt
INSTALLED = "native"
CHECKOUT = Path(__file__).resolve().parents[3]
GENERATED = Path("include", "clutchwork")
REGISTRY = GENERATED / "registry.gen.hpp"
ENDINGS = (".cpp", ".hpp", ".h")
# a controller runs without derivatives
LEFT_OUT = "derivatives"


def sources() -> dict[Path, bytes]:
    """Headers, sources and licence of the core, by their paths in the folder that holds them."""
    installed = Path(core().__file__).parent / INSTALLED
    if (installed / REGISTRY).is_file():
        return dict(_below(installed))
    if (CHECKOUT / "cpp" / "src").is_dir():
        return {**dict(_below(CHECKOUT / "cpp")), Path("LICENSE"): (CHECKOUT / "LICENSE").read_bytes(), **_generated()}
    raise FileNotFoundError(f"{installed} does not hold the sources of the core: install clutchwork again")


def licence() -> bytes:
    """The licence of the core."""
    installed = Path(core().__file__).parent / INSTALLED / "LICENSE"
    return (installed if installed.is_file() else CHECKOUT / "LICENSE").read_bytes()


def _below(folder: Path) -> Iterator[tuple[Path, bytes]]:
    for path in sorted(folder.rglob("*")):
        inside = path.relative_to(folder)
        if LEFT_OUT not in {path.stem, *inside.parts} and (path.suffix in ENDINGS or path.name == "LICENSE"):
            yield inside, path.read_bytes()


def _generated() -> dict[Path, bytes]:
    """The generated headers, made by the tool of the checkout."""
    generator = CHECKOUT / "tools" / "gen_registry.py"
    with TemporaryDirectory() as folder:
        # without the site module no installed clutchwork is in its way
        command = [sys.executable, "-I", "-S", str(generator), str(CHECKOUT), folder]
        done = subprocess.run(command, capture_output=True, text=True, check=False)  # noqa: S603 - our own tool
        if done.returncode != 0:
            raise OSError(f"{generator} failed: {done.stderr.strip()}")
        return {GENERATED / made.name: made.read_bytes() for made in sorted(Path(folder).glob("*.gen.hpp"))}
