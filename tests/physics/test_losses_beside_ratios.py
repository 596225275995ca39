"""Friction that follows a load beside ratios that vary."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import clutchwork as cw

FINE: dict[str, Any] = {"rtol": 1e-10, "atol": 1e-12}
# the integration of both keeps this
CLOSE = 1e-8


def test_a_ratio_that_ramps_before_a_lossy_gear() -> None:
    """With w the speed between: (i2 J1 + J2 + J3/(e n2)) w' = i T - R/(e n) - i i' J1 w while the gear is driven."""
    first, middle, last, torque, load, n, efficiency = 0.2, 0.05, 3.0, 90.0, 40.0, 3.0, 0.9
    t_end = 1.0
    d = cw.Driveline("cvt and axle")
    a = d.shaft("a", inertia=first, speed=300.0)
    b = d.shaft("b", inertia=middle, speed=150.0)
    c = d.shaft("c", inertia=last, speed=50.0)
    d.add(cw.VariableRatio("cvt", input=a, output=b, ratio=cw.Table([(0.0, 2.0), (t_end, 1.2)])))
    d.add(cw.LossyGear("axle", input=b, output=c, ratio=n, efficiency=efficiency))
    d.add(cw.Torque("drive", shaft=a, torque=torque))
    d.add(cw.Torque("load", shaft=c, torque=-load))
    run = d.simulate(t_end, dt=0.05, **FINE)
    slope = (1.2 - 2.0) / t_end

    def rate(t: float, w: Any) -> Any:
        i = 2.0 + slope * t
        inertia = i * i * first + middle + last / (efficiency * n * n)
        return (i * torque - load / (efficiency * n) - i * slope * first * w) / inertia

    found = solve_ivp(rate, (0.0, t_end), [150.0], method="DOP853", rtol=1e-12, atol=1e-12, t_eval=run.time)
    assert np.max(np.abs(run["b.speed"] - found.y[0])) < CLOSE * 300.0
    # what goes in and what comes out
    i = 2.0 + slope * run.time
    inside = run["axle.torque_input"]
    assert run["axle.torque_output"] == pytest.approx(-n * efficiency * inside, rel=1e-9)
    assert -i * run["cvt.torque"] == pytest.approx(-inside + middle * run["b.acceleration"], rel=1e-9)


def twins(ratio: float, **how: Any) -> tuple[Any, Any]:
    """A driveline with a varying ratio that stays, and with a gear of that ratio."""
    runs = []
    for varying in (True, False):
        d = cw.Driveline("twin")
        a, b, c = d.shaft("a", inertia=0.3), d.shaft("b", inertia=0.05), d.shaft("c", inertia=1.0)
        e = d.shaft("e", inertia=0.5)
        if varying:
            d.add(cw.VariableRatio("first", input=a, output=b, ratio=ratio))
        else:
            d.add(cw.Gear("first", input=a, output=b, ratio=ratio))
        how["second"](d, b, c)
        d.add(cw.SpringDamper("shaft", base=c, follower=e, stiffness=800.0, damping=0.3))
        d.add(cw.BearingFriction("drag", shaft=e, torque=6.0, friction=cw.Coulomb(static=1.2, kinetic=1.0)))
        d.add(cw.Torque("drive", shaft=a, torque=cw.Sine(amplitude=25.0, frequency=1.7, offset=4.0)))
        d.add(cw.Torque("load", shaft=e, torque=cw.Sine(amplitude=30.0, frequency=0.6)))
        runs.append(d.simulate(2.0, dt=0.01, **FINE))
    return runs[0], runs[1]


def lossy(d: cw.Driveline, b: Any, c: Any) -> None:
    d.add(cw.LossyGear("second", input=b, output=c, ratio=-2.5, efficiency=0.85, backward_efficiency=0.7))


def worm(d: cw.Driveline, b: Any, c: Any) -> None:
    d.add(cw.WormGear("second", worm=b, wheel=c, ratio=12.0, lead_angle=0.3, friction_coefficient=0.1))


def limited_slip(d: cw.Driveline, b: Any, c: Any) -> None:
    other = d.shaft("other", inertia=0.4)
    d.add(cw.Differential("second", carrier=b, left=c, right=other, bias=2.5, preload=3.0))
    d.add(cw.Damper("grip", base=d.housing, follower=other, damping=0.8))


@pytest.mark.parametrize("second", [lossy, worm, limited_slip], ids=lambda f: f.__name__)
@pytest.mark.parametrize("ratio", [1.7, -0.6])
def test_a_ratio_that_stays_is_a_gear(second: Any, ratio: float) -> None:
    """The gear is a row of the fixed kind, the transmission one of the other: the same motion and the same events."""
    varying, fixed = twins(ratio, second=second)
    assert len(varying.events) > 0
    assert [(e.element, e.before, e.after) for e in varying.events] == [
        (e.element, e.before, e.after) for e in fixed.events
    ]
    for name in ("a.speed", "e.speed", "second.torque" if "second.torque" in fixed else "c.speed"):
        scale = np.max(np.abs(fixed[name]))
        assert np.max(np.abs(varying[name] - fixed[name])) < CLOSE * scale, name


def test_a_lossy_gear_at_a_shaft_that_follows() -> None:
    """Between a joint and the gear there is no inertia: the gear decides along a direction that varies."""
    d = cw.Driveline("bare shaft")
    a, b, c = d.shaft("a", inertia=0.3, speed=40.0), d.shaft("b"), d.shaft("c", inertia=0.7, speed=20.0)
    d.add(cw.VariableRatio("first", input=a, output=b, ratio=1.0))
    d.add(cw.LossyGear("second", input=b, output=c, ratio=2.0, efficiency=0.8, backward_efficiency=0.75))
    d.add(cw.Torque("drive", shaft=a, torque=cw.Sine(amplitude=30.0, frequency=1.0)))
    run = d.simulate(1.0, dt=0.01, **FINE)
    plain = cw.Driveline("without")
    a, c = plain.shaft("a", inertia=0.3, speed=40.0), plain.shaft("c", inertia=0.7, speed=20.0)
    plain.add(cw.LossyGear("second", input=a, output=c, ratio=2.0, efficiency=0.8, backward_efficiency=0.75))
    plain.add(cw.Torque("drive", shaft=a, torque=cw.Sine(amplitude=30.0, frequency=1.0)))
    same = plain.simulate(1.0, dt=0.01, **FINE)
    assert np.max(np.abs(run["c.speed"] - same["c.speed"])) < CLOSE * 20.0
    assert abs(run.energy.residual) <= 1e-8 * run.energy.turnover


def test_a_clutch_of_a_ratio_passes_zero_slip_beside_locked_contacts_that_depend_on_one_another() -> None:
    """A brake and a limited slip hold a shaft together; they have no part in a mass that a spring drives on."""
    d = cw.Driveline("apart")
    m, end = d.mass("m", mass=11.5, speed=8.33), d.mass("end", mass=6.58)
    d.add(cw.ElasticBacklash("k", base=m, follower=end, stiffness=41.7e3, gap=0.006, initial_twist=-0.0222))
    capacity = 115.0
    d.add(cw.VariableRatio("v", input=m, output=d.housing, ratio=1.0, capacity=capacity, locked=False))
    a, b = d.shaft("a", inertia=1.0), d.shaft("b", inertia=1.0)
    d.add(cw.LimitedSlip("lsd", carrier=a, left=b, right=d.housing))
    d.add(
        cw.Clutch(
            "brake",
            base=d.housing,
            follower=a,
            friction=cw.Coulomb(static=0.1, kinetic=0.1),
            gain=1.0,
            normal_force=1.0,
        )
    )
    run = d.simulate(0.6)
    passed = run.events.of("v")[0]
    assert (passed.before, passed.after) == ("forward", "backward")
    assert np.max(np.abs(run["v.torque"])) <= capacity * (1.0 + 1e-9)
    assert abs(run.energy.residual) <= 1e-6 * run.energy.turnover
