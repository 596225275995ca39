"""Values of the free numbers of a driveline with their intervals, and what the samples of all records leave open."""

from __future__ import annotations

from math import inf

import numpy as np
from numpy.typing import NDArray

from clutchwork.base.classes import dataclass
from clutchwork.fit import reasons
from clutchwork.fit.descent import Descent
from clutchwork.fit.failure import scipy
from clutchwork.fit.information import FLOOR, Information, information
from clutchwork.fit.intervals import FEWEST_NEIGHBOURS, alike, interval, widened
from clutchwork.fit.misfit import patterns
from clutchwork.fit.result import Parameter

Array = NDArray[np.float64]

SMALLEST = 1e-300


@dataclass(frozen=True)
class Identifiability:
    """What the samples say."""

    parameters: tuple[Parameter, ...]
    correlation: Array
    alike: dict[str, float]  # of neighbouring residuals by signal, those that are not chance
    doubts: list[str]  # why residuals are not noise


def known(descent: Descent, u: Array, confidence: float) -> Identifiability:
    """Intervals at a confidence, by the derivatives at a solution."""
    numbers, residuals, jacobian = descent.numbers, _felt(descent, descent.residuals(u)), descent.jacobian(u)
    scales = _scales(descent, jacobian)
    # runs have an error of their own
    found = information(jacobian * scales, _size(descent), False)
    freedom = max(len(residuals) - int(np.sum(~found.lost)), 1)
    rows = {name: (places, [residuals[own] for own in places]) for name, places in descent.rows.items()}
    correlated = {name: alike(parts) for name, (_, parts) in rows.items()}
    covariance = _covariance(found, jacobian * scales, np.diag(scales), _variances(rows, correlated, freedom))
    halves = float(scipy("stats").t.ppf(0.5 + 0.5 * confidence, freedom)) * np.sqrt(np.diag(covariance))
    spread, items, values = np.diag(scales), numbers.items, numbers.values(u).tolist()
    causes = reasons.causes(found, spread, items)
    sizes = np.where(found.silent, inf, scales * np.sqrt(len(jacobian)) / np.maximum(found.size, FLOOR))
    why, limits = [], []
    for place, (item, code, half) in enumerate(zip(items, u.tolist(), halves.tolist(), strict=True)):
        # the smallest number above zero is zero to a reader
        ends = 0.0 if 0.0 < item.lowest < SMALLEST else item.lowest, item.highest
        cause = causes[place] or reasons.at_end(item, values[place], ends)
        why.append(cause or reasons.wide(item, code, half, confidence, float(sizes[place])))
        limits.append(interval(item, code, half, ends) if half < 1e9 * max(scales[place], abs(code)) else ends)
    directions = reasons.directions(found, spread, items, why)
    made = tuple(
        Parameter(item.name, item.unit, value, *ends, item.start, reason, direction)
        for item, value, ends, reason, direction in zip(items, values, limits, why, directions, strict=True)
    )
    deviations = np.sqrt(np.diag(covariance))
    doubts = _doubts(descent, residuals)
    return Identifiability(
        made, covariance / np.outer(deviations, deviations), {k: v for k, v in correlated.items() if v}, doubts
    )


def _felt(descent: Descent, residuals: Array) -> Array:
    """Residuals as they count."""
    if descent.within is None:
        return residuals
    made = residuals.copy()
    for places in descent.rows.values():
        own = np.concatenate(places)
        made[own] = descent.loss.felt(residuals[own], descent.within[own])
    return made


def _doubts(descent: Descent, residuals: Array) -> list[str]:
    """Patterns over time that are left in a signal, against its variation in all records."""
    made, values = list[str](), np.concatenate(descent.measured) / np.concatenate(descent.weights)
    for name, places in descent.rows.items():
        size = float(np.std(values[np.concatenate(places)]))
        rows = {f"time of {name}{of}": residuals[own] for of, own in zip(_labels(descent, name), places, strict=True)}
        made += patterns(rows, size)
    return made


def _labels(descent: Descent, signal: str) -> list[str]:
    """Names of the records of a signal, for messages."""
    several = len(descent.records) > 1
    return [
        f" ({record.label})" if several else ""
        for record in descent.records
        for one in record.traces
        if one.signal == signal
    ]


def _size(descent: Descent) -> float:
    """Root mean square of all samples over their weights."""
    rows = [m / w for m, w in zip(descent.measured, descent.weights, strict=True)]
    return float(np.sqrt(np.mean(np.concatenate(rows) ** 2))) or 1.0


def _scales(descent: Descent, jacobian: Array) -> Array:
    """What changes of codes are measured in: of one that starts at zero what changes the samples by their size."""
    effects = np.sqrt(np.mean(jacobian**2, axis=0))
    zero = np.array([not item.is_log and item.start == 0.0 for item in descent.numbers.items])
    return np.where(zero & (effects > 0.0), _size(descent) / np.maximum(effects, 1e-300), descent.numbers.scales)


def _variances(
    rows: dict[str, tuple[list[NDArray[np.intp]], list[Array]]], correlated: dict[str, float], freedom: int
) -> Array:
    """Variance of the noise of each sample: that of its signal, wider where neighbours are alike."""
    count = sum(len(place) for places, _ in rows.values() for place in places)
    whole = sum(float(row @ row) for _, parts in rows.values() for row in parts) / freedom
    made = np.zeros(count)
    for name, (places, parts) in rows.items():
        own = sum(len(row) for row in parts)
        variance = sum(float(row @ row) for row in parts) / own * count / freedom
        made[np.concatenate(places)] = (variance if own >= FEWEST_NEIGHBOURS else whole) * widened(correlated[name])
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
