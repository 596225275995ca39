"""Thermal nodes against closed forms: rise of a mass, exchange of heat, a plate with a gradient, the balance."""

from __future__ import annotations

import math

import numpy as np
import pytest

import clutchwork as cw

# tolerance of the runs; the closed forms are then met to some 1e-8
FINE = {"rtol": 1e-10, "atol": 1e-10}


def _heater(d, node, power, speed=10.0):
    """A damper between the housing and a shaft of constant speed, which makes a constant heat flow [W]."""
    shaft = d.shaft("heater shaft", inertia=1.0)
    d.add(cw.PrescribedSpeed("drive", shaft=shaft, speed=speed))
    d.add(cw.Damper("heater", base=d.housing, follower=shaft, damping=power / speed**2, heat=node))


def _idle(d, speed=0.0):
    return d.shaft("idle", inertia=1.0, speed=speed)


@pytest.mark.feature("thermal: slip power heats the thermal mass")
def test_engagement_heats_a_mass_by_its_energy_over_its_capacity():
    """Two inertias that a clutch brings together lose E = 1/2 Jred w0^2."""
    d = cw.Driveline()
    a, b = d.shaft("a", inertia=0.3, speed=120.0), d.shaft("b", inertia=0.6)
    plates = d.thermal("plates", capacity=250.0, temperature=310.0)
    law = cw.Coulomb(static=0.15, kinetic=0.1)
    d.add(cw.Clutch("c1", base=b, follower=a, friction=law, gain=1.0, pressure=300.0, heat=plates))
    run = d.simulate(2.0, **FINE)
    energy = 0.5 * (0.3 * 0.6 / 0.9) * 120.0**2
    assert run["c1.state"][-1] == "locked"
    assert run["plates.heat"][-1] == pytest.approx(energy, rel=1e-9)
    assert run["plates.temperature"][-1] == pytest.approx(310.0 + energy / 250.0, rel=1e-12)
    np.testing.assert_array_equal(run["c1.temperature"], run["plates.temperature"])
    assert run.units["plates.temperature"] == "K"
    assert run.units["plates.heat"] == "J"


def test_a_share_of_the_heat_is_followed():
    d = cw.Driveline()
    a = d.shaft("a", inertia=0.5, speed=80.0)
    law = cw.Coulomb(static=0.1, kinetic=0.1)
    lining = d.thermal("lining", capacity=100.0)
    d.add(cw.Brake("b", shaft=a, friction=law, gain=1.0, pressure=200.0, heat=lining, heat_share=0.3))
    run = d.simulate(3.0, **FINE)
    energy = 0.5 * 0.5 * 80.0**2
    assert run["lining.heat"][-1] == pytest.approx(0.3 * energy, rel=1e-9)
    assert run.energy.untracked == pytest.approx(0.7 * energy, rel=1e-9)
    assert abs(run.energy.residual) <= 1e-8 * run.energy.turnover


def test_two_masses_through_a_conductance_approach_each_other_exponentially():
    d = cw.Driveline()
    _idle(d)
    hot = d.thermal("hot", capacity=200.0, temperature=400.0)
    cold = d.thermal("cold", capacity=600.0, temperature=300.0)
    d.add(cw.Conduction("wall", hot=hot, cold=cold, conductance=30.0))
    run = d.simulate(20.0, **FINE)
    rate = 30.0 * (1 / 200.0 + 1 / 600.0)
    difference = run["hot.temperature"] - run["cold.temperature"]
    np.testing.assert_allclose(difference, 100.0 * np.exp(-rate * run.time), atol=1e-6)
    mean = (200.0 * run["hot.temperature"] + 600.0 * run["cold.temperature"]) / 800.0
    np.testing.assert_allclose(mean, 325.0, rtol=1e-13)
    np.testing.assert_allclose(run["wall.heat_flow"], 30.0 * difference, rtol=1e-9, atol=1e-9)


def test_heat_flows_backward_where_cold_is_the_warmer_one():
    d = cw.Driveline()
    _idle(d)
    hot, cold = d.thermal("hot", capacity=10.0, temperature=280.0), d.ambient("cold", temperature=350.0)
    d.add(cw.Conduction("wall", hot=hot, cold=cold, conductance=5.0))
    run = d.simulate(100.0, **FINE)
    assert run["hot.temperature"][-1] == pytest.approx(350.0, rel=1e-9)
    assert run["cold.heat"][-1] == pytest.approx(-700.0, rel=1e-8)


