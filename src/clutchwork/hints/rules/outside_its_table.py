"""A lining hotter or colder than its table knows, an engine faster or slower than its table knows."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from clutchwork.declare.node import Domain
from clutchwork.declare.schema import specs
from clutchwork.hints.hint import Hint, shown
from clutchwork.hints.look import Look
from clutchwork.hints.registry import run_rule
from clutchwork.results.channels import SPEED

NAME = "outside its table"
# share of the range of a table beyond its ends that makes no difference
SLACK = 0.1


@run_rule(NAME)
def outside_its_table(look: Look) -> Iterator[Hint]:
    """Contacts that slip at temperatures, and elements that act at speeds, beyond the ends of their tables."""
    yield from _too_warm(look)
    yield from _too_fast(look)


def _too_warm(look: Look) -> Iterator[Hint]:
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


def _too_fast(look: Look) -> Iterator[Hint]:
    """An element with a torque over speed that turns at a speed beyond the ends of its table, and acts there."""
    torques = look.part("element_torque")
    for place, branch in enumerate(look.run.wiring.elements):
        known = speeds(branch.component)
        if branch.hidden or not known:
            continue
        speed, slack = look.rate(branch), SLACK * (known[-1] - known[0])
        beyond = (torques[:, place] != 0.0) & ((speed > known[-1] + slack) | (speed < known[0] - slack))
        if not np.any(beyond):
            continue
        worst = float(speed[beyond][np.argmax(np.abs(speed[beyond] - np.clip(speed[beyond], known[0], known[-1])))])
        begin, end = (float(t) for t in look.time[np.flatnonzero(beyond)[[0, -1]]])
        unit = SPEED[branch.domain]
        moves, what = ("turns", "torques") if branch.domain is Domain.ROTATION else ("moves", "forces")
        message = (
            f"{moves} at up to {shown(worst, unit)} between {begin:.4g} and {end:.4g} s, but its table of {what} ends"
            f" at {shown(known[-1] if worst > known[-1] else known[0], unit)}, where it goes on in a straight line"
        )
        remedy = "extend the table to that speed, or limit the speed"
        numbers = {f"speed [{unit}]": worst, f"lowest [{unit}]": known[0], f"highest [{unit}]": known[-1]}
        yield Hint(NAME, (branch.name,), message, remedy, numbers, begin, end)


def speeds(component: Any) -> tuple[float, ...]:
    """Speeds that the tables of an element know, rising; none where it has no table over its speed."""
    found = set[float]()
    for item, spec in specs(type(component), "curve"):
        value = getattr(component, item.name)
        if spec.unit_x == "rad/s" and not isinstance(value, int | float):
            found |= {float(x) for x, _ in value}
    return tuple(sorted(found))


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
