"""Linear systems against formulas of textbooks, to round-off."""

from __future__ import annotations

import math

import numpy as np
import pytest

import clutchwork as cw

# eigenvalues of small well-scaled matrices, and the mathematics before them, are exact to this part
EXACT = 1e-9


def frequencies(lin: cw.Linear) -> list[float]:
    """Angular frequencies of the modes that swing [rad/s]."""
    return [2.0 * math.pi * mode.natural_frequency for mode in lin.modes.swinging]


def two_masses(**contact):
    """Engine, clutch, hub, spring, car."""
    d = cw.Driveline("two masses")
    engine = d.shaft("engine", inertia=0.2, speed=contact.pop("engine", 50.0))
    hub, car = d.shaft("hub", inertia=0.1, speed=50.0), d.shaft("car", inertia=1.5, speed=50.0)
    d.add(cw.Clutch("c1", base=engine, follower=hub, **contact))
    d.add(cw.SpringDamper("shaft", base=hub, follower=car, stiffness=900.0, damping=0.6))
    d.add(cw.Torque("drive", shaft=engine, torque=20.0))
    return d


COULOMB = {"friction": cw.Coulomb(static=0.1, kinetic=0.1), "gain": 1.0, "normal_force": 1000.0}


def test_locked_clutch_joins_the_inertias_and_leaves_one_speed_less():
    lin = cw.linearise(two_masses(**COULOMB))
    assert lin.contacts == {"c1": "locked"}
    assert lin.states == ("engine.speed", "car.speed", "shaft.twist")
    reduced = 1.0 / (1.0 / 0.3 + 1.0 / 1.5)
    (mode,) = lin.modes.swinging
    assert frequencies(lin) == pytest.approx([math.sqrt(900.0 / reduced)], rel=EXACT)
    assert mode.damping == pytest.approx(0.6 / (2.0 * math.sqrt(900.0 * reduced)), rel=EXACT)
    # both ends keep the centre of mass at rest
    assert mode.shape["engine"] == mode.shape["hub"] == 1.0
    assert mode.shape["car"] == pytest.approx(-0.3 / 1.5, rel=EXACT)


def test_slipping_clutch_with_constant_torque_frees_the_engine():
    lin = cw.linearise(two_masses(**COULOMB, engine=150.0))
    assert lin.contacts == {"c1": "backward"}
    assert lin.states == ("engine.speed", "hub.speed", "car.speed", "shaft.twist")
    assert frequencies(lin) == pytest.approx([math.sqrt(900.0 * (1.0 / 0.1 + 1.0 / 1.5))], rel=EXACT)
    place = lin.inputs.index("c1.normal_force")
    # the torque of the contact is a tenth of the force, on both sides
    assert lin.B[:3, place] == pytest.approx([-0.1 / 0.2, 0.1 / 0.1, 0.0], rel=EXACT)


def test_slope_of_the_friction_law_is_a_damping_and_a_falling_one_makes_judder():
    falling = cw.FrictionTable(kinetic=[(0.0, 0.14), (200.0, 0.10)], static=0.15)
    lin = cw.linearise(two_masses(friction=falling, gain=1.0, normal_force=1000.0, engine=150.0))
    slope = 1000.0 * (0.10 - 0.14) / 200.0
    expected = np.array([[-slope / 0.2, slope / 0.2], [slope / 0.1, (-slope - 0.6) / 0.1]])
    assert lin.A[:2, :2] == pytest.approx(expected, rel=EXACT)
    (judder,) = lin.modes.swinging
    # 0.2 N m s/rad of negative damping at a hub with 0.6 in its shaft: alone it would not grow
    assert judder.damping > 0.0
    softer = two_masses(friction=falling, gain=1.0, normal_force=10_000.0, engine=150.0)
    (judder,) = cw.linearise(softer).modes.swinging
    assert judder.damping < 0.0
    assert judder.time_constant < 0.0
    assert "grows" in judder.kind


