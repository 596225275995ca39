"""Which further experiment would determine a parameter that the samples leave open."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import pi
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from clutchwork.fit.information import information
from clutchwork.fit.measurement import Measurement
from clutchwork.fit.model import model_of
from clutchwork.fit.search import Search, derivatives
from clutchwork.fit.sliding import coefficients

if TYPE_CHECKING:
    from clutchwork.fit.unknowns import Unknowns

Array = NDArray[np.float64]

SAMPLES = 60
# an experiment that leaves more than this relative uncertainty determines nothing
ENOUGH = 0.2


@dataclass(frozen=True)
class Experiment:
    """One that could be done: in words, and what it would measure."""

    words: str
    jacobian: Array


def advice(search: Search, u: Array, deviation: float, places: list[int]) -> dict[int, str]:
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
    made = {}
    for place in places:
        column = _column(unknowns, place)
        left = [_left(np.vstack([before, c.jacobian]), search, column) * noise for c in candidates]
        size = 1.0 if unknowns.items[place].is_log else abs(unknowns.codes(u)[place]) or search.scales[column]
        best = min(left, default=np.inf)
        # the first that is nearly as good is the simplest
        chosen = next((c for c, value in zip(candidates, left, strict=True) if value <= 1.25 * best), None)
        if chosen is None or best > ENOUGH * float(size):
            made[place] = "hold it at a known value: no experiment that was tried would determine it"
        else:
            made[place] = f"to determine it, {chosen.words}"
    return made


def _column(unknowns: Unknowns, place: int) -> int:
    """Place of a parameter among those searched for; one that closes a sum: its neighbour."""
    return unknowns.searched.index(place) if place in unknowns.searched else unknowns.searched.index(place - 1)


def _left(jacobian: Array, search: Search, column: int) -> float:
    """Uncertainty of one code per deviation of the samples."""
    known = information(jacobian, search.measured.size, search.model.exact)
    if known.silent[column] or np.any(np.abs(known.directions[known.lost, column]) > 1e-3):
        return float(np.inf)
    return float(np.sqrt(known.inverse[column, column]))


def _candidates(search: Search, u: Array) -> Iterator[Experiment]:
    yield from _steady(search, u)
    if search.unknowns.law.sticks:
        yield _break_away(search, u)
    if search.unknowns.law.own_states():
        yield from _swings(search, u)


def _units(search: Search) -> tuple[str, str]:
    return ("m/s", "m") if search.measured.translation else ("rad/s", "rad")


def _load(search: Search) -> float:
    load = search.measured.load
    return float(np.median(load[load > 0.0]))


def _steady(search: Search, u: Array) -> Iterator[Experiment]:
    """Steady slip, from a thousandth of the smallest measured one to a hundred times the largest."""
    slip = np.abs(search.measured.slip)
    moving = slip[slip > search.model.rest]
    # a law with a band of slip in which it sticks says nothing there
    band = float(getattr(search.unknowns.law_at(u), "band", 0.0))
    low, high = max(float(np.min(moving)) * 1e-3, 2.0 * band), max(float(np.max(moving)), 2.0 * band)
    for centre in np.geomspace(low, 100.0 * high, 31):
        near = int(np.sum((slip > centre / 2.0) & (slip < centre * 2.0)))
        seen = f"{near or 'no'} sample{'' if near == 1 else 's'} within a factor 2 of that"
        words = f"measure steady slip near {centre:.2g} {_units(search)[0]} ({seen})"
        sweep = np.geomspace(centre / 1.5, centre * 1.5, SAMPLES)
        yield _planned(search, u, words, np.linspace(0.0, 1.0, SAMPLES), sweep)


def _swings(search: Search, u: Array) -> Iterator[Experiment]:
    """Displacements back and forth, slow ones first."""
    for frequency in (0.1, 1.0, 10.0, 100.0):
        time = np.linspace(0.0, 2.0 / frequency, SAMPLES)
        for amplitude in np.geomspace(1e-7, 1.0, 8):
            words = f"move back and forth by {amplitude:.1g} {_units(search)[1]} at {frequency:g} Hz"
            speed = 2.0 * pi * frequency
            yield _planned(search, u, words, time, amplitude * speed * np.sin(speed * time))


def _planned(search: Search, u: Array, words: str, time: Array, slip: Array) -> Experiment:
    """What the fitted law would show there."""
    full = np.full(SAMPLES, _load(search))
    plan = Measurement(time, slip, np.zeros(SAMPLES), full, search.measured.translation, turned=False)
    law = search.unknowns.law_at(u)
    # steps are those of the samples: a plan has no torque to judge them by
    return Experiment(words, Search(model_of(plan, law, 0.0), search.unknowns, search.scales).jacobian(u))


def _break_away(search: Search, u: Array) -> Experiment:
    """Static coefficients of a few torque ramps from rest."""
    load, repeats = _load(search), 10
    slips = np.zeros(1)

    def torques(at: Array) -> Array:
        return np.full(repeats, load * coefficients(search.unknowns.law_at(at), slips)[1])

    words = "raise the torque slowly from rest until it slides, ten times, sampled finely at break-away"
    return Experiment(words, derivatives(torques, u, search))
