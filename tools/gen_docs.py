"""Write the reference pages of elements, friction laws and signals from their declarations.

Usage: gen_docs.py FOLDER. The documentation build calls it; its output is never committed. The equations of a friction
law are those of its section in docs/theory/friction-laws.md.
"""

from __future__ import annotations

import inspect
import re
import sys
from collections.abc import Iterator
from dataclasses import Field
from pathlib import Path
from typing import Any, NamedTuple

import clutchwork  # noqa: F401  importing the package fills the registry
from clutchwork.declare.docs import described, words
from clutchwork.declare.schema import REGISTRY, Role, Spec, State, specs


class Page(NamedTuple):
    """One page: file, title, introduction, heading of each role, folder of the C++ headers."""

    name: str
    title: str
    introduction: str
    roles: dict[Role, str]
    headers: str


PAGES = (
    Page(
        "elements",
        "Elements",
        "A component of the driveline. Ports name the shafts that it joins; `torque` is what it applies to its follower"
        " (or shaft), see [signs](../guide/signs.md).",
        {
            Role.CONTACT: "Contacts: friction that sticks",
            Role.TORQUE: "Springs, dampers and torque sources",
            Role.GEAR: "Gears",
            Role.MOTION: "Prescribed motion",
            Role.FLOW: "Heat flows",
            Role.PROCESS: "Processes: states that signals, rates and heats drive",
            Role.COMPOSITE: "Made of other elements",
        },
        "elements",
    ),
    Page(
        "signals",
        "Signals",
        "A value over time, for every field of the kind *signal*. A plain number is a constant signal.",
        {Role.SIGNAL: ""},
        "",
    ),
)

ROOT = Path(__file__).resolve().parent.parent
THEORY = ROOT / "docs" / "theory" / "friction-laws.md"
LAWS = """# Friction laws

What `friction` of a contact may be: the coefficient over slip. Laws that stick lock and break away exactly. The others
are compliant, a function of slip and states of their own; they never lock. The [theory](../theory/friction-laws.md)
compares them.

| law | type in files | sticks | states | |
|---|---|---|---|---|"""


