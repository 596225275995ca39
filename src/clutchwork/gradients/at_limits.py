"""Freewheels that roll over, loaded exactly to a limit of theirs: a little more makes them give way, less does not."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from clutchwork.assembly.patches import parameter_place
from clutchwork.base.memoize import memoize
from clutchwork.gradients.watched import Distance, distance, moved
from clutchwork.results.forms import LOCKED

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.gradients.run_point import Run, RunPoint

Mask = NDArray[np.bool_]

HOLDING, DRAG = "holding", "drag"


def at_limits(system: System, point: RunPoint, run: Run) -> Iterator[tuple[str, Mask]]:
    """What is said of freewheels that hold exactly their load, and numbers that move one of both."""
    for number, name, place in holders(system):
        mode = run.primal.columns["contact_mode"].start + number
        for limit, left in _left(number, place, point, run):
            for time in point.looked_at:
                is_held = run.primal.rows[run.primal.row(time), mode] == LOCKED
                numbers = moved(point, run, left, time) if is_held else np.zeros(len(point.x), dtype=bool)
                if numbers.any():
                    what = f"{name} is loaded exactly to its {limit} at {time:.9g} s"
                    yield f"{what}, where a little more of the load makes it give way", numbers


def _left(contact: int, place: int, point: RunPoint, run: Run) -> Iterator[tuple[str, Distance]]:
    """What its torque leaves of what it holds either way."""
    torque, capacity = (run.primal.columns[f"contact_{what}"].start + contact for what in ("torque", "capacity"))
    yield HOLDING, distance([torque], [1.0], [point.chart.words_in("params")[0] + place], [1.0])
    yield DRAG, distance([torque, capacity], [1.0, 1.0])


@memoize
def holders(system: System) -> tuple[tuple[int, str, int], ...]:
    """Contacts that hold up to a number of theirs: each by its number, its name, and the place of that number."""
    return tuple(
        (number, one.name, parameter_place(system.numbered, one, HOLDING))
        for number, one in enumerate(system.contacts)
        if HOLDING in type(one).hooks
    )
