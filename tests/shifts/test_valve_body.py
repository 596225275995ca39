"""A controller through pump, line pressure, spool valves and pistons; fill time and kiss point are learnt."""

from __future__ import annotations

import pytest

import clutchwork as cw
from support.eight_speed_shifts import BOX, felt, qualities, shift, speed
from support.shift_car import car, with_valve_body

# single and double changes, long and short steps; all of them: examples/valve_body/valve_body.py --all
PAIRS = [("1", "2"), ("3", "4"), ("4", "3"), ("5", "2"), ("2", "5"), ("8", "7"), ("4", "6"), ("7", "3")]


def test_a_fill_test_goes_along_the_ports() -> None:
    """From the piston over the oil to the valve; each element is filled alone, for they share a pump."""
    model = with_valve_body(BOX, "3")
    found = cw.shifts.fill_test(model.assemble(), BOX)
    body = next(one for one in model.elements if isinstance(one, cw.ValveBody))
    piston = body.part("D_piston")
    assert isinstance(piston, cw.ClutchActuator)
    for name, one in found.items():
        assert one.signal == f"body.{name}_valve.command"
        # the line through the first steps of the stair; the valve holds within its overlap
        assert one.kiss == pytest.approx(piston.kiss_pressure, abs=2e3)
        # the pilot pressure falls with its lag behind the pulse, which fills too
        assert one.fill_time == pytest.approx(piston.fill_time(1e6), abs=3.0 * 0.015)
        assert one.lag < 0.05


def test_shifts_through_a_valve_body() -> None:
    """Each gear is reached, with power and without; jerk and hole are those of direct pressure within 20 %."""
    _, jerk, hole = felt(lambda gear, at: car(BOX, gear, at), PAIRS)
    count, with_oil, hole_with_oil = felt(lambda gear, at: with_valve_body(BOX, gear, at), PAIRS)
    assert count == 2 * len(PAIRS)
    assert with_oil < 1.2 * jerk
    assert hole_with_oil < 1.2 * hole


@pytest.mark.parametrize("fill", [0.7, 1.3])
@pytest.mark.parametrize("kiss", [0.7, 1.3])
def test_wrong_fill_times_and_kiss_points_are_learnt(fill: float, kiss: float) -> None:
    """Twenty shifts, up under power and down without, as a drive has them: each element is one that closes."""
    cars = {pair: with_valve_body(BOX, pair[0], speed(*pair)).assemble() for pair in (("3", "4"), ("4", "3"))}
    plant = cw.shifts.plant_of(cars["3", "4"], BOX)
    actuators = plant.actuators
    up, pedals = ("3", "4"), {("3", "4"): 0.3, ("4", "3"): 0.0}
    (right,) = qualities(shift(cars[up], *up, 0.3, plant=plant)[0])
    known = {name: cw.shifts.Learnt(fill * one.fill_time, kiss * one.kiss) for name, one in actuators.items()}
    (first,) = qualities(shift(cars[up], *up, 0.3, plant=plant, known=known)[0])
    for _ in range(10):
        for pair, pedal in pedals.items():
            _, control = shift(cars[pair], *pair, pedal, plant=plant, known=known)
            known = control.learnt
    (last,) = qualities(shift(cars[up], *up, 0.3, plant=plant, known=known)[0])
    for name in ("C", "D"):
        # what is learnt makes up for a law of control that lags, too
        assert known[name].kiss == pytest.approx(actuators[name].kiss, rel=0.05)
        assert known[name].fill_time == pytest.approx(actuators[name].fill_time, rel=0.12)
    # a period of the controller later or earlier
    assert last.peak_jerk < max(1.3 * right.peak_jerk, right.peak_jerk + 1.0)
    assert last.torque_hole < right.torque_hole + 30.0
    assert last.peak_jerk < first.peak_jerk


def test_line_pressure_falls_while_pistons_fill() -> None:
    """A small pump at idle: two pistons that fill at once take more than it delivers, and the pressure comes back."""
    d = with_valve_body(BOX, "3", 75.0, displacement=6e-6)
    sim = cw.Simulator(d.assemble())
    sim.advance(0.5)
    before = sim["body.line.pressure"]
    sim.set({"body.D_valve.command": 1e6, "body.E_valve.command": 1e6})
    least = before
    for _ in range(40):
        sim.advance(0.005)
        least = min(least, sim["body.line.pressure"])
    sim.advance(1.0)
    assert least < 0.7 * before
    assert sim["body.line.pressure"] == pytest.approx(before, rel=0.02)


def test_a_model_file_holds_a_valve_body(tmp_path: object) -> None:
    """Written and read again it moves alike."""
    d = with_valve_body(BOX, "3")
    path = f"{tmp_path}/model.toml"
    d.save(path)
    again = cw.Driveline.load(path)
    one, two = d.simulate(0.2), again.simulate(0.2)
    assert two["body.line.pressure"] == pytest.approx(one["body.line.pressure"], rel=1e-12)
    assert two["gearbox.A.torque"] == pytest.approx(one["gearbox.A.torque"], rel=1e-12, abs=1e-9)
