"""The rooms of the core: includes run downward, in no circle, and every header stands alone."""

from __future__ import annotations

import re
import subprocess
from collections import Counter
from collections.abc import Mapping, Sequence
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

from support import project

HEADERS, SOURCES = project.ROOT / "cpp/include/clutchwork", project.ROOT / "cpp/src"
# a room may include itself and those before it; files at the root, elements, laws and the parts of the workspace belong
# to the first one
ROOMS = ("components", "contacts", "motion", "run", "lanes")
REGISTRY = "registry.gen.hpp"
Includes = Mapping[str, Sequence[str]]


def rank(header: str) -> int:
    """Number of the room of a header."""
    room = header.partition("/")[0]
    return ROOMS.index(room) if room in ROOMS else 0


def upward(includes: Includes) -> list[str]:
    """Includes that run up."""
    return [f"{h} includes {other}" for h, found in includes.items() for other in found if rank(other) > rank(h)]


def circle(includes: Includes) -> list[str]:
    """Headers that include each other in a circle; empty: there is none."""
    try:
        list(TopologicalSorter(includes).static_order())
    except CycleError as error:
        return list(error.args[1])
    return []


def includes_of_the_core() -> Includes:
    """What every header of the core includes of it."""
    headers = sorted(path for path in HEADERS.rglob("*.hpp"))
    pattern = re.compile(r"#include <clutchwork/([^>]*)>")
    found = {str(path.relative_to(HEADERS)): pattern.findall(path.read_text()) for path in headers}
    # the generated one includes every component
    found[REGISTRY] = [header for header in found if header.partition("/")[0] in ("elements", "laws")]
    return found


def test_every_folder_is_a_room() -> None:
    assert {path.name for path in HEADERS.iterdir() if path.is_dir()} == {*ROOMS, "elements", "laws", "workspace"}


def test_includes_run_downward() -> None:
    assert upward(includes_of_the_core()) == []


def test_no_headers_include_each_other_in_a_circle() -> None:
    assert circle(includes_of_the_core()) == []


def test_an_include_that_runs_up_is_found() -> None:
    includes = {"contacts/a.hpp": ["components/b.hpp", "run/c.hpp"], "elements/d.hpp": ["workspace.hpp"]}
    assert upward(includes) == ["contacts/a.hpp includes run/c.hpp"]


def test_a_circle_is_found() -> None:
    assert set(circle({"a.hpp": ["b.hpp"], "b.hpp": ["a.hpp"], "c.hpp": ["a.hpp"]})) == {"a.hpp", "b.hpp"}


@pytest.fixture(scope="module")
def generated(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder for -I with the generated headers."""
    folder = tmp_path_factory.mktemp("generated")
    result = project.generate(project.ROOT, folder / "clutchwork")
    assert result.returncode == 0, result.stderr
    return folder


LIBRARY = re.compile(r"#include (<\w+>)")
OWN = re.compile(r"#include (<clutchwork/[^>]*>)")
# what so many headers include first is compiled once for all of them
OFTEN = 5


def first_include(header: Path) -> str:
    """The first header of ours that one includes, "" where it includes none."""
    found = OWN.search(header.read_text())
    return found[1] if found else ""


class Compiler:
    """Compiles headers alone, after what is compiled once: the standard library, or what they include first."""

    def __init__(self, folder: Path, generated: Path) -> None:
        include = [f"-I{path}" for path in (HEADERS.parent, SOURCES, generated)]
        self.command = ["c++", "-std=c++20", "-Wall", "-Wextra", "-Werror", *include, "-x"]
        found = {name for header in HEADERS.rglob("*.hpp") for name in LIBRARY.findall(header.read_text())}
        self.library = self._precompiled(folder / "library.hpp", sorted(found))
        often = Counter(map(first_include, HEADERS.rglob("*.hpp")))
        self.first = {
            name: self._precompiled(folder / f"first{place}.hpp", [name])
            for place, (name, count) in enumerate(often.items())
            if name and count >= OFTEN
        }

    def _precompiled(self, header: Path, names: Sequence[str]) -> Path:
        header.write_text("".join(f"#include {name}\n" for name in names))
        subprocess.run([*self.command, "c++-header", str(header), "-o", f"{header}.gch"], check=True)
        return header

    def says(self, header: Path) -> str:
        """What it says about a unit of one header; "": nothing."""
        before = self.first.get(first_include(header), self.library)
        command = [*self.command, "c++", "-fsyntax-only", "-Winvalid-pch", "-include", str(before), "-"]
        unit = f'#include "{header}"\n'
        return subprocess.run(command, input=unit, capture_output=True, text=True, check=False).stderr


@pytest.fixture(scope="module")
def compiler(generated: Path, tmp_path_factory: pytest.TempPathFactory) -> Compiler:
    return Compiler(tmp_path_factory.mktemp("precompiled"), generated)


def test_every_header_compiles_alone(compiler: Compiler, generated: Path) -> None:
    headers = sorted([*HEADERS.rglob("*.h*"), *SOURCES.glob("*.hpp"), *generated.rglob("*.hpp")])
    assert "".join(map(compiler.says, headers)) == ""


def test_a_header_that_needs_another_does_not_compile_alone(compiler: Compiler, tmp_path: Path) -> None:
    header = tmp_path / "needy.hpp"
    header.write_text("#pragma once\ninline clutchwork::Options options;\n")
    assert "clutchwork" in compiler.says(header)
