"""Sizes of quantities, by which importers scale their tolerances: those of a run of the model as it stands."""

from __future__ import annotations

import warnings
from math import floor, log10

import numpy as np
from numpy.typing import NDArray

from clutchwork.assembly.system import System
from clutchwork.declare.options import Options
from clutchwork.run.simulation import simulate

# where nothing else is known
OF_UNITS = {"Pa": 1e5, "K": 100.0}
SPEEDS = ("rad/s", "m/s")
# a size is no smaller than this share of what its unit says: speeds, and others, which bristles make small
LEAST, LEAST_OF_OTHERS = 1e-3, 1e-6
# instants of a run at which it is looked at, and steps that it may take
POINTS, MOST_STEPS = 1000, 100_000


def nominal(system: System, unit: str) -> float:
    """Size of a quantity where no run is known: that of the speeds where a run begins, else the one of its unit."""
    if unit in SPEEDS:
        return max(1.0, *(abs(float(speed)) for speed in system.initial_speed))
    return OF_UNITS.get(unit, 1.0)


def largest(system: System, options: Options, t_end: float) -> NDArray[np.float64] | None:
    """Largest amounts of all numbers of a row over the run of a model, as far as it goes; None: there is no run.

    Functions of Python are not called for that.
    """
    if any(item.signal.sampling() for item in system.inputs):
        return None
    times = np.linspace(options.t_start, t_end, POINTS)
    with warnings.catch_warnings():
        # a run that stops has sizes too, and what it says of itself is said where it is asked for
        warnings.simplefilter("ignore")
        how = {"times": times, "dt": None, "max_steps": min(options.max_steps, MOST_STEPS), "method": "auto"}
        run = simulate(system, t_end, options=options.changed(how))
    return np.max(np.abs(run.rows), axis=0, initial=0.0) if len(run.rows) else None


def size_of(amount: float, usual: float, unit: str) -> float:
    """The size of a number from its largest amount: the power of ten below it, at most what is usual for its unit."""
    least = usual * (LEAST if unit in SPEEDS else LEAST_OF_OTHERS)
    return min(usual, 10.0 ** floor(log10(max(amount, least)))) if amount > 0.0 else usual
