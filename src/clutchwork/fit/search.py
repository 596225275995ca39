"""Residuals of a friction law over the codes of its free parameters."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from clutchwork.base.arrays import Array
from clutchwork.fit.engine import STAY, LeastSquares
from clutchwork.fit.losses import Penalty

if TYPE_CHECKING:
    from clutchwork.fit.model import Model
    from clutchwork.fit.unknowns import Unknowns


# relative steps of difference quotients: of a formula, and of a run that has an error of its own
STEP_EXACT, STEP_RUN = 1e-5, 1e-3
# the signal that is measured
TORQUE = "torque"


class Residuals(LeastSquares):
    """Fitted minus measured torque of all samples [N m], and derivatives by central differences."""

    settings: ClassVar[dict[str, Any]] = {"gtol": 1e-12, "max_nfev": 200}

    def __init__(
        self, model: Model, unknowns: Unknowns, scales: Array | None = None, loss: Penalty | None = None
    ) -> None:
        self.model, self.unknowns, self.measured = model, unknowns, model.measured
        self.items, self.lower, self.upper, self.start = unknowns.items, unknowns.lower, unknowns.upper, unknowns.start
        self.searched = unknowns.searched
        self.loss, self.exact, self.size = loss or Penalty(), model.exact, model.measured.size
        # others only hold from one side, and determine nothing
        self.signals = {TORQUE: [np.flatnonzero(model.equations)]}
        self.step = STEP_EXACT if model.exact else STEP_RUN
        self.logs = [unknowns.items[place].is_log for place in unknowns.searched]
        self.scales = self._typical_sizes() if scales is None else scales
        self.stay = STAY * float(np.sqrt(np.sum(self.measured.torque**2))) / self.scales

    def noise(self, residuals: Array) -> Array:
        """From where on residuals count less, also those that give no equation."""
        return np.full(len(residuals), np.max(super().noise(residuals)))

    def residuals(self, u: Array) -> Array:
        """Fitted minus measured torque of every sample [N m]."""
        return self.model.torque(self.unknowns.law_at(u)) - self.measured.torque

    def jacobian(self, u: Array) -> Array:
        """Derivatives of the residuals by the codes, shape (samples, codes)."""
        return derivatives(self.residuals, u, self)

    def codes(self, u: Array) -> Array:
        """Codes of all parameters."""
        return self.unknowns.codes(u)

    def ends(self, u: Array) -> list[tuple[float, float]]:
        """Lowest and highest value of each parameter, where the others have these codes."""
        return self.unknowns.ends(u)

    def spread(self, u: Array) -> Array:
        """Derivatives of the codes of all parameters by those that are searched for."""
        columns = []
        for place in range(len(u)):
            move = np.zeros(len(u))
            move[place] = 1e-6 * max(1.0, abs(u[place]))
            columns.append((self.codes(u + move) - self.codes(u - move)) / (2.0 * move[place]))
        return np.array(columns).T

    def reach(self, u: Array, place: int, most: float) -> tuple[float, float]:
        """How far a parameter without effect can go until bounds at rest break, or samples notice it after all."""
        base, row = float(np.sum(self.residuals(u) ** 2)), self.searched[place]

        def moved(code: float) -> Array:
            return np.where(np.arange(len(u)) == place, code, u)

        def noticed(code: float) -> bool:
            return float(np.sum(self.residuals(moved(code)) ** 2)) - base > most

        made = list(self.ends(u)[row])
        for side, end in enumerate((self.lower[place], self.upper[place])):
            far = end if np.isfinite(end) else u[place] + 1e3 * self.scales[place] * (2 * side - 1)
            if noticed(far):
                near = u[place]
                for _ in range(40):
                    middle = 0.5 * (near + far)
                    near, far = (near, middle) if noticed(middle) else (middle, far)
                made[side] = float(self.values(moved(near))[row])
        return made[0], made[1]

    def _typical_sizes(self) -> Array:
        """Of a change of each code: 1 for logarithms, a typical size for numbers."""
        made = np.where(self.logs, 1.0, np.abs(self.start))
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


def derivatives(function: Callable[[Array], Array], u: Array, search: Residuals) -> Array:
    """Difference quotients by every code: central inside the bounds, one-sided at them."""
    lower, upper = search.unknowns.lower, search.unknowns.upper
    columns = []
    for place in range(len(u)):
        step = search.step * max(float(search.scales[place]), 0.0 if search.logs[place] else abs(float(u[place])))
        above, below = u.copy(), u.copy()
        above[place] = min(u[place] + step, upper[place])
        below[place] = max(u[place] - step, lower[place])
        columns.append((function(above) - function(below)) / (above[place] - below[place]))
    return np.array(columns).T
