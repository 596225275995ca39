"""Dual-clutch gearboxes: preselection, synchronisation time, launch and shifts under power."""

from __future__ import annotations

from math import sin

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.shifts.preselect import Halves, expected

UP, DOWN = [(0.0, 200.0), (1.0, 300.0)], [(0.0, 100.0), (1.0, 130.0)]
DSG = ("vw-dq200", "vw-dq250")
# no drive shafts that swing: a fast launch control
LAUNCH = cw.shifts.ShiftSettings(launch_speed=150.0, launch_gain=15.0)
ENGINE = {"full_load": [(0.0, 120.0), (150.0, 220.0), (450.0, 250.0)], "motoring": [(0.0, -20.0), (600.0, -50.0)]}


def halves(box: cw.Gearbox) -> Halves:
    found = Halves.of(box)
    assert found is not None
    return found


def burning(torque: float) -> list[cw.shifts.TorqueSource]:
    """An engine that gives any torque at once, this one where nothing is asked for."""
    return [cw.shifts.TorqueSource("burning.torque", -30.0, 400.0, driven=torque)]


def waited(record: cw.shifts.ShiftRecord) -> bool:
    """Whether the gear waited on its shaft when it was asked for."""
    return record.phases[1][0] == record.phases[0][0]


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
    layout = halves(cw.Gearbox.load(name))
    assert layout.forward == [str(n) for n in range(1, len(layout.forward) + 1)]
    assert {layout.clutch[gear] for gear in layout.forward[::2]} == {"K1"}
    assert {layout.clutch[gear] for gear in layout.forward[1::2]} == {"K2"}
    assert layout.route("2", "3") == ["3"]
    assert layout.route("3", "3") == []
    # two gears of one shaft go through one of the other
    assert layout.route("2", "4") == ["3", "4"]
    assert layout.route("5", "1") in (["2", "1"], ["3", "1"], ["4", "1"])
    assert Halves.of(cw.Gearbox.load("zf-8hp70")) is None


@pytest.mark.parametrize("name", DSG)
def test_the_gear_that_is_asked_for_waits(name: str) -> None:
    """100 random cycles of speed and throttle without jumps: what is asked for had been chosen the instant before."""
    layout = halves(cw.Gearbox.load(name))
    schedule = cw.shifts.ShiftMap.two_lines(cw.Gearbox.load(name), UP, DOWN)
    rng, made = np.random.default_rng(5), 0
    for _ in range(100):
        time = np.arange(0.0, 200.0, 0.25)
        waves = [(rng.uniform(0.1, 1.0), rng.uniform(0.01, 0.06), rng.uniform(0, 6)) for _ in range(4)]
        speed = sum(size * np.sin(rate * time + start) for size, rate, start in waves)
        speed = 5.0 + 110.0 * (speed - speed.min()) / np.ptp(speed)
        pedal = 0.5 + 0.4 * np.sin(rng.uniform(0.01, 0.05) * time + rng.uniform(0, 6))
        gear, waiting = "1", "2"
        for output, throttle in zip(speed, pedal, strict=True):
            wanted = schedule.gear(gear, cw.shifts.Measured(0.0, float(output), 0.0, float(throttle), {}))
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
    layout, wheel = halves(box), f"w{gear}"
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
    shaft = next(member for member in box.element(layout.clutch[gear]).members if member != box.input)
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


def hole(run: cw.Trajectory, shift: cw.shifts.ShiftRecord) -> float:
    """What is missing under both levels, over the level before."""
    begin, end = shift.phases[1][0], shift.end
    assert end is not None
    before = smooth(run, begin - 0.06, begin).mean()
    after = smooth(run, end + 0.02, end + 0.08).mean()
    least = smooth(run, begin, end + 0.02).min()
    return float((min(before, after) - least) / before)


@pytest.mark.parametrize("name", DSG)
def test_launch_and_all_gears_under_power(name: str) -> None:
    box, system = cw.Gearbox.load(name), car(name).assemble()
    schedule = cw.shifts.ShiftMap.two_lines(box, UP, DOWN)
    plant = cw.shifts.plant_of(system, box)
    control = cw.shifts.ShiftController(box, plant, schedule=schedule, settings=LAUNCH)
    sim, top = cw.Simulator(system), len(box.ratios) - 1
    more = {"throttle": lambda _: 0.5, "sources": burning(150.0)}
    run = cw.shifts.drive(sim, control, 25.0, **more)
    launch, *ups = control.records
    assert (launch.before, launch.after, launch.reached) == ("N", "1", True)
    assert [shift.after for shift in ups] == [str(n) for n in range(2, top + 1)]
    assert all(shift.reached and waited(shift) for shift in ups)
    # while it launches the engine is held at its speed
    locks = next(time for time, state in launch.phases if state == "sync")
    launching = (run.time > 0.4) & (run.time < locks)
    assert run["engine.speed"][launching] == pytest.approx(150.0, abs=5.0)
    downs = cw.shifts.ShiftController(box, plant, gear=str(top))
    for gear in range(top - 1, 1, -1):
        downs.request(str(gear))
        run = cw.shifts.drive(sim, downs, sim.time + 2.5, **more)
    assert [shift.after for shift in downs.records] == [str(n) for n in range(top - 1, 1, -1)]
    holes = [hole(run, shift) for shift in (*ups, *downs.records)]
    assert max(holes) < 0.05, holes
    assert abs(run.energy.residual) < 1e-6 * run.energy.input


