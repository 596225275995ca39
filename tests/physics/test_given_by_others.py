"""Inputs that other components give: an actuator presses, heat wears, a node sets the temperature of a law."""

from __future__ import annotations

import numpy as np
import pytest

import clutchwork as cw

FINE = {"rtol": 1e-10, "atol": 1e-10}
LAW = cw.Coulomb(static=0.15, kinetic=0.1)


def _spinning(d, *, inertia=0.5, speed=200.0):
    return d.shaft("a", inertia=inertia, speed=speed)


def test_an_actuator_presses_a_brake():
    """A filled piston follows a step with its lag; the speed is the integral of the torque."""
    d = cw.Driveline()
    a = _spinning(d)
    piston = d.add(cw.PressureActuator("piston", command=2e5, lag=0.05, filled=True))
    d.add(cw.Brake("b1", shaft=a, friction=LAW, gain=1e-3, pressure=piston))
    run = d.simulate(0.5, **FINE)
    pressure = 2e5 * -np.expm1(-run.time / 0.05)
    np.testing.assert_allclose(run["piston.pressure"], pressure, atol=1e-4)
    np.testing.assert_array_equal(run["b1.pressure"], run["piston.pressure"])
    assert run.units["b1.pressure"] == "Pa"
    turned = 0.1 * 1e-3 * 2e5 / 0.5 * (run.time - 0.05 * -np.expm1(-run.time / 0.05))
    np.testing.assert_allclose(run["a.speed"], 200.0 - turned, atol=1e-7)
    assert abs(run.energy.residual) <= 1e-9 * run.energy.turnover


def test_one_actuator_presses_two_contacts():
    d = cw.Driveline()
    a, b = _spinning(d), d.shaft("b", inertia=0.2, speed=100.0)
    piston = d.add(cw.PressureActuator("piston", command=1e5, lag=0.1, filled=True))
    for name, shaft in (("b1", a), ("b2", b)):
        d.add(cw.Brake(name, shaft=shaft, friction=LAW, gain=1e-3, pressure=(piston, "pressure")))
    run = d.simulate(0.3, **FINE)
    np.testing.assert_allclose(run["b1.torque"], run["b2.torque"], rtol=1e-12)


def test_heat_of_a_contact_wears():
    """Depth is rate times energy over area, whatever way the energy took. The solver follows the energy."""
    d = cw.Driveline()
    a = _spinning(d)
    brake = d.add(cw.Brake("b1", shaft=a, friction=LAW, gain=1.0, pressure=cw.Ramp(height=900.0, duration=1.0)))
    d.add(cw.Wear("wear", rate=2e-13, area=0.01, heat=cw.HeatFlow(brake)))
    run = d.simulate(3.0, **FINE)
    energy = 0.5 * 0.5 * 200.0**2
    assert run["b1.state"][-1] == "locked"
    assert run["wear.depth"][-1] == pytest.approx(2e-13 * energy / 0.01, rel=1e-8)
    np.testing.assert_allclose(run["wear.depth"], 2e-13 / 0.01 * run["b1.heat"], rtol=1e-7, atol=1e-18)


def _faded(temperature, heat):
    """A brake whose coefficient falls from 0.4 at 300 K to 0.2 at 500 K."""
    d = cw.Driveline()
    a = _spinning(d)
    lining = d.thermal("lining", capacity=100.0) if heat else None
    law = cw.TemperatureTable(
        static=[(300.0, 0.42), (500.0, 0.22)], kinetic=[(300.0, 0.4), (500.0, 0.2)], temperature=temperature
    )
    d.add(cw.Brake("b1", shaft=a, friction=law, gain=1.0, pressure=100.0, heat=lining))
    return d


def test_a_law_takes_the_temperature_of_the_node_of_its_contact():
    """The torque falls with the heat q: with x = q/E, dx/dt follows from 0.5 J w^2 = E - q."""
    run = _faded(None, heat=True).simulate(1.0, **FINE)
    temperature = 300.0 + run["b1.heat"] / 100.0
    np.testing.assert_allclose(run["lining.temperature"], temperature, rtol=1e-10)
    np.testing.assert_array_equal(run["b1.friction.temperature"], run["lining.temperature"])
    coefficient = 0.4 - 0.001 * (temperature - 300.0)
    np.testing.assert_allclose(run["b1.torque"], -100.0 * coefficient, rtol=1e-9)


def test_a_given_temperature_goes_before_that_of_the_node():
    run = _faded(400.0, heat=True).simulate(0.1, **FINE)
    np.testing.assert_allclose(run["b1.torque"], -30.0, rtol=1e-9)


def test_a_law_without_temperature_is_a_mistake():
    (problem,) = _faded(None, heat=False).check()
    assert problem.quantity == "friction.temperature"
    assert "is missing" in str(problem)


def test_drag_counts_as_the_clutch():
    d = cw.Driveline()
    a, b = _spinning(d), d.shaft("b", inertia=0.3)
    disc = cw.DiskClutch(
        "c1", base=b, follower=a, friction=LAW, radius=0.1, surfaces=2, area=1e-3, pressure=5e4, drag=0.05,
        thermal_mass=200.0,
    )  # fmt: skip
    d.add(disc)
    run = d.simulate(0.5, **FINE)
    contact = -0.1 * disc.gain * 5e4
    np.testing.assert_allclose(run["c1.torque"], contact - 0.05 * run["c1.slip"], rtol=1e-9)
    np.testing.assert_allclose(run["c1.heat"], -run["c1.work"], rtol=1e-12)
    assert run["c1.heat"][-1] == pytest.approx(run["c1.plates.heat"][-1], rel=1e-9)


@pytest.mark.parametrize("kind", ["toml", "json"])
def test_references_in_a_model_file(tmp_path, kind):
    d = cw.Driveline("refers")
    a = _spinning(d)
    # the brake stands before what it refers to
    piston = cw.PressureActuator("piston", command=1e5, lag=0.1)
    brake = d.add(cw.Brake("b1", shaft=a, friction=LAW, gain=1e-3, pressure=piston))
    d.add(piston)
    wear = d.add(cw.Wear("wear", rate=1e-13, area=0.01, heat=cw.HeatFlow(brake)))
    d.add(
        cw.PlateContact("p1", base=d.housing, follower=a, friction=LAW, gain=1e-3, pressure=1e5, wear=(wear, "depth"))
    )
    d.save(tmp_path / f"model.{kind}")
    again = cw.Driveline.load(tmp_path / f"model.{kind}")
    assert again.to_dict() == d.to_dict()
    assert again.assemble().to_bytes() == d.assemble().to_bytes()
