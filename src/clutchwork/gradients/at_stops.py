"""Stops that are met where the least change misses them, or lets them be met before or behind something else."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from clutchwork.assembly.patches import parameter_place
from clutchwork.base.memoize import memoize
from clutchwork.declare.schema import specs
from clutchwork.gradients.grazing import AT, IMPACT, KIND, ONE_INSTANT, TIME
from clutchwork.gradients.watched import distance, moved
from clutchwork.model.parts import is_stop
from clutchwork.results.forms import LOCKED

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.gradients.run_point import Run, RunPoint

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

# numbers of stops that say where they block, and what of them is the position there
ENDS = {"lower": (1.0,), "upper": (1.0,), "gap": (-0.5, 0.5)}


def met_otherwise(system: System, events: Array, grazes: Array, contacts: Sequence[str]) -> Iterator[tuple[float, str]]:
    """Since when [s] what stops do is open, and why: they close without a blow, or are struck where a signal jumps."""
    jumps = grazes[grazes[:, KIND] < 0, TIME]
    own = {number for number, _, _ in ends(system)}
    for event in events.tolist() if own else ():
        time, number = event[AT["time"]], int(event[AT["contact"]])
        if number not in own:
            continue
        closes = event[AT["to"]] == LOCKED and event[AT["from"]] != LOCKED
        if event[AT["cause"]] == IMPACT and np.any(np.abs(jumps - time) <= ONE_INSTANT):
            yield time, f"{contacts[number]} is struck at {time:.9g} s, where a signal jumps; move one of both"
        elif event[AT["cause"]] != IMPACT and closes:
            yield time, f"{contacts[number]} is only just reached at {time:.9g} s, and a little less does not reach it"


def met_at_the_end(system: System, point: RunPoint, run: Run, end: float) -> Iterator[tuple[str, Mask]]:
    """What is said of stops that are open and just reached as a run ends [s], and numbers that move them or what does.

    A little more of these strikes them before, a little less does not.
    """
    primal, first = run.primal, point.chart.words_in("params")[0]
    if not len(primal.times) or primal.times[-1] < end:
        return
    for number, column, limits in ends(system):
        mode = primal.rows[-1, primal.columns["contact_mode"].start + number]
        for place, share in limits if mode != LOCKED else ():
            one = distance([primal.columns["state"].start + column], [1.0], [first + place], [share])
            numbers = moved(point, run, one, end) if np.isfinite(point.words[first + place]) else one.words[:0] > 0
            if numbers.any():
                yield f"{system.contacts[number].name} is reached at the end of the run, {end:.9g} s", numbers


@memoize
def ends(system: System) -> tuple[tuple[int, int, tuple[tuple[int, float], ...]], ...]:
    """Stops: the number of each, the place of its position among the states, and of its ends among all parameters."""
    places, states = (system.arrays[name] for name in ("contact_place", "element_state"))
    return tuple(
        (number, int(states[places[number]]), _ends(system, number))
        for number, one in enumerate(system.contacts)
        if is_stop(one)
    )


def _ends(system: System, number: int) -> tuple[tuple[int, float], ...]:
    one = system.contacts[number]
    names = [item.name for item, _ in specs(type(one), "param") if item.name in ENDS]
    return tuple((parameter_place(system.numbered, one, name), share) for name in names for share in ENDS[name])
