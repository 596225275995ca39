"""Derivatives along a step, in as many parts as they need: docs/theory/gradients.md (20), (21).

What a plain step leaves for them, and what a part leaves for the next, holds under conditions; each has a driveline
here that does not fulfil it.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from support import by_differences

LOOSE: dict[str, Any] = {"rtol": 1e-6, "atol": 1e-8}
# of a run at 1e-6: what its derivatives may miss of their scale
ALLOWED = 1e-5


def wrong(model: cw.Driveline, t_end: float, of: list[str], by: list[str]) -> list[str]:
    """Derivatives that are not those of differences of tight runs."""
    function = cw.differentiable(model, t_end, of=of, by=by, **LOOSE)
    scales = by_differences.scales(model.simulate(t_end, rtol=1e-8), function.task.outputs)
    found = by_differences.compared(function, function.gradient().matrix, scales)
    assert len(found) == len(by)
    assert all(np.all(one.doubt < 0.1 * ALLOWED) for one in found)
    return [f"{one.name}: {one.missed}" for one in found if not np.all(one.missed < ALLOWED)]


def geared(ratio: float = 2.5) -> cw.Driveline:
    """Two wheels in gear, of which one is held by a spring and braked."""
    d = cw.Driveline("geared")
    a, b, c = d.shaft("a", inertia=0.4, speed=20.0), d.shaft("b", inertia=0.3), d.shaft("c", inertia=1.0)
    d.add(cw.Gear("g", input=a, output=b, ratio=ratio))
    d.add(cw.SpringDamper("k", base=b, follower=c, stiffness=150.0, damping=1.0))
    d.add(cw.QuadraticTorque("r", shaft=c, nominal_torque=-20.0, nominal_speed=10.0))
    return d


@pytest.mark.parametrize("start", [0.0, 30.0])
def test_a_part_has_a_factor_of_its_own(start: float) -> None:
    # in balance the run has nothing to resolve, and its steps are long; a derivative swings
    inertia, stiffness, damping = 0.5, 200.0, 2.0
    d = cw.Driveline("balance")
    a = d.shaft("a", inertia=inertia)
    twist = start / stiffness
    spring = {"stiffness": stiffness, "damping": damping, "initial_twist": twist}
    d.add(cw.SpringDamper("k", base=d.housing, follower=a, **spring))
    d.add(cw.Torque("t", shaft=a, torque=start))
    t_end = 1.0
    decay, swing = damping / (2 * inertia), np.sqrt(stiffness / inertia - (damping / (2 * inertia)) ** 2)
    found = cw.differentiable(d, t_end, of="a.speed", by="t.torque", **LOOSE).gradient().matrix[0, 0]
    exact = np.exp(-decay * t_end) * np.sin(swing * t_end) / (inertia * swing)
    assert found == pytest.approx(exact, abs=ALLOWED / (inertia * swing))


def test_a_part_behind_a_tie_looks_at_its_slopes_again() -> None:
    d = cw.Driveline("tied")
    a, b, c = d.shaft("a", inertia=0.4, speed=20.0), d.shaft("b", inertia=0.3, speed=10.0), d.shaft("c", inertia=1.0)
    ratio = cw.Table([(0.0, 2.0), (0.4, 1.2), (1.0, 2.5)])
    d.add(cw.VariableRatio("v", input=a, output=b, ratio=ratio))
    d.add(cw.SpringDamper("k", base=b, follower=c, stiffness=400.0, damping=0.5))
    by = ["a.inertia", "v.ratio.values[2]", "k.stiffness", "c.inertia"]
    assert wrong(d, 1.0, ["a.speed", "c.speed"], by) == []


def test_rates_follow_ratios() -> None:
    assert wrong(geared(), 1.0, ["a.speed", "c.speed", "k.torque"], ["g.ratio"]) == []


def test_masses_follow_inertias() -> None:
    assert wrong(geared(), 1.0, ["a.speed", "c.speed", "k.torque"], ["a.inertia", "b.inertia", "c.inertia"]) == []


def test_steps_are_those_of_a_run_with_work() -> None:
    # nothing but the sine limits the steps: with work to a half, without to three halves of a radian
    d = cw.Driveline("ripple")
    a = d.shaft("a", inertia=50.0, speed=20.0)
    d.add(cw.Torque("t", shaft=a, torque=cw.Sine(amplitude=5.0, frequency=3.0)))
    d.add(cw.QuadraticTorque("r", shaft=a, nominal_torque=-20.0, nominal_speed=10.0))
    run = d.simulate(2.0, rtol=1e-3, atol=1e-5, method="rodas5p")
    found = run.gradient(of="a.speed", by="a.inertia")
    # steps of another length change it by 1e-8
    assert found.values[0] == pytest.approx(run["a.speed"][-1], rel=1e-12)