def test_power_off_and_two_on_one_shaft() -> None:
    """Coasting the clutch that comes takes over first on the way down; from 2 to 4 it goes through 3."""
    name = "vw-dq250"
    box, system = cw.Gearbox.load(name), car(name, speed=45.0, gear="4").assemble()
    control = cw.shifts.ShiftController(box, cw.shifts.plant_of(system, box), gear="4")
    sim, coasting = cw.Simulator(system), {"throttle": lambda _: 0.0, "sources": burning(-25.0)}
    for gear in ("3", "2"):
        control.request(gear)
        run = cw.shifts.drive(sim, control, sim.time + 2.5, **coasting)
    assert [shift.after for shift in control.records] == ["3", "2"]
    assert [state for _, state in control.records[0].phases][1] == "torque"
    control.request("4")
    run = cw.shifts.drive(sim, control, sim.time + 4.0, throttle=lambda _: 0.3, sources=burning(60.0))
    both = control.records[2]
    assert both.reached
    assert [one.after for one in both.exchanges] == [box.ratios["3"], box.ratios["4"]]
    gears = [one.gear for one in run.gears() if one.gear in box.gears]
    assert list(dict.fromkeys(gears)) == ["4", "3", "2"]
    assert gears[-1] == "4"
    assert run["engine.speed"][-1] / run["axle.speed"][-1] == pytest.approx(box.ratios["4"], rel=1e-6)
    with pytest.raises(cw.UseError, match="is not a gear"):
        control.request("9")
    with pytest.raises(cw.UseError, match="the engine changes its speed by its own torque: give sources"):
        cw.shifts.drive(sim, control, 20.0, throttle=lambda _: 0.3)


def test_an_engine_without_spare_torque_leaves_it_to_the_clutch() -> None:
    """Coasting up nothing slows the engine but its own drag, of which the clutch that goes carries less meanwhile."""
    name = "vw-dq250"
    box, system = cw.Gearbox.load(name), car(name, speed=30.0, gear="3").assemble()
    control = cw.shifts.ShiftController(box, cw.shifts.plant_of(system, box), gear="3")
    sim = cw.Simulator(system)
    control.request("4")
    dragging = [cw.shifts.TorqueSource("burning.torque", -25.0, 400.0, driven=-25.0)]
    run = cw.shifts.drive(sim, control, 2.5, throttle=lambda _: 0.0, sources=dragging)
    (record,) = control.records
    assert record.reached
    times = {state: time for time, state in record.phases}
    slowing = (run.time > times["inertia"] + 0.05) & (run.time < times["sync"] - 0.05)
    assert np.all(np.abs(run["gearbox.K1.torque"][slowing]) < 25.0)
    # all that the engine has, and the car as much less than nothing
    step = abs(box.ratios["3"] - box.ratios["4"]) * 30.0
    assert times["sync"] - times["inertia"] > 0.15 * step / 25.0


@pytest.mark.parametrize("most", [180.0, 250.0, 400.0])
def test_a_downshift_under_power_stays_within_the_limits_of_the_engine(most: float) -> None:
    """It takes as long as what the engine can give beside the driver's torque needs: 2 J ds / dT at the peak."""
    name = "vw-dq250"
    box, system = cw.Gearbox.load(name), car(name, speed=30.0, gear="4").assemble()
    control = cw.shifts.ShiftController(box, cw.shifts.plant_of(system, box), gear="4")
    sim = cw.Simulator(system)
    source = cw.shifts.TorqueSource("burning.torque", -30.0, most, driven=150.0)
    cw.shifts.drive(sim, control, 0.5, throttle=lambda _: 0.5, sources=[source])
    control.request("3")
    run = cw.shifts.drive(sim, control, 4.0, throttle=lambda _: 0.5, sources=[source])
    (record,) = control.records
    assert record.reached
    assert [state for _, state in record.phases][:2] == ["mesh", "inertia"]
    assert np.max(run["burning.torque"]) <= most
    times = {state: time for time, state in record.phases}
    at = run.at(np.array([times["inertia"]]))
    step = box.ratios["3"] * at["axle.speed"][0] - at["engine.speed"][0]
    needed = max(cw.shifts.ShiftSettings().inertia_time, 2.0 * 0.15 * step / (most - 150.0))
    # the engine's own inertia and what the speed of the car gains meanwhile; a few periods until the slip has settled
    assert times["sync"] - times["inertia"] == pytest.approx(needed, rel=0.15, abs=0.05)


