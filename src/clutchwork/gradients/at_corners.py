"""What rests at a corner of a road: its slope may be any between both sides, and follows from no number."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from clutchwork.base.memoize import memoize

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.gradients.primal import Primal

Places = NDArray[np.intp]

# slopes that differ by less are one
SAME = 1e-12


@memoize
def cornered(system: System) -> tuple[tuple[int, Any], ...]:
    """Roads, and the number of each among the processes."""
    return tuple((number, one) for number, one in enumerate(system.processes) if "corner" in type(one).hooks)


def resting_at_corners(system: System, primal: Primal) -> Iterator[tuple[str, Places]]:
    """What is said of a vehicle that rests between two slopes at the end, and the columns of what it leaves open."""
    ones = cornered(system)
    if not ones:
        return
    states, torques = primal.columns["state"], primal.columns["contact_torque"]
    row = primal.rows[primal.row(primal.t_end)]
    for number, one in ones:
        column = states.start + int(system.arrays["process_state"][number])
        # level before the first point and behind the last one
        slopes = np.array(
            [0.0, *((up - down) / (to - at) for (at, down), (to, up) in pairwise(one.elevation) if to > at)]
        )
        if np.all(np.abs(slopes - row[column]) > SAME * (1.0 + np.abs(slopes))):
            why = f"{one.name} ends at a corner at rest, where its slope may be any between both sides"
            yield (
                f"{why}: neither it nor what holds there has a derivative",
                np.r_[column, torques.start : torques.stop],
            )
