"""Derivatives where unrelated things happen at one instant: each moves with numbers of its own."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import clutchwork as cw

T_END = 1.05  # s
TIGHT: dict[str, Any] = {"rtol": 1e-9, "atol": 1e-12}


def two_masses(kind: str) -> tuple[cw.Driveline, list[str], np.ndarray]:
    """Masses m and n, each driven for itself; numbers; derivatives of both positions by them."""
    d = cw.Driveline("apart")
    moving = 0.0 if kind in ("stops", "bounces") else 1.0
    m, n = (d.mass(name, mass=1.0, position=0.0, speed=moving) for name in "mn")
    law = cw.Coulomb(static=1.0, kinetic=1.0)
    if kind in ("stops", "bounces"):
        for mass, end in ((m, "e"), (n, "b")):
            rebound = 0.5 if kind == "bounces" else 0.0
            d.add(cw.EndStop(end, follower=mass, upper=0.2, upper_restitution=rebound))
            d.add(cw.Torque(f"t_{end}", shaft=mass, torque=1.0))
        # 0.2 m are passed in sqrt(0.4) s; behind that a mass bounces at half its speed
        hit, end = np.sqrt(0.4), T_END
        own = 1.0
        if kind == "bounces":
            # x = u + (t - h)^2 / 2 - h (t - h) / 2 with the hit at h = sqrt(2 u)
            rest = end - hit
            own = 1.0 + (-rest - 0.5 * rest + 0.5 * hit) / hit
        return d, ["e.upper", "b.upper"], own * np.eye(2)
    d.add(cw.EndStop("e", follower=m, upper=1.0))
    if kind == "brake":
        d.add(cw.Brake("b", shaft=n, friction=law, gain=1.0, normal_force=1.0))
        # it stops after v^2 / (2 gain) = 0.5 m
        return d, ["e.upper", "b.gain"], np.diag([1.0, -0.5])
    d.add(cw.OneWayClutch("b", base=d.housing, follower=n))
    d.add(cw.Torque("t", shaft=n, torque=-1.0))
    return d, ["e.upper", "t.torque"], np.diag([1.0, 0.5])


@pytest.mark.parametrize("kind", ["stops", "bounces", "brake", "freewheel"])
def test_a_stop_and_what_has_nothing_to_do_with_it(kind: str) -> None:
    d, by, wanted = two_masses(kind)
    for side in (None, "left", "right"):
        found = cw.differentiable(d, T_END, of=["m.position", "n.position"], by=by, side=side, **TIGHT)
        np.testing.assert_allclose(found.gradient().matrix, wanted, rtol=1e-6, atol=1e-6)


def test_two_freewheels_that_close_at_one_instant() -> None:
    d = cw.Driveline("apart")
    for name in "mn":
        mass = d.mass(name, mass=1.0, position=0.0, speed=1.0)
        d.add(cw.OneWayClutch(f"f_{name}", base=d.housing, follower=mass))
        d.add(cw.Torque(f"t_{name}", shaft=mass, torque=-1.0))
    of = [cw.lock("f_m"), cw.lock("f_n")]
    found = cw.differentiable(d, 1.5, of=of, by=["t_m.torque", "t_n.torque"], **TIGHT).gradient().matrix
    # each stops after v / t
    np.testing.assert_allclose(found, np.eye(2), rtol=1e-6, atol=1e-6)


def test_a_gear_and_the_brake_of_its_shaft_stop_as_one() -> None:
    """Inertias and ratio are round: the words that an inertia reaches are more than those of the masses."""
    d = cw.Driveline("train")
    a, b = d.shaft("a", inertia=1.0, speed=10.0), d.shaft("b", inertia=1.0)
    d.add(cw.LossyGear("gear", input=a, output=b, ratio=2.0, efficiency=0.97))
    law = cw.Coulomb(static=1.0, kinetic=1.0)
    d.add(cw.Brake("brake", shaft=a, friction=law, gain=1.0, normal_force=20.0))
    found = cw.differentiable(d, 1.0, of="a.angle", by=["a.inertia", "b.inertia", "brake.gain"], **TIGHT).gradient()
    assert found.problems == ()
    f = cw.differentiable(d, 1.0, of="a.angle", by=["a.inertia", "b.inertia", "brake.gain"], rtol=1e-11, atol=1e-13)
    steps = 1e-5 * np.eye(3)
    wanted = [(f(f.x0 + step)[0] - f(f.x0 - step)[0]) / 2e-5 for step in steps]
    np.testing.assert_allclose(found.matrix[0], wanted, rtol=1e-6)
