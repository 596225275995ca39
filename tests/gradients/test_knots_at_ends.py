"""Knots that move at the start or at the end of a run: what each side of them gives, by closed forms."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import clutchwork as cw

TIGHT: dict[str, Any] = {"rtol": 1e-9, "atol": 1e-12}


def driven(torque: Any) -> cw.Driveline:
    d = cw.Driveline("x")
    a = d.shaft("a", inertia=1.0)
    d.add(cw.Torque("t", shaft=a, torque=torque))
    return d


def moved(speed: Any) -> cw.Driveline:
    d = cw.Driveline("x")
    a = d.mass("a", mass=5.0)
    d.add(cw.PrescribedSpeed("t", shaft=a, speed=speed))
    return d


def sides(model: cw.Driveline, t_end: float, of: Any, by: str) -> np.ndarray:
    """Derivatives from the left and from the right."""
    found = [cw.differentiable(model, t_end, of=of, by=by, side=side, **TIGHT).gradient() for side in ("left", "right")]
    return np.array([one.matrix[:, 0] for one in found])


def refused(model: cw.Driveline, t_end: float, of: Any, by: str, words: str) -> None:
    f = cw.differentiable(model, t_end, of=of, by=by, **TIGHT)
    with pytest.raises(cw.NoGradient, match=words):
        f.gradient()


def test_an_integral_ends_at_a_knot_as_the_work_does() -> None:
    # 1 N m, and 10 N m more from the end on: an earlier step adds them for that time, at 0.5 rad/s
    model = driven(cw.Step(height=10.0, start=0.5, offset=1.0))
    of = [cw.integral("t.power"), "t.work", cw.integral("a.acceleration")]
    refused(model, 0.5, of, "t.torque.start", "is asked for at a knot that moves")
    np.testing.assert_allclose(sides(model, 0.5, of, "t.torque.start"), [[-5, -5, -10], [0, 0, 0]], atol=1e-9)


@pytest.mark.parametrize("kind", ["integral", "work"])
def test_a_prescribed_speed_that_ends_with_the_run(kind: str) -> None:
    # from 4 m/s to 0 in half a second: what ends later is not yet still, what ends earlier stays still
    model = moved(cw.Table([(0.0, 4.0), (0.5, 2.0)]))
    of = cw.integral("a.acceleration") if kind == "integral" else "t.work"
    refused(model, 0.5, of, "t.speed.times[2]", "is asked for at a knot that moves")
    later = 4.0 if kind == "integral" else 5.0 * 2.0 * 4.0
    np.testing.assert_allclose(sides(model, 0.5, of, "t.speed.times[2]"), [[0.0], [later]], atol=1e-8)


def test_a_prescribed_speed_that_begins_with_the_run() -> None:
    # a = -4 m/s2: for an earlier knot the run begins at a lower speed, for a later one at the same
    model = moved(cw.Table([(0.0, 4.0), (1.0, 0.0)]))
    of = [cw.integral("a.acceleration"), "t.work"]
    refused(model, 0.5, of, "t.speed.times[1]", "has a knot at 0 s, where the run begins, that moves")
    found = sides(model, 0.5, of, "t.speed.times[1]")
    # the speed at the end grows by 2 m/s for each second, that at the start by 4 on one side
    np.testing.assert_allclose(found, [[2.0 - 4.0, 5.0 * (2.0 * 2.0 - 4.0 * 4.0)], [2.0, 5.0 * 2.0 * 2.0]], rtol=1e-8)
    alone = cw.differentiable(model, 0.5, of="a.speed", by="t.speed.times[1]", **TIGHT).gradient()
    np.testing.assert_allclose(alone.matrix, 2.0, rtol=1e-8)


def test_a_torque_that_jumps_where_the_run_begins() -> None:
    # 5 N m more from the start on, or a little later
    model = driven(cw.Table([(-1.0, 5.0), (0.0, 5.0), (0.0, 10.0), (1.0, 10.0)]))
    refused(model, 0.5, "a.speed", "t.torque.times[2]", "where the run begins, that moves")
    np.testing.assert_allclose(sides(model, 0.5, "a.speed", "t.torque.times[2]"), [[0.0], [-5.0]], atol=1e-9)


def test_a_torque_that_bends_where_the_run_begins_costs_no_further_run() -> None:
    model = driven(cw.Table([(-1.0, 5.0), (0.0, 5.0), (1.0, 10.0)]))
    f = cw.differentiable(model, 0.5, of=["a.speed", cw.integral("t.power")], by="t.torque.times[2]", **TIGHT)
    engine = f.engine
    point = engine.runs.point(f.x0)
    assert engine._doubts(point, *engine.lines(point)) == []
    # the slope is 5 / (1 - s) from s on
    assert f.jacobian(f.x0)[0, 0] == pytest.approx(-5.0 * 0.5 + 5.0 * 0.5**2 / 2.0, rel=1e-9)


@pytest.mark.parametrize("kind", [cw.minimum, cw.maximum])
def test_an_extreme_behind_a_jump_that_comes_before_the_end(kind: Any) -> None:
    # from 5 to 10 N m; for an earlier knot the acceleration falls to 2 rad/s2 within the run
    model = driven(cw.Table([(0.0, 5.0), (0.5, 10.0), (0.5, 2.0), (1.0, 0.0)]))
    of = kind("a.acceleration")
    refused(model, 0.5, of, "t.torque.times[2]", "has a kink at 0")
    right = cw.differentiable(model, 0.5, of=of, by="t.torque.times[2]", side="right", **TIGHT)
    wanted = 0.0 if kind is cw.minimum else -10.0
    assert right.gradient().matrix[0, 0] == pytest.approx(wanted, abs=1e-8)
    left = cw.differentiable(model, 0.5, of=of, by="t.torque.times[2]", side="left", **TIGHT)
    if kind is cw.minimum:
        # it jumps
        with pytest.raises(cw.NoGradient):
            left.gradient()
    else:
        assert left.gradient().matrix[0, 0] == pytest.approx(0.0, abs=1e-8)
