"""Tops by several steps: of a short one, errors of its rows at the tolerance of the run move the top.

docs/theory/gradients.md (12)
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.polynomial import Polynomial
from numpy.typing import NDArray

from clutchwork.gradients.primal import SMOOTH, Primal
from clutchwork.sweeps.parts import PARTS

Array = NDArray[np.float64]
# values of all rows from a first to a last step
Values = Callable[[int, int], Array]

# so many steps more on each side; degree of the polynomial over them, how well it fits, of the largest value, and how
# much less well over more steps: then it misses more than errors of rows
REACHES, DEGREE, FITS, WORSE = (1, 2, 4, 8), 6, 1e-8, 2.0
# steps of the method of Newton to a top
ROUNDS = 4


def top(primal: Primal, values: Values, step: int, share: float) -> tuple[int, float]:
    """A step and the place in it where a signal has the top that the polynomial of one step has at a place."""
    steps = primal.steps
    time = begin = float(steps.begin[step] + share * steps.length[step])
    fitted = _fitted(primal, values, step)
    if fitted is None:
        return step, share
    rate, bend = fitted.deriv(), fitted.deriv(2)
    for _ in range(ROUNDS):
        time -= float(rate(time)) / (float(bend(time)) or np.inf)
    if not abs(time - begin) <= steps.length[step]:
        return step, share
    place = max(int(np.searchsorted(steps.begin, time, side="right")) - 1, 0)
    return place, min((time - float(steps.begin[place])) / float(steps.length[place]), 1.0)


def _fitted(primal: Primal, values: Values, step: int) -> Polynomial | None:
    """The polynomial over as many steps around one as go on smoothly and as it fits; None where it does not fit few."""
    steps, kinds, found = primal.steps, primal.between[0], None
    # it says no more than that of the step itself where that misses less
    allowed = float(abs(steps.basis[step, PARTS] @ values(step, step)))
    for reach in REACHES:
        # parts of one step have its errors together
        first, last = steps.around(step, reach) or (0, -1)
        if last < 0 or np.any(kinds[first + 1 : last + 1] != SMOOTH):
            break
        times, own = primal.times[steps.rows[first : last + 1].ravel()], values(first, last)
        fitted = Polynomial.fit(times, own, DEGREE)
        missed = float(np.abs(fitted(times) - own).max())
        if missed > min(allowed, FITS * float(np.abs(own).max())):
            break
        found, allowed = fitted, min(allowed, WORSE * missed)
    return found
