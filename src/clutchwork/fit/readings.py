"""Other readings of the samples: units and columns that may be mistaken, named where they fit much better."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from math import pi

import numpy as np

from clutchwork.base.arrays import Array
from clutchwork.fit.estimates import Parameter
from clutchwork.fit.failure import FitError
from clutchwork.fit.measurement import Measurement, measurement
from clutchwork.fit.words import plain

# units in which slip may be by mistake, in rad/s
TURNS = {"1/min": pi / 30.0, "deg/s": pi / 180.0}
# what is left over with another reading, of what is left over now
FITS = 0.25
# r2 below which a reading fits no better than others
FAIR = 0.5
# how near a number must be to its start value times the factor of a unit, as a factor
NEAR = 1.5
# coefficients of friction, and far ends of what they are
COEFFICIENTS, USUAL = ("static", "kinetic", "slow", "fast"), (0.005, 5.0)
# what others may leave to be about as good as the best reading, of what that leaves
ALIKE = 1.5
# share of samples that may have another sign by noise
FEW = 0.02


def likely(samples: Measurement, left: float, fitted: Callable[[Measurement], float]) -> list[str]:
    """Readings of samples of a law that fit much better.

    Parameters: left, share of the variation that is left over; fitted, r2 with other samples.
    """
    found = list[tuple[float, str]]()
    for words, made in _others(samples):
        try:
            found.append((1.0 - fitted(made), words))
        except (FitError, ValueError):
            continue
    return named(found, left)


def named(found: Sequence[tuple[float, str]], left: float) -> list[str]:
    """The reading that leaves least, with others that are about as good; nothing where none fits much better.

    Parameters: found, what each reading leaves and its words; left, what is left over as it is read.
    """
    least = min((one for one, _ in found), default=np.inf)
    if not least < min(FITS * left, FAIR):
        return []
    good = sorted(one for one in found if one[0] <= ALIKE * least)
    return ["likely " + "; or ".join(f"{words}: with that r2 is {1.0 - one:.3g}" for one, words in good)]


def _others(samples: Measurement) -> Iterator[tuple[str, Measurement]]:
    """Samples with slip in another unit, without signs that were lost, or with two columns swapped."""
    for unit, scale in () if samples.translation else TURNS.items():
        yield f"the slip is in {unit} and was taken as rad/s", replace(samples, slip=samples.slip * scale)
    rows = {name: getattr(samples, name) for name in ("time", "slip", "torque")}
    for one, other in (("torque", "slip"), ("slip", "torque")):
        if _has_one_sign(rows[one]) and not _has_one_sign(rows[other]):
            signed = np.abs(rows[one]) * np.sign(rows[other])
            words = (
                f"the {one} is a magnitude, and the {other} has a sign: multiply the {one} by the sign of the {other}"
            )
            yield words, replace(samples, **{one: signed})
    for one, other in (("slip", "torque"), ("time", "slip"), ("time", "torque")):
        moved = rows | {one: rows[other], other: rows[one]}
        try:
            made = measurement(
                **moved, load=samples.load, temperature=samples.temperature, translation=samples.translation
            )
        except FitError:
            continue
        yield f"{one} and {other} are swapped", made


def _has_one_sign(row: Array) -> bool:
    """Whether hardly a value has another sign than the others."""
    share = float(np.mean(row > 0.0))
    return share < FEW or share > 1.0 - FEW


def of_units(parameters: Sequence[Parameter]) -> list[str]:
    """Whether all numbers with a unit of speed are off their start values by the factor of one unit."""
    powers = {"rad/s": 1.0, "s/rad": -1.0}
    ratios = [(p.value / p.start) ** powers[p.unit] for p in parameters if p.unit in powers and p.value and p.start]
    return [
        f"speeds are about {1.0 / scale:.3g} times their start values, as if the slip were in {unit}: "
        f"head its column with the unit, or multiply it by pi/{np.pi / scale:.0f}"
        for unit, scale in TURNS.items()
        if ratios and all(1.0 / NEAR < ratio * scale < NEAR for ratio in ratios)
    ]


def of_coefficients(parameters: Sequence[Parameter], *, translation: bool) -> list[str]:
    """Whether all coefficients of friction are far from usual ones, where they started among these."""
    found = [one for one in parameters if one.name.split("[")[0] in COEFFICIENTS]
    if not found or not all(USUAL[0] <= one.start <= USUAL[1] for one in found):
        return []
    most, unit, force = max(found, key=lambda one: one.value), *(("kN", "force") if translation else ("kN m", "torque"))
    said = f"{most.name} is {plain(most.value)}, and coefficients of friction are usually 0.02 to 1: likely the"
    if 0.0 < most.value < USUAL[0]:
        return [f"{said} {force} is in {unit}: multiply it by 1000"]
    return [f"{said} load is in {unit}: multiply it by 1000"] if most.value > USUAL[1] else []