def test_chain_of_equal_discs_has_the_frequencies_of_a_comb():
    n, inertia, stiffness = 8, 0.05, 2000.0
    d = cw.Driveline("chain")
    discs = [d.shaft(f"d{i}", inertia=inertia) for i in range(n)]
    for i in range(n - 1):
        d.add(cw.Spring(f"k{i}", base=discs[i], follower=discs[i + 1], stiffness=stiffness))
    lin = cw.linearise(d)
    comb = [2.0 * math.sqrt(stiffness / inertia) * math.sin(math.pi * k / (2 * n)) for k in range(1, n)]
    assert frequencies(lin) == pytest.approx(comb, rel=EXACT)
    # mode k is a cosine over the discs
    for k, mode in enumerate(lin.modes.swinging, 1):
        wave = np.cos(math.pi * k * (np.arange(n) + 0.5) / n)
        shape = np.array([mode.shape[f"d{i}"] for i in range(n)])
        assert shape / shape[0] == pytest.approx(wave / wave[0], abs=1e-6)


@pytest.mark.parametrize("n", [3, 15])
def test_chain_whose_ends_are_locked_together_becomes_a_ring(n):
    inertia, stiffness = 0.05, 2000.0
    d = cw.Driveline("ring")
    discs = [d.shaft(f"d{i}", inertia=inertia) for i in range(n + 1)]
    for i in range(n):
        d.add(cw.Spring(f"k{i}", base=discs[i], follower=discs[i + 1], stiffness=stiffness))
    d.add(cw.Clutch("lock", base=discs[0], follower=discs[n], **COULOMB))
    lin = cw.linearise(d)
    # one of the joined discs is gone, and of n twists only n - 1 can move apart
    assert len(lin.states) == n + n - 1
    values = np.linalg.eigvals(lin.A)
    first = np.zeros((n, n))
    for i in range(n):
        for a, b in ((i, i), ((i + 1) % n, (i + 1) % n)):
            first[a, b] += stiffness
        first[i, (i + 1) % n] -= stiffness
        first[(i + 1) % n, i] -= stiffness
    mass = np.diag([2 * inertia] + [inertia] * (n - 1))
    expected = np.sort(np.sqrt(np.clip(np.linalg.eigvals(np.linalg.solve(mass, first)).real, 0.0, None)))[1:]
    found = np.sort(values.imag[values.imag > 1e-6 * np.abs(values).max()])
    assert found == pytest.approx(expected, rel=1e-7)


def test_planetary_set_with_its_ring_held_reflects_the_inertia():
    ratio, sun_inertia, carrier_inertia, stiffness = 2.0, 0.02, 0.3, 500.0
    d = cw.Driveline("planetary")
    sun, ring = d.shaft("sun", inertia=sun_inertia), d.shaft("ring", inertia=0.1)
    carrier, load = d.shaft("carrier", inertia=carrier_inertia), d.shaft("load", inertia=5.0)
    d.add(cw.Planetary("set", sun=sun, ring=ring, carrier=carrier, ratio=ratio))
    d.add(cw.Brake("b1", shaft=ring, **COULOMB))
    d.add(cw.Spring("shaft", base=carrier, follower=load, stiffness=stiffness))
    d.add(cw.Torque("drive", shaft=sun, torque=0.0))
    lin = cw.linearise(d, outputs=["*.speed", "b1.torque"])
    # the sun turns 1 + k times as fast as the carrier
    reflected = carrier_inertia + (1.0 + ratio) ** 2 * sun_inertia
    reduced = 1.0 / (1.0 / reflected + 1.0 / 5.0)
    assert frequencies(lin) == pytest.approx([math.sqrt(stiffness / reduced)], rel=EXACT)
    assert len(lin.states) == 3
    # the pinions turn the ring backward with k times what the drive does not need to accelerate the sun
    drive, brake = lin.inputs.index("drive.torque"), lin.outputs.index("b1.torque")
    acceleration = (1.0 + ratio) / reflected
    on_ring = ratio * (1.0 - sun_inertia * (1.0 + ratio) * acceleration)
    assert lin.D[brake, drive] == pytest.approx(on_ring, rel=EXACT)


