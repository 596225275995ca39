"""Small pushes: the nonlinear model answers as the linear system does, to second order; and in harmonic motion."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from scipy.linalg import expm

import clutchwork as cw
from clutchwork.linear.instant import instant_of
from support.perturbed import Standing, started
from support.runs import TIGHT

DURATION = 0.25  # s


def pulled() -> cw.Driveline:
    """A motor drives a fan through a slipping clutch that warms its plates, and a shaft."""
    d = cw.Driveline("fan")
    motor, hub, fan = d.shaft("motor", inertia=0.2), d.shaft("hub", inertia=0.1), d.shaft("fan", inertia=0.6)
    plates, air = d.thermal("plates", capacity=60.0, temperature=330.0), d.ambient("air", temperature=300.0)
    d.add(cw.SpeedTorque("drive", shaft=motor, torque=[(0.0, 60.0), (200.0, 0.0)]))
    law = cw.Stribeck(static=0.13, kinetic=0.09, speed=40.0, viscous=2e-4)
    d.add(cw.Clutch("c1", base=motor, follower=hub, friction=law, gain=1.0, normal_force=250.0, heat=plates))
    d.add(cw.SpringDamper("shaft", base=hub, follower=fan, stiffness=350.0, damping=0.3))
    d.add(cw.QuadraticTorque("drag", shaft=fan, nominal_torque=-20.0, nominal_speed=60.0))
    d.add(cw.Conduction("cooling", hot=plates, cold=air, conductance=20.0))
    return d


@pytest.fixture(scope="module")
def steady() -> Standing:
    run = pulled().simulate(60.0, **TIGHT)
    standing = Standing(instant_of(run, 60.0))
    assert standing.instant.modes.tolist() == [-1]
    assert max(abs(state.rate) for state in standing.linear.states) < 1e-6
    return standing


def after(standing: Standing, change: np.ndarray) -> np.ndarray:
    """Speeds and states some time after a push."""
    row = standing.instant.row + change
    columns = standing.instant.wiring.columns
    system = started(
        standing.instant.system,
        row[columns["speed"]][standing.independent],
        row[columns["state"]],
        row[columns["input"]],
    )
    run = system_run(system)
    states = [run[state.name][-1] for state in standing.linear.states]
    return np.array(states)


def system_run(system: cw.System) -> cw.Trajectory:
    return cw.simulate(system, DURATION, times=[DURATION], **TIGHT)


def test_what_a_push_leaves_is_that_of_the_linear_system_to_second_order(steady):
    linear = steady.linear
    n = len(linear.states)
    carried = expm(linear.A * DURATION)
    rest = np.array([state.value for state in linear.states])
    sizes = np.array([{"rad/s": 4.0, "rad": 0.02, "K": 20.0}[state.unit] for state in linear.states])
    for column in range(n):
        missed = []
        for part in (1.0, 0.5, 0.25):
            push = part * sizes[column]
            found = after(steady, linear.row[:, column] * push) - rest
            missed.append(np.linalg.norm((found - carried[:, column] * push) / sizes))
        # half of the push leaves a quarter of the error, up to third order and the tolerance of the solver
        assert missed[2] < 0.05 * 0.25
        for large, small in pairwise(missed):
            assert large / small == pytest.approx(4.0, rel=0.25) or small < 1e-8


def test_harmonic_response_of_a_locked_driveline():
    def driveline(torque):
        d = cw.Driveline("ripple")
        engine, hub, car = d.shaft("engine", inertia=0.2), d.shaft("hub", inertia=0.1), d.shaft("car", inertia=1.5)
        d.add(cw.Torque("drive", shaft=engine, torque=torque))
        law = cw.Coulomb(static=0.2, kinetic=0.2)
        d.add(cw.Clutch("c1", base=engine, follower=hub, friction=law, gain=1.0, normal_force=1000.0))
        d.add(cw.SpringDamper("shaft", base=hub, follower=car, stiffness=900.0, damping=3.0))
        d.add(cw.LinearTorque("drag", shaft=car, nominal_torque=-20.0, nominal_speed=10.0))
        return d

    f = 8.0
    lin = cw.linearise(driveline(0.0), inputs="drive.torque", outputs=["shaft.twist", "c1.torque", "car.speed"])
    response = lin.frequency_response(f)[0, :, 0]
    # after twenty time constants of the slowest mode, over one period
    times = 20.0 + np.arange(64) / 64.0 / f
    run = cw.simulate(driveline(cw.Sine(amplitude=5.0, frequency=f)), times[-1], times=times, **TIGHT)
    wave = np.exp(-2j * np.pi * f * times)
    for name, expected in zip(lin.outputs, response, strict=True):
        # sin is the imaginary part
        found = 2j * np.mean(run[name] * wave) / 5.0
        assert found == pytest.approx(expected, rel=1e-6)
