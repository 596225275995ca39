"""What rests on a point of a table or a border of a law, and leaves it to one side or the other for other numbers."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import clutchwork as cw

TIGHT: dict[str, Any] = {"rtol": 1e-9, "atol": 1e-12}
BENT = [(0.0, 10.0), (100.0, 10.0), (200.0, -10.0)]
TIMES = np.linspace(0.3, 1.0, 20).tolist()


def shaft() -> tuple[cw.Driveline, cw.Shaft]:
    d = cw.Driveline("x")
    return d, d.shaft("e", inertia=0.2, speed=100.0)


def torque_over_speed() -> cw.Driveline:
    d, e = shaft()
    d.add(cw.SpeedTorque("t", shaft=e, torque=BENT))
    d.add(cw.Torque("l", shaft=e, torque=cw.Table([(0.0, -10.0), (0.3, -10.0), (0.6, -5.0)])))
    return d


def coefficients() -> cw.Driveline:
    d, e = shaft()
    law = cw.CoefficientTable(static=0.2, kinetic=[(0.0, 0.1), (100.0, 0.1), (200.0, 0.05)])
    d.add(cw.Brake("b", shaft=e, friction=law, gain=1e-3, pressure=1e5))
    d.add(cw.Torque("t", shaft=e, torque=cw.Table([(0.0, 10.0), (0.3, 10.0), (0.6, 12.0)])))
    return d


def retarder() -> cw.Driveline:
    d, e = shaft()
    d.add(cw.Retarder("b", shaft=e, capacity=1e-3, max_torque=10.0, max_power=1e4, command=1.0))
    d.add(cw.Torque("t", shaft=e, torque=cw.Table([(0.0, 10.0), (0.3, 10.0), (0.6, 12.0)])))
    return d


def prescribed() -> cw.Driveline:
    d = cw.Driveline("x")
    e = d.shaft("e", inertia=0.1)
    speed = cw.Table([(0.0, 0.0), (0.2, 100.0), (0.5, 100.0), (0.8, 150.0)])
    d.add(cw.PrescribedSpeed("p", shaft=e, speed=speed))
    d.add(cw.SpeedTorque("c", shaft=e, torque=[(0.0, 10.0), (100.0, 5.0), (200.0, -20.0)]))
    return d


def many_points() -> cw.Driveline:
    d, e = shaft()
    d.add(cw.SpeedTorque("t", shaft=e, torque=BENT))
    points = [(0.0, -10.0), *((time, -10.0) for time in TIMES)]
    d.add(cw.Torque("l", shaft=e, torque=cw.Table(points)))
    return d


def from_both_sides(model: cw.Driveline, of: str, by: str) -> np.ndarray:
    """Differences from the left and from the right, without what goes with the root of their step."""
    f = cw.differentiable(model, 1.0, of=of, by=by, rtol=1e-12, atol=1e-13)
    x, here = f.x0, f(f.x0)[0]
    step = 1e-5 * np.abs(x)
    slopes = [[(f(x + sign * far * step)[0] - here) / (sign * far * step[0]) for far in (1, 0.25)] for sign in (-1, 1)]
    return np.array([2.0 * near - far for far, near in slopes])


@pytest.mark.parametrize(
    ("make", "of", "by"),
    [
        (coefficients, "e.speed", "b.gain"),
        (retarder, "e.speed", "t.torque.values[2]"),
        (prescribed, "c.work", "p.speed.values[2]"),
    ],
    ids=lambda one: getattr(one, "__name__", str(one)),
)
def test_what_leaves_a_border_for_other_numbers_has_two_sides(make: Any, of: str, by: str) -> None:
    """Though no number moves the border, asked for alone as with others."""
    wanted = from_both_sides(make(), of, by)
    assert abs(wanted[0] - wanted[1]) > 1e-3 * abs(wanted).max()
    with pytest.raises(cw.NoGradient, match="stays at a border of its table or its law"):
        cw.differentiable(make(), 1.0, of=of, by=by, **TIGHT).gradient()
    for side, one in zip(("left", "right"), wanted, strict=True):
        found = cw.differentiable(make(), 1.0, of=of, by=by, side=side, **TIGHT).gradient()
        # it comes back to the border after a time that goes with the root of the distance, which no line follows
        assert found.matrix[0, 0] == pytest.approx(one, rel=1e-4)


def test_a_shaft_that_rests_on_a_point_of_its_torque_has_the_sides_of_both_pieces() -> None:
    """Below 100 rad/s nothing slows it down, above it does; from 0.3 s on it is above whatever the number."""
    times = np.linspace(0.0, 0.6, 6001)
    pushes = np.interp(times, [0.0, 0.3, 0.6], [0.0, 1.0, 0.0]) / 0.2
    for side, free in (("left", 0.3), ("right", 0.0)):
        wanted = np.trapezoid(pushes * np.exp(np.maximum(times, free) - 1.0), times)
        f = cw.differentiable(torque_over_speed(), 1.0, of="e.speed", by="l.torque.values[2]", side=side, **TIGHT)
        assert f.gradient().matrix[0, 0] == pytest.approx(wanted, rel=1e-4 if side == "left" else 1e-6)
    with pytest.raises(cw.NoGradient, match="stays at a border"):
        cw.differentiable(torque_over_speed(), 1.0, of="e.speed", by="l.torque.values[2]", **TIGHT).gradient()


def test_many_points_of_a_table_by_a_run_that_is_followed_back() -> None:
    """From the right no torque falls with the speed, so that each point acts as it would on a free shaft."""
    by = [f"l.torque.values[{number}]" for number in range(1, len(TIMES) + 2)]
    with pytest.raises(cw.NoGradient, match="stays at a border"):
        cw.differentiable(many_points(), 1.0, of="e.speed", by=by, **TIGHT).gradient()
    left = cw.differentiable(many_points(), 1.0, of="e.speed", by=by, side="left", **TIGHT).gradient().matrix[0]
    right = cw.differentiable(many_points(), 1.0, of="e.speed", by=by, side="right", **TIGHT).gradient().matrix[0]
    widths = np.diff([0.0, *TIMES])
    shares = 0.5 * (np.r_[widths, 0.0] + np.r_[0.0, widths]) / 0.2
    # below 100 rad/s the torque is constant, above it falls by 0.2 N m for each rad/s
    np.testing.assert_allclose(left, shares, rtol=1e-6)
    assert np.all(right[:-1] < 0.99 * shares[:-1])


def test_what_leaves_a_border_whatever_the_numbers_has_a_derivative_without_further_runs() -> None:
    """A load that rests on a point of its table until a clutch pulls it away, and one that is held there."""
    for brake in (False, True):
        d = cw.Driveline("x")
        e, load = d.shaft("e", inertia=0.2, speed=100.0), d.shaft("l", inertia=0.8)
        pressure = cw.Table([(0.0, 0.0), (0.2, 0.0), (0.4, 2e5), (1.0, 2e5)])
        law = cw.Coulomb(static=0.125, kinetic=0.1)
        d.add(cw.Clutch("c", base=e, follower=load, friction=law, gain=5e-4, pressure=pressure))
        d.add(cw.SpeedTorque("t", shaft=load, torque=[(-100.0, 0.0), (0.0, 0.0), (100.0, -10.0)]))
        if brake:
            d.add(cw.Brake("b", shaft=load, friction=law, gain=1e-3, pressure=1e6))
        f = cw.differentiable(d, 1.0, of="l.speed" if not brake else "e.speed", by=["c.gain", "e.inertia"], **TIGHT)
        found = f.gradient()
        assert found.problems == ()
        step = 1e-4 * f.x0
        for number, own in enumerate(np.diag(step)):
            slope = (f(f.x0 + own) - f(f.x0 - own)) / (2.0 * step[number])
            np.testing.assert_allclose(found.matrix[:, number], slope, rtol=1e-5)