def test_ambient_takes_what_the_mass_gives():
    """Constant heating of a mass that an ambient cools ends at power/conductance above it."""
    d = cw.Driveline()
    mass, air = d.thermal("mass", capacity=50.0, temperature=290.0), d.ambient("air", temperature=290.0)
    _heater(d, mass, power=400.0)
    d.add(cw.Conduction("wall", hot=mass, cold=air, conductance=8.0))
    run = d.simulate(30.0, **FINE)
    rise = 400.0 / 8.0 * (1.0 - np.exp(-8.0 / 50.0 * run.time))
    np.testing.assert_allclose(run["mass.temperature"], 290.0 + rise, atol=1e-6)
    np.testing.assert_allclose(run["air.heat"] + run["mass.heat"], 400.0 * run.time, rtol=1e-9, atol=1e-6)
    np.testing.assert_array_equal(run["air.temperature"], 290.0)
    assert run.energy.thermal == {"mass": pytest.approx(50.0 * rise[-1]), "air": pytest.approx(run["air.heat"][-1])}


def test_ambient_temperature_over_time():
    """Behind a ramp of slope r a mass lags by r C/G once the start has faded."""
    d = cw.Driveline()
    _idle(d)
    mass = d.thermal("mass", capacity=20.0, temperature=300.0)
    air = d.ambient("air", temperature=cw.Table([(0.0, 300.0), (1000.0, 500.0)]))
    d.add(cw.Conduction("wall", hot=mass, cold=air, conductance=4.0))
    run = d.simulate(200.0, **FINE)
    assert run["air.temperature"][-1] - run["mass.temperature"][-1] == pytest.approx(0.2 * 20.0 / 4.0, abs=1e-6)


@pytest.mark.feature("thermal: convection that depends on a speed")
@pytest.mark.parametrize("speed", [0.0, 40.0, -40.0, 100.0, 250.0])
def test_convection_follows_its_table_over_the_speed_of_a_shaft(speed):
    d = cw.Driveline()
    drum, air = d.thermal("drum", capacity=30.0, temperature=400.0), d.ambient("air", temperature=300.0)
    shaft = d.shaft("shaft", inertia=1.0)
    d.add(cw.PrescribedSpeed("drive", shaft=shaft, speed=speed))
    table = [(0.0, 2.0), (100.0, 12.0)]
    d.add(cw.Convection("fan", hot=drum, cold=air, conductance=table, speed=shaft))
    run = d.simulate(5.0, **FINE)
    conductance = 2.0 + 0.1 * min(abs(speed), 100.0)
    expected = 300.0 + 100.0 * np.exp(-conductance / 30.0 * run.time)
    np.testing.assert_allclose(run["drum.temperature"], expected, atol=1e-6)
    # the sensor on the shaft is no element of the user
    assert not [name for name in run.names if "sensor" in name]


@pytest.mark.feature("thermal: convection that depends on a speed")
def test_convection_over_a_changing_speed():
    """While a shaft slows down linearly the exponent is the integral of the conductance, kinks included."""
    d = cw.Driveline()
    drum, air = d.thermal("drum", capacity=30.0, temperature=400.0), d.ambient("air", temperature=300.0)
    shaft = d.shaft("shaft", inertia=1.0)
    d.add(cw.PrescribedSpeed("drive", shaft=shaft, speed=cw.Table([(0.0, 100.0), (10.0, -100.0), (20.0, -100.0)])))
    d.add(cw.Convection("fan", hot=drum, cold=air, conductance=[(0.0, 2.0), (50.0, 7.0), (60.0, 7.0)], speed=shaft))
    run = d.simulate(10.0, **FINE)
    # both halves: 50 rad/s at 7 W/K, 50 rad/s at 4.5 W/K in the mean
    integral = 2 * (2.5 * 7.0 + 2.5 * 4.5)
    assert run["drum.temperature"][-1] == pytest.approx(300.0 + 100.0 * math.exp(-integral / 30.0), abs=1e-5)


def test_convection_with_a_number_is_conduction():
    ends = []
    for kind in (cw.Convection, cw.Conduction):
        d = cw.Driveline()
        _idle(d)
        hot, cold = d.thermal("hot", capacity=3.0, temperature=400.0), d.ambient("cold")
        d.add(kind("x", hot=hot, cold=cold, conductance=5.0))
        ends.append(d.simulate(1.0, **FINE)["hot.temperature"][-1])
    assert ends[0] == pytest.approx(ends[1], rel=1e-9)


@pytest.mark.feature("thermal: oil flow")
def test_oil_carries_heat_away_while_it_flows():
    d = cw.Driveline()
    _idle(d)
    plates, sump = d.thermal("plates", capacity=500.0, temperature=420.0), d.ambient("sump", temperature=360.0)
    flow = cw.Table([(0.0, 0.1), (2.0, 0.1), (2.0, -0.1), (4.0, -0.1)])
    d.add(cw.OilFlow("oil", hot=plates, inlet=sump, flow=flow, heat_capacity=2100.0))
    run = d.simulate(4.0, **FINE)
    # a flow below zero counts as zero
    expected = 360.0 + 60.0 * np.exp(-0.1 * 2100.0 / 500.0 * np.minimum(run.time, 2.0))
    np.testing.assert_allclose(run["plates.temperature"], expected, atol=1e-6)


