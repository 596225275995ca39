"""Numbers at their bounds, of which the least change has effects that are not seen there: rebounds, and losses."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from clutchwork.assembly.patches import parameter_place
from clutchwork.base.memoize import memoize
from clutchwork.declare.schema import specs
from clutchwork.gradients.grazing import AT, IMPACT
from clutchwork.model.parts import is_stop
from clutchwork.model.structure import follows_load
from clutchwork.results.forms import LOCKED

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.declare.node import Component
    from clutchwork.gradients.primal import Primal
    from clutchwork.gradients.words import Chart, Slopes

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
Places = NDArray[np.intp]

# numbers of a row of losses: the speed, two efficiencies, two frictions; and words of a point
ROW, EFFICIENCIES, POINT = 5, slice(1, 3), 3


def held_fast(chart: Chart, words: Array, slopes: Slopes, events: Array) -> Iterator[tuple[float, str, Mask]]:
    """Stops without restitution: since when [s] each has been struck, what is said of it, and its numbers."""
    first, count = chart.words_in("params")
    struck = events[events[:, AT["cause"]] == IMPACT]
    if not len(struck) or not slopes.touch(first, count):
        return
    system = chart.assembled.system
    for number, contact in enumerate(system.contacts):
        own = struck[struck[:, AT["contact"]] == number, AT["time"]]
        if not len(own) or not is_stop(contact):
            continue
        for item, _ in specs(type(contact), "param"):
            place = np.array([first + parameter_place(system.numbered, contact, item.name)])
            numbers: Mask = (slopes.of(place) != 0.0).any(axis=0)
            if item.name.endswith("restitution") and words[place[0]] == 0.0 and numbers.any():
                what = f"{contact.name} is struck at {own[0]:.9g} s with {item.name} 0"
                yield float(own[0]), f"{what}, and bounces for a little more", numbers


def without_losses(chart: Chart, words: Array, slopes: Slopes) -> Iterator[tuple[str, Mask]]:
    """Gears and limited slips without losses, which make some one way or the other; and the numbers that give them."""
    if not any(slopes.touch(*chart.words_in(name)) for name in ("params", "points")):
        return
    system = chart.assembled.system
    for contact in filter(follows_load, system.contacts):
        places = _ideal(chart, words, system, contact)
        numbers: Mask = (slopes.of(places) != 0.0).any(axis=0)
        if numbers.any():
            why = f"{contact.name} has no losses that follow its load, whose sign decides what a little of them does"
            yield why, numbers


def holding_nothing(system: System, primal: Primal) -> Iterator[str]:
    """Contacts that are locked though they can hold nothing: any difference of what they join lets them slip."""
    alone = limited(system)
    if not alone:
        return
    row, columns, events = primal.rows[primal.row(primal.t_end)], primal.columns, primal.events
    held = (row[columns["contact_mode"]] == LOCKED) & (row[columns["contact_capacity"]] == 0.0)
    lets_go = (events[:, AT["from"]] == LOCKED) & (events[:, AT["torque_after"]] == 0.0)
    left = set(events[lets_go, AT["contact"]].astype(int).tolist())
    for number in alone:
        if held[number] or number in left:
            name = system.contacts[number].name
            yield f"{name} is locked without capacity, and slips as soon as what it joins moves apart"


@memoize
def limited(system: System) -> tuple[int, ...]:
    """Limited slips, whose capacity is a share of their load."""
    ones = enumerate(system.contacts)
    return tuple(number for number, contact in ones if follows_load(contact) and not _has_table(contact))


def _has_table(contact: Component) -> bool:
    """Whether its capacity follows a table of losses, as that of a gear does."""
    return any(item.name == "loss_table" for item, _ in specs(type(contact), "numbers"))


def _ideal(chart: Chart, words: Array, system: System, contact: Component) -> Places:
    """Words of losses of a contact that has none, or has none at a speed."""
    begin, (first, _) = chart.words_in("params")[0], chart.words_in("points")
    if not _has_table(contact):
        # shares of the load have no unit
        shares = [item.name for item, spec in specs(type(contact), "param") if spec.unit == "1"]
        own = [begin + parameter_place(system.numbered, contact, name) for name in shares]
        return np.array(own) if not words[own].any() else np.zeros(0, dtype=np.intp)
    place = begin + parameter_place(system.numbered, contact, "loss_table")
    start, count = (int(one) for one in words[place : place + 2])
    table = first + POINT * (start + np.arange(count).reshape(-1, ROW)[:, EFFICIENCIES])
    return np.asarray(table[(words[table] == 1.0).all(axis=1)].ravel())
