"""What makes derivatives cheap, counted rather than timed, and that it changes none: docs/theory/gradients.md (20)."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.declare.core import derivatives
from support import six_speed

LOOSE: dict[str, Any] = {"rtol": 1e-6, "atol": 1e-8}
T_END, POINTS = 2.0, 40


def launch(points: int = POINTS) -> cw.Driveline:
    """A clutch that pulls a load up over a spring, under a pressure of many points."""
    d = cw.Driveline("launch")
    a, b, c = d.shaft("a", inertia=0.3, speed=150.0), d.shaft("b", inertia=0.1), d.shaft("c", inertia=1.5)
    times = np.linspace(0.0, T_END, points)
    pressure = list(zip(times.tolist(), (1e5 + 4e5 * np.sin(0.7 * times)).tolist(), strict=True))
    law = cw.Exponential(static=0.15, slow=0.13, fast=0.1, speed=20.0)
    d.add(cw.Clutch("k", base=a, follower=b, friction=law, gain=3e-4, pressure=cw.Table(pressure)))
    d.add(cw.SpringDamper("s", base=b, follower=c, stiffness=900.0, damping=3.0))
    d.add(cw.QuadraticTorque("r", shaft=c, nominal_torque=-20.0, nominal_speed=100.0))
    return d


def runs_of(by: list[str] | str, of: str = "c.speed") -> tuple[Any, Any]:
    """Runs with derivatives, and the point of the driveline itself."""
    function = cw.differentiable(launch(), T_END, of=cw.at(of, [0.2, 1.0, T_END]), by=by, **LOOSE)
    runs = function.engine.runs
    return runs, runs.point(function.x0)


def carried(runs: Any, point: Any, seeds: np.ndarray) -> Any:
    """What the core gives for columns of directions."""
    return derivatives().tangents(point.system, point.slopes.places.astype(np.int64), seeds, *runs._how(point))


@pytest.mark.parametrize("count", [2, 8, 9])
def test_a_direction_is_the_same_beside_its_copies(count: int) -> None:
    # the stages of one alone are other code
    runs, point = runs_of(["k.gain"])
    alone = carried(runs, point, point.slopes.matrix)
    among = carried(runs, point, np.repeat(point.slopes.matrix, count, axis=1))
    assert np.abs(alone[3]).max() > 0
    for one, other in ((alone[2], among[2]), (alone[3].repeat(count, axis=2), among[3]), (alone[4], among[4])):
        assert one.tobytes() == other.tobytes()


def test_what_begins_late_is_zero_until_then_and_the_same_beside_what_begins_early() -> None:
    late = f"k.pressure.values[{POINTS // 2}]"
    runs, point = runs_of([late])
    alone = runs.forward(point).tangents[:, :, 0]
    together, beside = runs_of([late, "k.gain"])
    among = together.forward(beside).tangents[:, :, 0]
    assert not alone[:1].any()
    assert alone[-1].any()
    scale = np.abs(among).max(axis=0)
    assert np.all(np.abs(alone - among).max(axis=0) <= 1e-5 * scale)


def test_what_acts_for_a_while_is_zero_until_then_and_goes_on_behind_it() -> None:
    # a clutch that sticks at first, and slips less and less
    model, late = six_speed.gearbox(six_speed.SHIFT).assemble(), "F2.friction.static"
    of = cw.at("w8.speed", [1.0, 2.4, 2.7, 4.0])
    functions = [cw.differentiable(model, 4.0, of=of, by=by, **LOOSE) for by in ([late], [late, "F1.gain"])]
    alone, among = (f.jacobian(f.x0)[:, 0] for f in functions)
    assert alone[0] == 0.0
    assert np.abs(alone - among).max() <= 1e-6 * np.abs(among).max()


def tape_of(model: cw.System, by: str) -> int:
    """Nodes on the tape of a run that is followed back."""
    runs = cw.differentiable(model, 4.0, of="w8.speed", by=by, **LOOSE).engine.runs
    size: int = runs.taped(runs.point(np.array([one.start for one in runs.task.parameters]))).slope.args[0].size
    return size


def test_steps_of_a_run_that_is_followed_back_are_not_those_of_a_table_that_is_shaken() -> None:
    # each part of a step writes as much on the tape; points of unlike signs took 3.4 times as many
    instants, values = zip(*six_speed.SHIFT["F1"], strict=True)
    times = np.linspace(0.0, 4.0, 100)
    points = list(zip(times.tolist(), np.maximum(np.interp(times, instants, values), 2e4).tolist(), strict=True))
    model = six_speed.gearbox({**six_speed.SHIFT, "F1": points}).assemble()
    assert tape_of(model, "F1.pressure.values") < 2.7 * tape_of(model, "F1.gain")


def test_both_ways_agree_on_the_points_of_a_table() -> None:
    runs, point = runs_of("k.pressure.values")
    forward, back = runs.forward(point), runs.taped(point)
    one, columns = forward.primal.functional(), sorted(next(iter(runs.signals.plain.values())).reads())
    one.add(np.array([len(point.grid) - 1]), np.array(columns), np.ones((1, 1)))
    along, followed = forward.slope(one), back.slope(one)
    assert np.abs(along - followed).max() <= 1e-5 * np.abs(along).max()


def test_one_look_ahead_is_as_good_as_two() -> None:
    # steps are the same on both sides of where the second one begins, so what differs is what one look misses
    by = ["k.gain", "k.friction.static", "k.pressure.values[5]", "s.stiffness", "c.inertia"]
    found = []
    for rtol in (1e-8, 0.9999e-8):
        function = cw.differentiable(
            launch(), T_END, of=cw.at("c.speed", [0.2, 1.0, T_END]), by=by, rtol=rtol, atol=1e-10
        )
        found.append(function.gradient().matrix)
    scale = np.abs(found[1]).max(axis=0)
    # derivatives may miss three tolerances in each part
    assert np.all(np.abs(found[0] - found[1]).max(axis=0) <= 3e-8 * scale)


def test_derivatives_by_points_are_those_of_differences() -> None:
    by = [f"k.pressure.values[{number}]" for number in (2, POINTS // 2, POINTS - 3)]
    function = cw.differentiable(launch(), T_END, of="c.speed", by=by, rtol=1e-9, atol=1e-11)
    found, x = function.gradient().matrix[0], function.x0
    for number in range(len(by)):
        step = 1e-3 * x * (np.arange(len(by)) == number)
        slope = (function(x + step)[0] - function(x - step)[0]) / (2 * step[number])
        assert found[number] == pytest.approx(slope, rel=1e-4, abs=1e-6 * np.abs(found).max())
