"""How well the samples determine free numbers: covariance, intervals, and what stays open."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import chain
from math import exp, inf, log, sqrt
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np

from clutchwork.base import dataclass
from clutchwork.base.arrays import Array
from clutchwork.fit import reasons
from clutchwork.fit.estimates import Parameter
from clutchwork.fit.failure import scipy
from clutchwork.fit.information import FLOOR, Information, information

if TYPE_CHECKING:
    from clutchwork.fit.engine import LeastSquares, Signals
    from clutchwork.fit.search import Residuals
    from clutchwork.fit.unknown import Unknown


FEWEST_NEIGHBOURS = 10
# half widths that are so many times what a code is measured in say nothing
BOUNDLESS = 1e9


@dataclass(frozen=True)
class Estimate:
    """What the samples say of all free numbers, in their order."""

    deviation: float  # of the residuals, widened where neighbours are alike
    tolerance: float  # by which squares may sum up to more in a solution that is as good
    covariance: Array  # of the codes
    limits: list[tuple[float, float]]  # ends of the intervals
    reasons: list[str]  # why a number is not determined; "" where it is
    directions: list[str]  # relative changes that the samples cannot tell from no change
    alike: dict[str, float]  # correlation of neighbouring residuals by signal
    felt: Array  # residuals as they count

    @property
    def correlation(self) -> Array:
        """Of the codes."""
        deviations = np.sqrt(np.diag(self.covariance))
        deviations = np.where(deviations > 0.0, deviations, 1.0)
        return np.asarray(self.covariance / np.outer(deviations, deviations))

    def parameters(
        self, search: LeastSquares, u: Array, ideas: Mapping[int, str] = MappingProxyType({})
    ) -> tuple[Parameter, ...]:
        """The numbers with their intervals; ideas, what would determine those that are open."""
        rows = zip(search.items, search.values(u).tolist(), self.limits, self.reasons, self.directions, strict=True)
        return tuple(
            Parameter(item.name, item.unit, value, *ends, item.start, reason, direction, ideas.get(place, ""))
            for place, (item, value, ends, reason, direction) in enumerate(rows)
        )


def estimate(search: LeastSquares, u: Array, confidence: float) -> Estimate:
    """Intervals of all free numbers at a confidence, and what is not determined."""
    felt, jacobian = search.felt(u), search.jacobian(u)
    sizes, equations = search.sizes(jacobian), np.sort(np.concatenate(list(chain(*search.signals.values()))))
    jacobian, spread = jacobian[equations] * sizes, search.spread(u) * sizes
    known = information(jacobian, search.size, search.exact)
    freedom = max(len(equations) - int(np.sum(~known.lost)), 1)
    correlated = {name: alike([felt[own] for own in places]) for name, places in search.signals.items()}
    variances = _variances(felt, search.signals, correlated, freedom)[equations]
    covariance = _covariance(known, jacobian, spread, variances)
    variance = float(np.mean(variances))
    t = float(scipy("stats").t.ppf(0.5 + 0.5 * confidence, freedom))
    halves, codes, widths = t * np.sqrt(np.diag(covariance)), search.codes(u), np.max(np.abs(spread), axis=1)
    rows = list(zip(search.items, codes.tolist(), halves.tolist(), search.ends(u), strict=True))
    boundless = halves >= BOUNDLESS * np.maximum(widths, np.abs(codes))
    limits = [row[3] if far else interval(*row) for row, far in zip(rows, boundless.tolist(), strict=True)]
    for place in np.flatnonzero(known.silent):
        limits[search.searched[int(place)]] = search.reach(u, int(place), t**2 * variance)
    # what changes the samples by their size
    least = np.where(known.silent, inf, sizes * np.sqrt(len(equations)) / np.maximum(known.size, FLOOR))
    why = [
        cause or reasons.at_end(item, item.decoded(code), end) or reasons.wide(item, code, half, confidence, size)
        for cause, (item, code, half, end), size in zip(
            reasons.causes(known, spread, search.items), rows,
            least.tolist() if search.zeros else [0.0] * len(rows), strict=True,
        )
    ]  # fmt: skip
    directions = reasons.directions(known, spread, search.items, codes, why)
    return Estimate(sqrt(variance), t**2 * variance, covariance, limits, why, directions, correlated, felt[equations])


def _variances(felt: Array, signals: Signals, correlated: Mapping[str, float], freedom: int) -> Array:
    """Variance of the noise of each sample: that of its signal, wider where neighbours are alike."""
    made, together = np.zeros(len(felt)), {name: np.concatenate(places) for name, places in signals.items()}
    count = sum(map(len, together.values()))
    whole = sum(float(felt[own] @ felt[own]) for own in together.values()) / freedom
    for name, own in together.items():
        variance = float(felt[own] @ felt[own]) / len(own) * count / freedom
        made[own] = (variance if len(own) >= FEWEST_NEIGHBOURS else whole) * widened(correlated[name])
    return made


def _covariance(found: Information, jacobian: Array, spread: Array, variances: Array) -> Array:
    """Covariance of the codes where signals have noise of their own: docs/guide/fit.md."""
    singular = np.maximum(found.singular, FLOOR)
    left = (jacobian / found.size) @ found.directions.T / singular
    left[:, found.lost] = 0.0
    inner = left.T @ (left * variances[:, None])
    inner[np.diag_indices(len(inner))] += np.where(found.lost, float(np.mean(variances)), 0.0)
    root = (spread / found.size) @ found.directions.T / singular
    return np.asarray(root @ inner @ root.T)


def limits_at(search: Residuals, u: Array, tolerance: float, places: Array) -> list[tuple[float, float]]:
    """Intervals at some codes when only those at some places are unknown."""
    jacobian = search.jacobian(u)[search.model.equations]
    known = information(jacobian[:, places], search.measured.size, search.model.exact)
    spread = search.spread(u)[:, places]
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


def interval(item: Unknown, code: float, half: float, ends: tuple[float, float]) -> tuple[float, float]:
    """Interval of the value, within its bounds."""
    lower, upper = ends
    if not item.is_log:
        return max(code - half, lower), min(code + half, upper)
    if half > log(1e9):
        return lower, upper
    return max(exp(code - half), lower), min(exp(code + half), upper)
