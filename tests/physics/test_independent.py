"""The independent solver against closed forms, and clutchwork against hand-written models solved by SciPy."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import clutchwork as cw
from reference import independent
from support.runs import clutch, switches


def constant(name: str, direction: list[float], kinetic: float, static: float | None = None) -> independent.Contact:
    """A contact of constant capacity."""
    return independent.Contact(
        name, np.array(direction), lambda t: 1.0, kinetic if static is None else static, lambda w: kinetic
    )


def nothing(t: float, v: np.ndarray, s: np.ndarray) -> np.ndarray:
    return np.zeros(len(s))


def test_the_independent_solver_on_two_discs() -> None:
    model = independent.Model(
        np.diag([0.2, 0.8]), (constant("c", [-1.0, 1.0], 10.0),), lambda t, v, s: np.zeros(2), nothing
    )
    solution = independent.solve(model, np.array([100.0, 0.0]), np.zeros(0), 2.0)
    assert [(e.contact, e.after) for e in solution.events if e.time > 0] == [("c", independent.LOCKED)]
    assert solution.events[-1].time == pytest.approx(1.6, abs=1e-9)
    assert solution([2.0])[0] == pytest.approx([20.0, 20.0], rel=1e-9)


def test_the_independent_solver_on_stick_slip() -> None:
    """Break-away and re-sticking of the pulled block, as in the closed forms."""
    c, speed, m, hold, slide = 40.0, 0.5, 0.8, 15.0, 10.0
    model = independent.Model(
        np.array([[m]]),
        (constant("f", [1.0], slide, hold),),
        lambda t, v, s: s.copy(),
        lambda t, v, s: np.array([c * (speed - v[0])]),
    )
    solution = independent.solve(model, np.zeros(1), np.zeros(1), 3.0)
    omega = math.sqrt(c / m)
    slip = 2 / omega * (math.pi - math.atan((hold - slide) * omega / (c * speed)))
    start = hold / (c * speed)
    stick = 2 * (hold - slide) / (c * speed)
    expected = [start, start + slip, start + slip + stick, start + 2 * slip + stick]
    assert [e.time for e in solution.events if e.time > 0][:4] == pytest.approx(expected, abs=1e-7)


def test_the_independent_solver_on_parallel_brakes() -> None:
    """10 and 20 N m hold 30 N m together (redundant contacts)."""
    contacts = (constant("b1", [1.0], 10.0), constant("b2", [1.0], 20.0))
    model = independent.Model(np.eye(1), contacts, lambda t, v, s: np.array([29.0]), nothing)
    # least-norm sharing would overload b1, so this needs the bounded problem: enumeration finds the slipping set only
    with pytest.raises(AssertionError, match="no set"):
        independent.solve(model, np.zeros(1), np.zeros(0), 1.0)


@pytest.mark.parametrize("method", ["rodas5p", "dopri5"])
def test_launch_with_elastic_shaft_against_radau(method: str) -> None:
    """Engine, clutch with exponential law and a rising pressure, elastic shaft, vehicle: one phase at a time."""
    Je, Jg, Jv, c, d, drag = 0.25, 0.05, 6.0, 9000.0, 25.0, 0.4
    fast, slow, fade, static = 0.08, 0.13, 15.0, 0.15
    engine_torque = 180.0

    def capacity(t: float) -> float:
        return 400.0 / 0.13 * min(t / 0.8, 1.0)

    def slipping(t: float, y: np.ndarray) -> list[float]:
        we, wg, wv, twist = y
        T = capacity(t) * (fast + (slow - fast) * math.exp(-abs(we - wg) / fade))
        shaft = c * twist + d * (wg - wv)
        return [(engine_torque - T) / Je, (T - shaft) / Jg, (shaft - drag * wv) / Jv, wg - wv]

    def locked(t: float, y: np.ndarray) -> list[float]:
        _, wg, wv, twist = y
        shaft = c * twist + d * (wg - wv)
        together = (engine_torque - shaft) / (Je + Jg)
        return [together, together, (shaft - drag * wv) / Jv, wg - wv]

    def slip(t: float, y: np.ndarray) -> float:
        return y[0] - y[1]

    slip.terminal, slip.direction = True, -1  # type: ignore[attr-defined]
    options = {"method": "Radau", "rtol": 1e-10, "atol": 1e-12, "dense_output": True}
    first = solve_ivp(slipping, (0, 0.8), [100.0, 0.0, 0.0, 0.0], events=slip, max_step=0.01, **options)
    assert first.status == 0
    second = solve_ivp(slipping, (0.8, 6.0), first.y[:, -1], events=slip, max_step=0.01, **options)
    assert second.status == 1
    lock = second.t[-1]
    third = solve_ivp(locked, (lock, 6.0), second.y[:, -1], max_step=0.01, **options)

    m = cw.Driveline("launch")
    e, g, v = m.shaft("e", inertia=Je, speed=100.0), m.shaft("g", inertia=Jg), m.shaft("v", inertia=Jv)
    m.add(cw.Torque("engine", shaft=e, torque=engine_torque))
    law = cw.Exponential(static=static, slow=slow, fast=fast, speed=fade)
    force = cw.Table([(0.0, 0.0), (0.8, 400.0 / 0.13)])
    m.add(cw.Clutch("c", base=g, follower=e, friction=law, gain=1.0, normal_force=force))
    m.add(cw.SpringDamper("k", base=v, follower=g, stiffness=c, damping=d))
    m.add(cw.Damper("drag", base=m.housing, follower=v, damping=drag))
    run = m.simulate(6.0, dt=0.05, method=method, rtol=1e-10, atol=1e-12)
    assert [s[1:] for s in switches(run)] == [("c", "forward", "locked")]
    # 1e-6: asked for against independent solvers
    assert switches(run)[0][0] == pytest.approx(lock, abs=1e-6)
    parts = [(first, 0.0, 0.8), (second, 0.8, lock), (third, lock, 6.0)]
    reference = np.array([next(s.sol(t) for s, a, b in parts if a <= t <= b + 1e-12) for t in run.time])
    for i, name in enumerate(("e.speed", "g.speed", "v.speed", "k.twist")):
        assert np.max(np.abs(run[name] - reference[:, i])) <= 1e-6 * np.max(np.abs(reference[:, i]))


def test_clutch_helper_is_what_it_says() -> None:
    """Constant capacity: static and kinetic torque as given."""
    d = cw.Driveline("helper")
    a = d.shaft("a", inertia=1.0, speed=5.0)
    d.add(clutch("b", d.housing, a, kinetic=3.0, static=4.0))
    run = d.simulate(0.1, times=[0.0])
    assert run["b.torque"][0] == pytest.approx(-3.0)
    assert run["b.capacity"][0] == pytest.approx(4.0)
