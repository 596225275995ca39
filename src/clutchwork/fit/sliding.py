"""What laws without states say of measured samples; those that stick give only bounds at rest."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from clutchwork.base.arrays import Array
from clutchwork.declare.core import core, number
from clutchwork.fit.failure import FitError
from clutchwork.model.pools import Pools

if TYPE_CHECKING:
    from clutchwork.declare.node import Law
    from clutchwork.fit.measurement import Measurement


# deviations of the noise within which two coefficients count as equal
DOUBT = 3.0
# share of the largest slip below which a sample counts as at rest, when none is given and no sign is wrong
REST = 1e-3
# slips of a wrong sign by noise: share of all that are not larger, share of the largest slip that none is above, share
# of a usual coefficient that shows its sign
WRONG, NEAR_REST, SHOWN = 0.1, 0.1, 0.25
# the noise reaches further than the largest of them
REACH = 1.25


def coefficients(law: Law, slips: Array, temperatures: Array | None = None) -> tuple[Array, Array]:
    """Kinetic and static coefficients of a law without states at slips [rad/s], by the compiled core.

    Slips of a law that sticks are >= 0. A law that depends on the temperature needs one [K] for each slip.
    """
    pools = Pools()
    pools.add(law, "law")
    place, compiled = number(type(law)), core().law
    params, points = np.array(pools.params, dtype=float), np.array(pools.points, dtype=float).reshape(-1, 3)
    rows = [[]] * len(slips) if temperatures is None else temperatures.reshape(-1, 1).tolist()
    places = zip(slips.tolist(), rows, strict=True)
    found = np.array([compiled(place, params, points, slip, inputs=row) for slip, row in places]).reshape(-1, 2)
    return found[:, 0], found[:, 1]


class Sliding:
    """Residuals of a law that sticks.

    A sample that slides gives an equation. One at rest gives a bound, `abs(torque) <= static load`, and a residual
    only where it breaks it. The last sample before a break-away gives an equation again: there the bound is reached.
    """

    exact = True

    def __init__(self, measured: Measurement, law: Law, rest: float | None) -> None:
        self.measured = measured
        # a law with a band of slip in which it sticks says no more there
        self.noisy = noisy(measured) if rest is None else np.zeros(0)
        noise = REACH * float(np.max(self.noisy, initial=0.0))
        self.rest = max(at_rest(measured, rest), noise, float(law.band))
        self.slides = np.abs(measured.slip) > self.rest
        if not np.any(self.slides):
            largest = float(np.max(np.abs(measured.slip)))
            fault = f"never exceeds {self.rest:g} rad/s, below which a sample counts as at rest"
            raise FitError("slip", fault, f"lower `rest`; the largest slip is {largest:g} rad/s")
        self.breaks = break_aways(measured, self.slides, noisy=len(self.noisy) > 0)

    @property
    def equations(self) -> NDArray[np.bool_]:
        """Samples that give an equation."""
        return np.asarray(self.slides | self.breaks)

    def torque(self, law: Law) -> Array:
        """Fitted torque of every sample [N m]; at rest the measured one, as far as the law can hold it."""
        measured = self.measured
        warm = measured.temperature
        kinetic, _ = coefficients(law, np.abs(measured.slip[self.slides]), None if warm is None else warm[self.slides])
        # without a temperature the static coefficient is one
        _, static = coefficients(law, np.zeros(1 if warm is None else len(warm)), warm)
        capacity = static * measured.load
        made = np.clip(measured.torque, -capacity, capacity)
        made[self.breaks] = np.sign(measured.torque[self.breaks]) * capacity[self.breaks]
        made[self.slides] = np.sign(measured.slip[self.slides]) * kinetic * measured.load[self.slides]
        return made


class Smooth:
    """Residuals of a law that neither sticks nor has states: its torque follows from the slip, at rest too."""

    exact = True

    def __init__(self, measured: Measurement, rest: float | None) -> None:
        self.measured, self.rest = measured, at_rest(measured, rest)

    @property
    def equations(self) -> NDArray[np.bool_]:
        """Samples that give an equation: all."""
        return np.ones(len(self.measured.time), dtype=bool)

    def torque(self, law: Law) -> Array:
        """Torque of every sample [N m]."""
        return coefficients(law, self.measured.slip, self.measured.temperature)[0] * self.measured.load


def at_rest(measured: Measurement, rest: float | None) -> float:
    """Slip below which a sample counts as at rest."""
    return REST * float(np.max(np.abs(measured.slip))) if rest is None else float(rest)


def noisy(measured: Measurement) -> Array:
    """Slips that are not at rest by the default and whose sign is wrong by noise: friction would drive.

    Near rest noise turns signs of many. One of a wrong sign among many right ones that are not larger is off otherwise.
    """
    slip, loaded = np.abs(measured.slip), measured.load > 0.0
    share = np.where(loaded, measured.torque * np.sign(measured.slip) / np.where(loaded, measured.load, 1.0), 0.0)
    wrong = share < -SHOWN * float(np.median(np.abs(share[loaded])))
    largest = float(np.max(slip))
    found = np.sort(slip[wrong & (slip > REST * largest) & (slip <= NEAR_REST * largest)])
    moving = np.sort(slip[(slip > 0.0) & (share != 0.0)])
    below = np.searchsorted(moving, found, side="right")
    known = np.flatnonzero(np.searchsorted(np.sort(slip[wrong]), found, side="right") >= WRONG * below)
    return found[: known[-1] + 1] if len(known) else found[:0]


def break_aways(measured: Measurement, slides: NDArray[np.bool_], *, noisy: bool = False) -> NDArray[np.bool_]:
    """The last samples at rest before it slides off under the torque.

    Their coefficient is, up to the noise, at least the one just after, else the peak fell between two samples and is
    not known. Where the slip is noisy the first samples that slide count as at rest: the peak is before them, and what
    slides slowly is at rest now and then without a zero of the slip.
    """
    found = np.zeros(len(slides), dtype=bool)
    doubt = DOUBT * noise(measured.torque)
    for first in np.flatnonzero(~slides[:-1] & slides[1:]) + 1:
        apart = np.flatnonzero(slides[:first] | (measured.load[:first] <= 0.0))
        rests = slice(int(apart[-1]) + 1 if len(apart) else 0, int(first))
        along = np.sign(measured.slip[first])
        if rests.start == rests.stop or measured.load[first] <= 0.0:
            continue
        if noisy and np.all(along * measured.slip[rests] > 0.0):
            continue
        share = along * measured.torque[rests] / measured.load[rests]
        after = along * measured.torque[first] / measured.load[first]
        place = int(np.argmax(share))
        place = place if share[place] - share[-1] > doubt / measured.load[first - 1] else len(share) - 1
        at = rests.start + place
        found[at] = share[place] > 0.0 and share[place] >= after - doubt / measured.load[at]
    return found


def noise(values: Array) -> float:
    """Standard deviation of noise on a smooth row, from the median of its second differences."""
    bends = np.abs(values[2:] - 2.0 * values[1:-1] + values[:-2])
    return float(np.median(bends) / (0.6745 * np.sqrt(6.0)))
