"""How well the samples determine the parameters: covariance, intervals, and what stays open."""

from __future__ import annotations

from collections.abc import Sequence
from math import exp, log, sqrt
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from clutchwork.base.classes import dataclass
from clutchwork.fit import reasons
from clutchwork.fit.failure import scipy
from clutchwork.fit.information import information

if TYPE_CHECKING:
    from clutchwork.fit.search import Residuals
    from clutchwork.fit.unknown import Unknown

Array = NDArray[np.float64]

FEWEST_NEIGHBOURS = 10


@dataclass(frozen=True)
class Estimate:
    """What the samples say of all parameters, in the order of the unknowns."""

    deviation: float  # of the residuals [N m], widened where neighbours are alike
    tolerance: float  # N2 m2, by which squares may sum up to more in a solution that is as good
    covariance: Array  # of the codes of all parameters
    limits: list[tuple[float, float]]  # ends of the intervals
    reasons: list[str]  # why a parameter is not determined; "" where it is
    directions: list[str]  # relative changes that the samples cannot tell from no change
    alike: float  # correlation of neighbouring residuals
    felt: Array  # residuals of the equations as they count [N m]


def estimate(search: Residuals, u: Array, confidence: float) -> Estimate:
    """Intervals of all parameters at a confidence, and what is not determined."""
    # a bound that samples at rest lean on holds from one side only: it determines nothing
    equations = search.model.equations
    residuals = search.residuals(u)[equations]
    if not search.loss.is_linear:
        residuals = search.loss.felt(residuals, search.within)
    known = information(search.jacobian(u)[equations], search.measured.size, search.model.exact)
    freedom = max(len(residuals) - int(np.sum(~known.lost)), 1)
    correlated = alike([residuals])
    variance = float(np.sum(residuals**2)) / freedom * widened(correlated)
    spread = spread_of(search, u)
    covariance = variance * known.covariance(spread)
    t = float(scipy("stats").t.ppf(0.5 + 0.5 * confidence, freedom))
    items, ends = search.unknowns.items, search.unknowns.ends(u)
    codes, halves = search.unknowns.codes(u).tolist(), (t * np.sqrt(np.diag(covariance))).tolist()
    rows = list(zip(items, codes, halves, ends, strict=True))
    limits = [interval(*row) for row in rows]
    for place in np.flatnonzero(known.silent):
        limits[search.unknowns.searched[place]] = _reach(search, u, int(place), t**2 * variance)
    why = [
        cause or reasons.at_end(item, item.decoded(code), end) or reasons.wide(item, code, half, confidence)
        for cause, (item, code, half, end) in zip(reasons.causes(known, spread, items), rows, strict=True)
    ]
    directions = reasons.directions(known, spread, items, why)
    return Estimate(sqrt(variance), t**2 * variance, covariance, limits, why, directions, correlated, residuals)


def limits_at(search: Residuals, u: Array, tolerance: float, places: Array) -> list[tuple[float, float]]:
    """Intervals at some codes when only those at some places are unknown."""
    jacobian = search.jacobian(u)[search.model.equations]
    known = information(jacobian[:, places], search.measured.size, search.model.exact)
    spread = spread_of(search, u)[:, places]
    halves = np.sqrt(tolerance * np.diag(known.covariance(spread))).tolist()
    rows = zip(search.unknowns.items, search.unknowns.codes(u).tolist(), halves, search.unknowns.ends(u), strict=True)
    return [interval(*row) for row in rows]


def alike(rows: Sequence[Array]) -> float:
    """Correlation of neighbouring residuals, 0 where it may be chance; neighbours that are alike count less.

    Parameters: rows, residuals in order of time, those of each signal and record on their own.
    """
    count, size = sum(len(row) for row in rows), sum(float(row @ row) for row in rows)
    if count < FEWEST_NEIGHBOURS or not size:
        return 0.0
    found = sum(float(row[1:] @ row[:-1]) for row in rows) / size
    return min(found, 0.99) if found > 2.0 / sqrt(count) else 0.0


def widened(correlated: float) -> float:
    """Factor on a variance where neighbouring residuals are correlated."""
    return (1.0 + correlated) / (1.0 - correlated)


def spread_of(search: Residuals, u: Array) -> Array:
    """Derivatives of the codes of all parameters by those that are searched for."""
    unknowns, step = search.unknowns, 1e-6
    columns = []
    for place in range(len(u)):
        move = np.zeros(len(u))
        move[place] = step * max(1.0, abs(u[place]))
        columns.append((unknowns.codes(u + move) - unknowns.codes(u - move)) / (2.0 * move[place]))
    return np.array(columns).T


def interval(item: Unknown, code: float, half: float, ends: tuple[float, float]) -> tuple[float, float]:
    """Interval of the value, within its bounds."""
    lower, upper = ends
    if not item.is_log:
        return max(code - half, lower), min(code + half, upper)
    if half > log(1e9):
        return lower, upper
    return max(exp(code - half), lower), min(exp(code + half), upper)


def _reach(search: Residuals, u: Array, place: int, most: float) -> tuple[float, float]:
    """How far a parameter without effect can go until bounds at rest break, or samples notice it after all."""
    base, row = float(np.sum(search.residuals(u) ** 2)), search.unknowns.searched[place]

    def moved(code: float) -> Array:
        return np.where(np.arange(len(u)) == place, code, u)

    def noticed(code: float) -> bool:
        return float(np.sum(search.residuals(moved(code)) ** 2)) - base > most

    made = list(search.unknowns.ends(u)[row])
    for side, end in enumerate((search.unknowns.lower[place], search.unknowns.upper[place])):
        far = end if np.isfinite(end) else u[place] + 1e3 * search.scales[place] * (2 * side - 1)
        if noticed(far):
            near = u[place]
            for _ in range(40):
                middle = 0.5 * (near + far)
                near, far = (near, middle) if noticed(middle) else (middle, far)
            made[side] = search.unknowns.values(moved(near))[row]
    return made[0], made[1]
