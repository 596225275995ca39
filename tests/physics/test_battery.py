"""Batteries on a DC link: closed forms of a constant power, limits, and energies that close with the motors."""

from __future__ import annotations

from math import sqrt

import numpy as np
import pytest

import clutchwork as cw

FLAT = {"charges": (0.0, 1.0), "voltages": (200.0, 200.0), "resistances": (0.4, 0.4), "capacity": 3600.0}
TABLE = {"charges": (0.1, 0.4, 0.9), "voltages": (180.0, 200.0, 215.0), "resistances": (0.5, 0.3, 0.35)}


def turning(**values: object) -> cw.Driveline:
    """A shaft that keeps its speed, so that a model has something that moves, and a battery beside it."""
    d = cw.Driveline("battery")
    d.shaft("shaft", inertia=1.0, speed=1.0)
    d.add(cw.Battery("battery", **{**FLAT, **values}))  # type: ignore[arg-type]
    return d


@pytest.mark.parametrize("power", [-9000.0, 500.0, 12000.0])
def test_constant_power(power: float) -> None:
    """At constant voltage and resistance the current is that of the quadratic equation, all the time."""
    run = turning(load=power, second_load=100.0, third_load=-60.0, fourth_load=-40.0).simulate(20.0)
    current = (200.0 - sqrt(200.0**2 - 4 * 0.4 * power)) / (2 * 0.4)
    # a linear course of the states is exact up to round-off
    assert run["battery.charge"] == pytest.approx(0.5 - current * run.time / 3600.0, rel=1e-12)
    assert run["battery.energy"] == pytest.approx(200.0 * current * run.time, rel=1e-12)
    assert run["battery.loss"] == pytest.approx(0.4 * current**2 * run.time, rel=1e-12)
    # round-off of 240 kJ
    assert run["battery.unserved"] == pytest.approx(0.0, abs=1e-8)


@pytest.mark.parametrize(
    ("power", "current"),
    [
        (30e3, 250.0),  # beyond U^2 / 4 R = 25 kW: the current of the most power
        (10e3, 40.0),  # beyond the limit
        (-10e3, -30.0),
    ],
)
def test_limits(power: float, current: float) -> None:
    limits = {"max_charging_current": 30.0} if power < 0 else {} if current == 250.0 else {"max_current": 40.0}
    run = turning(load=power, **limits).simulate(3.0)
    given = (200.0 - 0.4 * current) * current
    assert run["battery.charge"][-1] == pytest.approx(0.5 - 3.0 * current / 3600.0, rel=1e-12)
    assert run["battery.unserved"][-1] == pytest.approx(max(0.0, 3.0 * (power - given)), rel=1e-12)
    assert run["battery.refused"][-1] == pytest.approx(max(0.0, 3.0 * (given - power)), rel=1e-12)
    battery = cw.Battery("battery", **FLAT, **limits, load=0.0)  # type: ignore[arg-type]
    answer = battery.answer(0.5, power)
    assert answer == pytest.approx((current, 200.0 - 0.4 * current, 0.4 * current**2, given), rel=1e-12)
    # the last one that it takes or gives
    assert battery.limits(0.5)[power > 0] == pytest.approx(given, rel=1e-12)


def test_empty_and_full() -> None:
    """An empty battery gives nothing more, a full one takes nothing more, and both work the other way."""
    load = cw.Table([(0.0, 4000.0), (30.0, 4000.0), (30.0, -4000.0), (90.0, -4000.0), (90.0, 1000.0)])
    run = turning(capacity=360.0, initial_charge=0.2, load=load).simulate(100.0)
    charge = dict(zip(run.time, run["battery.charge"], strict=True))
    out, into = ((200.0 - sqrt(200.0**2 - 1.6 * power)) / 0.8 for power in (4000.0, -4000.0))
    emptied, filled = 0.2 * 360.0 / out, 30.0 + 360.0 / -into
    # events are located to the tolerance of the run
    assert run["battery.unserved"][run.time <= 30.0][-1] == pytest.approx(4000.0 * (30.0 - emptied), rel=1e-6)
    assert charge[30.0] == pytest.approx(0.0, abs=1e-9)
    assert run["battery.unserved"][-1] == pytest.approx(4000.0 * (30.0 - emptied), rel=1e-6)
    assert run["battery.refused"][-1] == pytest.approx(4000.0 * (90.0 - filled), rel=1e-6)
    assert max(charge.values()) == pytest.approx(1.0, abs=1e-8)
    assert charge[100.0] < 1.0
    asked = 4000.0 * 30.0 - 4000.0 * 60.0 + 1000.0 * 10.0
    total = run["battery.energy"][-1] - run["battery.loss"][-1] + run["battery.unserved"][-1]
    total -= run["battery.refused"][-1]
    # the kink of each limit is an event
    assert total == pytest.approx(asked, rel=1e-9)


