"""Jerk limited beside heat and duration: found from a start that breaks it, told where it cannot be held."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.gradients.differentiable import Differentiable
from clutchwork.results.gradient import NoGradient
from support.engagement import BOTH, GAIN, LINING, PRESSURE, SPEED, least_torque
from support.launches import END, Launch

# a search that cannot hold its limits ends within so many
MOST_RUNS = 300


def gentle(jerk=400.0, latest=1.5, **how):
    """Least heat of a launch under limits of jerk, heat and duration; the start jumps to its torque at once."""
    launch = Launch()
    return cw.calibrate(
        launch.driveline(np.array([60.0, *[62.0] * 8])),
        END,
        free={"c1.pressure.values": (0.0, 80.0)},
        minimise="c1.heat",
        subject_to=[
            cw.limit(cw.jerk("load", 0.1, (0.0, 2.0)), upper=jerk),
            cw.limit(cw.lock("c1"), upper=latest),
            cw.limit("c1.heat", upper="1.5 kJ"),
        ],
        **how,
    )


def test_a_start_that_breaks_limits_is_restored():
    found = gentle(60.0)
    jerk, lock, heat = found.limits
    # the start is out by far
    assert jerk.before[1] > 5.0 * 60.0
    assert found.feasible, found.message
    assert jerk.active
    # by a run apart from the search
    times = np.arange(41) * 0.05
    speed = cw.simulate(found.system, END, times=times.tolist(), rtol=1e-9, atol=1e-11)["load.speed"][: len(times)]
    assert np.max(np.abs(speed[4:] - 2.0 * speed[2:-2] + speed[:-4])) / 0.1**2 <= 60.0 * (1.0 + 1e-5)
    assert lock.after[1] <= 1.5 * (1.0 + 1e-6)
    assert heat.after[1] <= 1500.0 * (1.0 + 1e-6)


def test_limits_that_cannot_be_held_together_are_told_soon():
    found = gentle(60.0, 0.5)
    assert not found.feasible
    assert sum(one.runs for one in found.outcomes) < MOST_RUNS
    broken = [one for one in found.limits if one.after[1] > one.upper * (1.0 + 1e-6)]
    assert broken
    for one in broken:
        assert f"{one.name} is" in found.message
        assert f"at best, by {one.after[1] - one.upper:.6g} {one.unit} outside of its bounds" in found.message


def test_corners_of_the_scatter_decide():
    lining = {"lining": cw.together(["c1.friction.kinetic", "c1.friction.static"], factor=(0.9, 1.1))}
    found = least_torque(1.0, scatter=lining, samples=8)
    factors = sorted(float(one[0]) for one in found.samples)
    assert factors[0] == pytest.approx(0.9, rel=1e-12)
    assert factors[-1] == pytest.approx(1.1, rel=1e-12)
    assert found["pressure"] * 0.9 == pytest.approx(SPEED * BOTH / (GAIN * LINING * PRESSURE), rel=1e-6)
    # no other gearbox is worse
    assert found.verify(200).holds


def test_all_corners_of_several_are_there():
    scatter = {"c1.friction.kinetic": (0.09, 0.11), "engine.inertia": (0.19, 0.21)}
    found = least_torque(1.0, scatter=scatter, samples=16)
    given = {tuple(np.round(one, 12)) for one in found.samples}
    assert set(product((0.09, 0.11), (0.19, 0.21))) <= given
    assert found.verify(200).holds


def test_points_that_graze_do_not_end_the_search(monkeypatch):
    exact, asked = Differentiable.value_and_jacobian, []

    def grazing(self, x):
        asked.append(x)
        if len(asked) % 2 == 0:
            raise NoGradient(["c1 at 1 s only just touches zero"])
        return exact(self, x)

    monkeypatch.setattr(Differentiable, "value_and_jacobian", grazing)
    found = least_torque(1.0)
    assert len(asked) > 2
    assert found.solved, found.message
    assert found.goal[1] == pytest.approx(SPEED * BOTH, rel=1e-5)


def test_the_multiplier_is_what_another_hundredth_saves():
    found, wider = gentle(60.0), gentle(60.6)
    assert found.feasible
    assert wider.feasible
    saved = found.goal[1] - wider.goal[1]
    assert found.limits[0].multiplier * 0.6 == pytest.approx(saved, rel=0.05)
