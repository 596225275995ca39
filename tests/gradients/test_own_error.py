"""Derivatives have an error control of their own: docs/theory/gradients.md (20) and (21).

From rest and in steady motion steps of a run are long, and say nothing of how derivatives swing.
"""

from __future__ import annotations

import math
import warnings

import numpy as np
import pytest

import clutchwork as cw
from support import free_numbers, random_drivelines
from support.amount import amount

TOLERANCES = {1e-6: 1e-4, 1e-9: 1e-7}


@pytest.mark.parametrize("rtol", [1e-6, 1e-9, 1e-12])
@pytest.mark.parametrize("steady", [0.0, 50.0])
def test_the_derivative_of_two_discs_by_their_twist_is_that_of_the_closed_form(rtol: float, steady: float) -> None:
    d = cw.Driveline("twist")
    a, b = d.shaft("a", inertia=0.3, speed=steady), d.shaft("b", inertia=0.7, speed=steady)
    d.add(cw.SpringDamper("k", base=a, follower=b, stiffness=400.0, damping=0.5))
    function = cw.differentiable(d, 0.5, of="b.speed", by="k.initial_twist", rtol=rtol)
    # u'' + 2 damping u' + square u = 0 for the twist u, u(0) = 1
    mass = 1 / (1 / 0.3 + 1 / 0.7)
    damping, square = 0.5 / (2 * mass), 400.0 / mass
    omega = math.sqrt(square - damping**2)
    rate = -square / omega * math.exp(-damping * 0.5) * math.sin(omega * 0.5)
    forward, back = function.gradient().matrix[0, 0], function.vjp(function.x0, [1.0])
    assert abs(forward) == pytest.approx(abs(mass / 0.7 * rate), rel=max(20 * rtol, 1e-10))
    assert np.ravel(back[1] if isinstance(back, tuple) else back)[0] == pytest.approx(
        forward, rel=max(20 * rtol, 1e-10)
    )


@pytest.mark.random
def test_derivatives_of_random_drivelines_have_the_tolerance_of_the_run() -> None:
    within = {rtol: list[bool]() for rtol in TOLERANCES}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for seed in range(amount(4)):
            system = random_drivelines.describe(seed).driveline().assemble()
            speeds = [f"{node.name}.speed" for node in system.nodes if not node.fixed]
            run = cw.simulate(system, 2.0, rtol=1e-8)
            scales = np.array([np.abs(run[name]).max() for name in speeds])
            for one in free_numbers.some(system, np.random.default_rng(seed), 2):
                try:
                    found = [
                        cw.differentiable(system, 2.0, of=speeds, by=one.name, rtol=rtol, atol=rtol / 100)
                        .gradient()
                        .matrix[:, 0]
                        for rtol in (*TOLERANCES, 1e-12)
                    ]
                except cw.NoGradient:
                    continue
                size = abs(one.start) or one.scale
                of = np.maximum(scales, np.abs(found[-1]) * size)
                for (rtol, allowed), matrix in zip(TOLERANCES.items(), found[:-1], strict=True):
                    within[rtol] += list(np.abs(matrix - found[-1]) * size / of <= allowed)
    assert min(len(each) for each in within.values()) > 10
    assert all(np.mean(each) >= 0.9 for each in within.values())


@pytest.mark.parametrize("t_start", [0.1, 0.3])
def test_a_prescribed_acceleration_that_begins_later_keeps_its_derivatives(t_start: float) -> None:
    d = cw.Driveline("later")
    e, w = d.shaft("e", speed=10.0), d.shaft("w", inertia=0.8)
    d.add(cw.PrescribedAcceleration("m", shaft=e, acceleration=5.0))
    d.add(cw.Clutch("c", base=e, follower=w, friction=cw.Coulomb(static=0.12, kinetic=0.1), gain=5e-4, pressure=1e4))
    run = cw.simulate(d, 0.6, t_start=t_start)
    # it slips all the time: the torque is 0.5 N m
    rise = 0.5 * (0.6 - t_start) / 0.8
    found = run.gradient(of="w.speed", by=["w.inertia", "c.friction.kinetic"]).matrix[0]
    assert found == pytest.approx([-rise / 0.8, rise / 0.1], rel=1e-9)


