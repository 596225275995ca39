"""Which further experiment would determine a parameter that the samples leave open."""

from __future__ import annotations

from collections.abc import Iterator
from math import pi
from typing import TYPE_CHECKING

import numpy as np

from clutchwork.base import dataclass
from clutchwork.base.arrays import Array
from clutchwork.fit.information import Information, information
from clutchwork.fit.measurement import Measurement
from clutchwork.fit.model import model_of
from clutchwork.fit.ordinates import axis, is_outside
from clutchwork.fit.search import Residuals, derivatives
from clutchwork.fit.sliding import coefficients
from clutchwork.fit.words import plain

if TYPE_CHECKING:
    from clutchwork.fit.unknowns import Unknowns


SAMPLES = 60
# an experiment that leaves more than this relative uncertainty determines nothing
ENOUGH = 0.2
# K, within which samples count as measured at a temperature
NEAR = 10.0


@dataclass(frozen=True)
class ProposedExperiment:
    """One that could be done: in words, and what it would measure."""

    words: str
    jacobian: Array


def advice(search: Residuals, u: Array, deviation: float, places: list[int]) -> dict[int, str]:
    """For each open parameter the experiment after which it would be known best.

    Every candidate is computed with the fitted law, what is open as at the start, with the load and the noise of the
    samples, and added to them.
    """
    unknowns = search.unknowns
    again = sorted({_column(unknowns, place) for place in places})
    u = np.where(np.isin(np.arange(len(u)), again), unknowns.start, u)
    if len(again) < len(u):
        u = search.solve(u, held=again).u
    noise = max(deviation, 1e-3 * search.measured.size)
    counts = search.model.equations
    before = search.jacobian(u)[counts]
    candidates = list(_candidates(search, u))
    size, exact = search.measured.size, search.model.exact
    after = [information(np.vstack([before, c.jacobian]), size, exact) for c in candidates]
    spread, made = search.spread(u), {}
    for place in places:
        column = _column(unknowns, place)
        left = [_left(known, spread[place]) * noise for known in after]
        scale = 1.0 if unknowns.items[place].is_log else abs(unknowns.codes(u)[place]) or search.scales[column]
        best = min(left, default=np.inf)
        # the first that is nearly as good is the simplest
        chosen = next((c for c, value in zip(candidates, left, strict=True) if value <= 1.25 * best), None)
        if chosen is None or best > ENOUGH * float(scale):
            made[place] = "hold it at a known value: no experiment that was tried would determine it"
        else:
            made[place] = f"to determine it, {chosen.words}"
    return made


def _column(unknowns: Unknowns, place: int) -> int:
    """Place of a parameter among those searched for; one that closes a sum: its neighbour."""
    return unknowns.searched.index(place) if place in unknowns.searched else unknowns.searched.index(place - 1)


def _left(known: Information, change: Array) -> float:
    """Uncertainty of one parameter per deviation of the samples; change, its derivatives by what is searched for."""
    scaled = change / known.size
    if np.any(np.abs(known.directions[known.lost] @ scaled) > 1e-3 * np.linalg.norm(scaled)):
        return float(np.inf)
    return float(np.sqrt(known.covariance(change[np.newaxis])[0, 0]))


def _candidates(search: Residuals, u: Array) -> Iterator[ProposedExperiment]:
    for temperature in _temperatures(search):
        yield from _steady(search, u, temperature)
        if search.unknowns.law.sticks:
            yield _break_away(search, u, temperature)
    if search.unknowns.law.own_states():
        yield from _swings(search, u)


def _units(search: Residuals) -> tuple[str, str]:
    return ("m/s", "m") if search.measured.translation else ("rad/s", "rad")


def _load(search: Residuals) -> float:
    load = search.measured.load
    return float(np.median(load[load > 0.0]))


def _temperatures(search: Residuals) -> list[float | None]:
    """Where to measure [K]: at that of the samples, then at those of the tables; None where the law knows none."""
    measured = search.measured.temperature
    if measured is None:
        return [None]
    middle = float(np.median(measured))
    return [middle, *(value for value in axis(search.unknowns.law, "K") if abs(value - middle) > NEAR)]


def _at(temperature: float | None) -> str:
    return "" if temperature is None else f" at {temperature:.4g} K"


def _steady(search: Residuals, u: Array, temperature: float | None) -> Iterator[ProposedExperiment]:
    """Steady slip, from a thousandth of the smallest measured one to a hundred times the largest, near ones first."""
    slip = np.abs(search.measured.slip)
    moving = slip[slip > search.model.rest]
    # a law with a band of slip in which it sticks says nothing there
    band = float(search.unknowns.law_at(u).band)
    low, high = max(float(np.min(moving)) * 1e-3, 2.0 * band), max(float(np.max(moving)), 2.0 * band)
    warm = search.measured.temperature
    there = np.ones(len(slip), dtype=bool)
    if warm is not None and temperature is not None:
        there = np.abs(warm - temperature) < NEAR
    middle = np.log(np.median(moving))
    for centre in sorted(np.geomspace(low, 100.0 * high, 31), key=lambda slip: abs(np.log(slip) - middle)):
        sweep = np.geomspace(centre / 1.5, centre * 1.5, SAMPLES)
        if is_outside(search.unknowns.law, "rad/s", sweep):
            continue
        near = int(np.sum((slip > centre / 2.0) & (slip < centre * 2.0) & there))
        seen = f"{near or 'no'} sample{'' if near == 1 else 's'} within a factor 2"
        seen += " of that" if warm is None else f" and {NEAR:g} K of that"
        words = f"measure steady slip near {plain(centre)} {_units(search)[0]}{_at(temperature)} ({seen})"
        yield _planned(search, u, words, np.linspace(0.0, 1.0, SAMPLES), sweep, temperature)


def _swings(search: Residuals, u: Array) -> Iterator[ProposedExperiment]:
    """Displacements back and forth, slow ones first."""
    for frequency in (0.1, 1.0, 10.0, 100.0):
        time = np.linspace(0.0, 2.0 / frequency, SAMPLES)
        for amplitude in np.geomspace(1e-7, 1.0, 8):
            words = f"move back and forth by {amplitude:.1g} {_units(search)[1]} at {frequency:g} Hz"
            speed = 2.0 * pi * frequency
            yield _planned(search, u, words, time, amplitude * speed * np.sin(speed * time))


def _planned(
    search: Residuals, u: Array, words: str, time: Array, slip: Array, temperature: float | None = None
) -> ProposedExperiment:
    """What the fitted law would show there."""
    full = np.full(SAMPLES, _load(search))
    warm = None if temperature is None else np.full(SAMPLES, temperature)
    plan = Measurement(time, slip, np.zeros(SAMPLES), full, search.measured.translation, False, warm)
    law = search.unknowns.law_at(u)
    # steps are those of the samples: a plan has no torque to judge them by
    return ProposedExperiment(words, Residuals(model_of(plan, law, 0.0), search.unknowns, search.scales).jacobian(u))


def _break_away(search: Residuals, u: Array, temperature: float | None) -> ProposedExperiment:
    """Static coefficients of a few torque ramps from rest."""
    load, repeats = _load(search), 10
    slips, warm = np.zeros(1), None if temperature is None else np.array([temperature])

    def torques(at: Array) -> Array:
        return np.full(repeats, load * coefficients(search.unknowns.law_at(at), slips, warm)[1][0])

    words = f"raise the torque slowly from rest{_at(temperature)} until it slides, ten times"
    words += ", sampled finely at break-away"
    return ProposedExperiment(words, derivatives(torques, u, search))
