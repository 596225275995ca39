"""Power splits under their controller: torques of the statics, mode shifts nobody feels, limits of the battery."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from math import inf

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.shifts import EngineSource, HybridController, HybridSettings, Sensed, TorqueSource, drive
from clutchwork.shifts.split_motion import split_motion

CHARGE = Sensed(charge="battery.charge")
MOST, POWER = 280.0, 70e3  # N m, W
TABLES = {
    "full_load": [(0.0, 150.0), (150.0, 300.0), (550.0, 320.0)],
    "motoring": [(0.0, -20.0), (600.0, -50.0)],
}
SPEEDS = [(0.0, 110.0), (30e3, 180.0), (100e3, 400.0)]  # W, rad/s


def hybrid(
    box: cw.Gearbox, mode: str, initial: float = 0.6, **battery: float
) -> tuple[cw.Driveline, cw.Engine, cw.Battery]:
    d = cw.Driveline(box.name)
    crank, out = d.shaft("crank", inertia=0.2, speed=110.0), d.shaft("out", inertia=0.02)
    axle, body = d.shaft("axle", inertia=1.0, speed=0.0), d.mass("car", mass=2200.0)
    gearbox = cw.Transmission("gearbox", gearbox=box, input=crank, output=out, inertia=0.03, torque=400.0, gear=mode)
    engine = cw.Engine("engine", shaft=crank, throttle=0.0, lag=0.05, **TABLES)
    motors = [
        cw.ElectricMotor(name, shaft=gearbox.part(member), command=0.0, max_torque=MOST, max_power=POWER)
        for name, member in box.machines.items()
    ]
    loads = {"load": cw.SupplyPower(motors[0]), "second_load": cw.SupplyPower(motors[1])}
    cells = {"charges": (0.0, 1.0), "voltages": (280.0, 320.0), "resistances": (0.3, 0.25), "capacity": 23400.0}
    store = cw.Battery("battery", initial_charge=initial, **cells, **loads, **battery)
    for part in (gearbox, engine, *motors, store):
        d.add(part)
    d.add(cw.Gear("final", input=out, output=axle, ratio=3.4 if "EVT1" in box.gears else 1.0))
    d.add(cw.RollingWheel("wheels", shaft=axle, mass=body, radius=0.33))
    d.add(cw.Vehicle("road", mass=body, drag_area=0.8, locked=False))
    return d, engine, store


def controlled(
    box: cw.Gearbox,
    d: cw.Driveline,
    engine: cw.Engine,
    store: cw.Battery,
    full: float = 900.0,
    charge: float = 0.6,
    **more: float,
) -> tuple[cw.Simulator, HybridController]:
    system = d.assemble()
    machines = {name: TorqueSource(f"{name}.command", -MOST, MOST, power=(-POWER, POWER)) for name in box.machines}
    settings = HybridSettings(
        [(0.0, full), (100.0, full), (300.0, 0.5 * full)], SPEEDS, charge, limits=store.limits, **more
    )
    plant = cw.shifts.plant_of(system, box)
    made = HybridController(box, plant, machines=machines, engine=EngineSource.of(engine), settings=settings)
    return cw.Simulator(system), made


@pytest.mark.parametrize(("name", "mode"), [("toyota-p410", "split"), ("gm-2ml70", "EVT1"), ("gm-2ml70", "EVT2")])
def test_torques_are_those_of_the_statics(name: str, mode: str) -> None:
    """Virtual work over two speeds against the balance of all members, docs/theory/gearboxes.md."""
    box = cw.Gearbox.load(name)
    motion = split_motion(box, box.closed_in(mode), {})
    free = dict.fromkeys(box.machines, (-inf, inf))
    for speed, torque, output_speed, output in ((200.0, 100.0, 60.0, 500.0), (150.0, -30.0, 20.0, -200.0)):
        ends = {"speed": speed, "torque": torque, "output_speed": output_speed}
        point = box.operating_point(mode, **ends, output_torque=output, battery_power=None)
        found = motion.torques(-torque, output, free, (-inf, inf), (speed, output_speed))
        for machine, value in found.items():
            assert value == pytest.approx(point.machine_torques[machine], rel=1e-9, abs=1e-9)
            member = box.machines[machine]
            assert motion.speed(machine, (speed, output_speed)) == pytest.approx(point.speeds[member], rel=1e-12)


def test_limits_leave_what_the_input_needs() -> None:
    """Of the output's torque as much is given as machines and battery have; the input keeps all of its own."""
    box = cw.Gearbox.load("gm-2ml70")
    motion, at = split_motion(box, box.closed_in("EVT1"), {}), (200.0, 60.0)
    rng = np.random.default_rng(8)
    for _ in range(300):
        needed, wanted = rng.uniform(-150.0, 150.0), rng.uniform(-2000.0, 2000.0)
        ranges = {name: (-float(rng.uniform(100, 400)), float(rng.uniform(100, 400))) for name in box.machines}
        battery = (-float(rng.uniform(5e3, 5e4)), float(rng.uniform(5e3, 5e4)))
        found = motion.torques(needed, wanted, ranges, battery, at)
        power = sum(found[name] * motion.speed(name, at) for name in found)
        at_input, at_output = (sum(motion.machines[n][k] * found[n] for n in found) for k in (0, 1))
        inside = all(ranges[name][0] <= found[name] <= ranges[name][1] for name in found)
        assert inside
        # every other torque of the output with that of the input: none that is allowed is closer to the wanted one
        ways = np.array([[motion.machines[n][k] for n in found] for k in (0, 1)])
        closest = inf
        for output in np.linspace(-2500.0, 2500.0, 501):
            tried = dict(zip(found, np.linalg.solve(ways, [needed, output]), strict=True))
            fits = all(ranges[n][0] <= tried[n] <= ranges[n][1] for n in tried)
            if fits and battery[0] <= sum(tried[n] * motion.speed(n, at) for n in tried) <= battery[1]:
                closest = min(closest, abs(output - wanted))
        if closest < inf:
            assert at_input == pytest.approx(needed, abs=1e-9)
            assert battery[0] - 1e-6 <= power <= battery[1] + 1e-6
            assert abs(at_output - wanted) <= closest + 1e-6