def test_first_order_actuator_and_thermal_mass_have_their_time_constants():
    d = cw.Driveline("lags")
    d.shaft("idle", inertia=1.0)
    actuator = d.add(cw.PressureActuator("valve", command=2e5, lag=0.08, filled=True, initial_pressure=1e5))
    a, b = d.shaft("a", inertia=1.0, speed=80.0), d.shaft("b", inertia=1.0)
    plates, air = d.thermal("plates", capacity=500.0, temperature=350.0), d.ambient("air", temperature=300.0)
    lining = {"friction": cw.Coulomb(static=0.1, kinetic=0.1), "gain": 1e-3, "heat": plates}
    d.add(cw.Clutch("c1", base=a, follower=b, pressure=actuator, **lining))
    d.add(cw.Conduction("cooling", hot=plates, cold=air, conductance=2.5))
    lin = cw.linearise(d)
    assert {"valve.pressure", "plates.temperature"} <= set(lin.states)
    place = {name: number for number, name in enumerate(lin.states)}
    valve, warm = place["valve.pressure"], place["plates.temperature"]
    assert lin.A[valve, valve] == pytest.approx(-1.0 / 0.08, rel=EXACT)
    assert lin.A[warm, warm] == pytest.approx(-2.5 / 500.0, rel=EXACT)
    assert lin.B[valve, lin.inputs.index("valve.command")] == pytest.approx(1.0 / 0.08, rel=EXACT)
    assert lin.B[warm, lin.inputs.index("air.temperature")] == pytest.approx(2.5 / 500.0, rel=EXACT)
    # heat of friction is torque times slip, 0.1 gain slip per Pa
    assert lin.A[warm, valve] == pytest.approx(0.1 * 1e-3 * 80.0 / 500.0, rel=EXACT)
    assert lin.A[place["a.speed"], valve] == pytest.approx(-0.1 * 1e-3, rel=EXACT)
    assert lin.state["plates.temperature"] == 350.0
    assert lin.rate["plates.temperature"] == pytest.approx((0.1 * 1e-3 * 1e5 * 80.0 - 2.5 * 50.0) / 500.0, rel=EXACT)
    constants = [mode.time_constant for mode in lin.modes if not mode.shape and math.isfinite(mode.time_constant)]
    assert pytest.approx(2.5 / 500.0, rel=EXACT) in [1.0 / constant for constant in constants]


def test_coefficient_over_temperature_is_a_feedback_of_the_heat():
    d = cw.Driveline("hot")
    a, b = d.shaft("a", inertia=1.0, speed=100.0), d.shaft("b", inertia=2.0)
    plates = d.thermal("plates", capacity=400.0, temperature=350.0)
    law = cw.TemperatureTable(kinetic=[(300.0, 0.12), (400.0, 0.10)], static=[(300.0, 0.13), (400.0, 0.11)])
    d.add(cw.Clutch("c1", base=a, follower=b, friction=law, gain=1.0, normal_force=500.0, heat=plates))
    lin = cw.linearise(d, outputs=["c1.torque", "c1.power", "c1.capacity"])
    slope = 500.0 * (0.10 - 0.12) / 100.0
    # slip is follower less base, -100 rad/s
    assert lin.A[:, 2] == pytest.approx([-slope, slope / 2.0, slope * 100.0 / 400.0], rel=EXACT)
    assert lin.C[:, 2] == pytest.approx([slope, slope * -100.0, 500.0 * (0.11 - 0.13) / 100.0], rel=EXACT)
    torque = 500.0 * 0.11
    assert lin.C[1, :2] == pytest.approx([-torque, torque], rel=EXACT)


def test_shaft_without_inertia_between_spring_and_damper():
    d = cw.Driveline("maxwell")
    a, m, b = d.shaft("a", inertia=1.0), d.shaft("m"), d.shaft("b", inertia=2.0)
    d.add(cw.Spring("k", base=a, follower=m, stiffness=400.0))
    d.add(cw.Damper("c", base=m, follower=b, damping=5.0))
    d.add(cw.Torque("t", shaft=a, torque=0.0))
    lin = cw.linearise(d)
    assert lin.states == ("a.speed", "b.speed", "k.twist")
    # the shaft m turns with b, plus what the spring torque moves the damper
    assert pytest.approx(np.array([[0, 0, 400.0], [0, 0, -200.0], [-1.0, 1.0, -400.0 / 5.0]]), rel=EXACT) == lin.A
    assert lin.C[lin.outputs.index("m.speed")] == pytest.approx([0.0, 1.0, -80.0], rel=EXACT)


