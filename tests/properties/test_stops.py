"""Random drivelines with rigid play, end stops and clutches: nothing penetrates, pulls or makes energy."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from support import random_stops
from support.amount import seeds


@pytest.mark.parametrize("seed", seeds())
def test_random_stops(seed: int) -> None:
    d, found = _with_stops(seed)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", cw.ModelWarning)
        run = d.simulate(random_stops.T_END, rtol=1e-9, atol=1e-11)
    assert run.status == "done", run.message
    torques = [run[name] for name in run.names if name.endswith(".torque")]
    largest = max(float(np.max(np.abs(torque))) for torque in torques)
    for stop in found:
        _keeps(run, stop, largest)
    # what swings back and forth counts too
    kinetic = max(e.energy_before for e in run.events) if len(run.events) else 0.0
    assert abs(run.energy.residual) <= 1e-8 * (run.energy.turnover + kinetic)
    for event in run.events:
        if event.cause in ("impact", "impulse"):
            assert event.energy_after <= event.energy_before * (1 + 1e-12) + 1e-14


def _with_stops(seed: int) -> tuple[cw.Driveline, list[Any]]:
    """The driveline of a seed, or of one farther on where it has no stop."""
    while True:
        d = random_stops.driveline(seed)
        found = random_stops.stops(d)
        if found:
            return d, found
        seed += 100_000


def _keeps(run: Any, stop: Any, largest: float) -> None:
    """One stop stays inside its ends, pushes at them, and does nothing between them."""
    lower, upper = random_stops.limits(stop)
    position, torque = run[f"{stop.name}.position"], run[f"{stop.name}.torque"]
    size = max(abs(end) for end in (lower, upper) if np.isfinite(end))
    # a stop that opens and closes within a step is seen to its tolerance
    assert np.max(np.maximum(lower - position, position - upper)) <= 1e-9 * size
    at_lower, at_upper = abs(position - lower) <= 1e-9 * size, abs(position - upper) <= 1e-9 * size
    assert np.all(torque[at_lower] >= -1e-9 * largest)
    assert np.all(torque[at_upper] <= 1e-9 * largest)
    assert np.all(torque[~(at_lower | at_upper)] == 0.0)
    assert np.all(np.diff(run[f"{stop.name}.heat"]) >= -1e-9 * (run.energy.turnover + 1e-6))
