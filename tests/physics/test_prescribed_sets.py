"""Contacts that prescribed speeds pull apart, and others that a review of random models found wrong."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from support.amount import amount

ONE = cw.Coulomb(static=1.0, kinetic=1.0)
MOTIONS = {
    "ramp": cw.Ramp(height=10.0, duration=1.0, start=0.5),
    "sine": cw.Sine(amplitude=10.0, frequency=0.5, start=0.5),
    "tangential": cw.Sine(amplitude=10.0, frequency=0.5, phase=-np.pi / 2, offset=10.0, start=0.5),
}


@pytest.mark.parametrize("weak", ["b", "c"])
@pytest.mark.parametrize("motion", list(MOTIONS))
def test_of_a_brake_and_a_clutch_to_a_prescribed_shaft_the_weaker_slips(motion: str, weak: str) -> None:
    """Both hold a shaft of 1 kg m2 while the prescribed speed stands still; then one of them must let go."""
    d = cw.Driveline("between")
    p, s = d.shaft("p", inertia=1.0), d.shaft("s", inertia=1.0)
    offset = MOTIONS[motion]
    d.add(cw.PrescribedSpeed("m", shaft=p, speed=offset))
    for name, base in (("b", d.housing), ("c", p)):
        force = 50.0 if name == weak else 100.0
        d.add(cw.Clutch(name, base=base, follower=s, friction=ONE, gain=1.0, normal_force=force))
    run = d.simulate(1.2)
    strong = "c" if weak == "b" else "b"
    assert run[f"{strong}.state"][-1] == "locked"
    assert abs(run[f"{weak}.torque"][-1]) == pytest.approx(50.0, rel=1e-12)
    expected = run["p.speed"] if weak == "b" else np.zeros(len(run))
    after = run.time > 0.6
    assert run["s.speed"][after] == pytest.approx(expected[after], abs=1e-9)
    assert abs(run.energy.residual) <= 1e-6 * run.energy.turnover


def test_freewheels_that_prescribed_speeds_turn_backward_end_the_run() -> None:
    """From the start, by a ramp, and two of them against each other: never done with a freewheel that runs backward."""
    for speed in (cw.Ramp(height=-9.0, duration=1.0, start=0.2), -5.0):
        d = cw.Driveline("jammed")
        p = d.shaft("p", inertia=1.0)
        d.add(cw.PrescribedSpeed("m", shaft=p, speed=speed))
        d.add(cw.OneWayClutch("f", base=d.housing, follower=p))
        with pytest.warns(cw.StoppedEarly, match="backward.*'f'"):
            run = d.simulate(1.0)
        assert run.status == "jammed"
    d = cw.Driveline("between")
    p, q = d.shaft("p", inertia=1.0), d.shaft("q", inertia=1.0)
    d.add(cw.PrescribedSpeed("m", shaft=p, speed=cw.Ramp(height=10.0, duration=1.0, start=0.2)))
    d.add(cw.OneWayClutch("f", base=p, follower=q))
    d.add(cw.OneWayClutch("g", base=q, follower=d.housing))
    with pytest.warns(cw.StoppedEarly, match="backward"):
        assert d.simulate(1.0).status == "jammed"


def test_a_stop_within_a_tolerance_is_decided_again() -> None:
    """A brake that stops a shaft a little early by an impulse: the freewheel behind it opens and never pulls."""
    d = cw.Driveline("stop")
    a, b = d.shaft("a", inertia=1.0, speed=-10.0), d.shaft("b", inertia=1.0, speed=-10.0)
    d.add(cw.OneWayClutch("f", base=a, follower=b))
    d.add(cw.Brake("k", shaft=a, friction=ONE, gain=1.0, normal_force=100.0, tolerance=1e-3))
    d.add(cw.Torque("t", shaft=b, torque=20.0))
    run = d.simulate(1.0)
    assert run["f.torque"].min() >= 0.0
    assert [(e.element, e.after) for e in run.events] == [("f", "forward"), ("k", "locked")]


@pytest.mark.parametrize("after", [-30.0, 0.0])
def test_a_law_of_pieces_stays_within_its_capacity_when_the_slip_jumps(after: float) -> None:
    """The elements of GMS cross their whole range within a step: 40 N m static, whatever the jump."""
    elements = [(2e-5, 0.1), (5e-5, 0.2), (1e-4, 0.3), (2e-4, 0.4)]
    law = cw.GMS(static=0.4, kinetic=0.2, speed=10.0, elements=elements)
    d = cw.Driveline("jump")
    p = d.shaft("p", inertia=1.0)
    d.add(cw.PrescribedSpeed("m", shaft=p, speed=cw.Step(offset=5.0, height=after - 5.0, start=0.5)))
    d.add(cw.Brake("c", shaft=p, friction=law, gain=1.0, normal_force=100.0))
    run = d.simulate(1.0)
    assert run.status == "done"
    assert np.abs(run["c.torque"]).max() <= 40.0 * 1.01


@pytest.mark.random
def test_a_freewheel_that_an_impulse_stopped_locks_under_a_ramp() -> None:
    """What the impulse leaves of the slip, and of the acceleration, is round-off: no endless sequence."""
    for seed in range(amount()):
        rng = np.random.default_rng([seed, 60])
        d = cw.Driveline("stopped")
        s = d.shaft("s", inertia=float(rng.uniform(0.1, 2.0)), speed=-float(rng.uniform(0.1, 50.0)))
        d.add(cw.OneWayClutch("f", base=d.housing, follower=s))
        d.add(cw.Damper("v", base=d.housing, follower=s, damping=0.1))
        d.add(cw.Torque("t", shaft=s, torque=cw.Ramp(height=-10.0, duration=1.0, start=0.5)))
        assert d.simulate(2.0).status == "done", seed


@pytest.mark.random
def test_a_load_that_dips_below_zero_by_round_off_goes_on() -> None:
    """A sine whose offset is its amplitude less 1e-12 of it, or exactly."""
    for seed in range(amount()):
        rng = np.random.default_rng([seed, 61])
        amplitude, less = float(rng.uniform(1.0, 20.0)), float(rng.choice([0.0, 1e-12, 1e-9]))
        force = cw.Sine(amplitude=amplitude, frequency=float(rng.uniform(0.5, 5.0)), offset=amplitude * (1 - less))
        d = cw.Driveline("dip")
        s = d.shaft("s", inertia=float(rng.uniform(0.2, 2.0)), speed=float(rng.uniform(-10.0, 10.0)))
        q = d.shaft("q", inertia=1.0)
        law = cw.Coulomb(static=0.3, kinetic=0.2)
        d.add(cw.Clutch("c", base=s, follower=q, friction=law, gain=1.0, normal_force=force))
        d.add(cw.Torque("t", shaft=s, torque=float(rng.uniform(-20.0, 20.0))))
        assert d.simulate(2.0).status == "done", seed


@pytest.mark.random
def test_a_dip_of_the_capacity_within_a_step_is_seen() -> None:
    """The load exceeds the capacity, a sine, for a short while: the same events with a hundred steps a period."""

    def run(rng: np.random.Generator, **options: Any) -> cw.Trajectory:
        amplitude = 1.0 - float(rng.choice([0.0, 1e-3]))
        torque, f = (
            100.0 * (1.0 - amplitude + 10.0 ** float(rng.uniform(-4, -1.8))),
            10.0 ** float(rng.uniform(-0.5, 1)),
        )
        force = cw.Sine(amplitude=amplitude, frequency=f, phase=float(rng.uniform(0, 6)), offset=1.0)
        d = cw.Driveline("dip")
        a = d.shaft("a", inertia=1.0)
        d.add(cw.Brake("b", shaft=a, friction=ONE, gain=100.0, normal_force=force))
        d.add(cw.Torque("t", shaft=a, torque=torque))
        return d.simulate(1.5 / f, **options, **({"max_step": 1e-2 / f} if options else {}))

    for seed in range(amount() // 3):
        found, fine = (run(np.random.default_rng([seed, 62]), **o) for o in ({}, {"rtol": 1e-6}))
        assert len(found.events.changes()) == len(fine.events.changes()), seed
        assert np.all(np.abs(found["b.torque"]) <= found["b.capacity"] + 1e-7), seed


@pytest.mark.parametrize("turning", [False, True])
def test_a_brake_on_a_prescribed_mass_does_not_keep_a_cam_locked(turning: bool) -> None:
    """A brake and a cam that cannot pull hold a shaft up to the limit of the brake, whatever turns elsewhere."""
    limit, first, slope = 10.0, 50.0, -5500.0
    d = cw.Driveline("cam")
    shaft, mass = d.shaft("shaft", inertia=0.08, angle=0.5), d.mass("mass", mass=1.0)
    law = cw.Coulomb(static=0.5, kinetic=0.5)
    d.add(cw.Brake("brake", shaft=shaft, friction=law, gain=1.0, normal_force=2 * limit, locked=True))
    d.add(cw.Brake("other", shaft=mass, friction=law, gain=1.0, normal_force=2 * limit, locked=True))
    d.add(cw.Torque("drive", shaft=shaft, torque=cw.Table([(0.0, first), (0.1, first + 0.1 * slope)])))
    turns = np.pi * np.array([0.0, 0.5, 1.0, 1.5, 2.0])
    lift = [(float(x), 0.01 * float(min(x, 2 * np.pi - x)) / np.pi) for x in turns]
    d.add(cw.Cam("cam", shaft=shaft, mass=mass, lift=lift))
    d.add(cw.PrescribedPosition("motion", shaft=mass, position=0.0016))
    if turning:
        one, two = d.shaft("one", inertia=0.1, speed=20.0), d.shaft("two", inertia=0.1)
        d.add(cw.UniversalJoint("joint", base=one, follower=two, bend_angle=0.3))
    run = d.simulate(0.03)
    away = (-limit - first) / slope
    assert run.events[0].time == pytest.approx(away, rel=1e-9)
    assert run["shaft.speed"][-1] == pytest.approx(slope * (0.03 - away) ** 2 / 2 / 0.08, rel=1e-6)


@pytest.mark.parametrize("size", [1e-3, 1e-6, 1e-8])
@pytest.mark.parametrize(
    ("capacities", "load", "torques"),
    [
        # the brake already carries 5 of its 10 N m the way it would slip, the clutches nothing of their 11
        ((10.0, 8.0, 3.0), 5.0, (-9.0, 4.0 * 8.0 / 11.0, 4.0 * 3.0 / 11.0)),
        ((5.0, 5.0, 5.0), 0.0, (-4.5, 2.25, 2.25)),
        ((10.0, 8.0), 9.0, (-9.0, 0.0)),
    ],
    ids=["two clutches", "equal", "loaded"],
)
def test_however_slowly_a_shaft_is_drawn_away_the_weaker_side_slips(
    size: float, capacities: tuple[float, ...], load: float, torques: tuple[float, ...]
) -> None:
    """A brake and clutches to a prescribed shaft, all locked; kinetic torque is 0.9 of static."""
    d = cw.Driveline("slowly")
    p, s = d.shaft("p", inertia=1.0), d.shaft("s", inertia=1.0)
    leaving = cw.Sine(offset=size, amplitude=-size, frequency=0.05 / np.pi, phase=np.pi / 2)
    d.add(cw.PrescribedSpeed("m", shaft=p, speed=leaving))
    d.add(cw.Torque("t", shaft=s, torque=load))
    for number, capacity in enumerate(capacities):
        base, law = (d.housing if number == 0 else p), cw.Coulomb(static=1.0, kinetic=0.9)
        d.add(
            cw.Clutch(f"c{number}", base=base, follower=s, friction=law, gain=1.0, normal_force=capacity, locked=True)
        )
    run = d.simulate(30.0)
    assert run["c0.state"][-1] == "forward"
    found = [run[f"c{number}.torque"][-1] for number in range(len(capacities))]
    # what follows the prescribed shaft is accelerated with it
    assert found == pytest.approx(torques, abs=1e-6 + 0.02 * size)