@pytest.mark.parametrize("method", ["dopri5", "rodas5p"])
def test_energies_close_with_two_motors(method: str) -> None:
    """What two motors draw by their own quadrature is what the battery gives, over a cycle in all quadrants."""
    d = cw.Driveline("two motors")
    shaft, second = d.shaft("shaft", inertia=0.2, speed=50.0), d.shaft("second", inertia=0.1)
    losses = {"no_load_loss": 100.0, "iron_loss": 0.01, "copper_loss": 0.1}
    first = cw.ElectricMotor(
        "first", shaft=shaft, max_torque=120.0, lag=0.05, **losses,
        command=cw.Table([(0.0, 0.0), (2.0, 60.0), (4.0, -60.0), (6.0, 50.0)]),
    )  # fmt: skip
    other = cw.ElectricMotor(
        "other", shaft=second, max_torque=((0.0, 60.0), (200.0, 20.0)), **losses,
        command=cw.Sine(offset=5.0, amplitude=30.0, frequency=0.4),
    )  # fmt: skip
    battery = cw.Battery(
        "battery",
        **TABLE,
        capacity=3600.0,
        load=cw.SupplyPower(first),
        second_load=cw.SupplyPower(other),
        third_load=250.0,
    )  # type: ignore[arg-type]
    for one in (first, other, battery, cw.Damper("drag", base=shaft, follower=second, damping=0.05)):
        d.add(one)
    d.add(cw.QuadraticTorque("load", shaft=shaft, nominal_torque=-20.0, nominal_speed=100.0))
    run = d.simulate(8.0, method=method, rtol=1e-8)
    drawn = run["first.electric_energy"] + run["other.electric_energy"] + 250.0 * run.time
    given = run["battery.energy"] - run["battery.loss"] + run["battery.unserved"] - run["battery.refused"]
    # both are integrals of the same powers, one as a state, one by quadrature
    assert np.abs(drawn - given).max() <= 1e-6 * np.abs(drawn).max()
    assert abs(run.energy.residual) <= 1e-6 * np.abs(drawn).max()
    # the open-circuit voltage over the charge is the energy of the cells
    fine = np.linspace(run["battery.charge"][-1], 0.5, 100001)
    voltage = np.interp(fine, TABLE["charges"], TABLE["voltages"])
    assert run["battery.energy"][-1] == pytest.approx(3600.0 * np.trapezoid(voltage, fine), rel=1e-6)


def one_motor(copper_loss: float = 0.1) -> cw.Driveline:
    d = cw.Driveline("one motor")
    shaft = d.shaft("shaft", inertia=0.2, speed=50.0)
    motor = cw.ElectricMotor(
        "motor", shaft=shaft, max_torque=120.0, lag=0.05, no_load_loss=100.0, copper_loss=copper_loss,
        command=cw.Table([(0.0, 0.0), (1.0, 60.0), (2.0, -60.0)]),
    )  # fmt: skip
    d.add(motor)
    d.add(cw.Battery("battery", **TABLE, capacity=3600.0, load=cw.SupplyPower(motor)))  # type: ignore[arg-type]
    return d


def test_derivatives_and_steps_of_one_length() -> None:
    """The charge by a loss against differences of runs; a row of the linear system against the current that it has."""
    wanted, change = cw.at("battery.charge", 2.0), 1e-4
    found = one_motor().simulate(2.0).gradient(wanted, "motor.copper_loss")
    upper, lower = (
        one_motor(0.1 + sign * change).simulate(2.0, rtol=1e-11)["battery.charge"][-1] for sign in (1.0, -1.0)
    )
    # a central difference of second order
    assert float(np.squeeze(found.matrix)) == pytest.approx((upper - lower) / (2.0 * change), rel=1e-6)
    system = cw.linearise(one_motor())
    battery = next(part for part in one_motor().elements if part.name == "battery")
    voltage, resistance = battery.voltage(0.5), battery.resistance(0.5)
    current = battery.answer(0.5, 100.0).current
    row, column = (list(system.states).index(name) for name in ("battery.energy", "motor.request"))
    # power by torque is the speed, current by power 1/(U - 2 R I)
    assert system.A[row, column] == pytest.approx(voltage * 50.0 / (voltage - 2.0 * resistance * current), rel=1e-9)
    run = one_motor().simulate(2.0, method="fixed", step=1e-3)
    given = run["battery.energy"] - run["battery.loss"] + run["battery.unserved"] - run["battery.refused"]
    # the power of a step is its work; losses are those of its middle
    assert given == pytest.approx(run["motor.electric_energy"], abs=1e-6 * np.abs(given).max())


def test_mistakes() -> None:
    d = cw.Driveline("wrong")
    shaft = d.shaft("shaft", inertia=1.0)
    torque = d.add(cw.Torque("torque", shaft=shaft, torque=1.0))
    d.add(cw.Battery("battery", **{**FLAT, "voltages": (1.0,)}, load=cw.SupplyPower(torque)))  # type: ignore[arg-type]
    assert "has 1 values for 2 charges" in "\n".join(map(str, d.check()))
    d = cw.Driveline("wrong")
    shaft = d.shaft("shaft", inertia=1.0)
    torque = d.add(cw.Torque("torque", shaft=shaft, torque=1.0))
    d.add(cw.Battery("battery", **FLAT, load=cw.SupplyPower(torque)))  # type: ignore[arg-type]
    assert "draws nothing from a supply; give an electric motor" in "\n".join(map(str, d.check()))
