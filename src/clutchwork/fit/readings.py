"""Other readings of the samples: units and columns that may be mistaken, named where they fit much better."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from math import pi

import numpy as np

from clutchwork.fit.estimates import Parameter
from clutchwork.fit.failure import FitError
from clutchwork.fit.measurement import Measurement, measurement

RPM = pi / 30.0
# what is left over with another reading, of what is left over now
FITS = 0.25
# r2 below which a reading fits no better than others
FAIR = 0.5
# how near a number must be to its start value times the factor of a unit, as a factor
NEAR = 1.5
TURNS = "as if the slip were in 1/min: head its column with the unit, or multiply it by pi/30"


def likely(samples: Measurement, left: float, fitted: Callable[[Measurement], float]) -> list[str]:
    """Readings of samples of a law that fit much better.

    Parameters: left, share of the variation that is left over; fitted, r2 with other samples.
    """
    found = list[tuple[float, str]]()
    for told, made in _others(samples):
        try:
            found.append((1.0 - fitted(made), told))
        except (FitError, ValueError):
            continue
    best = min(found, default=(np.inf, ""))
    return [f"likely {best[1]}: with that r2 is {1.0 - best[0]:.3g}"] if best[0] < min(FITS * left, FAIR) else []


def _others(samples: Measurement) -> Iterator[tuple[str, Measurement]]:
    """Samples with slip in 1/min, or with two columns swapped."""
    if not samples.translation:
        yield "the slip is in 1/min and was taken as rad/s", replace(samples, slip=samples.slip * RPM)
    rows = {name: getattr(samples, name) for name in ("time", "slip", "torque")}
    for one, other in (("slip", "torque"), ("time", "slip"), ("time", "torque")):
        moved = rows | {one: rows[other], other: rows[one]}
        try:
            made = measurement(
                **moved, load=samples.load, temperature=samples.temperature, translation=samples.translation
            )
        except FitError:
            continue
        yield f"{one} and {other} are swapped", made


def of_units(parameters: Sequence[Parameter]) -> list[str]:
    """Whether all numbers with a unit of speed are off their start values by the factor of 1/min."""
    powers = {"rad/s": 1.0, "s/rad": -1.0}
    ratios = [(p.value / p.start) ** powers[p.unit] for p in parameters if p.unit in powers and p.value and p.start]
    if not ratios or not all(1.0 / NEAR < ratio * RPM < NEAR for ratio in ratios):
        return []
    return [f"speeds are about 9.55 times their start values, {TURNS}"]
