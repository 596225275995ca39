"""Lists of Python objects in docs/api.md, for which the site documents these objects.

A line of such a list is a name with a link to its source, and what of its members is documented:

- [`clutchwork.simulate`](../src/clutchwork/...)
- [`clutchwork.Events()`](...): all members
- [`clutchwork.Linear()`](...): all members but `modes_of_contacts`, `shaft_speeds`
- [`clutchwork.Options()`](...): members `load`, `save`

Brackets behind a class say that it is handed out, not made by its user. Other words describe it in place of its
docstring.
"""

from __future__ import annotations

import inspect
import re
from collections.abc import Iterator
from importlib import import_module
from types import ModuleType
from typing import Any

LISTED = re.compile(r"(?m)(?:^- \[`clutchwork\.[^`]+`\]\([^)]*\).*\n(?:  .*\n)*)+")
ITEM = re.compile(
    r"(?ms)^- \[`([\w.]+)(\([^`]*\))?`\]\([^)]*\)(?:: (.*?))?$(?=\n- |\n*\Z)"
)
NAMES = re.compile(r"`(\w+)`")


def documented(text: str) -> str:
    """A page with a directive in place of each line."""
    return LISTED.sub(
        lambda found: (
            "```{eval-rst}\n" + "\n".join(map(_entry, _items(found[0]))) + "```\n"
        ),
        text,
    )


def _items(listed: str) -> Iterator[tuple[str, str, str]]:
    for name, call, rest in ITEM.findall(listed):
        yield name, call, " ".join(rest.split())


def _entry(item: tuple[str, str, str]) -> str:
    name, call, rest = item
    if rest and "members" not in rest:
        module, _, last = name.rpartition(".")
        return f".. py:class:: {last}\n   :module: {module}\n\n   {rest.replace('`', '``')}\n"
    return f".. auto{_kind(thing(name))}:: {name}{call}\n{_options(rest)}\n"


def thing(name: str) -> Any:
    """What has a name."""
    parts = name.split(".")
    found: Any = import_module(parts[0])
    for number, part in enumerate(parts[1:], 2):
        if not hasattr(found, part):
            import_module(".".join(parts[:number]))
        found = getattr(found, part)
    return found


def _kind(found: Any) -> str:
    if isinstance(found, ModuleType):
        return "module"
    if not inspect.isclass(found):
        return "function"
    return "exception" if issubclass(found, BaseException) else "class"


def _options(rest: str) -> str:
    if rest.startswith("members"):
        return f"   :members: {', '.join(NAMES.findall(rest))}\n"
    if not rest.startswith("all members"):
        return ""
    inherited = "   :inherited-members:\n" if "inherited" in rest else ""
    left_out = NAMES.findall(rest)
    return f"   :members:\n{inherited}" + (
        f"   :exclude-members: {', '.join(left_out)}\n" if left_out else ""
    )
