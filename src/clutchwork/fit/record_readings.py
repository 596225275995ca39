"""Other readings of measured records: units and columns that may be mistaken, as the run at the start values shows."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

import numpy as np

from clutchwork.base.arrays import Array
from clutchwork.fit.descent import Descent
from clutchwork.fit.readings import FITS, RPM


def readings(descent: Descent) -> list[str]:
    """Readings with which the run at the start values is much closer to the samples."""
    runs = _runs(descent)
    return [told for told, ratio in (*_turns(descent, runs), *_swapped(descent, runs)) if ratio < FITS]


def _runs(descent: Descent) -> list[Array]:
    """Every trace as the run at the start values has it."""
    residuals, first, made = descent.residuals(np.clip(descent.numbers.codes(), descent.lower, descent.upper)), 0, []
    weights = np.concatenate(descent.weights)
    for one in descent.traces:
        part = slice(first, first + len(one.times))
        made.append(one.values + residuals[part] * weights[part])
        first = part.stop
    return made


def _turns(descent: Descent, runs: list[Array]) -> Iterator[tuple[str, float]]:
    """Speeds that are in 1/min, or were converted twice, and what is left then."""
    for name in descent.signals:
        pairs = [(one, run) for one, run in zip(descent.traces, runs, strict=True) if one.signal == name]
        if pairs[0][0].unit != "rad/s":
            continue
        now = sum(_off(run, one.values) for one, run in pairs) or 1.0
        told = f"likely {name} is in 1/min and was taken as rad/s: give units={{{name!r}: '1/min'}}"
        yield told, sum(_off(run, RPM * one.values) for one, run in pairs) / now
        told = f"likely {name} is in rad/s and was taken as 1/min"
        yield told, sum(_off(run, one.values / RPM) for one, run in pairs) / now


def _swapped(descent: Descent, runs: list[Array]) -> Iterator[tuple[str, float]]:
    """Signals of a record that are each other, and what is left then."""
    pairs, first = list(zip(descent.traces, runs, strict=True)), 0
    for record in descent.records:
        own = pairs[first : first + len(record.traces)]
        first += len(own)
        of = f" of {record.label}" if len(descent.records) > 1 else ""
        for (one, run), (other, beside) in combinations(own, 2):
            if np.array_equal(one.times, other.times):
                now = _off(run, one.values) + _off(beside, other.values)
                left = _off(run, other.values) + _off(beside, one.values)
                yield f"likely {one.signal} and {other.signal}{of} are swapped", left / (now or 1.0)


def _off(run: Array, values: Array) -> float:
    """Squares of what is left, over those of the run."""
    return float(np.sum((run - values) ** 2)) / (float(np.sum(run**2)) or 1.0)