def stop_and_go(name: str, *, pistons: bool) -> tuple[cw.Driveline, cw.Engine]:
    """A car with brakes and an engine with a throttle that lags; both clutches pressed directly or by pistons."""
    d = cw.Driveline(name)
    engine = d.shaft("engine", inertia=0.15, speed=90.0)
    axle, body = d.shaft("axle", inertia=1.0, speed=0.0), d.mass("car", mass=1400.0)
    idle = {"lag": 0.05, "idle_speed": 80.0, "idle_gain": 0.02, "idle_integral": 0.05, "idle_limit": 0.5}
    burns = cw.Engine("burning", shaft=engine, throttle=0.0, **ENGINE, **idle)
    d.add(burns)
    shift = {}
    for clutch in ("K1", "K2") if pistons else ():
        fills = {"lag": 0.02, "fill_time": 0.06, "fill_pressure": 5e5, "spring": 5e4}
        shift[clutch] = {"pressure": cw.PressureActuator(f"{clutch}_piston", command=0.0, **fills)}
        d.add(shift[clutch]["pressure"])
    values = {"inertia": 0.001, "inertias": {"in1": 0.004, "in2": 0.004}, "torque": 250.0, "shift": shift}
    d.add(cw.Transmission("gearbox", gearbox=cw.Gearbox.load(name), input=engine, output=axle, **values))
    d.add(cw.RollingWheel("wheel", shaft=axle, mass=body, radius=0.31))
    d.add(cw.Vehicle("road", mass=body, drag_area=0.6, locked=False))
    d.add(cw.Brake("brakes", shaft=body, friction=cw.Coulomb(static=1.0, kinetic=0.9), gain=1e4, normal_force=0.0))
    return d, burns


@pytest.mark.parametrize(("name", "pistons"), [("vw-dq250", False), ("vw-dq250", True), ("vw-dq200", True)])
def test_stop_and_go_and_reverse(name: str, pistons: bool) -> None:
    """Off, up, braked to rest, off again, to rest, backward: one controller, an engine with a throttle, pistons."""
    d, engine = stop_and_go(name, pistons=pistons)
    box, system, sim = cw.Gearbox.load(name), d.assemble(), cw.Simulator(d.assemble())
    plant = cw.shifts.plant_of(system, box)
    schedule = cw.shifts.ShiftMap.two_lines(box, UP, DOWN)
    control = cw.shifts.ShiftController(box, plant, schedule=schedule, settings=LAUNCH)
    more = {
        "throttle": lambda t: 0.4 if 0.5 < t < 8.0 or 16.0 < t < 20.0 else 0.3 if 27.0 < t < 31.0 else 0.0,
        "also": lambda t, _: {"brakes.normal_force": 0.45 if 10.0 < t < 15.0 or 22.0 < t < 26.0 else 0.0},
        "sources": [cw.shifts.EngineSource.of(engine)],
    }
    cw.shifts.drive(sim, control, 26.5, **more)
    launches = [one for one in control.records if one.before == "N"]
    assert [one.after for one in launches] == ["1", "1"]
    assert all(one.reached for one in launches)
    ups = [one for one in control.records if one.kind == "power-on upshift"]
    assert len(ups) >= 3
    assert all(one.reached for one in ups)
    back = cw.shifts.ShiftController(box, plant, gear="N", settings=LAUNCH)
    back.request("R")
    cw.shifts.drive(sim, back, 26.9, **more)
    # it waits for the pedal
    assert back.gear == "N"
    assert not back.records
    run = cw.shifts.drive(sim, back, 32.0, **more)
    assert [one.after for one in back.records] == ["R"]
    assert back.records[0].reached
    assert run["car.speed"][-1] < -3.0
    assert run["engine.speed"][-1] / run["axle.speed"][-1] == pytest.approx(box.ratios["R"], rel=1e-6)
    # it neither stalls nor runs away
    assert 60.0 < np.min(run["engine.speed"]) < np.max(run["engine.speed"]) < 360.0
    at = run.at(np.array([14.5, 25.5]))
    assert np.abs(at["car.speed"]) == pytest.approx(0.0, abs=1e-9)
    assert at["engine.speed"] == pytest.approx(80.0, abs=3.0)
    # gears of the two shafts at most
    sleeves = np.array([run[f"gearbox.S{gear}.forward_dog.sleeve"] for gear in [*box.ratios]])
    layout = halves(box)
    for clutch in ("K1", "K2"):
        own = [number for number, gear in enumerate(box.ratios) if layout.clutch[gear] == clutch]
        assert np.max(np.sort(sleeves[own], axis=0)[-2]) < 0.5
