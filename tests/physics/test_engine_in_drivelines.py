"""Engine and motor among clutches and brakes: start, stall, launch; random drivelines against finer tolerances."""

from __future__ import annotations

import numpy as np
import pytest

import clutchwork as cw

FINE = {"rtol": 1e-9, "atol": 1e-11}
FULL, DRAG = [(60.0, 90.0), (200.0, 220.0), (400.0, 240.0), (600.0, 180.0)], [(0.0, -20.0), (600.0, -60.0)]
CONTROL = {
    "idle_speed": 85.0,
    "idle_gain": 0.01,
    "idle_integral": 0.04,
    "lag": 0.05,
    "stall_speed": 40.0,
    "max_speed": 600.0,
    "limit_band": 30.0,
}
LAW = cw.Coulomb(static=0.35, kinetic=0.3)


def _engine(d, throttle, speed=0.0, **more):
    crank = d.shaft("crank", inertia=0.2, speed=speed)
    d.add(cw.Engine("engine", shaft=crank, throttle=throttle, full_load=FULL, motoring=DRAG, **(CONTROL | more)))
    return crank


@pytest.mark.parametrize(("torque", "starts"), [(1.9, False), (6.0, True)])
def test_a_starter_must_overcome_what_the_engine_holds(torque, starts):
    """Ratio 10: 19 N m do not break 20 N m away, 60 N m do; above the stall speed the engine runs by itself."""
    d = cw.Driveline()
    crank, rotor = _engine(d, 0.0), d.shaft("rotor", inertia=1e-3)
    pinion = d.shaft("pinion")
    d.add(cw.Gear("g", input=rotor, output=pinion, ratio=10.0))
    law = cw.Coulomb(static=1.0, kinetic=1.0)
    d.add(cw.OneWayClutch("overrun", base=pinion, follower=crank, friction=law, gain=1.0, pressure=0.0))
    command = cw.Table([(0.0, torque), (1.0, torque), (1.0, 0.0)])
    d.add(cw.ElectricMotor("starter", shaft=rotor, command=command, max_torque=8.0, max_power=2e3))
    run = d.simulate(6.0, **FINE)
    assert abs(run.energy.residual) <= 1e-8 * run.energy.turnover + 1e-12
    if starts:
        assert run["crank.speed"][-1] == pytest.approx(85.0, abs=0.5)
        assert run["overrun.state"][-1] != "locked"
    else:
        assert np.all(run["crank.speed"] == 0.0)


def test_a_clutch_that_closes_too_fast_stalls_the_engine_and_all_come_to_rest_together():
    """Engine, clutch and a car on its brake: both hold, the engine with what is left of its 20 N m."""
    d = cw.Driveline()
    crank, car = _engine(d, 0.0, speed=85.0, initial_idle=0.1), d.shaft("car", inertia=6.0)
    d.add(
        cw.Clutch(
            "clutch", base=crank, follower=car, friction=LAW, gain=1.0, normal_force=cw.Ramp(height=900.0, duration=0.5)
        )
    )
    d.add(cw.Brake("brake", shaft=car, friction=LAW, gain=1.0, normal_force=2000.0))
    d.add(cw.Torque("slope", shaft=car, torque=-15.0))
    run = d.simulate(3.0, **FINE)
    assert run["crank.speed"][-1] == 0.0
    assert run["engine.drag.state"][-1] == run["brake.state"][-1] == "locked"
    # 15 N m are held by brake and engine together
    assert run["brake.torque"][-1] + run["engine.torque"][-1] == pytest.approx(15.0, rel=1e-9)
    assert abs(run.energy.residual) <= 1e-8 * run.energy.turnover


def _random(seed):
    g = np.random.default_rng(seed)
    d = cw.Driveline()
    throttle = cw.Table([(0.0, 0.0), (0.5, 0.0), (0.8, g.uniform(0.2, 1.0)), (2.0, g.uniform(0.2, 1.0)), (2.2, 0.0)])
    crank = _engine(
        d, throttle, speed=85.0, initial_idle=0.12, cut=bool(g.integers(2)), max_speed=g.uniform(250.0, 500.0)
    )
    plate, wheel = d.shaft("plate", inertia=0.02), d.shaft("wheel", inertia=g.uniform(0.5, 3.0))
    force = cw.Ramp(height=g.uniform(500.0, 1500.0), duration=g.uniform(0.3, 1.0), start=0.5)
    d.add(cw.Clutch("clutch", base=crank, follower=plate, friction=LAW, gain=1.0, normal_force=force))
    d.add(cw.SpringDamper("shaft", base=plate, follower=wheel, stiffness=g.uniform(500.0, 3000.0), damping=2.0))
    d.add(cw.QuadraticTorque("drag", shaft=wheel, nominal_torque=-g.uniform(10.0, 80.0), nominal_speed=300.0))
    d.add(cw.BearingFriction("bearing", shaft=wheel, friction=cw.Coulomb(static=1.0, kinetic=1.0), torque=5.0))
    if seed % 2:
        command = cw.Sine(amplitude=g.uniform(20.0, 120.0), frequency=g.uniform(0.3, 1.5))
        envelope = {"max_torque": [(0.0, 80.0), (300.0, 40.0)], "max_power": 1e4, "copper_loss": 0.05}
        d.add(cw.ElectricMotor("motor", shaft=wheel, command=command, lag=0.02, thermal_mass=800.0, **envelope))
    return d


@pytest.mark.parametrize("seed", range(8))
def test_random_drivelines_against_a_finer_tolerance(seed):
    times = np.linspace(0.0, 3.0, 151)
    coarse, fine = (_random(seed).simulate(3.0, times=times, rtol=r, atol=1e-3 * r) for r in (1e-7, 1e-10))
    assert abs(fine.energy.residual) <= 1e-8 * fine.energy.turnover
    for name in ("crank.speed", "plate.speed", "wheel.speed"):
        size = np.abs(fine[name]).max()
        # a swing behind the clutch carries what 1e-7 of the torque leaves
        np.testing.assert_allclose(coarse[name], fine[name], atol=2e-5 * size, err_msg=name)
    assert [e.element for e in coarse.events] == [e.element for e in fine.events]


@pytest.mark.parametrize("swapped", [False, True])
def test_an_engine_at_rest_that_is_drawn_backward_does_not_burn(swapped):
    """With the torque of the burning engine the clutch would hold, without it it slips."""
    burning, load, held, inertia = 80.0, 100.0, 30.0, 0.5
    d = cw.Driveline()
    a, b = d.shaft("a", inertia=inertia), d.shaft("b", inertia=inertia)
    torques = ((0.0, burning), (0.0, burning))
    grid = {"speeds": (0.0, 100.0), "throttles": (0.0, 1.0), "torques": torques}
    d.add(cw.Engine("e", shaft=a, throttle=1.0, **grid))
    d.add(cw.Torque("t", shaft=a, torque=-load))
    ends = {"base": b, "follower": a} if swapped else {"base": a, "follower": b}
    d.add(cw.Clutch("c", **ends, friction=cw.Coulomb(static=held, kinetic=held), gain=1.0, normal_force=1.0))
    run = d.simulate(0.1)
    assert run.status == "done"
    np.testing.assert_allclose(run["a.speed"], -(load - held) / inertia * run.time, atol=1e-9)
    np.testing.assert_allclose(run["b.speed"], -held / inertia * run.time, atol=1e-9)
