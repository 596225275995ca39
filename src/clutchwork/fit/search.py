"""Bounded least squares over the free parameters."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from clutchwork.base.classes import dataclass
from clutchwork.fit.failure import scipy
from clutchwork.fit.losses import Penalty

if TYPE_CHECKING:
    from clutchwork.fit.model import Model
    from clutchwork.fit.unknowns import Unknowns

Array = NDArray[np.float64]

# relative steps of difference quotients: of a formula, and of a run that has an error of its own
STEP_EXACT, STEP_RUN = 1e-5, 1e-3
MOST_ITERATIONS = 200
# weight of staying at the start value, which alone decides what the samples leave open
STAY = 1e-6
# times that the noise is found anew for a loss, and by what share it may still change at the end
MOST_ROUNDS, SETTLED = 20, 1e-3


@dataclass(frozen=True)
class Solution:
    """Where the search ended."""

    u: Array  # codes
    converged: bool
    squares: float  # N2 m2, sum over the samples, as they count


class Residuals:
    """Residuals of all samples over the codes of the free parameters, and their derivatives."""

    def __init__(
        self, model: Model, unknowns: Unknowns, scales: Array | None = None, loss: Penalty | None = None
    ) -> None:
        self.model, self.unknowns, self._scales = model, unknowns, scales
        self.measured, self.loss = model.measured, loss or Penalty()
        # of the residuals, from where on they count less [N m]
        self.within = np.inf
        self.step = STEP_EXACT if model.exact else STEP_RUN
        self.logs = [unknowns.items[place].is_log for place in unknowns.searched]

    def residuals(self, u: Array) -> Array:
        """Fitted minus measured torque of every sample [N m]."""
        return self.model.torque(self.unknowns.law_at(u)) - self.measured.torque

    @cached_property
    def scales(self) -> Array:
        """What a change of each code by one step is measured in: 1 for logarithms, a typical size for numbers."""
        if self._scales is not None:
            return self._scales
        start = self.unknowns.start
        made = np.where(self.logs, 1.0, np.abs(start))
        for place in np.flatnonzero(made == 0.0):
            made[place] = self._typical(int(place))
        return made

    def _typical(self, place: int) -> float:
        """Size of a number that starts at zero: so much changes the torque by about its own size."""
        base, size = self.residuals(self.unknowns.start), self.measured.size
        for exponent in range(-12, 7):
            u = self.unknowns.start.copy()
            u[place] += 10.0**exponent
            change = float(np.sqrt(np.mean((self.residuals(u) - base) ** 2)))
            if change > 1e-4 * size:
                return float(10.0**exponent * size / change)
        return 1.0

    def jacobian(self, u: Array) -> Array:
        """Derivatives of the residuals by the codes, shape (samples, codes), by central differences."""
        return derivatives(self.residuals, u, self)

    def tied(self, u: Array) -> Array:
        """Residuals, and small ones more for leaving the start values."""
        stay = STAY * float(np.sqrt(np.sum(self.measured.torque**2))) * (u - self.unknowns.start) / self.scales
        return np.concatenate([self.residuals(u), stay])

    def settle(self) -> Solution:
        """The best codes; with a loss other than squares the noise, which it is measured by, is found on the way."""
        made = self.solve()
        for _ in range(0 if self.loss.is_linear else MOST_ROUNDS):
            before, own = self.within, self.residuals(made.u)[self.model.equations]
            self.within = self.loss.scale(own, self.measured.size)
            if abs(self.within - before) <= SETTLED * self.within:
                break
            made = self.solve(made.u)
        return made

    def solve(self, start: Array | None = None, held: Sequence[int] = ()) -> Solution:
        """The best codes within their bounds.

        Parameters: start, codes to start from, by default those of the start values; held, places of codes that stay.
        """
        whole = self.unknowns.start if start is None else start
        moving = np.setdiff1d(np.arange(len(whole)), held)
        lower, upper = self.unknowns.lower[moving], self.unknowns.upper[moving]

        def full(part: Array) -> Array:
            made = whole.copy()
            made[moving] = part
            return made

        robust = np.full(len(self.measured.time), self.within) if np.isfinite(self.within) else None
        found = scipy("optimize").least_squares(
            lambda part: self.tied(full(part)),
            np.clip(whole[moving], lower, upper),
            jac=lambda part: derivatives(self.tied, full(part), self, moving),
            bounds=(lower, upper), method="trf", x_scale="jac", xtol=1e-10, ftol=1e-12, gtol=1e-12,
            max_nfev=MOST_ITERATIONS, loss=self.loss.searched(robust),
        )  # fmt: skip
        # the search comes close to its bounds and never touches them
        close = 1e-9 * np.maximum(self.scales[moving], np.abs(found.x))
        part = np.where(found.x - lower < close, lower, np.where(upper - found.x < close, upper, found.x))
        left = self.residuals(full(part))
        squares = float(np.sum(left**2 if robust is None else self.loss.costs(left, self.within)))
        return Solution(full(part), found.status > 0, squares)


def derivatives(
    function: Callable[[Array], Array], u: Array, search: Residuals, places: Iterable[int] | None = None
) -> Array:
    """Difference quotients by every code, or some: central inside the bounds, one-sided at them."""
    lower, upper = search.unknowns.lower, search.unknowns.upper
    columns = []
    for place in range(len(u)) if places is None else places:
        step = search.step * max(float(search.scales[place]), 0.0 if search.logs[place] else abs(float(u[place])))
        above, below = u.copy(), u.copy()
        above[place] = min(u[place] + step, upper[place])
        below[place] = max(u[place] - step, lower[place])
        columns.append((function(above) - function(below)) / (above[place] - below[place]))
    return np.array(columns).T
