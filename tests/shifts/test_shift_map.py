"""Shift maps: each line where it is drawn, no hunting, kickdown, inhibits, skips, files; a drive that follows one."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.shifts import Inhibit, Measured, ShiftMap
from support.shift_car import FINAL_DRIVE, RADIUS, SENSED, car

BOX = cw.Gearbox.load("zf-8hp70")
GEARS = [gear for gear, ratio in sorted(BOX.ratios.items(), key=lambda pair: -pair[1]) if ratio > 0.0]
RATIOS = {gear: BOX.ratios[gear] for gear in GEARS}
# turbine 170 rad/s light to 550 rad/s full up, 100 to 300 down, as speeds of the output
UP = {pair: ((0.0, 170.0 / RATIOS[pair[0]]), (1.0, 550.0 / RATIOS[pair[0]])) for pair in pairwise(GEARS)}
DOWN = {pair: ((0.0, 100.0 / RATIOS[pair[0]]), (1.0, 300.0 / RATIOS[pair[0]])) for pair in pairwise(GEARS[::-1])}


def now(output: float, pedal: float = 0.5, **more: float) -> Measured:
    return Measured(0.0, output, 0.0, pedal, {}, **more)


@pytest.mark.parametrize("pair", [*UP, *DOWN])
@pytest.mark.parametrize("pedal", [0.0, 0.37, 1.0])
def test_a_shift_is_made_at_its_own_line(pair: tuple[str, str], pedal: float) -> None:
    made = ShiftMap(RATIOS, UP | DOWN, skips=False)
    (_, low), (_, high) = (UP | DOWN)[pair]
    line = low + pedal * (high - low)
    assert made.speed(pair, pedal) == pytest.approx(line)
    past, before = (1.0 + 1e-9, 1.0 - 1e-9) if pair in UP else (1.0 - 1e-9, 1.0 + 1e-9)
    assert made.gear(pair[0], now(line * past, pedal)) == pair[1]
    assert made.gear(pair[0], now(line * before, pedal)) == pair[0]


def test_lines_of_any_speed_are_the_same_map() -> None:
    """Of the input, the output, or the vehicle."""
    per_output = RADIUS / FINAL_DRIVE
    lines = UP | DOWN
    of_output = ShiftMap(RATIOS, lines)
    of_input = ShiftMap(RATIOS, {p: [(x, v * RATIOS[p[0]]) for x, v in line] for p, line in lines.items()}, "input")
    of_car = ShiftMap(
        RATIOS, {p: [(x, v * per_output) for x, v in line] for p, line in lines.items()}, "vehicle", per_output
    )
    for output in np.linspace(5.0, 500.0, 60):
        for gear in GEARS:
            seen = {one.gear(gear, now(float(output), 0.4)) for one in (of_output, of_input, of_car)}
            assert len(seen) == 1


def test_no_gear_hunts_in_a_map_that_is_accepted() -> None:
    """From any gear, at any speed and pedal, the gear that is chosen is one in which it stays."""
    made = ShiftMap(RATIOS, UP | DOWN)
    for output in np.linspace(1.0, 600.0, 120):
        for pedal in np.linspace(0.0, 1.0, 7):
            for gear in GEARS:
                chosen = made.gear(gear, now(float(output), float(pedal)))
                assert made.gear(chosen, now(float(output), float(pedal))) == chosen


def test_maps_that_hunt_or_are_not_whole_are_refused() -> None:
    tight = {**DOWN, ("4", "3"): ((0.0, UP["3", "4"][0][1] * 0.99), (1.0, 0.5))}
    with pytest.raises(cw.ModelError, match=r"shifts 3-4-3: hunts at pedal 0: up at .* down at"):
        ShiftMap(RATIOS, UP | tight)
    with pytest.raises(cw.ModelError, match="line 3-4: is above that of 4-5 at pedal 0, so that 4 is never driven in"):
        ShiftMap(RATIOS, {**UP, ("3", "4"): ((0.0, 500.0), (1.0, 600.0))} | DOWN)
    with pytest.raises(cw.ModelError, match="shift 2-1: has no line"):
        ShiftMap(RATIOS, UP | {pair: line for pair, line in DOWN.items() if pair != ("2", "1")})
    with pytest.raises(cw.ModelError, match="choose from input, output, vehicle"):
        ShiftMap(RATIOS, UP | DOWN, "wheels")


def test_kickdown_overspeed_and_skips() -> None:
    """Down to the lowest gear in which the input turns with less than 500 rad/s, by one step or all, below a limit."""
    late = {pair: ((0.0, 100.0 / RATIOS[pair[0]]), (1.0, 120.0 / RATIOS[pair[0]])) for pair in DOWN}
    speeds = {pair: 500.0 / RATIOS[pair[1]] for pair in DOWN}
    output = 140.0
    made = ShiftMap(RATIOS, UP | late, kickdown=0.95, kickdown_speeds=speeds)
    assert made.gear("6", now(output, 0.94)) == "6"
    assert made.gear("6", now(output, 1.0)) == next(gear for gear in GEARS if output * RATIOS[gear] < 500.0) == "2"
    one_by_one = ShiftMap(RATIOS, UP | late, kickdown=0.95, kickdown_speeds=speeds, skips=False)
    assert one_by_one.gear("6", now(output, 1.0)) == "5"
    limited = ShiftMap(RATIOS, UP | late, kickdown=0.95, kickdown_speeds=speeds, fastest=400.0)
    assert limited.gear("6", now(output, 1.0)) == "3"
    # a kickdown into a gear that goes up again at once
    wild = {pair: 560.0 / RATIOS[pair[1]] for pair in DOWN}
    with pytest.raises(cw.ModelError, match="shifts 1-2-1: hunts at pedal 1"):
        ShiftMap(RATIOS, UP | late, kickdown=0.95, kickdown_speeds=wild)


def test_inhibits() -> None:
    """No eighth gear with cold oil, none above fourth on a climb; what is in stays in."""
    cold, climb = Inhibit(("8",), colder_than=293.15), Inhibit(("5", "6", "7", "8"), steeper_than=0.08)
    made = ShiftMap(RATIOS, UP | DOWN, inhibits=(cold, climb))
    assert made.gear("1", now(450.0)) == "8"
    assert made.gear("1", now(450.0, oil=280.0)) == "7"
    assert made.gear("1", now(450.0, grade=0.1)) == "4"
    assert made.gear("8", now(450.0, oil=280.0, grade=0.1)) == "8"


def test_maps_from_files(tmp_path: Path) -> None:
    path = tmp_path / "map.csv"
    lines = UP | DOWN
    rows = ["shift, pedal, speed"]
    rows += [f"{a}-{b}, {x}, {v * 30.0 / np.pi!r}" for (a, b), line in lines.items() for x, v in reversed(line)]
    path.write_text("\n".join(rows) + "\n\n")
    made = ShiftMap.from_csv(path, BOX, unit="rpm")
    assert list(made.ratios) == GEARS
    for pair in lines:
        assert made.speed(pair, 0.3) == pytest.approx(ShiftMap(RATIOS, lines).speed(pair, 0.3))
    path.write_text("1-2, 0.0, fast\n")
    with pytest.raises(cw.UseError, match=r"map.csv, line 1: '1-2,0.0,fast' must be a row such as 1-2, 0.3, 25"):
        ShiftMap.from_csv(path, BOX)
    with pytest.raises(cw.UseError, match="unit is 'knots'; choose from rad/s, rpm"):
        ShiftMap.from_csv(path, BOX, unit="knots")


def test_a_drive_follows_its_map() -> None:
    """Every shift of a drive begins within a resting period of its line."""
    made = ShiftMap(RATIOS, UP | DOWN, skips=False)
    system = car(BOX, "2", 300.0).assemble()
    control = cw.shifts.ShiftController(BOX, cw.shifts.plant_of(system, BOX), schedule=made, gear="2")
    sim = cw.Simulator(system, rtol=1e-6)
    run = cw.shifts.drive(sim, control, 8.0, sensed=SENSED, throttle=lambda _: 0.5)
    assert len(control.records) >= 2
    assert all(record.reached for record in control.records[:-1])
    for record in control.records:
        speed = run.at(np.array([record.begin]))[f"gearbox.{BOX.output}.speed"][0]
        line = made.speed((record.before, record.after), 0.5)
        # the pause behind the shift before, and a period at rest, in which the car goes on
        assert line < speed < 1.15 * line
