"""Pages are plain Markdown that a forge shows; the site puts its own in place of what only a forge needs."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import pytest

from clutchwork.declare.schema import REGISTRY, Role
from support.project import ROOT

sys.path.extend(str(ROOT / name) for name in ("docs", "docs/figures", "tools"))

import committed
import entries
import forge
import live

DOCS = ROOT / "docs"
PAGES = committed.pages()
FOLDERS = ("decisions", "examples", "benchmarks", "interfaces")
OTHERS = [ROOT / name for name in ("README.md", "CONTRIBUTING.md", "CHANGELOG.md")]
OTHERS += [path for name in FOLDERS for path in (ROOT / name).rglob("*.md") if "node_modules" not in path.parts]
# words of the site alone, which a forge shows as they are: directives, roles, labels, attributes
OWN = re.compile(
    r"(?m)^ *(?:`{3,}|~{3,}|:{3,}) *\{|\{[\w:-]+\}`|^\([\w-]+\)=$|^\{[.#][^}]*\}$|\)\{[^}]*\}|^%|<iframe|^\+\+\+$"
)


def prose(path: Path) -> str:
    """A page without code."""
    text = re.sub(r"(?ms)^(`{3,})(\w*\n).*?^\1$", r"\1\2\1", path.read_text(encoding="utf-8"))
    return re.sub(r"`[^`\n{}]*(?:\{[^`\n]*)?`(?!`)", "", re.sub(r"(?ms)^\$\$.*?^\$\$", "$$", text))


def named(path: Path) -> str:
    return path.relative_to(DOCS).as_posix()


@pytest.mark.parametrize("path", PAGES, ids=named)
def test_a_page_has_nothing_that_only_the_site_knows(path: Path) -> None:
    assert OWN.findall(prose(path)) == []


@pytest.mark.parametrize("path", PAGES, ids=named)
def test_no_line_of_an_equation_begins_a_list_or_a_heading(path: Path) -> None:
    # a forge takes "- x" for an item and "=" below a line for a heading before it looks for formulas
    equations = re.findall(r"(?ms)^\$\$$(.*?)^\$\$", path.read_text(encoding="utf-8"))
    assert re.findall(r"(?m)^ *(?:[-+*] .*|[-=]+$|\d+[.)] .*|[>#].*)", "".join(equations)) == []


@pytest.mark.parametrize("path", [*PAGES, *OTHERS], ids=lambda path: path.relative_to(ROOT).as_posix())
def test_no_page_links_to_nothing_or_to_what_a_build_makes(path: Path) -> None:
    links = re.findall(r"\]\(([^)\s#]+)", prose(path))
    local = [(path.parent / link).resolve() for link in links if "://" not in link]
    assert [str(link) for link in local if not link.exists() or link.is_relative_to(DOCS / "reference")] == []


def slugs(path: Path) -> set[str]:
    """Anchors of the headings of a page, and those that are written down."""
    text = path.read_text(encoding="utf-8")
    heads = re.findall(r"^#{1,6} (.*)$", re.sub(r"(?ms)^```.*?^```", "", text), re.MULTILINE)
    made = {re.sub(r"[^\w -]", "", head.lower()).strip().replace(" ", "-") for head in heads}
    return made | set(re.findall(r'<a id="([\w-]+)">', text))


@pytest.mark.parametrize("path", PAGES, ids=named)
def test_anchors_of_links_are_there(path: Path) -> None:
    found = re.findall(r"\]\(([^)\s#:]*)(?:\.md)?#([\w-]+)\)", path.read_text(encoding="utf-8"))
    pages = [
        (path.parent / (page + ("" if page.endswith(".md") else ".md")) if page else path, to) for page, to in found
    ]
    # the anchors of what a reference page is made from are those of that page
    assert [f"{page}#{to}" for page, to in pages if page.exists() and to not in slugs(page)] == []


def test_what_a_reference_page_is_made_from_leads_to_it() -> None:
    text = (
        "[a](../../src/clutchwork/laws/gms.py#turn) [b](../../src/clutchwork/elements) [c](fit.md) `[d](../../tests)`"
    )
    assert forge.site("[a](../parts.toml)", "guide/x") == "[a](../reference/parts.md)"
    made = forge.site(text, "guide/x")
    assert made.startswith("[a](../reference/laws/gms.md#turn) [b](../reference/elements.md) [c](fit.md)")
    assert forge.site("```python\n[a](../tests)\n```\n", "x") == "```python\n[a](../tests)\n```\n"
    assert forge.site("[`examples/car`](../examples/car): [a](x.md)", "x") == "`examples/car`: [a](x.md)"
    assert all((ROOT / path).exists() for path in forge.PAGES)


@pytest.mark.parametrize("role", list(Role))
def test_every_declaration_that_is_linked_has_its_page(role: Role) -> None:
    for kind in REGISTRY[role]:
        for room in ("elements", "laws"):
            path = f"src/clutchwork/{room}/{kind}.py"
            assert not (ROOT / path).exists() or forge.reference(path) == f"reference/{room}/{kind}.md"


def test_captions_are_headings_of_a_level() -> None:
    assert forge.levels('<p class="caption" role="heading">') == '<p class="caption" role="heading" aria-level="2">'


def test_a_picture_of_a_live_page_becomes_that_page() -> None:
    made = forge.site("[![A block: its speed](../pictures/pages/stick_slip.png)](../figures/live.py)", "guide/x")
    assert 'src="../live/stick_slip.html#compact" title="A block"' in made
    assert "```{raw} html\n<iframe" in made
    assert "<select" in forge.site("[![A gear](../pictures/pages/chooser.svg)](../../tools/gearbox_page.py)", "guide/x")
    shown = [name for path in PAGES for _, name, _ in forge.LIVE.findall(path.read_text(encoding="utf-8"))]
    assert sorted(shown) == sorted([*live.PAGES, "chooser"])


def test_equations_and_anchors_become_those_of_the_site() -> None:
    assert forge.site('by [(play-3)](theory/play.md)\n\n<a id="cams"></a>\n', "x") == "by {eq}`play-3`\n\n(cams)=\n"
    for path in PAGES:
        for label, link in re.findall(r"\[\(([a-z-]+-\d+)\)\]\(([^)]*)\)", path.read_text(encoding="utf-8")):
            assert f"$$ ({label})" in (path.parent / link).read_text(encoding="utf-8"), f"{path}: {label}"


def test_lists_of_pages_are_the_contents() -> None:
    made = forge.site((DOCS / "index.md").read_text(encoding="utf-8"), "index")
    listed = re.findall(r"(?ms)^```\{toctree\}\n.*?:hidden:\n\n(.*?)\n```", made)
    pages = {name for part in listed for name in part.splitlines()}
    written = {named(path).removesuffix(".md") for path in PAGES if path.parent.name != "elements"}
    theory = {name for name in written if name.startswith("theory/") and name != "theory/index"}
    assert pages >= written - theory - {"index"}
    made = forge.site((DOCS / "theory" / "index.md").read_text(encoding="utf-8"), "theory/index")
    assert {f"theory/{name}" for name in re.findall(r"(?ms):hidden:\n\n(.*?)\n```", made)[0].splitlines()} == theory


def test_what_is_public_is_documented_from_a_list_with_links_to_its_source() -> None:
    text = (DOCS / "api.md").read_text(encoding="utf-8")
    made = entries.documented(text)
    assert "- [`clutchwork" not in made
    assert ".. autoclass:: clutchwork.Driveline\n   :members:\n" in made
    assert ".. autofunction:: clutchwork.simulate\n" in made
    assert ".. autoexception:: clutchwork.ModelError\n" in made
    assert ":inherited-members:\n   :exclude-members: system, options" in made
    assert ".. py:class:: Node\n   :module: clutchwork\n\n   a shaft" in made
    for name, link in re.findall(r"^- \[`([\w.]+)[^`]*`\]\(([^)]*)\)", text, re.MULTILINE):
        assert entries.thing(name) is not None
        words = (DOCS / link).read_text(encoding="utf-8")
        last = name.rpartition(".")[2]
        assert link.endswith("__init__.py") or re.search(rf"(?m)^(?:def|class) {last}\b|^{last}\b", words), name
