"""The method that is chosen for a phase: explicit where nothing is stiff, handed over where the motion becomes so."""

from __future__ import annotations

from typing import Any

import pytest

import clutchwork as cw

WIDE: dict[str, Any] = {"dt": 2.0, "rtol": 1e-6, "atol": 1e-8}


def damped(damping: float) -> cw.Driveline:
    """A disc on a damper under a constant torque."""
    d = cw.Driveline("damped")
    a = d.shaft("a", inertia=1.0, speed=100.0)
    d.add(cw.Torque("t", shaft=a, torque=1e4))
    d.add(cw.Damper("c", base=d.housing, follower=a, damping=damping))
    return d


def rising() -> cw.Driveline:
    """A drag that grows with the speed: soft at rest, with rates of 2e4 per second at 100 rad/s, in one phase."""
    d = cw.Driveline("rising")
    a = d.shaft("a", inertia=1.0, speed=0.0)
    d.add(cw.Torque("t", shaft=a, torque=cw.Table([(0.0, 1.0), (4.0, 2e6)])))
    d.add(cw.QuadraticTorque("drag", shaft=a, nominal_torque=-1e6, nominal_speed=100.0))
    return d


def evaluations(run: cw.Trajectory) -> tuple[int, int]:
    """Accepted steps, and evaluations in all: six for an explicit step, seven for an implicit one."""
    return run.statistics["steps"], run.statistics["evaluations"]


def test_a_motion_that_becomes_stiff_is_handed_over() -> None:
    model = rising()
    chosen, implicit, explicit = (model.simulate(2.0, method=m, **WIDE) for m in ("auto", "rodas5p", "dopri5"))
    assert chosen["a.speed"][-1] == pytest.approx(implicit["a.speed"][-1], rel=1e-6)
    assert chosen["a.speed"][-1] == pytest.approx(explicit["a.speed"][-1], rel=1e-6)
    # without the change it takes the steps of the explicit method, which stability holds
    assert chosen.statistics["steps"] < 0.2 * explicit.statistics["steps"]


def test_a_soft_motion_takes_explicit_steps() -> None:
    model = damped(0.0)
    chosen, explicit = (model.simulate(2.0, method=m, **WIDE) for m in ("auto", "dopri5"))
    assert evaluations(chosen) == evaluations(explicit)


def test_a_stiff_motion_takes_implicit_steps() -> None:
    model = damped(1e4)
    chosen, implicit = (model.simulate(2.0, method=m, **WIDE) for m in ("auto", "rodas5p"))
    assert evaluations(chosen) == evaluations(implicit)
