"""Starts beside which the equations are others: contacts at rest, states at zero."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from clutchwork.assembly.changes import owners_of
from clutchwork.gradients.words import Chart, Slopes
from clutchwork.model.changes import field_of, target
from clutchwork.model.parts import is_stop

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.declare.node import Component
    from clutchwork.gradients.parameters import Tunable

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
Places = NDArray[np.intp]

# a slip that is zero, of the largest speed that it is made of
ZERO = 1e-10
# numbers of a piece of a signal
PIECE = 12


def at_rest(chart: Chart, words: Array, slopes: Slopes) -> Iterator[tuple[str, Mask]]:
    """What is said of contacts without slip at the start, and numbers that would make one."""
    known = [chart.words_in(name) for name in ("contact_rate_value", "initial_speed", "segment_coef")]
    moves, drives = any(slopes.touch(*part) for part in known[:2]), slopes.touch(*known[2])
    if not moves and not drives:
        return
    system, (rates, _), (starts, _) = chart.assembled.system, *known[:2]
    ends = system.arrays["contact_rate_end"]
    for number, contact in enumerate(system.contacts):
        driven = _driven(chart, number)
        if is_stop(contact) or not (moves or len(driven)):
            continue
        first, last = int(ends[number - 1]) if number else 0, int(ends[number])
        factors, speeds = rates + np.arange(first, last), starts + system.arrays["contact_rate_column"][first:last]
        parts = words[factors] * words[speeds]
        if not len(driven) and abs(parts.sum()) > ZERO * (1.0 + np.abs(parts).max(initial=0.0)):
            continue
        moved = words[factors] @ slopes.of(speeds) + words[speeds] @ slopes.of(factors)
        # how a prescribed speed begins is not looked at: whatever moves it may move the slip
        numbers: Mask = (np.abs(moved) > 0.0) | slopes.of(driven).any(axis=0)
        if numbers.any():
            yield f"{contact.name} begins at rest, and slips one way or the other for another start value", numbers


def at_zero(chart: Chart, slopes: Slopes) -> Iterator[tuple[str, Mask]]:
    """What is said of states that start at zero where equations change there, and numbers that would move them."""
    system, states = chart.assembled.system, chart.words_in("initial_state")
    if not slopes.touch(*states):
        return
    for part, first in _bending(system):
        for place, (state, start) in enumerate(zip(part.own_states(), part.initial_states(), strict=True), first):
            numbers: Mask = slopes.of(np.array([states[0] + place]))[0] != 0.0
            if start == 0.0 and numbers.any():
                why = f"{part.name} begins with {state.name} zero, on whose sides it has other equations"
                yield why, numbers


def at_rest_on_a_border(system: System, starts: Array, end: Array) -> Iterator[tuple[str, int]]:
    """What is said of states that stay as they begin where equations change, and the place of each.

    Parameters: starts, end, states with which a run begins and ends.
    """
    for part, first in _bending(system):
        for place, state in enumerate(part.own_states(), first):
            if starts[place] == end[place]:
                why = f"{part.name}.{state.name} stays at its start value, on whose sides it has other equations"
                yield why, place


def _bending(system: System) -> Iterator[tuple[Component, int]]:
    """Elements and processes whose equations change where a state passes zero, and the place of their first state."""
    places, starts = system.numbered.places, system.arrays
    for one in (one for one in system.elements if one.bends):
        yield one, int(starts["element_state"][places[one.name][1]])
    for number, one in enumerate(system.processes):
        if one.bends:
            yield one, int(starts["process_state"][number])


def at_border(system: System, parameters: Sequence[Tunable], x: Array) -> Iterator[tuple[str, Mask]]:
    """What is said of tables that begin at zero, as that of a converter at stall, and the numbers that begin them."""
    for number, one in enumerate(parameters):
        if one.places == ((0,),) and x[number] == 0.0 and _is_rising(system, one.field):
            what = f"{one.name} is 0, where its table begins, and what stands still is there"
            yield f"{what}: for more it is before the table, for less inside of it", np.arange(len(x)) == number


def _is_rising(system: System, field: str) -> bool:
    aim = target(owners_of(system), field)
    return aim is not None and bool(field_of(aim)[1].rising)


def _driven(chart: Chart, number: int) -> Places:
    """Words of prescribed speeds that are in the slip of a contact."""
    system = chart.assembled.system
    shares, found = system.arrays["contact_rate_prescribed"], [np.zeros(0, dtype=np.intp)]
    for signal in system.arrays["prescribed_input"][np.flatnonzero(shares[number])] if shares.size else ():
        first, count = (int(system.arrays[f"input_{what}"][signal]) for what in ("first", "count"))
        begin = system.starts["segment_coef"] // 8 + PIECE * first
        found.append(np.arange(begin, begin + PIECE * count))
    return np.concatenate(found)
