"""Motions of few numbers take their derivatives by matrices: docs/theory/gradients.md (23)."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import clutchwork as cw

TIGHT: dict[str, Any] = {"rtol": 1e-9, "atol": 1e-11}
BY = [
    "k.gain",
    "k.friction.slow",
    "k.pressure.values[2]",
    "k.pressure.times[2]",
    "s.stiffness",
    "c.inertia",
    "a.speed",
    "load.torque",
]
# of the largest derivative of a value: a run misses a few times its tolerance
APART = 1e-7
# shafts that have no part in it, and the numbers of the motion of all
BESIDE = {0: 4, 2: 7, 3: 9}


def launch(beside: int) -> cw.Driveline:
    """A clutch that pulls a load up over a spring; shafts on springs beside it swing on their own."""
    d = cw.Driveline("launch")
    a, b, c = d.shaft("a", inertia=0.3, speed=150.0), d.shaft("b", inertia=0.1), d.shaft("c", inertia=1.5)
    law = cw.Exponential(static=0.15, slow=0.13, fast=0.1, speed=20.0)
    pressure = cw.Table([(0.0, 1e5), (0.5, 4e5), (1.0, 5e5), (2.0, 5e5)])
    d.add(cw.Clutch("k", base=a, follower=b, friction=law, gain=3e-4, pressure=pressure))
    d.add(cw.SpringDamper("s", base=b, follower=c, stiffness=900.0, damping=3.0))
    d.add(cw.Torque("load", shaft=c, torque=-6.0))
    last = d.shaft("o", inertia=1.0, speed=1.0) if beside else None
    for number in range(1, beside):
        one = d.shaft(f"o{number}", inertia=1.0)
        d.add(cw.SpringDamper(f"os{number}", base=last, follower=one, stiffness=50.0, damping=0.1))
        last = one
    return d


def function(beside: int, by: list[str]) -> Any:
    """The speed of the load on its way, and when the clutch locks."""
    of = [cw.at("c.speed", [0.3, 1.0, 3.0]), cw.lock("k")]
    return cw.differentiable(launch(beside), 3.0, of=of, by=by, **TIGHT)


@pytest.mark.parametrize("by", [["k.pressure.values[2]"], BY], ids=["one direction", "many"])
@pytest.mark.parametrize("beside", [2, 3])
def test_what_swings_beside_it_changes_no_derivative(beside: int, by: list[str]) -> None:
    alone, among = (function(one, by).gradient().matrix for one in (0, beside))
    assert np.all(np.abs(alone - among) <= APART * np.abs(alone).max(axis=0))


@pytest.mark.parametrize("beside", BESIDE)
def test_a_run_that_is_followed_back_says_the_same(beside: int) -> None:
    f = function(beside, BY)
    runs = f.engine.runs
    point = runs.point(f.x0)
    forward, back = runs.forward(point), runs.taped(point)
    for column in sorted(next(iter(runs.signals.plain.values())).reads()):
        for row in range(len(point.grid)):
            one = forward.primal.functional()
            one.add(np.array([row]), np.array([column]), np.ones((1, 1)))
            along, followed = forward.slope(one), back.slope(one)
            assert np.all(np.abs(along - followed) <= APART * np.abs(along).max())


def test_a_torque_that_the_motion_hardly_feels_takes_steps_of_its_own() -> None:
    """Steps are long where it counts for nothing; its derivative is (1 - cos(w t)) / (J w)."""
    inertia, times = 0.5, np.array([0.13, 0.37, 0.77])
    d = cw.Driveline("shaken")
    a = d.shaft("a", inertia=inertia, speed=10.0)
    d.add(cw.Torque("drive", shaft=a, torque=cw.Sine(amplitude=1e-4, frequency=5.0, offset=1.0)))
    bare: dict[str, Any] = {**TIGHT, "work": False, "angles": False}
    f = cw.differentiable(d, 1.0, of=cw.at("a.speed", times), by="drive.torque.amplitude", **bare)
    rate = 2 * np.pi * 5.0
    exact = (1.0 - np.cos(rate * times)) / (inertia * rate)
    assert np.all(np.abs(f.jacobian(f.x0)[:, 0] - exact) <= 1e-8 * exact.max())
