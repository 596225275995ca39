"""Launches of two discs: least heat with a bounded jerk, least squared jerk, 16 random ones of each."""

from __future__ import annotations

import numpy as np
import pytest

import clutchwork as cw
from support.launches import JERK, LOCKED_BY, MOST, Launch, costs, draws

LAUNCHES = [Launch(), *draws(16)]
# limits and first-order optimality, in shares of their scales
TIGHT = 1e-6


@pytest.mark.parametrize("number", range(len(LAUNCHES)))
@pytest.mark.parametrize("pieces", [15, 30])
def test_least_squared_jerk_is_that_of_the_closed_form(number, pieces):
    launch = LAUNCHES[number]
    found = launch.least_jerk(pieces)
    least, torques = launch.exact_least_jerk(pieces)
    assert found.solved, found.message
    assert found.certificate.violation < TIGHT
    assert found.certificate.residual < TIGHT
    # a ten-millionth of the slip is left, which saves about as much
    assert found.goal[1] == pytest.approx(least, rel=1e-6)
    assert np.max(np.abs(found.x - torques)) < 1e-5 * np.max(torques)


@pytest.mark.parametrize("number", range(len(LAUNCHES)))
@pytest.mark.parametrize("pieces", [15, 30])
def test_least_heat_is_optimal(number, pieces):
    launch = LAUNCHES[number]
    found = launch.least_heat(pieces)
    assert found.solved, found.message
    assert found.certificate.violation < TIGHT
    assert found.certificate.residual < TIGHT
    # the same cost by closed forms, and none of the allowed profiles beside it costs less
    beside = neighbours(launch, np.append(0.0, found.x), 400)
    other = costs(launch, beside)
    assert other[0] == pytest.approx(found.goal[1], rel=1e-7)
    assert np.nanmin(other) > other[0] * (1.0 - 1e-9)


def neighbours(launch, profile, count):
    """The profile, and random ones near it within bounds of torque and slope."""
    rng, rise = np.random.default_rng(1), JERK * launch.load * LOCKED_BY / (len(profile) - 1)
    found = [profile]
    for size in np.geomspace(1e-3, 0.3, count):
        rates = np.clip(np.diff(profile) + rise * size * rng.normal(size=len(profile) - 1), -rise, rise)
        torque = [0.0]
        for rate in rates:
            # what is clipped keeps both bounds
            torque.append(float(np.clip(torque[-1] + rate, 0.0, MOST)))
        found.append(np.array(torque))
    return np.array(found)


def test_the_neighbours_would_find_a_better_profile():
    """Of a profile that is not optimal many neighbours are better."""
    launch = Launch()
    start = np.minimum(0.5 * JERK * launch.load * np.linspace(0.0, LOCKED_BY, 16), 0.9 * MOST)
    other = costs(launch, neighbours(launch, start, 400))
    assert np.nanmin(other) < other[0] * 0.99


def test_many_starts_find_nothing_better():
    launch = LAUNCHES[3]
    one, many = launch.least_heat(15), launch.least_heat(15, starts=4)
    assert many.goal[1] == pytest.approx(one.goal[1], rel=1e-9)
    reached = [outcome.goal for outcome in many.outcomes if outcome.is_feasible]
    assert len(reached) >= 3
    assert max(reached) == pytest.approx(one.goal[1], rel=1e-7)


def test_the_values_are_those_of_the_model_that_comes_out():
    found = Launch().least_heat(15)
    run = found.run()
    assert run["c1.heat"][-1] + 1e-3 * float(np.sum(np.diff(np.append(0.0, found.x)) ** 2) / 0.1) == pytest.approx(
        found.goal[1], rel=1e-6
    )
    assert isinstance(found.system, cw.System)