def _plate(nodes, end):
    """Surface and back of a steel plate that 50 kW heat, over time."""
    d = cw.Driveline()
    values = {"thickness": 0.004, "area": 0.02, "conductivity": 45.0, "density": 7800.0, "specific_heat": 480.0}
    plate = d.add(cw.ThermalPlate("plate", **values, nodes=nodes, temperature=350.0))
    _heater(d, plate.surface, power=5e4)
    run = d.simulate(end, **FINE)
    return run, values


def _series(values, power, time, place):
    """Temperature rise at a share of the thickness, from the insulated back on. Carslaw and Jaeger, section 3.8."""
    length, conductivity = values["thickness"], values["conductivity"]
    per_area = values["density"] * values["specific_heat"] * length
    n = np.arange(1, 400)[:, None]
    decay = conductivity * length / per_area * (n * np.pi / length) ** 2
    fading = np.sum((-1.0) ** n / n**2 * np.exp(-decay * time) * np.cos(n * np.pi * place), axis=0)
    steady = (3.0 * place**2 - 1.0) / 6.0 - 2.0 / np.pi**2 * fading
    return power / values["area"] * (time / per_area + length / conductivity * steady)


@pytest.mark.feature("thermal: plates with a gradient")
def test_plate_with_a_gradient_follows_the_series():
    """Half of the time that heat needs to cross the plate: 4 mm of steel, 0.66 s."""
    run, values = _plate(41, end=0.66)
    late = run.time > 0.1
    for name, place in (("surface", 1.0), ("back", 0.0), ("node_21", 0.5)):
        rise = run[f"plate.{name}.temperature"][late] - 350.0
        expected = _series(values, 5e4, run.time[late], place)
        # 1/(nodes - 1)^2 of the difference across the plate, power thickness/(conductivity area) = 222 K
        np.testing.assert_allclose(rise, expected, atol=222.0 / 40.0**2)


def test_plate_gets_better_with_the_square_of_its_nodes():
    errors = []
    for nodes in (6, 11, 21):
        run, values = _plate(nodes, end=0.4)
        errors.append(run["plate.surface.temperature"][-1] - 350.0 - float(_series(values, 5e4, 0.4, 1.0)[0]))
    assert errors[0] / errors[1] == pytest.approx(4.0, abs=0.2)
    assert errors[1] / errors[2] == pytest.approx(4.0, abs=0.1)


def test_plate_of_two_nodes_holds_all_heat():
    run, values = _plate(2, end=1.0)
    held = run["plate.surface.heat"] + run["plate.back.heat"]
    np.testing.assert_allclose(held, 5e4 * run.time, rtol=1e-9, atol=1e-6)
    capacity = math.prod(values[name] for name in ("thickness", "area", "density", "specific_heat"))
    mean = held / capacity + 350.0
    both = 0.5 * (run["plate.surface.temperature"] + run["plate.back.temperature"])
    np.testing.assert_allclose(both, mean, rtol=1e-12)


def _network(seed):
    """Clutches, a damper, a spring with damping and a brake that heat a random network."""
    rng = np.random.default_rng(seed)
    d = cw.Driveline()
    a, b, c = (d.shaft(name, inertia=rng.uniform(0.1, 1.0), speed=rng.uniform(-100.0, 100.0)) for name in "abc")
    masses = [
        d.thermal(f"m{k}", capacity=rng.uniform(50.0, 500.0), temperature=rng.uniform(280.0, 400.0)) for k in range(3)
    ]
    air = d.ambient("air", temperature=cw.Sine(amplitude=5.0, frequency=0.3, offset=295.0))
    law = cw.Exponential(static=0.15, slow=0.14, fast=0.08, speed=20.0)
    load = {"gain": 1.0, "pressure": cw.Ramp(height=200.0, duration=1.0)}
    d.add(cw.Clutch("c1", base=a, follower=b, friction=law, **load, heat=masses[0], heat_share=rng.uniform(0.2, 1.0)))
    d.add(cw.Brake("b1", shaft=c, friction=law, gain=1.0, pressure=rng.uniform(10.0, 90.0), heat=masses[1]))
    d.add(cw.SpringDamper("s", base=b, follower=c, stiffness=800.0, damping=2.0, heat=masses[2]))
    d.add(cw.Damper("v", base=d.housing, follower=a, damping=0.2, heat=air))
    d.add(cw.Torque("t", shaft=a, torque=cw.Sine(amplitude=30.0, frequency=1.0)))
    d.add(cw.Conduction("k1", hot=masses[0], cold=masses[1], conductance=rng.uniform(1.0, 50.0)))
    d.add(cw.Conduction("k2", hot=masses[1], cold=masses[2], conductance=rng.uniform(1.0, 50.0)))
    d.add(cw.Convection("fan", hot=masses[2], cold=air, conductance=[(0.0, 1.0), (100.0, 9.0)], speed=c))
    d.add(cw.OilFlow("oil", hot=masses[0], inlet=air, flow=cw.Step(height=0.02, start=0.7)))
    return d


