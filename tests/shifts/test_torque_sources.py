"""Who gives the torque of a shift: a motor within its limits first, then the throttle."""

from __future__ import annotations

import numpy as np
import pytest

import clutchwork as cw
from support.shift_car import FULL_LOAD, MOTORING, SENSED, car, rigid

BOX = cw.Gearbox.load("zf-8hp70")
SUM = cw.shifts.Sensed(torque=("converter.turbine.torque", "motor.torque"), throttle="combustion.throttle")


def shift(least: float, *, pedal: float = 0.4) -> tuple[cw.Trajectory, cw.shifts.ShiftController]:
    """Third gear to fourth under power, with a motor at the turbine that gives from `least` up to 100 N m."""
    d = car(BOX, "3", 200.0)
    turbine = next(node for node in d.nodes if node.name == "turbine")
    d.add(cw.Torque("motor", shaft=turbine, torque=0.0))
    system = d.assemble()
    control = cw.shifts.ShiftController(BOX, cw.shifts.plant_of(system, BOX), gear="3")
    sim = cw.Simulator(system, rtol=1e-6)
    motor = cw.shifts.TorqueSource("motor.torque", least, 100.0)
    more = {"sensed": SUM, "throttle": lambda _: pedal, "sources": [motor]}
    cw.shifts.drive(sim, control, 0.6, **more)
    control.request("4")
    return cw.shifts.drive(sim, control, 2.4, **more), control


def test_a_motor_gives_all_of_a_reduction() -> None:
    """The engine keeps the throttle of the driver; the torque at the input falls by the share that was asked for."""
    run, control = shift(-100.0)
    assert control.records[0].reached
    assert np.all(run["combustion.throttle"] == 0.4)
    begin = next(time for time, state in control.records[0].phases if state == "inertia")
    loaded = run.at(np.array([begin]))["converter.turbine.torque"][0]
    # a period of the controller behind the begin of the phase
    assert np.min(run["motor.torque"]) == pytest.approx(-0.3 * loaded, rel=0.1)
    # before and behind the shift it gives nothing
    assert run["motor.torque"][0] == run["motor.torque"][-1] == 0.0


def test_what_a_motor_cannot_give_is_left_to_the_throttle() -> None:
    run, control = shift(-10.0)
    assert control.records[0].reached
    assert np.min(run["motor.torque"]) == -10.0
    least = float(np.min(run["combustion.throttle"]))
    assert 0.4 * 0.7 < least < 0.4
    alone, _ = shift(0.0)
    assert np.all(alone["motor.torque"] == 0.0)
    assert np.min(alone["combustion.throttle"]) == pytest.approx(0.4 * 0.7)


def test_limits_and_ratios() -> None:
    """Torques at the input, of a motor that turns twice as fast; its power limits them above a speed."""
    motor = cw.shifts.TorqueSource("m", -50.0, 80.0, ratio=2.0, driven=30.0, power=(-4e3, 8e3))
    assert motor.demand(0.3, 0.0) == 60.0
    assert motor.limits(0.0) == (-100.0, 160.0)
    assert motor.limits(100.0) == (-40.0, 80.0)
    # backward it drives with what is negative
    assert motor.limits(-100.0) == (-80.0, 40.0)
    assert motor.command(60.0, 0.0) == 30.0
    with pytest.raises(cw.UseError, match="least is 1 N m, above most, -1 N m"):
        cw.shifts.TorqueSource("m", 1.0, -1.0)


def test_an_engine_gives_torque_by_its_throttle() -> None:
    """Throttle is the share between both curves, held beyond them; what a driver asks for follows from it."""
    engine = cw.shifts.EngineSource("e.throttle", [(0.0, 100.0), (100.0, 200.0)], [(0.0, -20.0), (100.0, -40.0)])
    assert engine.limits(50.0) == (-30.0, 150.0)
    for pedal in (0.0, 0.3, 1.0):
        assert engine.command(engine.demand(pedal, 50.0), 50.0) == pytest.approx(pedal)
    assert engine.command(-500.0, 50.0) == 0.0
    with pytest.raises(cw.UseError, match="need points"):
        cw.shifts.EngineSource("e.throttle", [])


