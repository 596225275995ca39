"""Squared jerks of runs that begin on a border: what is far from a line beside the point has a derivative at it."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest

import clutchwork as cw


def cam() -> cw.Driveline:
    """A cam whose lift begins where the run does, at angle 0."""
    rise = [(0.0, 0.0), (1.8, 0.0), (2.4, 4e-3), (pi, 9e-3)]
    d = cw.Driveline("cam")
    a, m = d.shaft("a", inertia=0.09, speed=5.0), d.mass("m", mass=0.12)
    lift = rise + [(2 * pi - x, h) for x, h in reversed(rise[:-1])]
    d.add(cw.Cam("x", shaft=a, mass=m, lift=lift))
    d.add(cw.Spring("s", base=d.housing, follower=m, stiffness=2e4))
    d.add(cw.Torque("p", shaft=m, torque=-197.0))
    d.add(cw.Torque("t", shaft=a, torque=-7.0))
    return d


def damper() -> cw.Driveline:
    """A torsional damper without twist at the start, where both of its ways of friction begin."""
    d = cw.Driveline("torsion")
    p, s = d.shaft("p", inertia=0.12, speed=90.0), d.shaft("s", inertia=0.06, speed=90.0)
    b, z = d.shaft("b", inertia=0.3, speed=90.0), d.shaft("z")
    twists = [(-0.7, -500.0), (-0.5, -150.0), (0.5, 150.0), (0.7, 500.0)]
    rubs = {"friction_limit": [5.0, 8.0], "friction_stiffness": [1000.0, 300.0], "friction_load": [0.03, 0.0]}
    d.add(cw.TorsionalDamper("x", base=p, follower=s, torque=twists, **rubs))
    d.add(cw.SpringDamper("i", base=s, follower=z, stiffness=9000.0, damping=1.0))
    d.add(cw.SpringDamper("j", base=z, follower=b, stiffness=5000.0, damping=1.0))
    d.add(cw.Torque("t", shaft=p, torque=cw.Sine(amplitude=20.0, frequency=10.0)))
    d.add(cw.Torque("m", shaft=p, torque=cw.Ramp(height=80.0, duration=0.1)))
    d.add(cw.Torque("r", shaft=b, torque=cw.Ramp(height=-80.0, duration=0.1)))
    return d


@pytest.mark.parametrize(
    ("make", "t_end", "shaft", "by"),
    [
        (cam, 0.6, "x.surface", ["x.lift.arguments[4]"]),
        (cam, 0.6, "a", ["x.lift.arguments[4]"]),
        (damper, 0.3, "b", ["i.initial_twist", "x.torque.values[3]"]),
    ],
)
def test_a_squared_jerk_of_a_run_that_begins_on_a_border(make, t_end, shaft, by) -> None:
    # a start is looked at from so far away that the derivative is no line up to there
    f = cw.differentiable(make(), t_end, of=cw.squared_jerk(shaft), by=by, rtol=1e-9, atol=1e-12)
    found = f.gradient()
    assert found.problems == ()
    plain = cw.differentiable(make(), t_end, of=cw.squared_jerk(shaft), by=by, rtol=1e-11, atol=1e-14)
    for number, start in enumerate(f.x0):
        step = 1e-4 * max(abs(start), 1.0) * np.eye(len(by))[number]
        # differences of the fourth order
        near, far = (
            (plain(f.x0 + k * step)[0] - plain(f.x0 - k * step)[0]) / (2 * k * step[number]) for k in (1.0, 2.0)
        )
        assert found.matrix[0, number] == pytest.approx((4.0 * near - far) / 3.0, rel=2e-5)
