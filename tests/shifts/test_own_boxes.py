"""A gearbox of each kind from its teeth, none of the catalogue, in a car on a cycle: 40 lines, and no controller."""

from __future__ import annotations

import inspect
from collections.abc import Callable

import numpy as np
import pytest

import clutchwork as cw

# m/s, s to get there, s that it is held
CYCLE = [(9.0, 9.0, 6.0), (16.0, 10.0, 6.0), (7.0, 8.0, 4.0), (0.0, 6.0, 4.0), (8.0, 8.0, 4.0)]
TABLES = {"full_load": [(0.0, 120.0), (150.0, 220.0), (450.0, 260.0)], "motoring": [(0.0, -20.0), (600.0, -50.0)]}
UP, DOWN = [(0.0, 200.0), (1.0, 380.0)], [(0.0, 100.0), (1.0, 180.0)]


def car(d: cw.Driveline, output: cw.Node, final: float) -> None:
    """A car behind the output, and its driver."""
    axle, body = d.shaft("axle", inertia=1.0, speed=0.0), d.mass("car", mass=1500.0)
    d.add(cw.Gear("final", input=output, output=axle, ratio=final))
    d.add(cw.RollingWheel("wheels", shaft=axle, mass=body, radius=0.31))
    d.add(cw.Vehicle("road", mass=body, drag_area=0.6, locked=False))
    driver = cw.Driver("driver", cycle=cw.drive_cycle(CYCLE), speed=body, gain=0.5)
    d.add(driver)
    discs = {"friction": cw.Coulomb(static=1.0, kinetic=0.9), "gain": 1e4}
    d.add(cw.Brake("brakes", shaft=body, normal_force=(driver, "brake"), **discs))


def crank(d: cw.Driveline) -> tuple[cw.Node, cw.Engine]:
    shaft = d.shaft("crank", inertia=0.15, speed=85.0)
    idle = {"idle_speed": 85.0, "idle_gain": 0.02, "idle_integral": 0.05}
    engine = cw.Engine("engine", shaft=shaft, throttle=0.0, lag=0.05, **TABLES, **idle)
    d.add(engine)
    return shaft, engine


def driven(d: cw.Driveline, box: cw.Gearbox, engine: cw.Engine) -> tuple[cw.Trajectory, list[cw.shifts.ShiftRecord]]:
    """The cycle of a box that an engine drives, under the controller that there is."""
    system = d.assemble()
    schedule = cw.shifts.ShiftMap.two_lines(box, UP, DOWN)
    settings = cw.shifts.ShiftSettings(launch_speed=150.0)
    control = cw.shifts.ShiftController(box, cw.shifts.plant_of(system, box), schedule=schedule, settings=settings)
    sources = [cw.shifts.EngineSource.of(engine)]
    run = cw.shifts.drive(cw.Simulator(system), control, 64.0, throttle="driver.throttle", sources=sources)
    return run, control.records


def automatic() -> tuple[cw.Trajectory, list[cw.shifts.ShiftRecord]]:
    """Four speeds after Simpson: two sets with one sun."""
    sets = {
        "P1": {"type": "single", "sun": "sun", "ring": "r1", "carrier": "out", "teeth_sun": 33, "teeth_ring": 75},
        "P2": {"type": "single", "sun": "sun", "ring": "out", "carrier": "c2", "teeth_sun": 33, "teeth_ring": 75},
    }
    elements = {"F": ["in", "r1"], "D": ["in", "sun"], "B": ["sun", "housing"], "L": ["c2", "housing"]}
    gears = {"1": ["F", "L"], "2": ["F", "B"], "3": ["F", "D"], "R": ["D", "L"]}
    given = {"name": "simpson", "input": "in", "output": "out", "shafts": [], "sets": sets}
    box = cw.Gearbox.from_dict(given | {"elements": elements, "gears": gears})
    d = cw.Driveline("automatic")
    shaft, engine = crank(d)
    out = d.shaft("out", inertia=0.02)
    d.add(cw.Transmission("gearbox", gearbox=box, input=shaft, output=out, inertia=0.005, torque=300.0))
    car(d, out, 3.8)
    return driven(d, box, engine)


def dual_clutch() -> tuple[cw.Trajectory, list[cw.shifts.ShiftRecord]]:
    """Four speeds on two shafts and one layshaft."""
    teeth = {"1": ("one", 14, 51), "2": ("two", 22, 46), "3": ("one", 31, 43), "4": ("two", 38, 36)}
    sets = {
        f"G{n}": {"type": "gear", "first": on, "second": f"w{n}", "teeth_first": a, "teeth_second": b}
        for n, (on, a, b) in teeth.items()
    }
    sets["F"] = {"type": "gear", "first": "lay", "second": "out", "teeth_first": 17, "teeth_second": 68}
    elements = {"K1": ["in", "one"], "K2": ["in", "two"]}
    elements |= {f"S{n}": {"type": "synchroniser", "members": ["lay", f"w{n}"]} for n in teeth}
    gears = {n: ["K1" if on == "one" else "K2", f"S{n}"] for n, (on, _, _) in teeth.items()}
    shafts = ["one", "two", *(f"w{n}" for n in teeth)]
    given = {"name": "four on two", "input": "in", "output": "out", "shafts": shafts, "sets": sets}
    box = cw.Gearbox.from_dict(given | {"elements": elements, "gears": gears})
    d = cw.Driveline("dual clutch")
    shaft, engine = crank(d)
    out = d.shaft("out", inertia=0.02)
    d.add(cw.Transmission("gearbox", gearbox=box, input=shaft, output=out, inertia=0.003, torque=300.0))
    car(d, out, 1.0)
    return driven(d, box, engine)


