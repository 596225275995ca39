"""The energy balance closes, and friction never makes power."""

from __future__ import annotations

import numpy as np
import pytest

import clutchwork as cw
from support import random_drivelines, six_speed

# residual over energy turned over at rtol 1e-9: asked for
RESIDUAL = 1e-8


@pytest.mark.parametrize("method", ["rodas5p", "dopri5"])
def test_shift_of_the_six_speed_gearbox(method: str) -> None:
    run = six_speed.gearbox(six_speed.SHIFT).simulate(4.0, method=method, rtol=1e-9, atol=1e-11)
    assert abs(run.energy.residual) <= RESIDUAL * run.energy.turnover
    assert run.energy.turnover > 1e5


@pytest.mark.parametrize("seed", range(10))
def test_random_drivelines(seed: int) -> None:
    run = random_drivelines.describe(seed).driveline().simulate(random_drivelines.T_END, rtol=1e-9, atol=1e-11)
    assert abs(run.energy.residual) <= RESIDUAL * run.energy.turnover
    for i in range(3):
        power = run[f"c{i}.power"]
        # round-off of a slip at the very instant of its zero
        assert np.max(power) <= 1e-12 * np.max(np.abs(power))
        assert np.all(np.diff(run[f"c{i}.heat"]) >= -1e-12 * run.energy.turnover)


def test_every_part_of_the_balance() -> None:
    """Spring, damper, source, load, prescribed speed, clutch and impulse in one model, against its signals."""
    d = cw.Driveline("all parts")
    a, b, c = d.shaft("a", inertia=0.4), d.shaft("b", inertia=0.3, speed=20.0), d.shaft("c", inertia=0.6)
    d.add(cw.PrescribedSpeed("motor", shaft=a, speed=cw.Sine(amplitude=30.0, frequency=1.0)))
    d.add(cw.SpringDamper("k", base=a, follower=b, stiffness=800.0, damping=2.0, initial_twist=0.01))
    d.add(cw.Spring("s", base=d.housing, follower=c, stiffness=50.0, initial_twist=-0.1))
    d.add(cw.Damper("q", base=d.housing, follower=c, damping=0.1))
    d.add(cw.ResistingTorque("load", shaft=c, torque=5.0, speed=1.0))
    law = cw.Coulomb(static=1.2, kinetic=1.0)
    table = cw.Table([(0.0, 0.0), (0.5, 30.0), (1.0, 30.0), (1.5, 0.0)])
    d.add(cw.Clutch("f", base=b, follower=c, friction=law, gain=1.0, normal_force=table))
    run = d.simulate(2.0, rtol=1e-9, atol=1e-11)
    assert abs(run.energy.residual) <= RESIDUAL * run.energy.turnover
    kinetic = [
        0.5 * sum(J * run[f"{n}.speed"][i] ** 2 for n, J in zip("abc", (0.4, 0.3, 0.6), strict=True)) for i in (0, -1)
    ]
    assert run.energy.kinetic == pytest.approx(kinetic[1] - kinetic[0], rel=1e-12)
    elastic = [run["k.spring_torque"][i] ** 2 / 1600 + run["s.spring_torque"][i] ** 2 / 100 for i in (0, -1)]
    assert run.energy.elastic == pytest.approx(elastic[1] - elastic[0], rel=1e-12)
    # work integrals of the solver against the trapezoidal rule over its refined output: as good as that rule
    for name in ("f", "q", "load"):
        assert run[f"{name}.work"][-1] == pytest.approx(np.trapezoid(run[f"{name}.power"], run.time), rel=1e-3)
