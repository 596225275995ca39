"""Who gives the torque of a shift: a motor within its limits first, then the throttle."""

from __future__ import annotations

import numpy as np
import pytest

import clutchwork as cw
from support.shift_car import SENSED, car

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
    """What is left is what the motor does not give at the input."""
    motor = cw.shifts.TorqueSource("m", -50.0, 80.0, ratio=2.0, driven=30.0)
    assert motor.gives(-40.0) == (10.0, 0.0)
    assert motor.gives(-200.0) == (-50.0, -40.0)
    assert motor.gives(200.0) == (80.0, 100.0)
    with pytest.raises(cw.UseError, match="least is 1 N m, above most, -1 N m"):
        cw.shifts.TorqueSource("m", 1.0, -1.0)


def test_without_motors_nothing_changes() -> None:
    """The throttle is that of the driver times what the controller asks for."""
    system = car(BOX, "3", 200.0).assemble()
    control = cw.shifts.ShiftController(BOX, cw.shifts.plant_of(system, BOX), gear="3")
    sim = cw.Simulator(system, rtol=1e-6)
    cw.shifts.drive(sim, control, 0.6, sensed=SENSED, throttle=lambda _: 0.4)
    control.request("4")
    run = cw.shifts.drive(sim, control, 2.0, sensed=SENSED, throttle=lambda _: 0.4)
    assert np.min(run["combustion.throttle"]) == pytest.approx(0.4 * 0.7)
