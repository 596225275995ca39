"""Sphinx extension: pages are written for a forge, and the site puts its own in place of what only a forge needs.

- A link to what a reference page is made from, such as the declaration of an element, leads to that page.
- A link to another folder of the project, which has no page, is its words.
- A picture that links to the program of a live page becomes that page.
- Links to equations and anchors become those of Sphinx.
- Captions of the contents are headings of a level.
- The lists of a section "All pages" are the contents of the site too; those of docs/api.md become documentation of
  Python objects.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable
from pathlib import Path, PurePosixPath
from typing import Any

import entries

import gearbox_page

ROOT = Path(__file__).resolve().parents[1]
FENCE = re.compile(r"(?ms)^(`{3,}).*?^\1$")
LINK = re.compile(r"\]\(([^)\s#:]+)(#[\w-]+)?\)")
FOLDER = re.compile(r"\[([^\[\]]+)\]\(((?:\.\./)+\w[^)\s#:]*)\)")
LIVE = re.compile(r"\[!\[([^\]]*)\]\([^)]*?pages/(\w+)\.\w+\)\]\(([^)]*)\)")
EQUATION = re.compile(r"\[\(([a-z-]+-\d+)\)\]\([^)]*\)")
ANCHOR = re.compile(r'(?m)^<a id="([\w-]+)"></a>$')
CONTENTS = re.compile(r"(?ms)^## All pages\n(.*?)(?=^## |\Z)")
CHOOSER, LIVE_PAGES = "tools/gearbox_page.py", "docs/figures/live.py"

# what pages of the reference are made from, and these pages below docs/reference
PAGES = {
    "src/clutchwork/elements": "elements.md",
    "src/clutchwork/laws": "laws.md",
    "src/clutchwork/signals": "signals.md",
    "src/clutchwork/declare/options.py": "options.md",
    "src/clutchwork/gearbox/catalogue": "gearboxes.md",
    "src/clutchwork/command": "command-line.md",
    "docs/parts.toml": "parts.md",
    "tools/parity.py": "parity.md",
    "tests": "tests.md",
}


def reference(path: str) -> str | None:
    """The page of the reference that is made from a file or folder, below docs."""
    if path in PAGES:
        return f"reference/{PAGES[path]}"
    found = re.fullmatch(r"src/clutchwork/(elements|laws)/(\w+)\.py", path)
    return f"reference/{found[1]}/{found[2]}.md" if found else None


def site(text: str, name: str) -> str:
    """The text of a page, by its name below docs without ending, as the site has it."""
    folder = PurePosixPath("docs", name).parent
    up = "../" * (len(folder.parts) - 1)

    def linked(found: re.Match[str]) -> str:
        page = reference(os.path.normpath(folder / found[1]))
        return f"]({up}{page}{found[2] or ''})" if page else found[0]

    def worded(found: re.Match[str]) -> str:
        path = os.path.normpath(folder / found[2])
        return (
            found[1] if reference(path) is None and (ROOT / path).is_dir() else found[0]
        )

    def live(found: re.Match[str]) -> str:
        program = os.path.normpath(folder / found[3])
        if program == CHOOSER:
            return _raw(gearbox_page.chooser())
        if program != LIVE_PAGES:
            return found[0]
        title = found[1].partition(":")[0]
        return _raw(
            f'<iframe class="live" loading="lazy" src="{up}live/{found[2]}.html#compact" title="{title}"></iframe>\n'
        )

    if name == "api":
        text = entries.documented(text)
    text = outside_fences(
        text, lambda prose: LINK.sub(linked, FOLDER.sub(worded, LIVE.sub(live, prose)))
    )
    text = outside_fences(
        text, lambda prose: ANCHOR.sub(r"(\1)=", EQUATION.sub(r"{eq}`\1`", prose))
    )
    return CONTENTS.sub(contents, text)


def _raw(html: str) -> str:
    return f"```{{raw}} html\n{html}```"


def outside_fences(text: str, change: Callable[[str], str]) -> str:
    """A text with its prose changed, and all that is fenced as it is."""
    made, end = "", 0
    for fence in FENCE.finditer(text):
        made += change(text[end : fence.start()]) + fence[0]
        end = fence.end()
    return made + change(text[end:])


def contents(found: re.Match[str]) -> str:
    """A section with lists of pages, and contents of the site after them, a table for each heading."""
    made = f"{found[0].rstrip()}\n\n"
    made += "" if "### " in found[1] else _toctree("", found[1])
    for part in found[1].split("### ")[1:]:
        caption, _, rows = part.partition("\n")
        made += _toctree(f":caption: {caption}\n", rows)
    return made


def _toctree(options: str, rows: str) -> str:
    pages = "\n".join(path.removesuffix(".md") for path, _ in LINK.findall(rows))
    return f"```{{toctree}}\n{options}:maxdepth: 2\n:hidden:\n\n{pages}\n```\n\n"


def _read(_app: Any, name: str, content: list[str]) -> None:
    content[0] = site(content[0], name)


def levels(html: str) -> str:
    """Captions of the contents as headings with a level, which screen readers ask for."""
    return html.replace('role="heading"', 'role="heading" aria-level="2"')


def _shown(
    _app: Any, _page: str, _template: str, context: dict[str, Any], _tree: Any
) -> None:
    for part in ("furo_navigation_tree", "body"):
        if part in context:
            context[part] = levels(context[part])


def setup(app: Any) -> dict[str, Any]:
    """Register what changes pages as they are read and written."""
    app.connect("source-read", _read)
    # after the theme has made its contents
    app.connect("html-page-context", _shown, priority=900)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
