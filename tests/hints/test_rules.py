"""Every rule speaks of a model that has what it looks for, with right numbers, and of no other."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import pytest

import clutchwork as cw
from clutchwork.hints.hint import Hint
from clutchwork.hints.registry import rules
from support.hint_models import CASES, hill, juddering, launch, racing, shift, warm

NAMES = sorted(CASES)


def test_every_rule_has_a_case() -> None:
    assert {rule.name for rule in rules()} == set(CASES)


@pytest.mark.parametrize("name", NAMES)
def test_a_rule_speaks_of_a_model_and_not_of_the_corrected_one(name: str) -> None:
    case = CASES[name]
    found = case.wrong().simulate(case.t_end).hints
    assert [hint.rule for hint in found] == [name]
    assert case.right().simulate(case.t_end).hints == ()


@pytest.mark.parametrize("name", NAMES)
def test_a_hint_has_numbers_names_and_a_remedy(name: str) -> None:
    case = CASES[name]
    driveline = case.wrong()
    (hint,) = driveline.simulate(case.t_end).hints
    known = {node.name for node in driveline.nodes} | {element.name for element in driveline.elements}
    assert hint.elements
    assert set(hint.elements) <= known
    assert hint.remedy
    assert all(math.isfinite(value) for value in hint.numbers.values())
    assert all("[" in key for key in hint.numbers)
    if hint.begin is not None:
        assert 0.0 <= hint.begin <= hint.end <= case.t_end
    assert str(hint).startswith(", ".join(hint.elements) + ": ")


def test_the_torque_that_a_clutch_lacks() -> None:
    """Both sides gain speed alike under T with 100 - T over 0.2 as T - 80 over 1: T = 580/6; slip 100 + 220 t."""
    (hint,) = launch(60.0).simulate(2.0).hints
    assert hint.numbers["needed [N m]"] == pytest.approx(580.0 / 6.0, rel=1e-9)
    assert hint.numbers["slipping torque [N m]"] == pytest.approx(60.0, rel=1e-9)
    assert hint.numbers["capacity [N m]"] == pytest.approx(70.0, rel=1e-9)
    assert hint.numbers["slip [rad/s]"] == pytest.approx(100.0 + 2.0 * ((100 - 60) / 0.2 - (60 - 80) / 1.0), rel=1e-9)
    assert "96.67 N m" in str(hint)
    assert "1.62 times" in str(hint)


def test_a_clutch_that_follows_the_hint_locks() -> None:
    (hint,) = launch(60.0).simulate(2.0).hints
    factor = hint.numbers["needed [N m]"] / hint.numbers["slipping torque [N m]"]
    run = launch(60.0 * factor * 1.3).simulate(20.0)
    assert run["c.state"][-1] == "locked"
    # just below it the slip grows, however long it lasts
    assert launch(60.0 * factor * 0.97).simulate(20.0).hints.rules == ("never locks",)


def test_a_clutch_that_is_let_go_before_it_locks() -> None:
    """150 N m brake the slip of 100 rad/s by 320 rad/s2: it needs 0.3125 s and has 0.3."""
    run = launch(150.0, cw.Table([(0.0, 1.0), (0.3, 1.0), (0.3001, 0.0)])).simulate(1.0)
    (hint,) = run.hints
    assert hint.rule == "never locks"
    # what the ramp of 0.1 ms adds is part of it
    assert hint.numbers["slip [rad/s]"] == pytest.approx(4.0, rel=0.02)
    assert hint.numbers["missing [s]"] == pytest.approx(0.0125, rel=0.02)


def test_the_torque_that_pulls_a_brake_through() -> None:
    """The wheel has 100 N m and the brake 75; full from 98 % of its ramp on."""
    (hint,) = hill(250.0).simulate(2.0).hints
    assert hint.numbers["needed [N m]"] == pytest.approx(100.0, rel=1e-9)
    # 98 % to 100 % of it in the first 2 ms of 1.8 s
    assert hint.numbers["slipping torque [N m]"] == pytest.approx(75.0, rel=1e-4)
    assert hint.begin == pytest.approx(0.198, abs=0.002)
    assert hint.end == 2.0


def test_a_brake_that_slows_its_wheel_is_as_it_should_be() -> None:
    d = cw.Driveline("stop")
    wheel = d.shaft("wheel", inertia=2.0, speed=200.0)
    pull = cw.Table([(0.1, 0.0), (0.2, 250.0)])
    d.add(cw.Brake("brake", shaft=wheel, friction=cw.Coulomb(static=0.35, kinetic=0.3), gain=1.0, normal_force=pull))
    assert d.simulate(2.0).hints == ()


def test_the_heat_of_a_tie_up_is_that_of_both_clutches() -> None:
    run = shift(0.5).simulate(3.0)
    (hint,) = run.hints
    assert hint.elements == ("c1", "c2")
    ends = run.at([hint.begin, hint.end])
    burnt = sum(float(ends[f"{name}.heat"][-1] - ends[f"{name}.heat"][0]) for name in hint.elements)
    assert hint.numbers["heat [J]"] == pytest.approx(burnt, rel=1e-6)
    assert hint.numbers["power [W]"] == pytest.approx(burnt / (hint.end - hint.begin), rel=1e-6)
    # it begins where the torque of the first clutch turns round, while it is locked, and ends where it is open
    assert float(run.at([hint.begin - 0.005])["c1.torque"][0]) > 0.0 > float(ends["c1.torque"][0])
    assert hint.end == pytest.approx(0.9, abs=0.004)


def test_a_vehicle_brake_that_stops_a_car_in_gear_is_no_tie_up() -> None:
    d = cw.Driveline("stop in gear")
    engine, wheels = d.shaft("engine", inertia=0.2, speed=200.0), d.shaft("wheels", inertia=20.0, speed=50.0)
    hub = d.shaft("hub", inertia=0.02)
    law = cw.Coulomb(static=0.35, kinetic=0.3)
    d.add(cw.Gear("gear", input=hub, output=wheels, ratio=4.0))
    d.add(cw.Torque("drive", shaft=engine, torque=10.0))
    pressed = cw.Table([(0.0, 1.0), (5.0, 0.9)])
    d.add(cw.Clutch("c", base=engine, follower=hub, friction=law, gain=1000.0, normal_force=pressed))
    foot = cw.Table([(0.5, 0.0), (1.0, 1.0)])
    d.add(cw.Brake("brake", shaft=wheels, friction=law, gain=1500.0, normal_force=foot))
    d.add(cw.Torque("road", shaft=wheels, torque=-20.0))
    assert d.simulate(2.0).hints == ()


def test_what_a_brake_would_have_to_hold_at_the_start() -> None:
    (hint,) = CASES["breaks away at the start"].wrong().simulate(1.0).hints
    assert hint.numbers == pytest.approx({"needed [N m]": 80.0, "capacity [N m]": 70.0}, rel=1e-12)
    assert hint.begin == 0.0


def test_the_speed_that_stays() -> None:
    """Its momentum is that of the instant in which the last clutch opened."""
    run = CASES["turns freely"].wrong().simulate(2.0)
    (hint,) = run.hints
    assert hint.elements == ("drum",)
    assert hint.numbers["drum [rad/s]"] == run["drum.speed"][-1]
    assert run.at([hint.begin])["drum.speed"][0] == pytest.approx(run["drum.speed"][-1], rel=1e-9)


def test_the_frequency_and_the_share_of_a_stiff_shaft() -> None:
    case = CASES["stiff"]
    run = case.wrong().simulate(case.t_end)
    (hint,) = run.hints
    assert hint.numbers["frequency [Hz]"] == pytest.approx(math.sqrt(1e6 * 15.0) / (2 * math.pi), rel=1e-12)
    # what the hint promises: without the ringing that share of the steps is gone, but for those of the clutch
    left = case.right().simulate(case.t_end).statistics["steps"] / run.statistics["steps"]
    assert hint.numbers["share [1]"] >= 0.9 * (1.0 - left)
    assert left < 0.2


def test_the_temperature_that_leaves_the_table() -> None:
    """15 N m at 100 rad/s warm 200 J/K by 7.5 K/s; the table ends at 400 K, its tenth more at 410 K."""
    (hint,) = warm(400.0).simulate(30.0).hints
    assert hint.numbers["temperature [K]"] == pytest.approx(300.0 + 7.5 * 30.0, rel=1e-6)
    assert hint.begin == pytest.approx(110.0 / 7.5, abs=0.04)


def outside(run: cw.Trajectory) -> list[Hint]:
    """Hints of that rule alone."""
    return [hint for hint in run.hints if hint.rule == "outside its table"]


def test_the_speed_that_leaves_the_table() -> None:
    """100 N m on 0.5 kg m2 add 200 rad/s2 to 100 rad/s; the table ends at 400 rad/s, its tenth more at 440 rad/s."""
    run = racing(400.0).simulate(3.0)
    (hint,) = outside(run)
    assert hint.elements == ("ice",)
    assert hint.numbers["speed [rad/s]"] == pytest.approx(700.0, rel=1e-9)
    # an instant of the output later at most
    assert hint.begin == pytest.approx(340.0 / 200.0, abs=2.0 * 3.0 / 1000.0)
    assert hint.end == 3.0
    assert "turns at up to 700 rad/s" in str(hint)
    assert "ends at 400 rad/s, where it goes on in a straight line" in str(hint)
    assert outside(racing(700.0).simulate(3.0)) == []
    # one that is switched off says nothing
    off = racing(1.0, gain=0.0).simulate(3.0)
    assert off["engine.speed"][-1] > 10.0
    assert outside(off) == []


def test_a_force_over_speed_leaves_its_table_too() -> None:
    d = cw.Driveline("sledge")
    body = d.mass("body", mass=10.0, speed=-5.0)
    d.add(cw.SpeedTorque("push", shaft=body, torque=[(0.0, 1.0), (2.0, 1.0)]))
    (hint,) = outside(d.simulate(1.0))
    assert hint.numbers["speed [m/s]"] == pytest.approx(-5.0)
    assert "moves at up to -5 m/s" in str(hint)
    assert "table of forces ends at 0 m/s" in str(hint)


def test_the_temperature_that_no_lining_stands() -> None:
    """80 J/K: 18.75 K/s, so 773 K after 473/18.75 s."""
    (hint,) = CASES["too hot"].wrong().simulate(30.0).hints
    assert hint.numbers["temperature [K]"] == pytest.approx(300.0 + 18.75 * 30.0, rel=1e-6)
    assert hint.begin == pytest.approx(473.0 / 18.75, abs=0.04)


def test_a_lining_with_a_limit_of_its_own_is_compared_with_it(tmp_path: Path) -> None:
    """1500 W into 200 J/K: 7.5 K/s from 300 K on."""
    d = warm(900.0)
    d._model.thermal[0] = plates = cw.ThermalNode("plates", 200.0, 300.0, limit="200 degC")
    d._model.elements[-1] = replace(d.elements[-1], heat=plates)
    d.save(tmp_path / "warm.toml")
    for one in (d, cw.Driveline.load(tmp_path / "warm.toml")):
        (hint,) = one.simulate(30.0).hints
        assert hint.numbers["limit [K]"] == 473.15
        assert hint.begin == pytest.approx(173.15 / 7.5, abs=0.04)
        assert "its limit is 473.15 K" in hint.message
    d._model.thermal[0] = plates = replace(plates, limit="530 K")
    d._model.elements[-1] = replace(d.elements[-1], heat=plates)
    assert not d.simulate(30.0).hints


def test_a_disc_clutch_gives_its_plates_the_limit() -> None:
    d = cw.Driveline("disc")
    shaft = d.shaft("s", inertia=1.0)
    given = {"base": d.housing, "follower": shaft, "radius": 0.1, "temperature_limit": "250 degC"}
    assert cw.DiskClutch("c", **given, thermal_mass=1e3).plates.limit == 523.15
    d.add(cw.DiskClutch("c", **given, area=1e-3, pressure=0.0))
    assert "give thermal_mass, or the limit of the heat node" in str(d.check()[0])


def test_judder_grows_by_the_slope_less_the_damping_over_twice_the_inertia() -> None:
    """J a = -k x - (c - slope) v: it grows with (slope - c)/(2 J) while that is small beside the frequency."""
    (hint,) = juddering(0.1).simulate(4.0).hints
    slope = hint.numbers["slope [N m s/rad]"]
    assert hint.numbers["damped [N m s/rad]"] == pytest.approx(0.1, rel=1e-5)
    # 0.2 % of the frequency of 31.8 Hz is what the growth takes off
    assert hint.numbers["frequency [Hz]"] == pytest.approx(math.sqrt(2000.0 / 0.05) / (2 * math.pi), rel=2e-3)
    assert hint.numbers["growth [s]"] == pytest.approx(2 * 0.05 / (slope - 0.1), rel=1e-3)


def test_judder_that_the_hint_says_is_damped_dies_away() -> None:
    run = juddering(0.6).simulate(4.0, dt=1e-3)
    speed = run["hub.speed"]
    assert abs(speed[-500:] - 100.0).max() < 0.1 * abs(speed[:500] - 100.0).max()