def test_mode_shifts_up_and_down() -> None:
    """Through second gear, in which both modes meet: no slip where C2 closes, no torque where C1 opens, no jerk."""
    box = cw.Gearbox.load("gm-2ml70")
    d, engine, store = hybrid(box, "EVT1", max_current=150.0, max_charging_current=100.0)
    sim, control = controlled(box, d, engine, store)
    run = drive(sim, control, 45.0, throttle=lambda t: 0.5 if t < 15.0 else -0.5, sensed=CHARGE)
    assert [(one.before, one.after) for one in control.records] == [("EVT1", "EVT2"), ("EVT2", "EVT1")]
    # docs/theory/jerk.md: what is felt
    time = np.arange(0.5, 44.5, 1e-3)
    felt = np.abs(cw.shifts.jerk(np.interp(time, run.time, run["car.speed"]), 1e-3))
    for record, (on, off) in zip(control.records, (("C2", "C1"), ("C1", "C2")), strict=True):
        assert record.reached
        begin = record.phases[0][0]
        closes = next(at for at, state in record.phases if state == "hand over")
        heat = run.at(np.array([begin, record.end + 0.2]))[f"gearbox.{on}.heat"]
        # J: a hundredth of a power shift's
        assert heat[1] - heat[0] < 50.0
        ratio = run.at(np.array([closes + 0.1]))
        assert ratio["crank.speed"][0] / ratio["out.speed"][0] == pytest.approx(box.ratios["2"], rel=1e-4)
        # what is left of its torque when it opens: the lag of the engine, and inertias that statics leave out
        carried = run.at(np.array([begin, record.end]))[f"gearbox.{off}.torque"]
        assert abs(carried[1]) < 0.1 * max(abs(carried[0]), 300.0)
        around = (time > begin) & (time < record.end + 0.3)
        assert np.max(felt[around]) < 10.0
    assert [run[f"battery.{name}"][-1] for name in ("unserved", "refused")] == pytest.approx([0.0, 0.0], abs=1e-6)
    assert abs(run.energy.residual) < 1e-6 * run.energy.turnover