def power_split() -> tuple[cw.Trajectory, list[cw.shifts.ShiftRecord]]:
    """One planetary set: engine, generator and wheels; the second machine at the ring by a pair of gears."""
    sets = {
        "P": {"type": "single", "sun": "MG1", "ring": "out", "carrier": "in", "teeth_sun": 28, "teeth_ring": 74},
        "G": {"type": "gear", "first": "MG2", "second": "out", "teeth_first": 24, "teeth_second": 51},
    }
    given = {"name": "one split", "input": "in", "output": "out", "sets": sets, "elements": {}}
    machines = {"MG1": "MG1", "MG2": "MG2"}
    box = cw.Gearbox.from_dict(given | {"machines": machines, "gears": {"split": []}})
    d = cw.Driveline("power split")
    shaft, engine = crank(d)
    out = d.shaft("out", inertia=0.02)
    gearbox = cw.Transmission("gearbox", gearbox=box, input=shaft, output=out, inertia=0.02)
    d.add(gearbox)
    sources = {}
    for name in machines:
        limits = {"max_torque": 250.0, "max_power": 60e3}
        d.add(cw.ElectricMotor(name, shaft=gearbox.part(name), command=0.0, **limits))
        sources[name] = cw.shifts.TorqueSource(f"{name}.command", -250.0, 250.0, power=(-6e4, 6e4))
    car(d, out, 3.5)
    system = d.assemble()
    settings = cw.shifts.HybridSettings([(0.0, 600.0), (300.0, 300.0)], [(0.0, 110.0), (6e4, 350.0)])
    control = cw.shifts.HybridController(
        box,
        cw.shifts.plant_of(system, box),
        machines=sources,
        engine=cw.shifts.EngineSource.of(engine),
        settings=settings,
    )
    run = cw.shifts.drive(cw.Simulator(system), control, 64.0, throttle="driver.throttle")
    return run, control.records


def axle() -> tuple[cw.Trajectory, list[cw.shifts.ShiftRecord]]:
    """Two pairs and two dog clutches behind a motor."""
    teeth = {"1": (19, 61), "2": (32, 48)}
    sets = {
        f"G{n}": {"type": "gear", "first": "in", "second": f"w{n}", "teeth_first": a, "teeth_second": b}
        for n, (a, b) in teeth.items()
    }
    sets["F"] = {"type": "gear", "first": "lay", "second": "out", "teeth_first": 19, "teeth_second": 71}
    elements = {f"D{n}": {"type": "dog", "members": ["lay", f"w{n}"]} for n in teeth}
    gears = {n: [f"D{n}"] for n in teeth}
    given = {"name": "two speeds", "input": "in", "output": "out", "shafts": ["w1", "w2"], "sets": sets}
    box = cw.Gearbox.from_dict(given | {"elements": elements, "gears": gears})
    d = cw.Driveline("electric axle")
    rotor, out = d.shaft("rotor", inertia=0.05), d.shaft("out", inertia=0.02)
    d.add(cw.Transmission("gearbox", gearbox=box, input=rotor, output=out, gear="1", inertia=0.002))
    limits = {"max_torque": 250.0, "max_power": 90e3}
    d.add(cw.ElectricMotor("motor", shaft=rotor, command=0.0, **limits))
    car(d, out, 1.0)
    system = d.assemble()
    schedule = cw.shifts.ShiftMap.two_lines(box, [(0.0, 420.0)], [(0.0, 120.0)])
    plant = cw.shifts.plant_of(system, box)
    control = cw.shifts.ShiftController(box, plant, gear="1", schedule=schedule)
    motor = cw.shifts.TorqueSource(
        "motor.command", -250.0, 250.0, driven=lambda pedal: 250.0 * pedal, power=(-9e4, 9e4)
    )
    run = cw.shifts.drive(cw.Simulator(system), control, 64.0, throttle="driver.throttle", sources=[motor])
    return run, control.records


@pytest.mark.parametrize("made", [automatic, dual_clutch, power_split, axle])
def test_a_box_of_each_kind_drives_a_cycle(
    made: Callable[[], tuple[cw.Trajectory, list[cw.shifts.ShiftRecord]]],
) -> None:
    assert len(inspect.getsource(made).splitlines()) <= 40
    run, records = made()
    # m/s: the driver looks 0.5 pedal per m/s behind, a launch and an interrupted shift a little more
    late = np.abs(run["car.speed"] - run["driver.cycle"])
    assert np.max(late) < 2.5
    assert np.mean(late) < 0.6
    assert run["car.speed"][-1] > 6.0
    assert abs(run.energy.residual) < 1e-6 * run.energy.turnover
    wrong = [one for one in records if one.end is not None and one.problem and "stalled" not in one.problem]
    assert not wrong
    if made is not power_split:
        assert len(records) >= 2
