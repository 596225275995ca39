"""Write the reference pages of elements, friction laws and signals from their declarations.

Usage: gen_docs.py FOLDER. The documentation build calls it; its output is never committed. The equations of a friction
law are those of its section in docs/theory/friction-laws.md; what is written by hand about an element stands in
docs/elements.
"""

from __future__ import annotations

import inspect
import re
import shutil
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import clutchwork  # noqa: F401  importing the package fills the registry
import element_figures
import element_pages
import gearbox_page
import law_pages
import option_page
import parts_page
from clutchwork.declare.schema import REGISTRY, Role, State, specs
from reference_fields import entry, header, linked, summary, table

ROOT = Path(__file__).resolve().parent.parent
THEORY = ROOT / "docs" / "theory" / "friction-laws.md"
SIGNALS = """# Signals

A value over time, for every field that is a *signal*. A plain number is a constant signal."""
LAWS = """# Friction laws

What `friction` of a contact may be: the coefficient over slip. Laws that stick lock and break away exactly. The others
are compliant, a function of slip and states of their own; they never lock. The [theory](../theory/friction-laws.md)
compares them.

{.fields}
| law | type in files | at rest | states | |
|---|---|---|---|---|"""


def write(folder: Path) -> list[Path]:
    """Write all pages and their pictures, and return the paths of the pages."""
    for name in ("laws", "elements"):
        (folder / name).mkdir(parents=True, exist_ok=True)
    laws = sorted(REGISTRY[Role.LAW].items())
    texts = dict(element_pages.pages())
    texts |= {"signals": "\n".join(_signals())}
    texts |= {"laws": "\n".join(_overview(laws)), "options": option_page.page(), "parts": parts_page.page()}
    texts |= {"gearboxes": gearbox_page.page()}
    texts |= {f"laws/{kind}": "\n".join(_law(kind, cls)) for kind, cls in laws}
    for picture in element_figures.KEPT.glob("*.svg"):
        shutil.copy2(picture, folder / "elements" / f"{picture.stem.rpartition('-')[0]}.svg")
    return [_write(folder / f"{name}.md", text) for name, text in texts.items()]


def _write(path: Path, text: str) -> Path:
    # an unchanged file keeps its date, so that the documentation build stays incremental
    if not path.exists() or path.read_text(encoding="utf-8") != text:
        path.write_text(text, encoding="utf-8")
    return path


def _signals() -> Iterator[str]:
    """All signals on one page."""
    yield SIGNALS
    for kind, cls in sorted(REGISTRY[Role.SIGNAL].items()):
        yield f"\n({kind})=\n## {cls.__name__}\n"
        yield entry(cls)
        yield f'In model files: `type = "{kind}"`.\n'
        yield f"{linked(cls, '..')}\n"
        yield from table(cls)


def _overview(laws: list[tuple[str, Any]]) -> Iterator[str]:
    """Table of all friction laws, and their pages."""
    yield LAWS
    for kind, cls in laws:
        sticks = "sticks" if cls.sticks else "compliant"
        states = f"{len(cls.states)} state{'s' if len(cls.states) > 1 else ''}" if cls.states else ""
        yield f"| [{cls.__name__}](laws/{kind}.md) | `{kind}` | {sticks} | {states} | {summary(cls)} |"
    yield "\n```{toctree}\n:hidden:\n:maxdepth: 1\n"
    yield from (f"laws/{kind}" for kind, _ in laws)
    yield "```\n"


def _law(kind: str, cls: Any) -> Iterator[str]:
    """One page: what it is, fields, states, an example, equations."""
    sort = "sticks exactly" if cls.sticks else "is compliant: it never locks"
    yield f"({kind})=\n# {cls.__name__}\n"
    yield entry(cls)
    yield f'In model files: `type = "{kind}"`. It {sort}.\n\n{linked(cls)}\n'
    yield "## Fields\n"
    yield from table(cls)
    if cls.states:
        yield f"State: {'; '.join(_states(cls.states))}.{_in_use(cls)}\n"
    yield header(kind, "laws")
    yield f"## Example\n\n{_example(kind, cls)}\n"
    if kind in law_pages.kinds():
        yield f"## Turn the parameters\n\n{_live(kind, cls)}\n"
    yield f"## Equations\n\n{_symbols(cls)}\n\n{_equations(kind)}\n"


def _live(kind: str, cls: type) -> str:
    """The page on which the law is turned, in words, and in a frame."""
    title = f"{cls.__name__}: torque over slip, small movements, a disc on a drum"
    frame = f'<iframe class="live" loading="lazy" src="../../live/law-{kind}.html#compact" title="{title}"></iframe>'
    return f"{law_pages.words(kind)}\n\n```{{raw}} html\n{frame}\n```"


def _example(kind: str, cls: type) -> str:
    """The examples of the fields, in Python and in a model file."""
    values = {item.name: spec.example for item, spec in specs(cls) if spec.example is not None}
    if not values:
        return "See the [guide](../../guide/start.md)."
    python = "".join(f"    {name}={_points(value, '()')},\n" for name, value in values.items())
    toml = "".join(f"{name} = {_points(value, '[]')}\n" for name, value in values.items())
    return (
        f"```python\nfriction = cw.{cls.__name__}(\n{python})\n```\n\n"
        f'Below an `[[element]]` of a model file:\n\n```toml\n[element.friction]\ntype = "{kind}"\n{toml}```'
    )


def _points(value: Any, brackets: str) -> str:
    """A number, or pairs, numbers and rows of them in the brackets of the language."""
    if isinstance(value, Mapping) and brackets == "[]":
        return "{" + ", ".join(f"{name} = {text!r}" for name, text in value.items()) + "}"
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
    sections = re.split(r'^<a id="law-(\w+)"></a>\n## .*\n', THEORY.read_text(encoding="utf-8"), flags=re.MULTILINE)
    found = dict(zip(sections[1::2], sections[2::2], strict=True))
    if kind not in found:
        return "They stand in the header that is named above."
    text = found[kind].partition("\n## ")[0].strip()
    labels = re.findall(r"^\$\$ \((friction-laws-\d+)\)$", text, re.MULTILINE)
    text = re.sub(r"^\$\$ \(friction-laws-\d+\)$", "$$", text, flags=re.MULTILINE)
    text = re.sub(r"\]\(([\w-]+\.md)", r"](../../theory/\1", text)
    numbers = ", ".join(f"{{eq}}`{label}`" for label in labels)
    return f"{text}\n\nNumbers of these equations in the {{ref}}`theory <law-{kind}>`: {numbers}."


def _states(states: tuple[State, ...]) -> Iterator[str]:
    """Each state, or the first and the last one of many."""
    shown = [f"`{s.name}` [{s.unit}], {s.doc}" for s in states]
    yield from shown if len(shown) < 4 else (shown[0], "...", shown[-1])


def _in_use(cls: Any) -> str:
    own = inspect.getdoc(cls.own_states) if "own_states" in vars(cls) else ""
    return f" In use: {own[0].lower()}{own[1:]}" if own else ""


if __name__ == "__main__":
    for page in write(Path(sys.argv[1])):
        print(page)