def test_springs_in_series_through_a_shaft_without_inertia_are_one_spring():
    d = cw.Driveline("series")
    a, m, b = d.shaft("a", inertia=1.0), d.shaft("m"), d.shaft("b", inertia=2.0)
    d.add(cw.Spring("k1", base=a, follower=m, stiffness=400.0))
    d.add(cw.Spring("k2", base=m, follower=b, stiffness=100.0))
    lin = cw.linearise(d)
    assert lin.states == ("a.speed", "b.speed", "k1.twist")
    assert frequencies(lin) == pytest.approx([math.sqrt(80.0 * 1.5)], rel=EXACT)
    # the softer one twists four times as much
    assert lin.C[lin.outputs.index("k2.twist")] == pytest.approx([0.0, 0.0, 4.0], rel=EXACT)


def driven(ring_inertia: float = 0.1):
    """A planetary set whose ring is turned, its carrier on a spring to a heavy load."""
    d = cw.Driveline("driven")
    sun, ring = d.shaft("sun", inertia=0.02), d.shaft("ring", inertia=ring_inertia)
    carrier, load = d.shaft("carrier", inertia=0.3), d.shaft("load", inertia=5.0)
    d.add(cw.Planetary("set", sun=sun, ring=ring, carrier=carrier, ratio=2.0))
    d.add(cw.PrescribedSpeed("motor", shaft=ring, speed=0.0))
    d.add(cw.SpringDamper("shaft", base=carrier, follower=load, stiffness=500.0, damping=0.4))
    return d


def test_prescribed_speed_by_value_and_by_acceleration_give_one_response():
    by_value = cw.linearise(driven(), inputs="motor.speed", outputs=["load.speed", "carrier.speed", "sun.speed"])
    by_slope = cw.linearise(driven(), inputs="motor.acceleration", outputs=["load.speed", "carrier.speed", "sun.speed"])
    assert "sun.speed_free" in by_value.states or "carrier.speed_free" in by_value.states
    assert len(by_slope.states) == len(by_value.states) + 1
    assert by_slope.states[-1] == "motor.speed"
    f = np.array([0.1, 3.0, 7.0, 40.0])
    s = 2j * np.pi * f[:, None, None]
    # a speed is the integral of its acceleration
    assert by_value.frequency_response(f) == pytest.approx(s * by_slope.frequency_response(f), rel=1e-9)


def test_torque_that_needs_the_slope_of_a_prescribed_speed_says_so():
    with pytest.raises(cw.UseError, match=r"give the input 'motor.acceleration' in place of 'motor.speed'"):
        cw.linearise(driven(), inputs="motor.speed", outputs="motor.torque")
    lin = cw.linearise(driven(), inputs="motor.acceleration", outputs="motor.torque")
    # w_ring = (3 w_carrier - w_sun) / 2: the motor moves its ring, and carrier and sun with it
    M = np.array([[0.02 + 0.1 / 4.0, -0.1 * 3.0 / 4.0], [-0.1 * 3.0 / 4.0, 0.3 + 0.1 * 9.0 / 4.0]])
    toward_ring = np.array([-0.5, 1.5])
    felt = 1.0 / (toward_ring @ np.linalg.solve(M, toward_ring))
    assert lin.D[0, 0] == pytest.approx(felt, rel=EXACT)


def test_contact_locked_to_a_prescribed_shaft_follows_it():
    d = cw.Driveline("dyno")
    motor, load = d.shaft("motor", inertia=0.1), d.shaft("load", inertia=2.0, speed=30.0)
    far = d.shaft("far", inertia=1.0, speed=30.0)
    d.add(cw.PrescribedSpeed("source", shaft=motor, speed=30.0))
    d.add(cw.Clutch("c1", base=motor, follower=load, **COULOMB))
    d.add(cw.Spring("k", base=load, follower=far, stiffness=200.0))
    lin = cw.linearise(d)
    assert lin.states == ("far.speed", "k.twist")
    assert frequencies(lin) == pytest.approx([math.sqrt(200.0)], rel=EXACT)
    assert lin.D[lin.outputs.index("load.speed"), lin.inputs.index("source.speed")] == 1.0
    lin = cw.linearise(d, inputs=["source.acceleration"], outputs=["c1.torque"])
    assert pytest.approx(np.array([[2.0]]), rel=EXACT) == lin.D


