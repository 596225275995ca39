"""Linear systems of drivelines with ratios that vary, against differences. docs/theory/linearisation.md (10)"""

from __future__ import annotations

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.base.errors import UseError
from clutchwork.linear.instant import instant_of
from support import random_drivelines, varying
from support.perturbed import Standing, mismatch

# as tests/linear/test_differences.py
CLOSE = 1e-6


def cvt(**more):
    """A ratio behind its actuator, springs and a clutch beside it."""
    d = cw.Driveline("cvt")
    a, b, c = d.shaft("a", inertia=0.3, speed=40.0), d.shaft("b", inertia=0.7), d.shaft("c", inertia=0.5, speed=15.0)
    e = d.shaft("e", inertia=0.2, speed=60.0)
    actuator = d.add(cw.RatioActuator("ratio", command=cw.Step(offset=2.5, height=-1.5, start=0.02), lag=0.3))
    d.add(cw.VariableRatio("v", input=a, output=b, ratio=actuator, **more))
    d.add(cw.SpringDamper("s", base=b, follower=c, stiffness=300.0, damping=2.0))
    law = cw.Stribeck(static=1.2, kinetic=1.0, speed=3.0)
    d.add(cw.Clutch("k", base=e, follower=a, friction=law, gain=1.0, normal_force=15.0))
    d.add(cw.Torque("drive", shaft=e, torque=cw.Sine(amplitude=10.0, frequency=1.0, offset=8.0)))
    d.add(cw.Damper("drag", base=d.housing, follower=c, damping=0.3))
    return d


def joints():
    """Two joints with a shaft without inertia between them, a crank behind."""
    d = cw.Driveline("joints")
    a, c = d.shaft("a", inertia=0.3, speed=30.0), d.shaft("c", inertia=0.1)
    tube, m = d.shaft("tube", inertia=0.0), d.mass("m", mass=3.0)
    d.add(cw.UniversalJoint("first", base=a, follower=tube, bend_angle=0.5))
    d.add(cw.UniversalJoint("second", base=tube, follower=c, bend_angle=0.4, phase=0.7))
    d.add(cw.CrankSlider("crank", shaft=c, mass=m, radius=0.06, rod=0.2))
    d.add(cw.SpringDamper("s", base=d.housing, follower=m, stiffness=800.0, damping=5.0))
    d.add(cw.Torque("drive", shaft=a, torque=4.0))
    return d


@pytest.mark.parametrize("at", [0.013, 0.11, 0.43, 0.77])
@pytest.mark.parametrize("make", [cvt, lambda: cvt(capacity=12.0), joints], ids=["cvt", "capacity", "joints"])
def test_as_differences_have_it(make, at):
    run = make().simulate(1.0, rtol=1e-9)
    assert mismatch(Standing(instant_of(run, at))) < CLOSE


@pytest.mark.parametrize("seed", range(6))
def test_random_drivelines(seed):
    """Where the ratio stands: the pushed systems have constant signals."""
    description = varying.describe(seed)
    first, last = description.points[0][0], description.points[-1][0]
    run = description.driveline().simulate(random_drivelines.T_END)
    for at in (0.3 * first, 0.9 * first, last + 0.5 * (random_drivelines.T_END - last)):
        assert mismatch(Standing(instant_of(run, at))) < CLOSE, at


def test_the_stiffness_behind_a_ratio_counts_with_its_square():
    d = cw.Driveline("two masses")
    a, b, c = d.shaft("a", inertia=0.3), d.shaft("b", inertia=0.0), d.shaft("c", inertia=0.5)
    d.add(cw.VariableRatio("v", input=a, output=b, ratio=2.0))
    d.add(cw.Spring("s", base=b, follower=c, stiffness=300.0))
    frequency = [mode.frequency for mode in cw.linearise(d).modes]
    expected = np.sqrt(300.0 * (1.0 / (4.0 * 0.3) + 1.0 / 0.5)) / (2.0 * np.pi)
    assert max(frequency) == pytest.approx(expected, rel=1e-9)


def test_a_ratio_that_turns_is_no_input():
    d = cw.Driveline("ratio")
    a, b = d.shaft("a", inertia=0.3), d.shaft("b", inertia=0.7, speed=10.0)
    d.add(cw.VariableRatio("v", input=a, output=b, ratio=2.0))
    with pytest.raises(UseError, match=r"v.ratio acts by its slope too: give the ratio by a RatioActuator"):
        cw.linearise(d, inputs=["v.ratio"])
