"""Optional functions of a header: what one side names and the other has not ends the build."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from clutchwork.declare.hooks import HOOKS
from clutchwork.declare.schema import COMPILED_ROLES, REGISTRY
from support import project
from support.refused import ELEMENTS, HEADERS, LAWS, edit, refused_by_compiler, refused_by_generator


def with_hook(name: str, role: str) -> tuple[str, str]:
    """Folder and kind of a component that has a hook in a header of its own."""
    for one in COMPILED_ROLES:
        for kind, cls in REGISTRY[one].items():
            folder = "laws" if one.value == "law" else "elements"
            header = (project.ROOT / HEADERS / folder / f"{kind}.hpp").read_text()
            if one.value == role and name in cls.hooks and re.search(rf"\b{name}\b", header):
                return folder, kind
    raise AssertionError(f"no {role} has the hook {name}")


HOOK_NAMES = [(name, role) for hook in HOOKS for role in hook.roles for name in hook.names]


@pytest.mark.parametrize(("name", "role"), HOOK_NAMES)
def test_a_hook_that_the_header_misspells(copy: Path, name: str, role: str) -> None:
    folder, kind = with_hook(name, role)
    header = copy / f"{HEADERS}/{folder}/{kind}.hpp"
    # the function alone, not a number that is called alike
    header.write_text(re.sub(rf"(static [^\n]*?\b){name}\b(?=\(| =)", rf"\1{name}s", header.read_text()))
    refused_by_compiler(copy, f"{kind}.hpp: {name} is missing, a hook of", f"src/clutchwork/{folder}/{kind}.py")


@pytest.mark.parametrize(("name", "role"), HOOK_NAMES)
def test_a_hook_that_the_declaration_forgets(copy: Path, name: str, role: str) -> None:
    folder, kind = with_hook(name, role)
    path = copy / f"src/clutchwork/{folder}/{kind}.py"
    path.write_text(path.read_text().replace(f'"{name}", ', "", 1).replace(f'"{name}"', "", 1).replace("(,)", "()"))
    companions = next(hook.names for hook in HOOKS if name in hook.names and role in hook.roles)
    if len(companions) > 1:
        refused_by_generator(copy, f"{folder}/{kind}.py", f"without {name}")
    else:
        refused_by_compiler(copy, f"{kind}.hpp: {name} is not among the hooks of src/clutchwork/{folder}/{kind}.py")


def test_a_hook_that_the_declaration_misspells(copy: Path) -> None:
    edit(copy / f"{LAWS}/temperature_table.py", 'hooks=("outside", ', 'hooks=("outsied", ')
    refused_by_generator(copy, "laws/temperature_table.py", "no 'outsied', did you mean 'outside'", "a law may have")


def test_hooks_that_neither_side_names(copy: Path) -> None:
    header = copy / f"{HEADERS}/elements/damper.hpp"
    text = header.read_text().replace("\n};\n", "\n\n private:\n  static double heat(double x) { return x; }\n};\n")
    header.write_text(text)
    refused_by_compiler(copy, f"damper.hpp: heat is not among the hooks of {ELEMENTS}/damper.py")


def test_a_hook_in_another_form(copy: Path) -> None:
    header = copy / f"{HEADERS}/laws/temperature_table.hpp"
    edit(header, "const At<T>& at, T& seen) {", "const At<T>& at) {\n    T seen;")
    refused_by_compiler(copy, "temperature_table.hpp: outside not in the form", "BoundedLaw")