def write(folder: Path) -> list[Path]:
    """Write all pages and return their paths."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "laws").mkdir(exist_ok=True)
    laws = sorted(REGISTRY[Role.LAW].items())
    texts = {page.name: "\n".join(_page(page)) for page in PAGES}
    texts |= {"laws": "\n".join(_overview(laws))}
    texts |= {f"laws/{kind}": "\n".join(_law(kind, cls)) for kind, cls in laws}
    return [_write(folder / f"{name}.md", text) for name, text in texts.items()]


def _write(path: Path, text: str) -> Path:
    # an unchanged file keeps its date, so that the documentation build stays incremental
    if not path.exists() or path.read_text(encoding="utf-8") != text:
        path.write_text(text, encoding="utf-8")
    return path


def _page(page: Page) -> Iterator[str]:
    yield f"# {page.title}\n\n{page.introduction}\n"
    for role, heading in page.roles.items():
        if heading:
            yield f"## {heading}\n"
        level = "###" if heading else "##"
        for kind, cls in sorted(REGISTRY[role].items()):
            yield from _component(level, kind, cls, page.headers)


def _overview(laws: list[tuple[str, Any]]) -> Iterator[str]:
    """Table of all friction laws, and their pages."""
    yield LAWS
    for kind, cls in laws:
        summary = words(cls).partition("\n\n")[0].replace("\n", " ").replace("|", "\\|")
        sticks = "yes" if cls.sticks else "no"
        yield f"| [{cls.__name__}](laws/{kind}.md) | `{kind}` | {sticks} | {len(cls.states) or ''} | {summary} |"
    yield "\n```{toctree}\n:hidden:\n:maxdepth: 1\n"
    yield from (f"laws/{kind}" for kind, _ in laws)
    yield "```\n"


def _law(kind: str, cls: Any) -> Iterator[str]:
    """One page: what it is, fields, states, an example, equations."""
    yield from _component("#", kind, cls, "laws")
    yield f"## Example\n\n{_example(kind, cls)}\n"
    yield f"## Equations\n\n{_symbols(cls)}\n\n{_equations(kind)}\n"


def _example(kind: str, cls: type) -> str:
    """The examples of the fields, in Python and in a model file."""
    values = {item.name: spec.example for item, spec in specs(cls) if spec.example is not None}
    if not values:
        return "See the [guide](../../guide/start.md)."
    python = ", ".join(f"{name}={_points(value, '()')}" for name, value in values.items())
    toml = ", ".join(f"{name} = {_points(value, '[]')}" for name, value in values.items())
    return (
        f"```python\nfriction = cw.{cls.__name__}({python})\n```\n\n"
        f'```toml\nfriction = {{type = "{kind}", {toml}}}\n```'
    )


def _points(value: Any, brackets: str) -> str:
    """A number, or pairs, numbers and rows of them in the brackets of the language."""
    if not isinstance(value, tuple):
        return repr(value)
    pairs = all(isinstance(item, tuple) and len(item) == 2 for item in value)
    outer = "[]" if pairs else brackets
    inner = ", ".join(_points(item, brackets) if not pairs else _pair(item, brackets) for item in value)
    return f"{outer[0]}{inner}{outer[1]}"


def _pair(item: tuple[float, float], brackets: str) -> str:
    return f"{brackets[0]}{item[0]!r}, {item[1]!r}{brackets[1]}"


def _symbols(cls: type) -> str:
    """What the letters stand for that are not explained in the section."""
    names = {item.name for item, _ in specs(cls)}
    known = {"static": r"\mu_s", "kinetic": r"\mu_k", "speed": r"\sigma_s"}
    words = [f"${letter}$ is `{name}`" for name, letter in known.items() if name in names]
    words += [r"$s$ the Stribeck curve {eq}`friction-laws-4`, $c$ is `viscous`"] if "shape" in names else []
    return ", ".join([r"$\mu$ is the coefficient over the slip $\sigma$", *words]) + "."


def _equations(kind: str) -> str:
    """The section of a law in the theory, without labels, which stay unique; the numbers are named instead."""
    sections = re.split(r"^\(law-(\w+)\)=\n## .*\n", THEORY.read_text(encoding="utf-8"), flags=re.MULTILINE)
    found = dict(zip(sections[1::2], sections[2::2], strict=True))
    if kind not in found:
        return "They stand in the header that is named above."
    text = found[kind].partition("\n## ")[0].strip()
    labels = re.findall(r"^\$\$ \((friction-laws-\d+)\)$", text, re.MULTILINE)
    text = re.sub(r"^\$\$ \(friction-laws-\d+\)$", "$$", text, flags=re.MULTILINE)
    numbers = ", ".join(f"{{eq}}`{label}`" for label in labels)
    return f"{text}\n\nNumbers of these equations in the {{ref}}`theory <law-{kind}>`: {numbers}."


def _linked(text: str) -> str:
    """Digital object identifiers as links."""
    return re.sub(r"doi:(10\.[^\s,]*[^\s,.])", r"[doi:\1](<https://doi.org/\1>)", text)


def _component(level: str, kind: str, cls: Any, headers: str) -> Iterator[str]:
    yield f"({kind})=\n{level} {cls.__name__}\n"
    sort = "" if headers != "laws" else ". It sticks exactly." if cls.sticks else ". It is compliant: it never locks."
    yield f'`cw.{cls.__name__}`, in model files `type = "{kind}"`{sort}\n'
    yield f"{_linked(words(cls))}\n"
    yield "| field | sort | unit | default | bound | meaning |\n|---|---|---|---|---|---|"
    yield from (_row(item, spec) for item, spec in specs(cls))
    yield ""
    states = getattr(cls, "states", ())
    if states:
        yield f"State: {'; '.join(_states(states))}.{_in_use(cls)}\n"
    header = ROOT / "cpp" / "include" / "clutchwork" / headers / f"{kind}.hpp"
    if headers and header.exists():
        yield f"Header: `cpp/include/clutchwork/{headers}/{kind}.hpp`\n"


def _states(states: tuple[State, ...]) -> Iterator[str]:
    """Each state, or the first and the last one of many."""
    shown = [f"`{s.name}` [{s.unit}], {s.doc}" for s in states]
    yield from shown if len(shown) < 4 else (shown[0], "...", shown[-1])


def _in_use(cls: Any) -> str:
    own = inspect.getdoc(cls.own_states) if "own_states" in vars(cls) else ""
    return f" In use: {own[0].lower()}{own[1:]}" if own else ""


def _row(item: Field[Any], spec: Spec) -> str:
    told = described(item, spec)
    cells = (f"`{told.name}`", told.sort, told.unit, told.default, told.bound, told.meaning)
    return "| " + " | ".join(cells) + " |"


if __name__ == "__main__":
    for page in write(Path(sys.argv[1])):
        print(page)
