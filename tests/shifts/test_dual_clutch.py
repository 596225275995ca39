"""Dual-clutch gearboxes: preselection, synchronisation time, launch and shifts under power."""

from __future__ import annotations

from math import sin

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.shifts.preselect import Halves, expected

UP, DOWN = [(0.0, 200.0), (1.0, 300.0)], [(0.0, 100.0), (1.0, 130.0)]
DSG = ("vw-dq200", "vw-dq250")


def car(name: str, speed: float = 0.0, gear: str | None = None) -> cw.Driveline:
    """A car with a dual-clutch gearbox behind an engine whose torque is given at once."""
    box = cw.Gearbox.load(name)
    ratio = box.ratios[gear] if gear else 0.0
    d = cw.Driveline(name)
    engine = d.shaft("engine", inertia=0.15, speed=ratio * speed if gear else 100.0)
    axle, body = d.shaft("axle", inertia=1.0, speed=speed), d.mass("car", mass=1400.0)
    values = {"inertia": 0.001, "inertias": {"in1": 0.004, "in2": 0.004}, "torque": 250.0}
    d.add(cw.Transmission("gearbox", gearbox=box, input=engine, output=axle, gear=gear, **values))
    d.add(cw.RollingWheel("wheel", shaft=axle, mass=body, radius=0.31))
    d.add(cw.Vehicle("road", mass=body, drag_area=0.6, locked=False))
    d.add(cw.Torque("burning", shaft=engine, torque=0.0))
    return d


@pytest.mark.parametrize("name", DSG)
def test_two_halves(name: str) -> None:
    layout = Halves.of(cw.Gearbox.load(name))
    assert layout.forward == [str(n) for n in range(1, len(layout.forward) + 1)]
    assert {layout.clutch[gear] for gear in layout.forward[::2]} == {"K1"}
    assert {layout.clutch[gear] for gear in layout.forward[1::2]} == {"K2"}
    assert layout.route("2", "3") == ["3"]
    assert layout.route("3", "3") == []
    # two gears of one shaft go through one of the other
    assert layout.route("2", "4") == ["3", "4"]
    assert layout.route("5", "1") in (["2", "1"], ["3", "1"], ["4", "1"])
    with pytest.raises(cw.UseError, match="is not one clutch and one synchroniser"):
        Halves.of(cw.Gearbox.load("zf-8hp70"))


@pytest.mark.parametrize("name", DSG)
def test_the_gear_that_is_asked_for_waits(name: str) -> None:
    """100 random cycles of speed and throttle without jumps: what is asked for had been chosen the instant before."""
    layout = Halves.of(cw.Gearbox.load(name))
    schedule = cw.shifts.ShiftSchedule.of(cw.Gearbox.load(name), UP, DOWN)
    rng, made = np.random.default_rng(5), 0
    for _ in range(100):
        time = np.arange(0.0, 200.0, 0.25)
        waves = [(rng.uniform(0.1, 1.0), rng.uniform(0.01, 0.06), rng.uniform(0, 6)) for _ in range(4)]
        speed = sum(size * np.sin(rate * time + start) for size, rate, start in waves)
        speed = 5.0 + 110.0 * (speed - speed.min()) / np.ptp(speed)
        pedal = 0.5 + 0.4 * np.sin(rng.uniform(0.01, 0.05) * time + rng.uniform(0, 6))
        gear, waiting = "1", "2"
        for output, throttle in zip(speed, pedal, strict=True):
            wanted = schedule.gear(gear, float(output), float(throttle))
            if wanted != gear:
                # it starts somewhere
                assert wanted == waiting or output == speed[0]
                gear, made = wanted, made + 1
            waiting = expected(layout, schedule, gear, float(output), float(throttle))
            assert layout.clutch[waiting] != layout.clutch[gear]
    assert made > 300


