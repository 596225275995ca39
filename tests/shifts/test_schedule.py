"""Shift schedules: lines, hysteresis, skipped gears."""

from __future__ import annotations

import pytest

import clutchwork as cw
from support.gearboxes import EIGHT_SPEED

UP, DOWN = ((0.0, 180.0), (1.0, 580.0)), ((0.0, 100.0), (1.0, 300.0))


@pytest.fixture(scope="module")
def schedule() -> cw.shifts.ShiftSchedule:
    return cw.shifts.ShiftSchedule.of(cw.Gearbox.from_dict(EIGHT_SPEED), UP, DOWN)


@pytest.mark.parametrize("throttle", [0.0, 0.3, 1.0])
def test_it_shifts_at_its_lines(schedule: cw.shifts.ShiftSchedule, throttle: float) -> None:
    for (before, after), speed in schedule.output_speeds(throttle).items():
        up = schedule.ratios[before] > schedule.ratios[after]
        slower, faster = 0.999 * speed, 1.001 * speed
        assert schedule.gear(before, faster if up else slower, throttle) == after
        assert schedule.gear(before, slower if up else faster, throttle) == before


@pytest.mark.parametrize("throttle", [0.0, 0.5, 1.0])
def test_a_gear_that_was_chosen_stays(schedule: cw.shifts.ShiftSchedule, throttle: float) -> None:
    """Hysteresis: at no speed does the gear that was shifted to ask for another one."""
    for speed in range(5, 700, 5):
        for gear in schedule.ratios:
            chosen = schedule.gear(gear, float(speed), throttle)
            assert schedule.gear(chosen, float(speed), throttle) == chosen


def test_gears_are_skipped_where_asked(schedule: cw.shifts.ShiftSchedule) -> None:
    # 150 rad/s is below the line of gears 4 to 8, whose inputs are slower than 300 rad/s
    assert schedule.gear("8", 150.0, 1.0) == "3"
    one = cw.shifts.ShiftSchedule.of(cw.Gearbox.from_dict(EIGHT_SPEED), UP, DOWN, skips=False)
    assert one.gear("8", 150.0, 1.0) == "7"


def test_reverse_and_neutral_are_left_alone(schedule: cw.shifts.ShiftSchedule) -> None:
    assert schedule.gear("R", -50.0, 0.5) == "R"
    assert schedule.gear("N", 50.0, 0.5) == "N"


def test_lines_that_hunt_are_refused() -> None:
    with pytest.raises(
        cw.ModelError, match="shift 1 to 2: hunts at throttle 0: the shift leaves the input at 120 rad/s"
    ):
        cw.shifts.ShiftSchedule.of(cw.Gearbox.from_dict(EIGHT_SPEED), UP, ((0.0, 170.0), (1.0, 300.0)))
