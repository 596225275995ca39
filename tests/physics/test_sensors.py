"""Sensors: motion between two shafts, torque through a rigid line, against closed forms; they change nothing."""

from __future__ import annotations

import numpy as np
import pytest

import clutchwork as cw
from support import random_contacts

# of the signal's own scale: what rtol 1e-9 leaves after a second
CLOSE = 1e-8


def test_a_line_shares_its_torque_by_what_stands_behind() -> None:
    """J1, J2, J3 in a line: what goes through a cut is the torque times the inertia behind it over all inertia."""
    d = cw.Driveline("line")
    a, b, c = (d.shaft(name, inertia=inertia) for name, inertia in (("a", 0.2), ("b", 0.3), ("c", 0.5)))
    d.add(cw.Torque("drive", shaft=a, torque=cw.Sine(amplitude=40.0, frequency=3.0)))
    d.add(cw.TorqueSensor("ab", base=a, follower=b))
    d.add(cw.TorqueSensor("bc", base=b, follower=c))
    run = d.simulate(1.0, rtol=1e-9)
    torque = run["drive.torque"]
    assert run["ab.torque"] == pytest.approx(0.8 * torque, abs=40.0 * CLOSE)
    assert run["bc.torque"] == pytest.approx(0.5 * torque, abs=40.0 * CLOSE)
    assert run["ab.power"] == pytest.approx(run["ab.torque"] * run["b.speed"], abs=1e-9)
    assert run["ab.speed"] == pytest.approx(run["a.speed"], abs=1e-12)


def test_a_rigid_line_through_a_locked_clutch_and_a_load() -> None:
    """At rest in a locked clutch the sensor shows what holds the load, and nothing once the clutch is open."""
    d = cw.Driveline("held")
    a, b = d.shaft("a", inertia=0.1), d.shaft("b", inertia=0.4)
    d.add(cw.Brake("brake", shaft=a, friction=cw.Coulomb(static=1.0, kinetic=0.8), gain=1.0, normal_force=80.0))
    d.add(cw.TorqueSensor("cut", base=a, follower=b))
    d.add(cw.Torque("load", shaft=b, torque=-60.0))
    run = d.simulate(0.5)
    assert run["cut.torque"] == pytest.approx(60.0, abs=1e-9)
    assert not run["cut.power"].any()


def test_translation() -> None:
    d = cw.Driveline("train")
    engine, wagon = d.mass("engine", mass=60e3), d.mass("wagon", mass=20e3, position=-12.0)
    d.add(cw.Torque("pull", shaft=engine, torque=40e3))
    d.add(cw.TorqueSensor("coupling", base=engine, follower=wagon))
    d.add(cw.MotionSensor("gap", base=wagon, follower=engine))
    run = d.simulate(2.0)
    assert run["coupling.torque"] == pytest.approx(10e3, rel=CLOSE)
    assert run.units["coupling.torque"] == "N"
    assert run["gap.position"] == pytest.approx(12.0, rel=1e-12)
    assert run.units["gap.position"] == "m"


def test_motion_between_two_shafts() -> None:
    """Relative angle of two free shafts: difference of closed forms, of their starts too."""
    d = cw.Driveline("two")
    a, b = d.shaft("a", inertia=0.5, speed=3.0, angle=0.25), d.shaft("b", inertia=2.0, speed=-1.0, angle=-0.5)
    d.add(cw.Torque("one", shaft=a, torque=2.0))
    d.add(cw.Torque("other", shaft=b, torque=-1.0))
    d.add(cw.MotionSensor("between", base=a, follower=b))
    d.add(cw.MotionSensor("absolute", follower=b))
    run = d.simulate(2.0, rtol=1e-9)
    t = run.time
    assert run["between.acceleration"] == pytest.approx(-0.5 - 4.0, rel=CLOSE)
    assert run["between.speed"] == pytest.approx(-4.0 - 4.5 * t, abs=10.0 * CLOSE)
    assert run["between.angle"] == pytest.approx(-0.75 - 4.0 * t - 2.25 * t**2, abs=20.0 * CLOSE)
    assert np.array_equal(run["absolute.angle"], run["b.angle"])


def test_acceleration_has_both_limits_at_an_event() -> None:
    """A jump of torque at 0.5 s: the second of the two rows is the right limit."""
    d = cw.Driveline("jump")
    a = d.shaft("a", inertia=2.0)
    d.add(cw.Torque("drive", shaft=a, torque=cw.Step(height=6.0, start=0.5)))
    d.add(cw.MotionSensor("sensor", follower=a))
    run = d.simulate(1.0, times=[0.25, 0.5, 0.5, 0.75])
    assert list(run["sensor.acceleration"]) == pytest.approx([0.0, 0.0, 3.0, 3.0])


@pytest.mark.parametrize("seed", range(6))
def test_sensors_of_motion_change_no_bit(seed: int) -> None:
    plain, watched = random_contacts.driveline(seed), random_contacts.driveline(seed)
    first, last = watched.nodes[0], watched.nodes[-1]
    watched.add(cw.MotionSensor("watch", base=first, follower=last))
    one, other = plain.simulate(0.5), watched.simulate(0.5)
    assert np.array_equal(one.time, other.time)
    assert np.array_equal(one.rows, other.rows)
    assert np.array_equal(other["watch.speed"], other[f"{last.name}.speed"] - other[f"{first.name}.speed"])


