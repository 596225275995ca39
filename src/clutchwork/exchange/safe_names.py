"""Names of signals as other programs can take them, each of them once."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable

# what MATLAB takes as the name of a field
LONGEST = 63


def matlab(names: Iterable[str], taken: Iterable[str] = ()) -> dict[str, str]:
    """Names of fields by name of the signal: letters, digits and underscores, a letter first.

    Parameters: taken, names of other fields.
    """
    return _each(names, _field, taken)


def without(names: Iterable[str], character: str) -> dict[str, str]:
    """Names in which an underscore stands for a character, by name of the signal."""
    return _each(names, lambda name: name.replace(character, "_"), ())


def _field(name: str) -> str:
    made = re.sub(r"[^A-Za-z0-9_]", "_", name)
    return made if re.match(r"[A-Za-z]", made) else f"x{made}"


def _each(names: Iterable[str], change: Callable[[str], str], taken: Iterable[str]) -> dict[str, str]:
    used, made = set(taken), dict[str, str]()
    for name in names:
        safe, number = change(name)[:LONGEST] if change is _field else change(name), 1
        while safe in used:
            number += 1
            ending = f"_{number}"
            safe = f"{change(name)[: LONGEST - len(ending)]}{ending}"
        used.add(safe)
        made[name] = safe
    return made
