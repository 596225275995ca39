"""Names and wildcards, such as "c1.*" and "*.speed": which signals they mean."""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterable
from fnmatch import translate
from typing import Any

from clutchwork.base import UnknownName, UseError, quote


def chosen(wanted: Any, known: Iterable[str], fault: Callable[[str], str], call: str = "names") -> tuple[str, ...]:
    """Names that are meant, each once, in the order in which they are asked for; all where None is given.

    Parameters: wanted, a name or several, in which * stands for any characters and ? for one; fault, what is said of a
    name that there is not; call, what the names were given to. UnknownName, a KeyError, lists all that mean nothing.
    """
    names = tuple(known)
    if wanted is None:
        return names
    try:
        asked = [wanted] if isinstance(wanted, str) else list(wanted)
    except TypeError:
        asked = [wanted]
    wrong = [one for one in asked if not isinstance(one, str)]
    if wrong:
        remedy = 'give strings, such as names=["c1.*", "*.speed"]'
        raise UseError(call, [f"names: {quote(one)} is not the name of a signal; {remedy}" for one in wrong])
    found, faults = dict[str, None](), list[str]()
    for one in asked:
        matching = meant(one, names)
        found.update(dict.fromkeys(matching))
        if not matching:
            faults.append(fault(one))
    if faults:
        raise UnknownName("\n".join(faults))
    return tuple(found)


def meant(wanted: str, names: Collection[str]) -> list[str]:
    """Names that a name or a wildcard stands for."""
    if wanted in names or not ("*" in wanted or "?" in wanted):
        return [wanted] if wanted in names else []
    # brackets stand for themselves: they are part of names
    pattern = re.compile(translate(wanted.replace("[", "[[]")))
    return [name for name in names if pattern.match(name)]