@pytest.mark.parametrize(("name", "gear"), [("vw-dq250", "2"), ("vw-dq200", "4"), ("vw-dq200", "3")])
def test_time_of_synchronisation(name: str, gear: str) -> None:
    """A cone brings a free shaft and its wheels to speed: t = J dw / T."""
    box = cw.Gearbox.load(name)
    layout, wheel = Halves.of(box), f"w{gear}"
    d = cw.Driveline("free shaft")
    engine, axle = d.shaft("engine", inertia=1.0, speed=0.0), d.shaft("axle", speed=20.0)
    gearbox = cw.Transmission("gearbox", gearbox=box, input=engine, output=axle, inertia=0.002)
    d.add(gearbox)
    d.add(cw.PrescribedSpeed("road", shaft=axle, speed=20.0))
    system = d.assemble()
    sim = cw.Simulator(system)
    sleeve = f"gearbox.{layout.sleeve[gear]}"
    sim.set({f"{sleeve}.forward_dog.command": 1.0, f"{sleeve}.forward_cone.normal_force": 0.5})
    sim.advance(0.8)
    run = sim.run
    # all that the shaft turns, seen at the wheel
    shaft = layout.shaft[gear]
    sizes = {one.name: one.speeds_of_planets() for one in box.sets}
    on = [one for one in box.sets if one.members["first"] == shaft]
    inertia = 0.002 * (1.0 + sum(float(sizes[one.name][0] / sizes[one.name][1]) ** 2 for one in on))
    own = next(one for one in on if one.members["second"] == wheel)
    inertia *= float(sizes[own.name][1] / sizes[own.name][0]) ** 2
    if shaft == box.sets[[one.name for one in box.sets].index("GR")].members["first"]:
        # the gear behind the idler of reverse
        ratio = float(sizes["IR"][0] / sizes["IR"][1]) * float(sizes["GR"][0] / sizes["GR"][1])
        inertia += 0.002 * ratio**2 * float(sizes[own.name][1] / sizes[own.name][0]) ** 2
    torque = 0.035 / sin(0.12) * 0.5 * 800.0 * 0.1
    lay = next(member for member in box.element(layout.sleeve[gear]).members if member != wheel)
    slip = abs(run[f"gearbox.{lay}.speed"][-1])
    locked = next(e.time for e in run.events if e.element == f"{sleeve}.forward_cone" and e.after == "locked")
    assert locked == pytest.approx(inertia * slip / torque, rel=1e-6)
    assert run[f"{sleeve}.forward_dog.sleeve"][-1] > 0.99


def smooth(run: cw.Trajectory, first: float, last: float) -> np.ndarray:
    """Acceleration of the car as means of 20 ms: teeth that meet ring shorter than anybody feels."""
    speed = np.interp(np.arange(first, last, 0.005), run.time, run["car.speed"])
    return (speed[4:] - speed[:-4]) / 0.02


def hole(run: cw.Trajectory, shift: cw.shifts.DualClutchShift) -> float:
    """What is missing under both levels, over the level before."""
    before = smooth(run, shift.exchange - 0.06, shift.exchange).mean()
    after = smooth(run, shift.end + 0.02, shift.end + 0.08).mean()
    least = smooth(run, shift.exchange, shift.end + 0.02).min()
    return float((min(before, after) - least) / before)


@pytest.mark.parametrize("name", DSG)
def test_launch_and_all_gears_under_power(name: str) -> None:
    box, system = cw.Gearbox.load(name), car(name).assemble()
    schedule = cw.shifts.ShiftSchedule.of(box, UP, DOWN)
    control = cw.shifts.DualClutch(box, cw.shifts.plant_of(system, box), gear="1", schedule=schedule, launch=True)
    sim, top = cw.Simulator(system), str(len(box.ratios) - 1)
    run = cw.shifts.drive_dual_clutch(sim, control, 25.0, torque=lambda _: 150.0, engine="burning.torque")
    ups = control.records[:]
    assert [shift.after for shift in ups] == [str(n) for n in range(2, int(top) + 1)]
    assert all(shift.preselected for shift in ups)
    # while it launches the engine is held at its speed
    launching = (run.time > 0.25) & (run.time < 0.45)
    assert run["engine.speed"][launching] == pytest.approx(150.0, abs=5.0)
    control.schedule = None
    for gear in range(int(top) - 1, 1, -1):
        control.request(str(gear))
        run = cw.shifts.drive_dual_clutch(sim, control, sim.time + 2.5, torque=lambda _: 150.0, engine="burning.torque")
    assert [shift.after for shift in control.records[len(ups) :]] == [str(n) for n in range(int(top) - 1, 1, -1)]
    holes = [hole(run, shift) for shift in control.records]
    assert max(holes) < 0.05, holes
    assert abs(run.energy.residual) < 1e-6 * run.energy.input


def test_power_off_and_two_on_one_shaft() -> None:
    """Coasting the clutch that comes takes over first on the way down; from 2 to 4 it goes through 3."""
    name = "vw-dq250"
    box, system = cw.Gearbox.load(name), car(name, speed=45.0, gear="4").assemble()
    control = cw.shifts.DualClutch(box, cw.shifts.plant_of(system, box), gear="4")
    sim = cw.Simulator(system)
    for gear in ("3", "2"):
        control.request(gear)
        run = cw.shifts.drive_dual_clutch(sim, control, sim.time + 2.5, torque=lambda _: -25.0, engine="burning.torque")
    assert [shift.after for shift in control.records] == ["3", "2"]
    control.request("4")
    run = cw.shifts.drive_dual_clutch(sim, control, sim.time + 4.0, torque=lambda _: 60.0, engine="burning.torque")
    assert [shift.after for shift in control.records[2:]] == ["3", "4"]
    gears = [one.gear for one in run.gears() if one.gear in box.gears]
    assert list(dict.fromkeys(gears)) == ["4", "3", "2"]
    assert gears[-1] == "4"
    assert run["engine.speed"][-1] / run["axle.speed"][-1] == pytest.approx(box.ratios["4"], rel=1e-6)
    with pytest.raises(cw.UseError, match="is not a gear"):
        control.request("9")