def hybrid(least: float, sources: str) -> tuple[cw.Trajectory, cw.shifts.ShiftController]:
    """P2: engine and motor at the input of the 8HP70, third gear to fourth; the motor drives with 40 N m."""
    d = rigid(BOX, "3", 300.0)
    shaft = next(node for node in d.nodes if node.name == "engine")
    d.add(cw.Torque("motor", shaft=shaft, torque=40.0))
    engine = cw.shifts.EngineSource("combustion.throttle", FULL_LOAD, MOTORING, lag=0.05)
    motor = cw.shifts.TorqueSource("motor.torque", least, 150.0, driven=40.0)
    system = d.assemble()
    control = cw.shifts.ShiftController(BOX, cw.shifts.plant_of(system, BOX), gear="3")
    sim = cw.Simulator(system, rtol=1e-6)
    more = {"throttle": lambda _: 0.4, "sources": {"both": [motor, engine], "engine": [engine]}[sources]}
    cw.shifts.drive(sim, control, 0.6, **more)
    control.request("4")
    return cw.shifts.drive(sim, control, 2.4, **more), control


def test_motor_and_engine_blend() -> None:
    """The motor gives what it can, the throttle the rest: together the share of the torque that was asked for."""
    whole, control = hybrid(-200.0, "both")
    assert control.records[0].reached
    # all of it is the motor's: the engine follows the driver
    assert np.ptp(whole["combustion.throttle"]) < 1e-9
    begin = next(time for time, state in control.records[0].phases if state == "inertia")
    for least in (-200.0, 20.0):
        run, control = hybrid(least, "both")
        assert control.records[0].reached
        at = run.at(np.array([begin - 0.005, begin + 0.05]))
        speed = at["engine.speed"]
        full, drag = (np.interp(speed, *zip(*line, strict=True)) for line in (FULL_LOAD, MOTORING))
        asked = at["combustion.throttle"] * (full - drag) + drag + at["motor.torque"]
        usual = 0.4 * (full - drag) + drag + 40.0
        # the lag of the throttle is led, so only what the motor gives at once is exact
        assert asked[0] == pytest.approx(usual[0])
        assert asked[1] == pytest.approx(usual[1] - 0.3 * usual[0], rel=0.02 if least < 0.0 else 0.2)
        assert np.min(run["motor.torque"]) >= least


def test_a_motor_makes_a_shift_shorter() -> None:
    """With a reduction that acts at once the clutch makes less heat than with that of an engine which lags."""
    heats = []
    for sources in ("both", "engine"):
        run, control = hybrid(-200.0, sources)
        assert control.records[0].reached
        heats.append(run["gearbox.E.heat"][-1] + run["gearbox.D.heat"][-1] + run["gearbox.C.heat"][-1])
    assert heats[0] < heats[1]


def test_without_motors_nothing_changes() -> None:
    """The throttle is that of the driver times what the controller asks for."""
    system = car(BOX, "3", 200.0).assemble()
    control = cw.shifts.ShiftController(BOX, cw.shifts.plant_of(system, BOX), gear="3")
    sim = cw.Simulator(system, rtol=1e-6)
    cw.shifts.drive(sim, control, 0.6, sensed=SENSED, throttle=lambda _: 0.4)
    control.request("4")
    run = cw.shifts.drive(sim, control, 2.0, sensed=SENSED, throttle=lambda _: 0.4)
    assert np.min(run["combustion.throttle"]) == pytest.approx(0.4 * 0.7)


def test_inertia_behind_springs_and_gears() -> None:
    """What is fixed to a node behind a spring counts with the square of its speed over that of the input."""
    behind = {}
    for name, ratio in (("none", None), ("one", 1.0), ("two", 2.0), ("both", -0.5)):
        d = cw.Driveline(name)
        engine, turbine = d.shaft("engine", inertia=0.2), d.shaft("turbine", inertia=0.03)
        out = d.shaft("out", inertia=1.0)
        shaft = engine
        if ratio is not None:
            # engine speed = ratio * that of the shaft
            shaft = d.shaft("shaft", inertia=0.01)
            d.add(cw.Gear("step", input=engine, output=shaft, ratio=ratio))
        if name == "both":
            # a second spring behind the gear, with a flywheel
            d.add(cw.SpringDamper("pendulum", base=engine, follower=d.shaft("wheel", inertia=0.07), stiffness=1e3))
        d.add(cw.SpringDamper("spring", base=shaft, follower=turbine, stiffness=1e4, damping=10.0))
        gearbox = cw.Transmission("gearbox", gearbox=BOX, input=turbine, output=out, inertia=0.005, torque=500.0)
        d.add(gearbox)
        behind[name] = cw.shifts.plant_of(d, BOX).behind
    assert behind == pytest.approx({"none": 0.2, "one": 0.21, "two": 0.81, "both": 0.01 + 0.25 * 0.27}, rel=1e-12)


