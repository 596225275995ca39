"""Derivatives that random models of everything have found wrong, each by the smallest driveline that shows it."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from support import by_differences

TIGHT: dict[str, Any] = {"rtol": 1e-10, "atol": 1e-12}


def compared(model: cw.Driveline, t_end: float, of: Any, by: list[str], **options: Any) -> None:
    """Derivatives are those of differences at a tight tolerance."""
    function = cw.differentiable(model, t_end, of=of, by=by, **TIGHT, **options)
    scales = by_differences.scales(model.simulate(t_end, rtol=1e-8, **options), function.task.outputs)
    for one in by_differences.compared(function, function.jacobian(function.x0), scales):
        # what the package promises of a derivative at this tolerance
        assert np.all(one.missed < 1e-6), str(one)


def test_a_brake_lets_go_soon_after_its_load_has_begun() -> None:
    # seed 60031: the torque before the ramp, which is of the other sign along its line, counted in how fast it grows
    d, gain, force, rise, start = cw.Driveline("soon"), 0.297, 25.9, 28.97 / 0.0041, 0.0751
    a, b = d.shaft("a", inertia=0.179), d.shaft("b", inertia=0.0138)
    law = cw.Coulomb(static=0.2274, kinetic=0.181)
    d.add(cw.Torque("drive", shaft=b, torque=cw.Ramp(height=-28.97, duration=0.0041, start=start)))
    d.add(cw.SpragClutch("held", base=b, follower=a, holding=9.5))
    d.add(cw.Brake("brake", shaft=b, friction=law, gain=gain, normal_force=force))
    found = d.simulate(0.125, **TIGHT).gradient(of=cw.break_away("brake"), by="brake.friction.static")
    assert found.values[0] == pytest.approx(start + 0.2274 * gain * force / rise, rel=1e-9)
    assert found.matrix[0, 0] == pytest.approx(gain * force / rise, rel=1e-7)


@pytest.mark.parametrize(
    "law",
    [
        cw.Dahl(kinetic=0.1, stiffness=400.0),
        cw.RegularisedStribeck(static=0.12, kinetic=0.1, speed=5.0, shape="power", exponent=1.0, width=0.5),
    ],
    ids=lambda law: law.kind,
)
def test_an_exponent_of_one_has_a_derivative(law: cw.Law) -> None:
    # seed 60099: the power was its argument there, whatever the exponent
    d = cw.Driveline("power")
    a, b = d.shaft("a", inertia=0.3, speed=20.0), d.shaft("b", inertia=0.8)
    d.add(cw.Clutch("c", base=a, follower=b, friction=law, gain=5e-4, pressure=2e5))
    compared(d, 0.02, ["a.speed", "c.heat"], ["c.friction.exponent"])


def test_a_number_at_zero_is_looked_at_beside_in_its_own_scale() -> None:
    # seed 60042: right beside zero differences had steps of round-off
    d = cw.Driveline("zero")
    a, b = d.shaft("a", inertia=0.4), d.shaft("b", inertia=0.05)
    pulse = cw.Pulse(height=49.0, period=0.0345, width=0.0065)
    d.add(cw.Torque("drive", shaft=a, torque=pulse))
    d.add(cw.SpringDamper("k", base=a, follower=b, stiffness=300.0, damping=0.5))
    compared(d, 0.0734, ["a.speed", "b.speed"], ["drive.torque.start"], t_start=0.0354)


@pytest.mark.parametrize("rtol", [1e-6, 1e-8, 1e-10, 1e-12])
def test_a_piston_that_is_told_to_fall_below_rest_first(rtol: float) -> None:
    # seed 60067: its pressure begins to rise without an event, where no part of a step was short enough
    d = cw.Driveline("piston")
    a = d.shaft("a", inertia=0.3, speed=20.0)
    command = cw.Sine(amplitude=8e4, frequency=15.0, offset=-3e4)
    piston = cw.PressureActuator("piston", command=command, lag=0.0045)
    law = cw.Coulomb(static=0.1, kinetic=0.1)
    d.add(piston)
    d.add(cw.Brake("b", shaft=a, friction=law, gain=1e-6, pressure=piston))
    of, by = ["a.speed", "piston.pressure"], ["piston.command.amplitude", "piston.lag"]
    function = cw.differentiable(d, 0.03, of=of, by=by, rtol=rtol, atol=rtol / 100)
    scales = by_differences.scales(d.simulate(0.03, rtol=1e-8), function.task.outputs)
    for one in by_differences.compared(function, function.jacobian(function.x0), scales):
        # right behind rest a derivative is large beside a pressure of nearly zero: four digits fewer count later
        assert np.all(one.missed < max(1e-6, 1e4 * rtol)), str(one)


def test_a_speed_without_inertia_bends_at_a_knot_at_the_end() -> None:
    # a hard one: it follows a torque that bends there, which one side of the knot alone sees
    d = cw.Driveline("end")
    a, m, b = d.shaft("a", inertia=0.3, speed=5.0), d.shaft("m"), d.shaft("b", inertia=0.8)
    d.add(cw.Damper("k1", base=a, follower=m, damping=3.0))
    d.add(cw.Damper("k2", base=m, follower=b, damping=1.0))
    d.add(cw.Torque("t", shaft=m, torque=cw.Table([(0.0, 1.0), (0.1, 5.0), (0.3, -7.0)])))
    with pytest.raises(cw.NoGradient, match=r"m\.speed is asked for at a knot that moves"):
        d.simulate(0.3, **TIGHT).gradient(of="m.speed", by="t.torque.times[3]")
    found = d.simulate(0.3, **TIGHT).gradient(of=["a.speed", "m.speed"], by="t.torque.values[2]")
    assert found.problems == ()
