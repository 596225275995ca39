"""What reference pages say of any declaration: its words, its entry in the index, a table of its fields."""

from __future__ import annotations

import inspect
import re
from collections.abc import Iterator
from dataclasses import MISSING
from pathlib import Path
from typing import Any

from clutchwork.declare import docs
from clutchwork.declare.docs import described, words
from clutchwork.declare.schema import REGISTRY, specs

ROOT = Path(__file__).resolve().parent.parent


def summary(cls: type) -> str:
    """First sentence or two, for a cell of a table."""
    return docs.summary(cls).replace("|", "\\|")


def entry(cls: Any) -> str:
    """How it is called, which is also its entry in the index."""
    fields = [item for item, _ in specs(cls)]
    first = ["name"] if "name" in inspect.signature(cls).parameters else []
    first += [item.name for item in fields if not item.kw_only]
    keywords = [item.name for item in fields if item.kw_only and item.default is MISSING]
    keywords += ["..."] if any(item.kw_only and item.default is not MISSING for item in fields) else []
    call = ", ".join([*first, *(["*", *keywords] if keywords else [])])
    return f"```{{eval-rst}}\n.. py:class:: {cls.__name__}({call})\n   :module: clutchwork\n```\n"


def linked(cls: type, root: str = "../..") -> str:
    """The docstring with links: digital object identifiers, pages of the theory, other elements and laws."""
    text = re.sub(r"doi:(10\.[^\s,]*[^\s,.])", r"[doi:\1](<https://doi.org/\1>)", words(cls))
    text = re.sub(r"docs/theory/([\w-]+)\.md", rf"[\1]({root}/theory/\1.md)", text)
    known = {other.__name__: kind for kinds in REGISTRY.values() for kind, other in kinds.items() if other is not cls}
    return re.sub(
        r"`([A-Z]\w+)`",
        lambda found: f"{{ref}}`{found[1]} <{known[found[1]]}>`" if found[1] in known else found[0],
        text,
    )


def table(cls: type) -> Iterator[str]:
    """All fields with unit, default, meaning and bound; narrow screens show the meaning below the rest."""
    yield "{.fields}\n| field | unit | default | meaning |\n|---|---|---|---|"
    for item, spec in specs(cls):
        told = described(item, spec)
        sort = f"one of {told.bound}" if spec.choices else ", ".join(filter(None, (told.sort, told.bound)))
        yield f"| `{told.name}` | {told.unit} | {told.default} | {told.meaning}; *{sort}* |"
    yield ""


def header(kind: str, folder: str) -> str:
    """Where the equations are in the code."""
    found = sorted((ROOT / "cpp" / "include").rglob(f"{folder}/{kind}.hpp"))
    return f"Header: `{found[0].relative_to(ROOT)}`\n" if found else ""
