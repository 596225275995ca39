"""Calibrations whose optimum, multipliers and scatter are known in closed form."""

from __future__ import annotations

import numpy as np
import pytest

import clutchwork as cw
from support.engagement import BOTH, GAIN, LINING, PRESSURE, SPEED, discs, least_torque

# differences of runs are as exact as this, tangents more
CLOSE = 1e-6


def test_the_least_torque_locks_at_the_last_moment():
    found = least_torque(1.0)
    assert found.solved, found.message
    assert found.goal[1] == pytest.approx(SPEED * BOTH / 1.0, rel=CLOSE)
    assert found["pressure"] == pytest.approx(SPEED * BOTH / (GAIN * LINING * PRESSURE), rel=CLOSE)


def test_the_multiplier_is_the_derivative_of_the_goal_by_the_bound():
    found = least_torque(1.3)
    (held,) = found.limits
    assert held.active
    assert held.multiplier == pytest.approx(SPEED * BOTH / 1.3**2, rel=1e-5)
    (said,) = found.costs
    assert said == "0.1 s more allowed of lock(c1) saves 0.947 N m of c1.torque at"


def test_a_limit_that_does_not_bind_costs_nothing():
    found = cw.calibrate(
        discs(),
        5.0,
        free={"c1.gain": (3e-4, 9e-4)},
        minimise=cw.lock("c1"),
        subject_to=[cw.limit("c1.heat", upper="2 kJ")],
    )
    assert found.solved
    assert not found.limits[0].active
    assert found.costs == ()
    assert found["c1.gain"] == pytest.approx(9e-4)
    assert "at its upper bound" in str(found)


def test_limits_hold_for_every_lining_of_production():
    lining = {"lining": cw.together(["c1.friction.kinetic", "c1.friction.static"], factor=(0.9, 1.1))}
    found = least_torque(1.0, scatter=lining, samples=32, seed=3)
    worst = min(sample[0] for sample in found.samples)
    assert found.solved, found.message
    # the weakest of the samples decides
    assert found["pressure"] * worst == pytest.approx(SPEED * BOTH / (GAIN * LINING * PRESSURE), rel=CLOSE)
    assert worst < 0.91
    seen = found.verify(200, seed=5)
    weaker = np.count_nonzero(seen.samples[:, 0] < worst * (1.0 - 1e-6))
    assert np.count_nonzero(seen.broken) == weaker
    assert not seen.holds or weaker == 0
    assert seen.yields == pytest.approx(1.0 - weaker / 200)


def test_the_worst_of_production_may_be_the_goal():
    lining = {"c1.friction.kinetic": (0.09, 0.11)}
    found = cw.calibrate(
        discs(),
        5.0,
        free={"c1.gain": (3e-4, 9e-4)},
        # soon, and with little torque: of the strongest lining the torque counts, of the weakest one the time
        minimise={cw.lock("c1"): 1.0, cw.peak("c1.torque"): 0.05},
        scatter=lining,
        samples=16,
        robust="worst",
    )
    assert found.solved, found.message
    factors = np.array([sample[0] for sample in found.samples])
    torque = found["c1.gain"] * factors * PRESSURE
    costs = SPEED * BOTH / torque + 0.05 * torque
    assert found.goal[1] == pytest.approx(np.max(costs), rel=1e-5)
    # two samples are as bad as each other, or one is at its own optimum
    others = np.linspace(3e-4, 9e-4, 2001)[:, None] * factors * PRESSURE
    assert np.min(np.max(SPEED * BOTH / others + 0.05 * others, axis=1)) >= found.goal[1] * (1.0 - 1e-6)


def test_the_front_is_that_of_the_closed_form():
    found = least_torque(1.0)
    front = found.front("lock(c1)", [0.8, 1.0, "1.25 s"])
    assert front.goals == pytest.approx(SPEED * BOTH / np.array([0.8, 1.0, 1.25]), rel=CLOSE)
    assert front.slopes == pytest.approx(-SPEED * BOTH / np.array([0.8, 1.0, 1.25]) ** 2, rel=1e-5)