@pytest.mark.parametrize("seed", range(12))
def test_energy_balance_with_thermal_nodes(seed):
    run = _network(seed).simulate(3.0, rtol=1e-9, atol=1e-9)
    balance = run.energy
    assert abs(balance.residual) <= 1e-8 * balance.turnover
    made = sum(heat * balance.shares.get(name, 0.0) for name, heat in balance.heat.items())
    assert sum(balance.thermal.values()) == pytest.approx(made, abs=1e-8 * balance.turnover)
    assert set(balance.to_dict()["thermal_J"]) == {"m0", "m1", "m2", "air"}
    assert "in thermal nodes" in str(balance)


@pytest.mark.parametrize("method", ["rodas5p", "dopri5"])
def test_both_integrators_agree(method):
    fine = _network(3).simulate(2.0, rtol=1e-11, atol=1e-11)
    run = _network(3).simulate(2.0, rtol=1e-8, atol=1e-8, method=method)
    for name in ("m0", "m1", "m2"):
        assert run[f"{name}.temperature"][-1] == pytest.approx(fine[f"{name}.temperature"][-1], rel=1e-7)


@pytest.mark.parametrize("share", [1.0, 0.4])
def test_heat_of_an_impulse_arrives_too(share):
    """A clutch that starts locked between speeds that differ loses E at once, of which the node takes its share."""
    d = cw.Driveline()
    a, b = d.shaft("a", inertia=1.0, speed=10.0), d.shaft("b", inertia=1.0, speed=0.0)
    plates = d.thermal("plates", capacity=5.0)
    law = cw.Coulomb(static=0.2, kinetic=0.1)
    d.add(
        cw.Clutch(
            "c", base=b, follower=a, friction=law, gain=1.0, pressure=100.0, locked=True, heat=plates, heat_share=share
        )
    )
    run = d.simulate(0.1, **FINE)
    assert run.energy.heat["c"] == pytest.approx(25.0)
    assert run["plates.temperature"][-1] == pytest.approx(300.0 + 5.0 * share)
    assert abs(run.energy.residual) <= 1e-9


def test_adding_thermal_nodes_does_not_change_the_motion():
    """Nothing depends on the temperatures here, so only the steps may differ."""
    runs = []
    for warm in (False, True):
        d = cw.Driveline()
        a, b = d.shaft("a", inertia=0.3, speed=120.0), d.shaft("b", inertia=0.6)
        node = d.thermal("plates", capacity=250.0) if warm else None
        law = cw.Coulomb(static=0.15, kinetic=0.1)
        d.add(cw.Clutch("c1", base=b, follower=a, friction=law, gain=1.0, pressure=300.0, heat=node))
        runs.append(d.simulate(2.0, **FINE))
    (cold,), (hot,) = ([e for e in run.events if e.after == "locked"] for run in runs)
    assert hot.time == pytest.approx(cold.time, abs=1e-12)


@pytest.mark.parametrize("speeds", [(0.0, 195.0), (0.0, -195.0), (195.0, -120.5), (-0.5, 0.25), (450.0, 3.0)])
@pytest.mark.parametrize("first", [0.0, 20.0])
@pytest.mark.parametrize("points", [2, 60, 5000])
def test_a_speed_that_jumps_over_many_points_of_a_conductance(points: int, first: float, speeds: tuple[float, float]):
    """The drum cools with the conductance before the jump, then with that behind it: an event passes all points."""
    d = cw.Driveline()
    drum, air = d.thermal("drum", capacity=100.0, temperature=400.0), d.ambient("air", temperature=300.0)
    rising = [(float(x), 1.0 + 0.1 * float(x)) for x in np.linspace(first, 200.0, points)]
    before, behind = speeds
    fan = cw.Step(height=behind - before, start=1.0, offset=before)
    d.add(cw.Convection("walls", hot=drum, cold=air, conductance=rising, speed=fan))
    d.add(cw.Damper("drag", base=d.housing, follower=_idle(d), damping=1.0))
    run = d.simulate(3.0, **FINE)
    one, other = (1.0 + 0.1 * min(max(abs(speed), first), 200.0) for speed in speeds)
    assert run["drum.temperature"][-1] == pytest.approx(
        300.0 + 100.0 * math.exp(-(one + 2.0 * other) / 100.0), rel=1e-9
    )