def test_model_files_and_exports_know_them(tmp_path) -> None:
    d = cw.Driveline("file")
    a, b = d.shaft("a", inertia=0.5), d.shaft("b", inertia=0.5)
    d.add(cw.Torque("drive", shaft=a, torque=2.0))
    d.add(cw.TorqueSensor("cut", base=a, follower=b))
    d.add(cw.MotionSensor("turn", base=a, follower=b))
    d.save(tmp_path / "model.toml")
    run = cw.Driveline.load(tmp_path / "model.toml").simulate(1.0)
    assert run["cut.torque"] == pytest.approx(1.0)
    run.to_csv(tmp_path / "run.csv", ["cut.*", "turn.*"])
    head = (tmp_path / "run.csv").read_text().splitlines()[0]
    assert "cut.power" in head
    assert "turn.angle" in head


def test_energy_of_a_line_in_closed_form() -> None:
    """A sine on two inertias: what goes through is the kinetic energy of the second, and what its damper takes."""
    d = cw.Driveline("line")
    a, b = d.shaft("a", inertia=0.2, speed=5.0), d.shaft("b", inertia=0.3, speed=5.0)
    d.add(cw.Torque("drive", shaft=a, torque=cw.Sine(amplitude=4.0, frequency=2.0)))
    d.add(cw.Damper("oil", base=d.housing, follower=b, damping=0.1))
    d.add(cw.TorqueSensor("cut", base=a, follower=b))
    run = d.simulate(2.0, rtol=1e-9)
    kinetic = 0.15 * (run["b.speed"] ** 2 - 25.0)
    assert run["cut.energy"] == pytest.approx(kinetic - run["oil.work"], abs=5.0 * CLOSE)
    assert run.units["cut.energy"] == "J"
    bare = d.simulate(0.1, work=False)
    with pytest.raises(cw.UnknownName, match="work=True"):
        bare["cut.energy"]


def test_energy_of_an_impulse() -> None:
    """A freewheel stops both inertias at once: the energy of the far one goes through the line in no time."""
    d = cw.Driveline("blow")
    a, b = d.shaft("a", inertia=0.5, speed=-4.0), d.shaft("b", inertia=0.1, speed=-4.0)
    d.add(cw.TorqueSensor("cut", base=a, follower=b))
    stick = cw.Coulomb(static=1.0, kinetic=1.0)
    d.add(cw.OneWayClutch("stop", base=d.housing, follower=a, friction=stick, gain=1.0))
    run = d.simulate(0.1)
    assert run["cut.energy"] == pytest.approx(-0.05 * 16.0)
    c = cw.Driveline("jump")
    a, b = c.shaft("a", inertia=0.5, speed=1.0), c.shaft("b", inertia=0.1, speed=1.0)
    c.add(cw.TorqueSensor("cut", base=a, follower=b))
    c.add(cw.PrescribedSpeed("drive", shaft=a, speed=cw.Step(height=2.0, start=0.5, offset=1.0)))
    run = c.simulate(1.0)
    assert run["cut.energy"][-1] == pytest.approx(0.05 * (9.0 - 1.0))
    assert run["cut.energy"][0] == pytest.approx(0.0)


@pytest.mark.parametrize("seed", range(8))
def test_energy_in_random_gear_sets(seed: int) -> None:
    """Clutches lock and slip around a planetary set whose sun is metered: the joints of the table of losses agree."""
    rng = np.random.default_rng(seed)
    d = cw.Driveline("set")
    inertias, speeds = rng.uniform(0.05, 0.5, 5), rng.uniform(-20.0, 80.0, 2)
    engine = d.shaft("engine", inertia=inertias[0], speed=speeds[0])
    sun = d.shaft("sun", inertia=0.0 if seed % 2 else inertias[1])
    ring, carrier = d.shaft("ring", inertia=inertias[2], speed=speeds[1]), d.shaft("carrier", inertia=inertias[3])
    out = d.shaft("out", inertia=inertias[4])
    d.add(cw.Planetary("set", sun=sun, ring=ring, carrier=carrier, ratio=rng.uniform(1.5, 3.0)))
    d.add(cw.TorqueSensor("cut", base=engine, follower=sun))
    d.add(cw.TorqueSensor("end", base=carrier, follower=out))
    friction = cw.Coulomb(static=0.12, kinetic=0.1)
    force = cw.Sine(amplitude=900.0, frequency=3.0, offset=rng.uniform(-300.0, 600.0))
    d.add(cw.Clutch("c", base=ring, follower=carrier, friction=friction, gain=1.0, normal_force=force))
    d.add(cw.Brake("b", shaft=ring, friction=friction, gain=1.0, normal_force=cw.Step(height=800.0, start=0.4)))
    d.add(cw.Torque("drive", shaft=engine, torque=cw.Sine(amplitude=30.0, frequency=1.5, offset=40.0)))
    d.add(cw.Damper("load", base=d.housing, follower=out, damping=0.4))
    run = d.simulate(1.0, rtol=1e-9)
    joints = {(element, shaft): energy for element, shaft, energy in run.losses().joints}
    for name, shaft in (("cut", "sun"), ("end", "out")):
        assert run[f"{name}.energy"][-1] == pytest.approx(joints[name, shaft], abs=CLOSE * run.energy.turnover)
    mean = np.sum(0.5 * (run["cut.power"][1:] + run["cut.power"][:-1]) * np.diff(run.time))
    # trapezia over a thousand points
    assert mean == pytest.approx(run["cut.energy"][-1], abs=1e-3 * run.energy.turnover)
