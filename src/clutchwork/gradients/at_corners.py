"""What rests at a corner of a road: its slope may be any between both sides, and follows from no number."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from clutchwork.assembly.patches import parameter_place
from clutchwork.base.memoize import memoize

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.gradients.primal import Primal
    from clutchwork.gradients.run_point import RunPoint

Array = NDArray[np.float64]
Places = NDArray[np.intp]

# slopes that differ by less are one
SAME = 1e-12
# words of a point of a table
POINT = 3


def resting_at_corners(system: System, point: RunPoint, primal: Primal) -> Iterator[tuple[str, Places]]:
    """What is said of a vehicle that rests between two slopes at the end, and the columns of what it leaves open."""
    states, torques = primal.columns["state"], primal.columns["contact_torque"]
    for number, name, place in cornered(system):
        column = states.start + int(system.arrays["process_state"][number])
        slopes, own = _slopes(point, place), primal.rows[primal.row(primal.t_end), column]
        if np.all(np.abs(slopes - own) > SAME * (1.0 + np.abs(slopes))):
            why = f"{name} ends at a corner at rest, where its slope may be any between both sides"
            open_ = np.r_[column, torques.start : torques.stop]
            yield f"{why}: neither it nor what holds there has a derivative", open_


@memoize
def cornered(system: System) -> tuple[tuple[int, str, int], ...]:
    """Roads: the number of each among the processes, its name, and the place of its table among all parameters."""
    return tuple(
        (number, one.name, parameter_place(system.numbered, one, "elevation"))
        for number, one in enumerate(system.processes)
        if "corner" in type(one).hooks
    )


def _slopes(point: RunPoint, place: int) -> Array:
    """Slopes between the points of a road; it is level before the first and behind the last one."""
    (params, _), (points, _) = map(point.chart.words_in, ("params", "points"))
    first, count = (int(one) for one in point.words[params + place : params + place + 2])
    table = point.words[points + POINT * first : points + POINT * (first + count)].reshape(-1, POINT)
    along, up = np.diff(table[:, 0]), np.diff(table[:, 1])
    found: Array = np.r_[0.0, up[along > 0.0] / along[along > 0.0]]
    return found
