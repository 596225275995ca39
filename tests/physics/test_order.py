"""Observed orders of both methods, in a smooth phase and across events.

Tolerances so loose that every step is accepted leave `max_step` as the step. The error is the root mean square over all
speeds at four end times, which evens out zero crossings of single errors and how an event falls into its step. The
order is the slope over eight step sizes. For it to show, the leading term of a method's error has to lead: quadratic
drag makes it so for Rodas5P (on nearly linear models it converges with order 6), a stiffer spring for DOPRI5.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import clutchwork as cw

ENDS = (0.5, 0.65, 0.8, 1.0)
STEPS = [0.01 * 0.85**i for i in range(8)]

# stiffness of the spring [N m/rad] and drag [N m at 60 rad/s]
MODELS = {"rodas5p": (30.0, 200.0), "dopri5": (120.0, 5.0)}


def driveline(method: str, events: bool) -> cw.Driveline:
    """Two discs on a spring, driven by a sine, with exponential friction: on a third disc it locks and breaks away."""
    stiffness, drag = MODELS[method]
    d = cw.Driveline("order")
    a, b = d.shaft("a", inertia=0.3, speed=60.0), d.shaft("b", inertia=0.5, speed=20.0 if events else 50.0)
    c = d.shaft("c", inertia=0.4, speed=0.0 if events else -300.0)
    d.add(cw.SpringDamper("k", base=a, follower=b, stiffness=stiffness, damping=0.4))
    d.add(cw.Torque("drive", shaft=a, torque=cw.Sine(amplitude=90.0, frequency=1.3)))
    d.add(cw.QuadraticTorque("drag", shaft=a, nominal_torque=-drag, nominal_speed=60.0))
    law = cw.Exponential(static=0.16, slow=0.14, fast=0.065, speed=30.0)
    d.add(cw.Clutch("f", base=b, follower=c, friction=law, gain=1.0, normal_force=190.0))
    return d


def ends(method: str, events: bool, step: float | None) -> tuple[np.ndarray, int]:
    """Speeds at all end times, and the number of events until the last."""
    fixed: dict[str, Any] = {"rtol": 0.1, "atol": 1e6, "first_step": step, "max_step": step}
    exact: dict[str, Any] = {"rtol": 1e-13, "atol": 1e-13}
    found, count = [], 0
    for t in ENDS:
        run = driveline(method, events).simulate(t, dt=t, method=method, **(exact if step is None else fixed))
        found.append([run[f"{n}.speed"][-1] for n in "abc"])
        count = len(run.events.changes())
    return np.array(found), count


@pytest.mark.parametrize("method", MODELS)
@pytest.mark.parametrize("events", [False, True])
def test_order(method: str, events: bool) -> None:
    exact, count = ends(method, events, None)
    assert bool(count) == events
    errors = []
    for step in STEPS:
        speeds, same = ends(method, events, step)
        assert same == count
        errors.append(np.sqrt(np.mean((speeds - exact) ** 2)))
    slope = np.polyfit(np.log(STEPS), np.log(errors), 1)[0]
    # within 0.2 of the nominal 5: asked for
    assert slope == pytest.approx(5.0, abs=0.2), errors


def heated(t: float, step: float | None) -> float:
    """Temperature of a lining that a brake heats with a force over time, and that an ambient cools."""
    d = cw.Driveline("heated")
    a = d.shaft("a", inertia=0.3)
    lining, air = d.thermal("lining", capacity=20.0, temperature=300.0), d.ambient("air", temperature=300.0)
    d.add(cw.PrescribedSpeed("drive", shaft=a, speed=10.0))
    force = cw.Sine(amplitude=80.0, frequency=1.3, offset=100.0)
    law = cw.Coulomb(static=0.2, kinetic=0.2)
    d.add(cw.Brake("b", shaft=a, friction=law, gain=1.0, normal_force=force, heat=lining))
    d.add(cw.Conduction("wall", hot=lining, cold=air, conductance=100.0))
    exact: dict[str, Any] = {"rtol": 1e-13, "atol": 1e-13}
    fixed: dict[str, Any] = {"rtol": 0.1, "atol": 1e6, "first_step": step, "max_step": step}
    run = d.simulate(t, dt=t, method="rodas5p", **(exact if step is None else fixed))
    return float(run["lining.temperature"][-1])


def test_order_where_heat_changes_over_time() -> None:
    """The implicit step has the order of its name where it knows how the heat changes with the force."""
    steps = [5.0 * step for step in STEPS]
    exact = np.array([heated(t, None) for t in ENDS])
    errors = [np.sqrt(np.mean((np.array([heated(t, step) for t in ENDS]) - exact) ** 2)) for step in steps]
    assert np.polyfit(np.log(steps), np.log(errors), 1)[0] == pytest.approx(5.0, abs=0.2), errors
