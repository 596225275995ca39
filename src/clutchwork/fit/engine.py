"""Bounded least squares with a loss: the search behind fits of laws and of records."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from clutchwork.base import dataclass
from clutchwork.base.arrays import Array
from clutchwork.fit.failure import scipy

if TYPE_CHECKING:
    from clutchwork.fit.losses import Penalty
    from clutchwork.fit.unknown import Unknown

# places among residuals, those of each signal, in order of time in each record
Signals = dict[str, list[NDArray[np.intp]]]


# weight of staying at the start value, which alone decides what the samples leave open
STAY = 1e-6
# times that the noise is found anew for a loss, and by what share it may still change at the end
MOST_ROUNDS, SETTLED = 20, 1e-3
# shares of a scale within which a code lies on a bound: the search comes close to it and never touches it
CLOSE = 1e-9


@dataclass(frozen=True)
class Solution:
    """Where the search ended."""

    u: Array  # codes
    squares: float  # sum over the samples, as they count
    converged: bool


class LeastSquares:
    """Residuals of samples over codes of free numbers; who derives from it says what they are."""

    # of the search of SciPy
    settings: ClassVar[dict[str, Any]] = {}
    # whether a number that may be zero is compared with what changes the samples by their size
    zeros: ClassVar[bool] = False

    items: tuple[Unknown, ...]  # free numbers; some may be tied, so that there are less codes
    searched: Sequence[int]  # the number of each code
    lower: Array
    upper: Array
    start: Array  # codes of the start values
    scales: Array  # what a change of each code is measured in
    stay: Array  # what leaving the start value of each code costs
    signals: Signals  # residuals that give equations
    size: float  # root mean square of the samples, as residuals are counted
    exact: bool  # whether derivatives are those of a formula, not of runs with an error of their own
    loss: Penalty
    within: Array | None = None  # residuals from where on they count less; None: all count in full

    def residuals(self, u: Array) -> Array:
        """Fitted minus measured samples."""
        raise NotImplementedError

    def jacobian(self, u: Array) -> Array:
        """Derivatives of the residuals by the codes."""
        raise NotImplementedError

    def ends(self, u: Array) -> list[tuple[float, float]]:
        """Lowest and highest value of each free number, where the others have these codes."""
        raise NotImplementedError

    def codes(self, u: Array) -> Array:
        """Codes of all free numbers."""
        return u

    def spread(self, u: Array) -> Array:
        """Their derivatives by the codes that are searched for."""
        return np.eye(len(u))

    def values(self, u: Array) -> Array:
        """All free numbers."""
        return np.array([one.decoded(code) for one, code in zip(self.items, self.codes(u).tolist(), strict=True)])

    def sizes(self, jacobian: Array) -> Array:  # noqa: ARG002, others do
        """What changes of the codes are measured in by the samples."""
        return self.scales

    def reach(self, u: Array, place: int, most: float) -> tuple[float, float]:  # noqa: ARG002, others do
        """How far a number without effect can go until squares sum up to so much more."""
        return self.ends(u)[place]

    # ---------------------------------------------------------------------------------------------------------- search

    def noise(self, residuals: Array) -> Array:
        """From where on residuals count less, by the noise of their signal."""
        made = np.zeros(len(residuals))
        for places in self.signals.values():
            own = np.concatenate(places)
            made[own] = self.loss.scale(residuals[own], self.size)
        return made

    def felt(self, u: Array) -> Array:
        """Residuals as the estimate feels them."""
        made, within = self.residuals(u), self.within
        if within is None:
            return made
        for places in self.signals.values():
            own = np.concatenate(places)
            made[own] = self.loss.felt(made[own], within[own])
        return made

    def settle(self, ended: Solution) -> Solution:
        """The same; with a loss other than squares by the noise, which is found on the way."""
        for _ in range(0 if self.loss.is_linear else MOST_ROUNDS):
            before, self.within = self.within, self.noise(self.residuals(ended.u))
            if before is not None and np.all(np.abs(self.within - before) <= SETTLED * self.within):
                break
            ended = self.solve(ended.u)
        return ended

    def solve(self, start: Array | None = None, held: Sequence[int] = ()) -> Solution:
        """The best codes within their bounds.

        Parameters: start, codes to start from, by default those of the start values; held, places of codes that stay.
        """
        whole = self.start if start is None else start
        moving = np.setdiff1d(np.arange(len(whole)), held)
        lower, upper = self.lower[moving], self.upper[moving]

        def full(part: Array) -> Array:
            made = whole.copy()
            made[moving] = part
            return made

        def tied(part: Array) -> Array:
            u = full(part)
            return np.append(self.residuals(u), self.stay * (u - self.start))

        def slopes(part: Array) -> Array:
            return np.vstack([self.jacobian(full(part)), np.diag(self.stay)])[:, moving]

        found = scipy("optimize").least_squares(
            tied, np.clip(whole[moving], lower, upper), jac=slopes, bounds=(lower, upper), x_scale="jac",
            xtol=1e-10, ftol=1e-12, loss=self.loss.searched(self.within), **self.settings,
        )  # fmt: skip
        close = CLOSE * np.maximum(self.scales[moving], np.abs(found.x))
        part = np.where(found.x - lower < close, lower, np.where(upper - found.x < close, upper, found.x))
        left = self.residuals(full(part))
        costs = left**2 if self.within is None else self.loss.costs(left, self.within)
        return Solution(full(part), float(np.sum(costs)), found.status > 0)