def test_brake_on_a_prescribed_shaft_holds_the_input():
    d = driven()
    d.add(cw.Brake("b1", shaft=next(n for n in d.nodes if n.name == "ring"), **COULOMB))
    lin = cw.linearise(d)
    assert "motor.speed" not in lin.inputs
    assert any("motor.speed cannot change by itself" in note for note in lin.notes)
    with pytest.raises(cw.UseError, match="locked contacts hold that motion"):
        cw.linearise(d, inputs="motor.speed")


def test_two_brakes_on_one_shaft_share_a_torque_by_their_capacities():
    d = cw.Driveline("two brakes")
    a = d.shaft("a", inertia=1.0)
    d.add(cw.Torque("t", shaft=a, torque=30.0))
    for name, force in (("b1", 300.0), ("b2", 600.0)):
        d.add(cw.Brake(name, shaft=a, friction=cw.Coulomb(static=0.1, kinetic=0.1), gain=1.0, normal_force=force))
    lin = cw.linearise(d, outputs=["b1.torque", "b2.torque"])
    assert lin.states == ()
    place = {name: number for number, name in enumerate(lin.inputs)}
    assert lin.D[:, place["t.torque"]] == pytest.approx([-1.0 / 3.0, -2.0 / 3.0], rel=EXACT)
    # -30 F1 / (F1 + F2) over F1
    slope = -30.0 * 600.0 / 900.0**2
    assert lin.D[:, place["b1.normal_force"]] == pytest.approx([slope, -slope], rel=EXACT)


def test_angles_are_states_where_they_are_asked_for():
    d = two_masses(**COULOMB)
    lin = cw.linearise(d, outputs=["car.angle", "hub.angle", "shaft.twist"])
    # the angle of the hub is that of the car less the twist
    assert lin.states == ("engine.speed", "car.speed", "shaft.twist", "hub.angle")
    assert lin.C[0] == pytest.approx([0.0, 0.0, 1.0, 1.0], rel=EXACT)
    assert lin.A[3] == pytest.approx([1.0, 0.0, 0.0, 0.0], rel=EXACT)


@pytest.mark.parametrize("forces", [(200.0, 200.0), (200.0, 320.0)])
def test_a_freewheel_and_two_clutches_share_a_load_as_the_run_does(forces):
    """Of the load the freewheel has half, each clutch a share of its capacity in both, also where they are equal."""
    d = cw.Driveline("set")
    a, b = d.shaft("a", inertia=0.3), d.shaft("b", inertia=0.2)
    d.add(cw.Torque("t", shaft=a, torque=30.0))
    law = cw.Coulomb(static=0.1, kinetic=0.1)
    d.add(cw.Brake("holds", shaft=b, friction=law, gain=1.0, normal_force=1e4))
    d.add(cw.OneWayClutch("f", base=a, follower=b))
    for name, force in zip(("c1", "c2"), forces, strict=True):
        d.add(cw.Clutch(name, base=a, follower=b, friction=law, gain=1.0, normal_force=force, locked=True))
    lin = cw.linearise(d, outputs=["f.torque", "c1.torque", "c2.torque"])
    first, second = forces
    expected = [0.0, 15.0 * second / (first + second) ** 2, -15.0 * second / (first + second) ** 2]
    assert lin.D[:, lin.inputs.index("c1.normal_force")] == pytest.approx(expected, rel=1e-9, abs=1e-12)
    run = d.simulate(0.01)
    assert run["f.torque"][-1] == pytest.approx(15.0, rel=1e-12)
    assert run["c1.torque"][-1] == pytest.approx(15.0 * first / (first + second), rel=1e-12)
