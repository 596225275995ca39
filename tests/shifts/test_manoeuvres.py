"""Garage shifts, launches, coast-downs, skip shifts, changes of mind: what a driver does to a gearbox."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.base.errors import UseError
from support.shift_car import RIGID, SENSED, car, rigid

Pedal = Callable[[float], float]
BOXES = {name: cw.Gearbox.load(name) for name in ("six-speed", "zf-8hp70", "ford-10r80", "zf-9hp48")}
STEPS = cw.shifts.ShiftSettings()


def driven(
    model: cw.Driveline,
    box: cw.Gearbox,
    gear: str,
    requests: Sequence[tuple[float, str]],
    until: float,
    throttle: Pedal,
    brake: float | Pedal = 0.0,
    sensed: cw.shifts.Sensed = SENSED,
    **options: Any,
) -> tuple[cw.Trajectory, cw.shifts.ShiftController]:
    """A drive in which gears are asked for at times [s]."""
    system = model.assemble()
    control = cw.shifts.ShiftController(box, cw.shifts.plant_of(system, box), gear=gear, **options)
    sim = cw.Simulator(system, rtol=1e-6)

    def braked(time: float, _: cw.Simulator) -> Mapping[str, float]:
        return {"brakes.normal_force": brake(time) if callable(brake) else brake}

    for time, wanted in requests:
        cw.shifts.drive(sim, control, time, sensed=sensed, throttle=throttle, also=braked)
        control.request(wanted)
    return cw.shifts.drive(sim, control, until, sensed=sensed, throttle=throttle, also=braked), control


def is_in(run: cw.Trajectory, box: cw.Gearbox, gear: str, at: int = -1) -> bool:
    """Whether the input turns with a gear."""
    turning = run[f"gearbox.{box.input}.speed"][at], box.ratios[gear] * run[f"gearbox.{box.output}.speed"][at]
    return bool(turning[0] == pytest.approx(turning[1], rel=1e-9, abs=1e-6))


@pytest.mark.parametrize("name", ["six-speed", "zf-8hp70", "ford-10r80"])
def test_garage_shifts_at_rest(name: str) -> None:
    """Neutral to first gear, back, into reverse, and from there to first gear, with the brakes on."""
    box = BOXES[name]
    asked = [(0.5, "1"), (1.5, "N"), (2.5, "R"), (3.5, "1")]
    run, control = driven(car(box, "N"), box, "N", asked, 4.5, lambda _: 0.0, brake=0.5)
    assert [(one.before, one.after) for one in control.records] == [("N", "1"), ("1", "N"), ("N", "R"), ("R", "1")]
    assert all(one.reached and one.kind == "garage shift" for one in control.records)
    assert is_in(run, box, "1")
    assert abs(run["car.speed"][-1]) < 1e-6
    gears = [one.gear for one in cw.shifts.gears_of(run, box)]
    assert gears == ["N", "1", "N", "R", "1"]
    found = cw.shifts.qualities(run, box, torque="half_shafts.torque", acceleration="car.acceleration")
    assert [(one.shift.before, one.shift.after) for one in found] == [("N", "1"), ("N", "R"), ("R", "1")]
    for record, one in zip((control.records[0], *control.records[2:]), found, strict=True):
        assert record.end is not None
        assert record.begin <= one.shift.begin < one.shift.end <= record.end
        assert one.shift.torque_time == pytest.approx(0.0, abs=1e-9) or one.shift.before == "R"


def test_a_dog_clutch_that_cannot_engage_is_said() -> None:
    """First gear of the 9HP48 needs one that joins the input; where it is out, the engine turns past it."""
    box = BOXES["zf-9hp48"]
    run, control = driven(car(box, "N"), box, "N", [(0.5, "1")], 2.0, lambda _: 0.0, brake=0.5)
    (record,) = control.records
    assert record.problem == "F is out"
    assert not record.reached
    assert not is_in(run, box, "1")
    # a sleeve that stands at the tips of the teeth is not in mesh
    assert "1" not in run.gears().sequence
    # in mesh from the start it stays so in neutral
    shift = {name: {"engaged": True, "command": 1.0, "pointed": True} for name in ("A", "F")}
    asked = [(0.5, "1"), (1.5, "N"), (2.5, "1")]
    run, control = driven(car(box, "N", shift=shift), box, "N", asked, 3.5, lambda _: 0.0, brake=0.5)
    assert [one.problem for one in control.records] == ["", "", ""]
    assert run["gearbox.F.sleeve"][-1] > 0.99


@pytest.mark.parametrize("name", ["zf-8hp70", "six-speed"])
def test_launch_and_stop_without_converter(name: str) -> None:
    """The input keeps its launch speed while the clutch slips; braking to rest it is let go and the engine runs on."""
    box = BOXES[name]
    settings = cw.shifts.ShiftSettings(launch_speed=150.0)
    schedule = cw.shifts.ShiftMap.two_lines(
        box, up=((0.0, 180.0), (0.3, 250.0), (1.0, 550.0)), down=((0.0, 100.0), (0.3, 120.0), (1.0, 300.0))
    )
    run, control = driven(
        rigid(box, "N"),
        box,
        "N",
        [],
        17.0,
        lambda time: 0.35 if 0.5 < time < 6.0 or time > 13.0 else 0.0,
        lambda time: 0.3 if 6.5 < time < 12.5 else 0.0,
        RIGID,
        schedule=schedule,
        settings=settings,
    )
    first, *_, last = (one for one in control.records if one.before == "N")
    assert (first.after, last.after) == ("1", "1")
    assert first.reached
    assert last.reached
    began = {state: time for time, state in first.phases}
    times = np.linspace(began["inertia"] + 1.0, began["sync"], 50)
    # the gain is far below the slowest mode of the drive shafts
    assert np.all(np.abs(run.at(times)["engine.speed"] - 150.0) < 35.0)
    # let go above the speed at which it would stall, and never below idle by much
    assert any(one.after == "N" or "let go" in one.problem for one in control.records)
    assert np.min(run["engine.speed"]) > 60.0
    at_rest = run.at(np.array([12.5]))
    assert abs(at_rest["car.speed"][0]) < 1e-6
    assert at_rest["engine.speed"][0] == pytest.approx(75.0, abs=2.0)
    (launch, *_) = cw.shifts.qualities(run, box, torque="half_shafts.torque", acceleration="car.acceleration")
    assert (launch.shift.before, launch.shift.after) == ("N", "1")
    on = first.exchanges[0].on
    # the clutch turns into heat what the difference of speeds leaves of the power
    assert launch.slip_energy[on] > 3e3


def test_the_driver_gives_up_a_launch() -> None:
    """Off the pedal while the clutch slips: it lets go, the engine idles, and goes off again on the pedal."""
    box = BOXES["zf-8hp70"]
    run, control = driven(
        rigid(box, "N"),
        box,
        "N",
        [],
        8.0,
        lambda time: 0.35 if 0.5 < time < 1.2 or time > 3.5 else 0.0,
        sensed=RIGID,
        schedule=cw.shifts.ShiftMap.two_lines(box, up=((0.0, 300.0),), down=((0.0, 90.0),)),
        settings=cw.shifts.ShiftSettings(launch_speed=150.0),
    )
    first, second = control.records[:2]
    assert first.problem == "let go before the engine stalled"
    assert (second.before, second.after) == ("N", "1")
    assert second.reached
    assert np.min(run["engine.speed"]) > 60.0


@pytest.mark.parametrize("name", ["six-speed", "zf-8hp70", "ford-10r80"])
@pytest.mark.parametrize("power", [0.4, 0.0])
def test_skip_shifts(name: str, power: float) -> None:
    """Over two gears and more, by one exchange or several, up and down."""
    box = BOXES[name]
    gears = ("5", "6", "3", "2") if name == "six-speed" else ("4", "8", "5", "3")
    asked = [(0.4 + 2.0 * number, gear) for number, gear in enumerate(gears)]
    run, control = driven(car(box, "2", 120.0), box, "2", asked, 8.4, lambda _: power)
    assert [one.after for one in control.records] == list(gears)
    assert all(one.reached for one in control.records)
    assert is_in(run, box, gears[-1])
    # without power the engine drives too where it idles
    assert all(one.power_on for one in control.records) or not power
    # a way of several exchanges goes through gears
    for one in control.records:
        assert one.exchanges[0].before == pytest.approx(box.ratios[one.before])
        assert one.exchanges[-1].after == pytest.approx(box.ratios[one.after])
        opens = {*box.closed_in(one.before)} - {*box.closed_in(one.after)}
        assert ("double" in one.kind) == (len(opens) > 1)
    assert any("double" in one.kind for one in control.records)


def test_a_change_of_mind_while_it_fills() -> None:
    """Nothing was exchanged: the shift is called off, and another one begins at once."""
    box = BOXES["zf-8hp70"]
    asked = [(0.5, "4"), (0.55, "3"), (1.0, "4"), (1.05, "5")]
    run, control = driven(car(box, "3"), box, "3", asked, 3.0, lambda _: 0.3)
    called_off, again, last = control.records
    assert (called_off.before, called_off.after, called_off.problem) == ("3", "4", "called off")
    assert not called_off.reached
    assert (again.problem, last.before, last.after) == ("called off", "3", "5")
    assert last.reached
    assert is_in(run, box, "5")
    assert is_in(run, box, "3", int(np.searchsorted(run.time, 0.95)))


# the torque phase, early and late in the inertia phase, where elements close
@pytest.mark.parametrize("late", [0.15, 0.25, 0.35, 0.45, 0.6])
@pytest.mark.parametrize("power", [0.4, 0.0])
@pytest.mark.parametrize(("pair", "third"), [(("3", "4"), "5"), (("4", "3"), "2"), (("7", "2"), "4")])
def test_a_change_of_mind_in_any_phase(pair: tuple[str, str], third: str, power: float, late: float) -> None:
    """Back, or to a third gear, from the speeds that are: at once, in the time of one shift, and no speed runs away."""
    box = BOXES["zf-8hp70"]
    for target in (pair[0], third):
        asked = [(0.5, pair[1]), (0.5 + late, target)]
        # 7-2 triples the speed of the input
        speed = 200.0 if pair[0] != "7" else 120.0
        run, control = driven(car(box, pair[0], speed), box, pair[0], asked, 3.0, lambda _: power)
        last = control.records[-1]
        assert (last.after, last.problem) == (target, "")
        assert is_in(run, box, target)
        # at once; into a third gear from two that share one element with it only where statics allow
        assert last.begin == pytest.approx(0.5 + late, abs=0.011) or (pair[0] == "7" and target == third)
        assert last.end is not None
        # filled, and at most twice the time of an inertia phase
        assert last.end - last.begin < 1.4
        highest = max(box.ratios[gear] for gear in (*pair, target)) * np.max(run[f"gearbox.{box.output}.speed"])
        assert np.max(run[f"gearbox.{box.input}.speed"]) < highest + 15.0


@pytest.mark.parametrize("pair", [("2", "3"), ("3", "2"), ("5", "6"), ("6", "5")])
@pytest.mark.parametrize("after", [0.05, 0.15, 0.25, 0.35])
def test_the_throttle_moves_during_a_shift(pair: tuple[str, str], after: float) -> None:
    """Tip-out and tip-in in each phase: the gear is reached, and no speed runs away."""
    box = BOXES["zf-8hp70"]
    for first, second in ((0.5, 0.0), (0.0, 0.5)):
        at = 0.6 + after
        pedal = lambda time, one=first, two=second, turn=at: one if time < turn else two  # noqa: E731
        run, control = driven(car(box, pair[0]), box, pair[0], [(0.6, pair[1])], 3.0, pedal)
        (record,) = control.records
        assert record.reached, record
        assert is_in(run, box, pair[1])
        (one,) = cw.shifts.qualities(run, box)
        assert one.flare < 40.0


def test_open_loop() -> None:
    """Torques of the plan alone: the gear is reached, the speed does not follow its profile as closely."""
    box = BOXES["zf-8hp70"]
    times = {}
    for closed in (True, False):
        settings = cw.shifts.ShiftSettings(closed_loop=closed)
        run, control = driven(car(box, "3"), box, "3", [(0.6, "4")], 2.5, lambda _: 0.4, settings=settings)
        assert control.records[0].reached
        assert is_in(run, box, "4")
        times[closed] = cw.shifts.qualities(run, box)[0].shift.inertia_time
    wanted = cw.shifts.ShiftSettings().inertia_time
    assert abs(times[True] - wanted) < 0.1
    assert abs(times[False] - wanted) < 0.25


def test_an_exchange_that_takes_too_long_is_closed_by_pressure() -> None:
    """After `longest` the element locks with what slip is left, and the record waits for that."""
    box = BOXES["zf-8hp70"]
    settings = cw.shifts.ShiftSettings(inertia_time=1.5, longest=0.15, end_time=0.0)
    run, control = driven(car(box, "2"), box, "2", [(0.6, "3")], 2.5, lambda _: 0.4, settings=settings)
    (record,) = control.records
    assert record.reached
    assert record.end is not None
    part = run.at(np.array([record.end - 0.03, record.end]))
    slip = np.abs(part["gearbox.C.slip"])
    assert slip[0] > settings.sync_slip
    assert slip[1] <= settings.sync_slip


def test_settings_by_pair_and_by_kind() -> None:
    """A pair of gears counts before the kind of shift, and that before what holds for all."""
    box = BOXES["zf-8hp70"]
    usual, slow, slower = (cw.shifts.ShiftSettings(inertia_time=time) for time in (0.3, 0.5, 0.8))
    chosen = {"power-on upshift": slow, ("4", "5"): slower}
    asked = [(0.5, "4"), (2.5, "5"), (4.5, "4")]
    run, control = driven(car(box, "3"), box, "3", asked, 6.5, lambda _: 0.3, settings=usual, chosen=chosen)
    found = [one.shift.inertia_time for one in cw.shifts.qualities(run, box)]
    assert [one.kind for one in control.records] == ["power-on upshift", "power-on upshift", "power-on downshift"]
    assert found == pytest.approx([0.5, 0.8, 0.3], abs=0.1)


def test_gears_that_are_not_there() -> None:
    box = BOXES["zf-8hp70"]
    plant = cw.shifts.plant_of(car(box, "1").assemble(), box)
    with pytest.raises(UseError, match="'9' is not a gear of 'zf-8hp70'; choose from"):
        cw.shifts.ShiftController(box, plant, gear="1").request("9")
    with pytest.raises(UseError, match="'first' is not a gear"):
        cw.shifts.ShiftController(box, plant, gear="first")