def test_a_weak_battery_is_kept_within_its_limits() -> None:
    """5 A out, 2 A in: nothing is asked beyond, where the drive takes more of a strong one, and the engine helps."""
    box = cw.Gearbox.load("toyota-p410")
    speeds, most = [], []
    for limits in ({"max_current": 5.0, "max_charging_current": 2.0}, {"max_current": 150.0}):
        d, engine, store = hybrid(box, "split", **limits)
        sim, control = controlled(box, d, engine, store, 1800.0, charge=0.3)
        run = drive(sim, control, 12.0, throttle=lambda t: 0.6 if t < 8.0 else -0.2, sensed=CHARGE)
        power = sum(run[f"{name}.electric_power"] for name in box.machines)
        low, high = store.limits(0.6)
        # speeds move on for a period of the controller
        assert low - 0.03 * POWER < np.min(power) < np.max(power) < high + 0.03 * POWER
        most.append(float(np.max(power)))
        speeds.append(float(run.at(np.array([8.0]))["car.speed"][0]))
        assert run["battery.unserved"][-1] + run["battery.refused"][-1] < 0.01 * run.energy.turnover
    assert most[1] > 5.0 * most[0]
    assert speeds[0] == pytest.approx(speeds[1], rel=0.05)


@pytest.mark.parametrize(("name", "mode"), [("toyota-p410", "split"), ("gm-2ml70", "EVT1")])
def test_backward_and_forward_again(name: str, mode: str) -> None:
    """Machines drive backward, brake to rest and drive forward; the box stays in its mode meanwhile."""
    box = cw.Gearbox.load(name)
    sim, control = controlled(box, *hybrid(box, mode))
    ways = []
    for direction, until in (("R", 6.0), ("D", 14.0)):
        control.request(direction)
        run = drive(sim, control, until, throttle=0.3, sensed=CHARGE)
        ways.append(float(run["car.speed"][-1]))
    assert ways[0] < -1.0
    assert ways[1] > 1.0
    # the brake pedal stops it whichever way it rolls, and wherever the lever is
    for until, direction, lever in ((26.0, "D", "D"), (38.0, "D", "R"), (50.0, "R", "D"), (62.0, "R", "R")):
        control.request(direction)
        before = drive(sim, control, until - 8.0, throttle=0.3, sensed=CHARGE)["car.speed"][-1]
        assert before * (1.0 if direction == "D" else -1.0) > 0.5
        control.request(lever)
        run = drive(sim, control, until, throttle=-1.0, sensed=CHARGE)
        # it fades with the speed near rest: 1.4 s, its mass over the braking per speed, in the slower of both
        assert abs(run["car.speed"][-1]) < 0.01 * abs(before)
    assert not [record for record in control.records if not record.reached]


def test_the_engine_stands_where_little_is_wanted() -> None:
    """Below `electric` the machines drive alone and bring the engine to rest; above it they start it."""
    box = cw.Gearbox.load("toyota-p410")
    sim, control = controlled(box, *hybrid(box, "split", max_current=150.0), full=1800.0, electric=12e3)
    run = drive(sim, control, 20.0, throttle=lambda t: 0.2 if t < 8.0 else 0.6 if t < 16.0 else -0.1, sensed=CHARGE)
    there = run.at(np.array([6.0, 15.0, 19.9]))
    crank, car, burning = (there[name] for name in ("crank.speed", "car.speed", "engine.torque"))
    # friction holds it
    assert abs(crank[0]) < 1.0
    assert car[0] > 1.0
    assert crank[1] > 110.0
    assert burning[1] > 50.0
    assert abs(crank[2]) < 1.0
    # nobody feels it start: docs/theory/jerk.md
    time = np.arange(1.0, 19.5, 1e-3)
    felt = np.abs(cw.shifts.jerk(np.interp(time, run.time, run["car.speed"]), 1e-3))
    quiet = (time < 7.5) | ((time > 8.5) & (time < 15.5)) | (time > 16.5)
    assert np.max(felt[quiet]) < 10.0


