"""What the texts of declarations and headers say of each other, before a compiler sees them."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path

from clutchwork.declare.schema import COMPILED_ROLES
from registry.components import FOLDER, Component, Field, components, cpp_name

INCLUDES = "cpp/include/clutchwork"
TYPE = r"(?:T|Curve<T>|Word<T, [\w:]+>)"


def problems(root: Path) -> list[str]:
    """All that is wrong; what a missing file would entail is left out."""
    return list(unpaired(root)) or [*choices(), *(line for one in components() for line in apart(root, one))]


def unpaired(root: Path) -> Iterator[str]:
    """One line per declaration without header and per header without declaration."""
    for folder in ("elements", "laws"):
        stems = {path.stem for path in (root / INCLUDES / folder).glob("*.hpp")}
        roles = [role for role in COMPILED_ROLES if FOLDER[role.value] == folder]
        declared = {component.kind for role in roles for component in components(role)}
        for stem in sorted(declared - stems):
            yield f"src/clutchwork/{folder}/{stem}.py has no {INCLUDES}/{folder}/{stem}.hpp"
        for stem in sorted(stems - declared):
            yield f"{INCLUDES}/{folder}/{stem}.hpp has no declaration src/clutchwork/{folder}/{stem}.py"


def choices() -> Iterator[str]:
    """Choices of one name with different words, and words that cannot be C++ names: each name becomes one enum."""
    first: dict[str, tuple[Component, Field]] = {}
    for component in components():
        for field in (field for field in component.fields if field.spec.choices):
            other, same = first.setdefault(field.name, (component, field))
            if set(same.spec.choices) != set(field.spec.choices) or len(same.spec.choices) != len(field.spec.choices):
                words = f"the choice {field.name} has other words than that of {other.source}"
                yield f"{component.source}: {words}; give it another name, or the same words"
            elif same.spec.choices != field.spec.choices:
                yield f"{component.source}: the choice {field.name} has its words in another order than {other.source}"
            for word in field.spec.choices:
                if not word.isidentifier():
                    yield f"{component.source}: the choice {field.name} has the word {word!r}, which is no C++ name"


def apart(root: Path, component: Component) -> Iterator[str]:
    """What a header says otherwise than its declaration."""
    for field in component.fields:
        yield from other_line(root, component, field)
    yield from other_inputs(root, component)
    yield from numbers(root, component)


def other_line(root: Path, component: Component, field: Field) -> Iterator[str]:
    """A field of Params that is missing, or has another type or unit, or no unit."""
    pattern = re.compile(rf"^ *(?P<type>{TYPE}) {cpp_name(field.name)};(?: *///< (?P<comment>.*))?", re.MULTILINE)
    for path in chain(root, component.header):
        found = pattern.search(text(root, path))
        if found:
            break
    else:
        yield f"{component.header}: Params has no line `{field.line}`, which {component.source} asks for"
        return
    comment = found["comment"] or ""
    said = comment.partition("]")[0] + "]" if comment.startswith("[") else comment.partition(",")[0]
    if found["type"] != field.type() or said != field.comment:
        line = re.sub(r" +///<", "  ///<", found[0].strip())
        yield f"{path}: field {field.name} is `{line}`, {component.source} asks for `{field.line}`"


def other_inputs(root: Path, component: Component) -> Iterator[str]:
    """Inputs that the equations read and the declaration does not have, and those that nothing reads."""
    own = set(re.findall(r"\bInput::(\w+)", text(root, component.header)))
    read = {name for path in chain(root, component.header) for name in re.findall(r"\bInput::(\w+)", text(root, path))}
    declared = [cpp_name(name) for name in component.inputs]
    listed = ", ".join(declared) or "none"
    for name in sorted(own - set(declared)):
        yield f"{component.header}: Input::{name} is not an input of {component.source}, which has {listed}"
    for name in declared:
        if name not in read:
            yield f"{component.header}: nothing reads Input::{name}, which {component.source} declares"


def numbers(root: Path, component: Component) -> Iterator[str]:
    """Inputs, and states where there are several, by number: the order of the declaration may change."""
    named = [(r"\binput\[((?!Input::)[^\]]*)\]", "input[{}]", "Input::", component.inputs)]
    if len(component.states) > 1:
        named += [(rf"\b{array}\[(\d+)\]", array + "[{}]", "", component.states) for array in ("state", "rates")]
    for pattern, shown, prefix, known in named:
        for index in sorted(set(re.findall(pattern, text(root, component.header)))):
            name = cpp_name(known[int(index)]) if index.isdigit() and int(index) < len(known) else "name"
            wrong = f"{shown.format(index)} goes by number, which changes its meaning with the order of declaration"
            yield f"{component.header}: {wrong}; write {shown.format(prefix + name)}"


def chain(root: Path, header: str) -> list[str]:
    """A header and those that it includes, the nearest first."""
    found = [header]
    for path in found:
        others = (f"cpp/include/{name}" for name in re.findall(r"^#include <(clutchwork/\S+)>", text(root, path), re.M))
        found += [other for other in others if other not in found]
    return found


@cache
def text(root: Path, path: str) -> str:
    """The text of a file of the project, empty where there is none."""
    return (root / path).read_text(encoding="utf-8") if (root / path).is_file() else ""
