"""A lining that is hotter or colder than its table knows."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from clutchwork.declare.schema import specs
from clutchwork.results.hints.hint import Hint, shown
from clutchwork.results.hints.registry import run_rule

if TYPE_CHECKING:
    from clutchwork.results.hints.look import Look

NAME = "outside its table"
# share of the range of a table beyond its ends that makes no difference
SLACK = 0.1


@run_rule(NAME)
def outside_its_table(look: Look) -> Iterator[Hint]:
    """A contact that slips at a temperature beyond the ends of the table of its friction law."""
    for contact, branch in enumerate(look.contacts):
        law, name = branch.component.friction, f"{branch.name}.friction.temperature"
        known = temperatures(law)
        if not known or name not in look.fine:
            continue
        warm = look.fine[name]
        acts = look.closed[:, contact] & ~look.locked[:, contact]
        slack = SLACK * (known[-1] - known[0])
        beyond = acts & ((warm > known[-1] + slack) | (warm < known[0] - slack))
        if not np.any(beyond):
            continue
        worst = float(warm[beyond][np.argmax(np.abs(warm[beyond] - np.clip(warm[beyond], known[0], known[-1])))])
        begin, end = (float(t) for t in look.time[np.flatnonzero(beyond)[[0, -1]]])
        goes_on = "goes on in a straight line" if law.extrapolation == "linear" else "keeps its value at the end"
        message = (
            f"slips at up to {shown(worst, 'K')} between {begin:.4g} and {end:.4g} s, but its table of coefficients"
            f" ends at {shown(known[-1] if worst > known[-1] else known[0], 'K')}, where it {goes_on}"
        )
        remedy = "extend the table to that temperature, or cool the contact"
        numbers = {"temperature [K]": worst, "lowest [K]": known[0], "highest [K]": known[-1]}
        yield Hint(NAME, (branch.name,), message, remedy, numbers, begin, end)


def temperatures(law: Any) -> tuple[float, ...]:
    """Temperatures that the tables of a law know, rising; none where it has no table over them."""
    found = set[float]()
    for item, spec in specs(type(law)):
        value = getattr(law, item.name)
        if spec.what == "curve" and spec.unit_x == "K":
            found |= {float(x) for x, _ in value}
        elif spec.what == "numbers" and spec.unit == "K":
            found |= {float(x) for x in value}
    return tuple(sorted(found))