@pytest.mark.parametrize("limits", [{}, {"limits": lambda _: (-inf, inf)}], ids=["known", "unknown"])
def test_an_empty_battery_starts_the_engine(limits: dict[str, Callable[[float], tuple[float, float]]]) -> None:
    """However much is to be driven without it, the engine starts before the battery is empty, and charges it."""
    box = cw.Gearbox.load("toyota-p410")
    d, engine, store = hybrid(box, "split", 0.02, max_current=150.0)
    sim, control = controlled(box, d, engine, store, 1800.0, electric=60e3)
    control.settings = replace(control.settings, **limits)
    run = drive(sim, control, 30.0, throttle=0.5, sensed=CHARGE)
    assert run["crank.speed"][-1] > 110.0
    assert run["battery.charge"][-1] > 0.02
    assert np.min(run["battery.charge"]) > 0.005
    assert run["battery.unserved"][-1] < 1e-6 * run.energy.turnover
    with pytest.raises(cw.UseError, match=r"electric of the settings needs .*Sensed\(charge=\"battery.charge\"\)"):
        drive(sim, control, 31.0, throttle=0.5)


def test_what_is_wrong_is_said() -> None:
    box = cw.Gearbox.load("gm-2ml70")
    d, engine, _ = hybrid(box, "EVT1")
    plant = cw.shifts.plant_of(d.assemble(), box)
    more = {"engine": EngineSource.of(engine), "settings": HybridSettings([(0.0, 900.0)], SPEEDS)}
    both = {name: TorqueSource(f"{name}.command", -1.0, 1.0) for name in box.machines}
    good = {"box": box, "plant": plant, "machines": both, **more}
    wrong = {
        "box": ("x", "box is 'x': give a cw.Gearbox"),
        "plant": (d, "plant is <Driveline"),
        "engine": (cw.Engine, "engine is .*Engine.*: give cw.shifts.EngineSource.of"),
        "settings": (None, "settings is None: give cw.shifts.HybridSettings"),
        "machines": (both | {"MGB": "MGB"}, "machine 'MGB' is 'MGB': give a cw.shifts.TorqueSource"),
    }
    for name, (value, words) in wrong.items():
        with pytest.raises(cw.UseError, match=words):
            HybridController(**good | {name: value})
    with pytest.raises(cw.UseError, match="machines is None"):
        HybridController(**good | {"machines": None})
    with pytest.raises(cw.UseError, match=r"cw.shifts.HybridController\(\): 4 problems\n *plant is missing"):
        HybridController(box)
    with pytest.raises(cw.UseError, match="give sources for MGB"):
        HybridController(box, plant, machines={"MGA": TorqueSource("MGA.command", -1.0, 1.0)}, **more)
    with pytest.raises(cw.UseError, match="'2' is not a split"):
        HybridController(box, plant, machines=both, mode="2", **more)
    with pytest.raises(cw.UseError, match="'P' is not a direction: request 'D' or 'R'"):
        HybridController(box, plant, machines=both, **more).request("P")


@pytest.mark.parametrize(
    ("name", "values", "bound"),
    [
        ("electric", ("12 kW", None, -1.0, float("nan"), inf), "give a power in W, 0 or above"),
        ("charge_power", ("50 kW", -1.0, inf), "give a power in W, 0 or above"),
        ("charge", (60, -0.1, None), "give a number from 0 to 1"),
        ("follow", (0.0, -4.0, "4"), "give a rate in 1/s, above 0"),
        ("limits", ((-1e4, 1e4), None), "give a function of the charge"),
        ("shift", (None,), "give cw.shifts.ShiftSettings"),
        ("output_torque", (900.0, [], [(0.0, "x")], [(1.0, 2.0), (0.0, 1.0)], [(0.0, inf)]), "give points of two"),
        ("engine_speed", (None, [(0.0, 110.0), (0.0, 120.0)]), "give points of two"),
    ],
)
def test_settings_have_bounds(name: str, values: tuple[object, ...], bound: str) -> None:
    for value in values:
        with pytest.raises(cw.UseError, match=rf"cw.shifts.HybridSettings: 1 problem\n  {name} is .*: {bound}"):
            HybridSettings(**{"output_torque": [(0.0, 900.0)], "engine_speed": SPEEDS, name: value})
    # all at once
    with pytest.raises(cw.UseError, match="3 problems"):
        HybridSettings([], SPEEDS, charge=2.0, electric=-1.0)
    with pytest.raises(cw.UseError, match=r"cw.shifts.HybridSettings\(\): 1 problem\n  engine_speed is missing"):
        HybridSettings([(0.0, 900.0)])