@pytest.mark.parametrize("t_start", [0.0, 0.3])
def test_speeds_that_follow_at_a_later_start_have_derivatives(t_start: float) -> None:
    """What is free begins with what is prescribed, or with the ratio, at that time."""
    begin, end = (math.sin(4.0 * math.pi * t) for t in (t_start, 0.55))
    d = cw.Driveline("prescribed")
    a, b = d.shaft("a", inertia=0.8), d.shaft("b", inertia=0.4, speed=5.0)
    d.add(cw.PrescribedSpeed("pull", base=a, shaft=b, speed=cw.Sine(amplitude=3.0, frequency=2.0)))
    found = cw.simulate(d, 0.55, t_start=t_start).gradient(of="a.speed", by="pull.speed.amplitude").matrix[0, 0]
    assert found == pytest.approx(-begin + 0.4 / 1.2 * (begin - end), rel=1e-6)
    d = cw.Driveline("ratio")
    a, b = d.shaft("a", inertia=0.8), d.shaft("b", inertia=0.4, speed=5.0)
    d.add(cw.VariableGear("v", input=a, output=b, ratio=cw.Sine(amplitude=0.5, frequency=2.0, offset=1.5)))
    found = cw.simulate(d, 0.55, t_start=t_start).gradient(of="b.speed", by="v.ratio.amplitude").matrix[0, 0]
    # free, the energy stays what it is at the start
    first, last = 1.5 + 0.5 * begin, 1.5 + 0.5 * end
    inertias = 0.8 * first**2 + 0.4, 0.8 * last**2 + 0.4
    speed = 5.0 * math.sqrt(inertias[0] / inertias[1])
    assert found == pytest.approx(0.8 * speed * (first * begin / inertias[0] - last * end / inertias[1]), rel=1e-6)


@pytest.mark.parametrize("modes", [1, 3])
def test_a_swinging_speed_that_passes_zero_does_not_loosen_what_derivatives_may_miss(modes: int) -> None:
    # where the slip reverses the equations bend, and an error there stays: of the size that a mode had while it passed
    # zero, by which derivatives were measured, it was nothing
    d = cw.Driveline("rings")
    a, b = d.shaft("a", inertia=0.00488, speed=50.0), d.shaft("b", inertia=0.0313)
    d.add(cw.LinearTorque("engine", shaft=a, nominal_torque=2.73, nominal_speed=15.9))
    friction = cw.Dahl(kinetic=0.0732, stiffness=4140.0)
    d.add(cw.TorqueLimiter("limiter", base=a, follower=b, friction=friction, torque=236.0, locked=False))
    damped = {"stiffness": 386.0, "inertia": 0.00135, "damping_time": 0.000279}
    d.add(cw.FlexibleShaft("shaft", base=a, follower=b, modes=modes, **damped))
    found, wanted = (
        cw.differentiable(d, 0.05, of="a.speed", by="a.inertia", rtol=rtol, atol=rtol / 100).gradient().matrix[0, 0]
        for rtol in (1e-10, 1e-12)
    )
    # the motion has an error too: its bristles ring
    assert found == pytest.approx(wanted, rel=1e-4)


@pytest.mark.parametrize("load", [50.0, 300.0])
@pytest.mark.parametrize("rtol", [1e-6, 1.1e-6, 3e-6, 1e-8])
def test_a_jerk_that_settles_behind_a_knot_that_moves_is_known_or_refused(load: float, rtol: float) -> None:
    """Its derivative is the small difference of what the instant moves: a note says so, or there is none."""
    d = cw.Driveline("settles")
    s = d.shaft("s", inertia=0.05)
    d.add(cw.Torque("t", shaft=s, torque=cw.Table([(0.08, 0.0), (0.15, 0.0), (0.2, -0.5), (0.26, -3.6)])))
    law = cw.RegularisedStribeck(static=0.05, kinetic=0.037, speed=0.8, width=0.03)
    d.add(cw.Brake("b", shaft=s, friction=law, gain=1.0, normal_force=load))
    f = cw.differentiable(d, 0.3, of=cw.squared_jerk("s"), by="t.torque.times[3]", rtol=rtol, atol=1e-2 * rtol)
    sharp = cw.differentiable(d, 0.3, of=cw.squared_jerk("s"), by="t.torque.times[3]", rtol=1e-11, atol=1e-13)
    step = 1e-6
    wanted = (sharp(f.x0 + step)[0] - sharp(f.x0 - step)[0]) / (2 * step)
    if load > 100.0:
        with pytest.raises(cw.NoGradient, match="runs of two tolerances do not agree"):
            f.gradient()
        return
    found = f.gradient()
    assert any("fewer digits" in text for text in found.notes)
    assert found.matrix[0, 0] == pytest.approx(wanted, rel=1e-6)