def test_what_is_given_by_mistake_is_named() -> None:
    """The box by its name, the engine by its name, a throttle that is none; a number and a Driveline are welcome."""
    model = car(BOX, "3")
    plant = cw.shifts.plant_of(model, BOX)
    assert plant == cw.shifts.plant_of(model.assemble(), BOX)
    # kg m2 of the engine behind its converter
    engine = next(node for node in model.nodes if node.name == "engine")
    assert plant.behind == pytest.approx(engine.inertia)
    control = cw.shifts.ShiftController(BOX, plant, gear="3")
    sim, sensed = cw.Simulator(model), SENSED
    drive = cw.shifts.drive
    assert drive(sim, control, 0.1, throttle=0.3, sensed=sensed)["combustion.throttle"][-1] == 0.3
    wrong = {
        "box is 'zf-8hp70': give a cw.Gearbox": lambda: cw.shifts.plant_of(model, "zf-8hp70"),
        "'gbx' is not a Transmission of .*give prefix='gearbox'": lambda: cw.shifts.plant_of(model, BOX, "gbx"),
        "'gearbx' is not .*did you mean 'gearbox'": lambda: cw.shifts.plant_of(model, BOX, "gearbx"),
        "cw.shifts.plant_of: 1 problem\n  box is missing": lambda: cw.shifts.plant_of(model),
        "cw.shifts.ShiftController\\(\\): 1 problem\n  plant is missing": lambda: cw.shifts.ShiftController(BOX),
        "plant is <Driveline": lambda: cw.shifts.ShiftController(BOX, model),
        "engine is 'engine': give the cw.Engine": lambda: cw.shifts.EngineSource.of("engine"),
        "throttle is \\[0.3\\]: give a number from 0 to 1": lambda: drive(
            sim, control, 0.2, throttle=[0.3], sensed=sensed
        ),
        "throttle is 30: give a number from 0 to 1, down to -1": lambda: drive(
            sim, control, 0.2, throttle=30, sensed=sensed
        ),
        "throttle is nan": lambda: drive(sim, control, 0.2, throttle=float("nan"), sensed=sensed),
        "throttle returned None at 0.1 s: give a number": lambda: drive(
            sim, control, 0.2, throttle=lambda _: None, sensed=sensed
        ),
        "throttle returned 1.5 at 0.1 s": lambda: drive(sim, control, 0.2, throttle=lambda _: 1.5, sensed=sensed),
        "until is nan s": lambda: drive(sim, control, float("nan"), throttle=0.3, sensed=sensed),
        "until is -1 s, and it is 0.1 s": lambda: drive(sim, control, -1.0, throttle=0.3, sensed=sensed),
        "until is '1 s'": lambda: drive(sim, control, "1 s", throttle=0.3, sensed=sensed),
        "period is 0.0: give a time above 0 s": lambda: drive(
            sim, control, 0.2, throttle=0.3, sensed=sensed, period=0.0
        ),
        "period is '10 ms'": lambda: drive(sim, control, 0.2, throttle=0.3, sensed=sensed, period="10 ms"),
        "resting is nan": lambda: drive(sim, control, 0.2, throttle=0.3, sensed=sensed, resting=float("nan")),
        "also is {}: give a function": lambda: drive(sim, control, 0.2, throttle=0.3, sensed=sensed, also={}),
        "what also returned is None: give a function": lambda: drive(
            sim, control, 0.2, throttle=0.3, sensed=sensed, also=lambda time, sim: None
        ),
        "throttle is missing": lambda: drive(sim, control, 0.2, sensed=sensed),
        "sim is <Driveline": lambda: drive(model, control, 0.2, throttle=0.3),
    }
    for words, call in wrong.items():
        with pytest.raises(cw.UseError, match=words):
            call()
