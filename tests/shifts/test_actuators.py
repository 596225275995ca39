"""Controllers through valves and pistons: fill tests against closed forms, all shifts of a box, learnt fill times."""

from __future__ import annotations

from itertools import permutations

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.shifts.driver import ActuatorDriver
from support.eight_speed_shifts import BOX, felt, qualities, shift
from support.shift_car import car, hydraulic

FORWARD = [gear for gear, ratio in BOX.ratios.items() if ratio > 0.0]


def fill(known: cw.shifts.Learnt | float) -> float:
    """A fill time [s] that was given or learnt."""
    return known.fill_time if isinstance(known, cw.shifts.Learnt) else known


def test_a_fill_test_finds_what_was_declared() -> None:
    """Of a piston with a lag: its spring, its fill time at the full command, its lag, its torque."""
    found = cw.shifts.fill_test(hydraulic(BOX, "3", pistons=True).assemble(), BOX)
    plant = cw.shifts.plant_of(car(BOX, "3").assemble(), BOX)
    assert sorted(found) == list("ABCDE")
    for name, one in found.items():
        assert one.signal == f"{name}_piston.command"
        # a line through two steps of the stair
        assert one.kiss == pytest.approx(5e4, rel=2e-3)
        # 0.1 s at 0.5 MPa above the spring, hence 0.05 s at 1 MPa; it may touch softly
        assert one.fill_time == pytest.approx(0.05, abs=1e-3)
        assert one.lag == pytest.approx(0.03, rel=0.05)
        # the stair stays 0.25 s on each step, 8 lags
        assert one.most == pytest.approx(plant.capacity[name] * 1e6, rel=5e-3)
        middle = 0.5 * one.most
        assert one.command(middle) == pytest.approx(5e4 + middle / plant.capacity[name], rel=5e-3)


def test_a_fill_test_of_valves_and_pistons() -> None:
    """Its kiss point is that of the springs, its fill time about that of the orifice with the valve's lag on top."""
    model = hydraulic(BOX, "3")
    found = cw.shifts.fill_test(model.assemble(), BOX)
    piston = next(one for one in model.elements if one.name == "A_piston")
    assert isinstance(piston, cw.ClutchActuator)
    for one in found.values():
        assert one.signal.endswith("_valve.current")
        # no force below, 0.9 A for 1 MPa; a step of the stair is 0.025 A
        assert one.kiss == pytest.approx(0.1 + 0.9 * piston.kiss_pressure / 1e6, abs=0.013)
        # behind the pulse the valve's pressure falls with its lag, so it may be shorter by two of these
        assert one.fill_time == pytest.approx(piston.fill_time(1e6), abs=2.0 * 0.015)


def test_elements_that_are_pressed_directly_have_none() -> None:
    assert cw.shifts.fill_test(car(BOX, "3").assemble(), BOX) == {}
    system = hydraulic(BOX, "3", pistons=True).assemble()
    limits = {f"{name}_piston.command": (0.0, 1e3) for name in "ABCDE"}
    with pytest.raises(cw.UseError, match="no command closes A, B, C, D, E; give `limits`"):
        cw.shifts.fill_test(system, BOX, limits=limits)


def test_no_more_is_asked_for_than_is_wanted() -> None:
    """Led valves and pistons overshoot: on a ramp the torque stays behind by the lag and a period, and never ahead."""
    lag, period, slope = 0.04, 0.01, 500.0
    one = cw.shifts.ElementActuator("x.command", (0.0, 1e6), (0.0, 1e3), 0.0, 0.0, lag)
    driver, torque, worst = ActuatorDriver(one, 0.0, 0.0, level=1.0), 0.0, 0.0
    for number in range(40):
        time = number * period
        command = driver.command(slope * time, period if number else 0.0, period, open_=False)
        torque += (command / 1e3 - torque) * (1.0 - np.exp(-period / lag))
        behind = slope * (time + period) - torque
        worst = max(worst, behind)
        assert behind > 0.0
    assert worst < slope * (lag + period)


@pytest.mark.parametrize("pistons", [False, True])
def test_all_shifts_through_valves_and_pistons(pistons: bool) -> None:
    """Each gear is reached, with power and without; jerk and hole are those of direct pressure within 20 %."""
    pairs = list(permutations(FORWARD, 2))
    _, jerk, hole = felt(lambda gear, at: car(BOX, gear, at), pairs)
    count, late, hole_late = felt(lambda gear, at: hydraulic(BOX, gear, at, pistons=pistons), pairs)
    assert count == 112
    assert late < 1.2 * jerk
    assert hole_late < 1.2 * hole


@pytest.mark.parametrize("pistons", [False, True])
@pytest.mark.parametrize("wrong", [0.7, 1.3])
@pytest.mark.parametrize(("pair", "pedal"), [(("3", "4"), 0.3), (("5", "4"), 0.0), (("2", "3"), 0.5)])
def test_a_wrong_fill_time_is_learnt(pair: tuple[str, str], pedal: float, wrong: float, pistons: bool) -> None:
    """After 20 shifts it is as good as with the right one."""
    model = hydraulic(BOX, pair[0], pistons=pistons).assemble()
    plant = cw.shifts.plant_of(model, BOX)
    times = {name: one.fill_time for name, one in plant.actuators.items()}
    (right,) = qualities(shift(model, *pair, pedal, plant=plant)[0])
    known: dict[str, cw.shifts.Learnt | float] = {name: wrong * time for name, time in times.items()}
    (first,) = qualities(shift(model, *pair, pedal, plant=plant, known=known)[0])
    for _ in range(20):
        _, control = shift(model, *pair, pedal, plant=plant, known=known)
        known = dict(control.learnt)
    (last,) = qualities(shift(model, *pair, pedal, plant=plant, known=known)[0])
    (closes,) = last.shift.closes
    assert fill(known[closes]) == pytest.approx(times[closes], rel=0.1)
    # a period of the controller later or earlier
    assert last.peak_jerk < max(1.3 * right.peak_jerk, right.peak_jerk + 1.0)
    assert last.torque_hole < right.torque_hole + 30.0
    assert last.peak_jerk < first.peak_jerk
    # what is not asked for stays as it was
    unused = next(name for name in times if name not in (*last.shift.closes, *last.shift.opens))
    assert fill(known[unused]) == wrong * times[unused]


def test_nothing_is_learnt_where_that_is_not_wanted() -> None:
    model = hydraulic(BOX, "3").assemble()
    plant = cw.shifts.plant_of(model, BOX)
    known = {name: 1.3 * one.fill_time for name, one in plant.actuators.items()}
    still = cw.shifts.ShiftSettings(adaptation=0.0)
    _, control = shift(model, "3", "4", 0.3, plant=plant, known=known, settings=still)
    assert {name: one.fill_time for name, one in control.learnt.items()} == known
    assert {name: one.kiss for name, one in control.learnt.items()} == {n: a.kiss for n, a in plant.actuators.items()}
