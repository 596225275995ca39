"""Runs that go on where two rules seem to say different things of one instant, for the physics is regular there."""

from __future__ import annotations

from math import pi
from typing import Any

import numpy as np

import clutchwork as cw
from support.sweep import simulate

LIFT = ((0.0, 0.0), (0.5 * pi, 0.0184), (pi, 0.0368), (1.5 * pi, 0.0184), (2.0 * pi, 0.0))


def test_an_interpolant_does_not_wind_a_friction_spring() -> None:
    """Friction whose limit follows a speed ends its slide within a tolerance of that speed, again and again."""
    d = cw.Driveline("damper")
    light, heavy = d.shaft("light", inertia=0.272, speed=90.9), d.shaft("heavy", inertia=1.0)
    friction: dict[str, Any] = {"friction_limit": (24.44, 49.11), "friction_stiffness": (2350.0, 1175.0)}
    springs = cw.TorsionalDamper(
        "springs",
        base=light,
        follower=heavy,
        torque=((0.2, 189.6), (0.6, 948.0)),
        friction_speed=(7.57e-5, 2.72e-4),
        **friction,
    )
    d.add(springs)
    run = simulate(d, 0.539)
    assert run.status == "done"
    # the friction alone decides between both: their momentum stays
    momentum = 0.272 * run["light.speed"] + run["heavy.speed"]
    assert np.allclose(momentum, 0.272 * 90.9, rtol=1e-4)


def test_a_reversal_winds_a_friction_spring_back() -> None:
    """Where a damper turns, its friction leaves the limit, however little it moves in the step behind that."""
    d = cw.Driveline("turn")
    shaft, cam, mass = d.shaft("shaft", inertia=1.0, speed=7.22), d.shaft("cam", inertia=1.0), d.mass("mass", mass=1.0)
    lift = ((0.0, 0.0), (0.5 * pi, 0.00557), (1.5 * pi, 0.00612), (2.0 * pi, 0.0))
    d.add(cw.Cam("lifts", shaft=cam, mass=mass, lift=lift))
    friction: dict[str, Any] = {"friction_limit": (10.8, 16.2), "friction_stiffness": (1020.0, 510.0)}
    springs = cw.TorsionalDamper("springs", base=d.housing, follower=shaft, torque=((0.6, 205.6),), **friction)
    d.add(springs)
    run = simulate(d, 0.13, rtol=9.54e-5)
    assert run.status == "done"
    # a spring of constant torque with both frictions against the motion, then without most of them
    behind = run["shaft.speed"] < -0.5
    assert np.all(run["springs.torque"][behind] > -205.6 - 27.0)


def test_a_cam_drives_a_screw_without_load() -> None:
    """A cam at rest for an instant and a screw that could lock itself cannot both rest: the cam goes on turning."""
    d = cw.Driveline("screw")
    screw, cam, mass = d.shaft("screw", speed=-178.0), d.shaft("cam", inertia=1.0), d.mass("mass", mass=1.0)
    lift = ((0.0, 0.0), (0.5 * pi, 0.0172063), (1.5 * pi, 0.0207), (2.0 * pi, 0.0))
    d.add(cw.Cam("lifts", shaft=cam, mass=mass, lift=lift))
    d.add(cw.Leadscrew("nut", screw=screw, mass=mass, lead=1.0, radius=1.0, friction_coefficient=1.0))
    run = simulate(d, 0.0342)
    assert run.status == "done"
    # nothing drives the screw, so it has no friction: what the mass has is the energy that the cam lost
    energy = 0.5 * (run["cam.speed"] ** 2 + run["mass.speed"] ** 2)
    assert np.allclose(energy, energy[-1], rtol=1e-3)


def test_what_gives_way_moves_the_way_it_gives_way() -> None:
    """Rolling resistance and a screw beside one another: two loads fit the slip of the screw, one its motion."""
    d = cw.Driveline("nut")
    screw, support, mass = d.shaft("screw"), d.shaft("support", inertia=1.0), d.mass("mass", mass=373.0)
    d.add(cw.Torque("drive", shaft=support, torque=1.0))
    d.add(cw.Vehicle("road", mass=mass, drag_area=1.0, wind=1.0))
    law = cw.Tanh(kinetic=0.0878, speed=0.0422)
    d.add(cw.SpragClutch("sprag", base=d.housing, follower=screw, friction=law, holding=1.0, drag=10.0))
    sizes: dict[str, Any] = {"lead": 0.004, "radius": 0.07, "friction_coefficient": 0.2}
    d.add(cw.Leadscrew("nut", screw=screw, mass=mass, support=support, **sizes))
    run = simulate(d, 0.0858)
    assert run.status == "done"
    gone = [event for event in run.events.of("nut") if event.after == "backward"]
    assert len(gone) == 1
    assert run["mass.speed"][-1] < 0.0
    assert run["nut.slip"][-1] < 0.0


def test_a_stop_beside_a_dead_point_opens_by_what_the_cam_gives() -> None:
    """Right behind its dead point a cam turns its shaft by very little, and no torque but that opens a backlash."""
    d = cw.Driveline("cam")
    hammer, cam, mass = (
        d.shaft("hammer", inertia=0.104, speed=-17.0),
        d.shaft("cam", inertia=1.0),
        d.mass("m", mass=1.0),
    )
    d.add(cw.Torque("push", shaft=mass, torque=1.0))
    d.add(cw.Backlash("play", base=hammer, follower=cam, gap=1.0))
    bend = 0.02237171734822818
    d.add(cw.CamProfile("groove", shaft=cam, mass=mass, lift=LIFT, curvature=(bend, 0.0, -bend, 0.0, bend)))
    run = simulate(d, 0.0334)
    assert run.status == "done"
    # both go on together from the impact, but for what the cam does in 4 ms
    assert np.isclose(run["cam.speed"][-1], -17.0 * 0.104 / 1.104, rtol=1e-3)


def test_what_is_driven_does_not_stop_within_its_tolerance() -> None:
    """A clutch that locks below a slip is driven through that by a prescribed motion: it locks where that turns."""
    d = cw.Driveline("tolerance")
    driven, shaft = d.shaft("driven", inertia=1.0, speed=-5.0), d.shaft("shaft", inertia=0.22)
    law = cw.Coulomb(static=0.1, kinetic=0.1)
    sizes: dict[str, Any] = {"radius": 1.0, "half_angle": 1.0, "force": 100.0, "tolerance": 1.0}
    d.add(cw.ConeClutch("disc", base=d.housing, follower=shaft, friction=law, **sizes))
    d.add(cw.Backlash("play", base=shaft, follower=driven, gap=1.0))
    d.add(cw.PrescribedAcceleration("motion", shaft=driven, acceleration=20.0))
    run = simulate(d, 0.3)
    assert run.status == "done"
    assert len(run.events.of("disc")) < 6


def test_a_torque_that_fades_at_once_lets_nothing_go() -> None:
    """A bristle drives a screw without inertia that locks itself: slips of 1e-17 rad/s do not count."""
    d = cw.Driveline("bristle")
    drum, screw, mass = d.shaft("drum", inertia=0.00429, speed=15.6), d.shaft("screw"), d.mass("mass", mass=472.0)
    d.add(cw.Leadscrew("nut", screw=screw, mass=mass, lead=0.01, radius=1.0, friction_coefficient=1.0))
    law = cw.Dahl(kinetic=0.025, stiffness=850.0)
    disc: dict[str, Any] = {"radius": 1.0, "half_angle": 1.0, "force": 90.0}
    d.add(cw.ConeClutch("disc", base=drum, follower=screw, friction=law, **disc))
    d.add(cw.LinearTorque("drag", shaft=screw, nominal_torque=-40.0, nominal_speed=1.0))
    run = simulate(d, 0.2)
    assert run.status == "done"
    # friction and drag only take energy
    energy = 0.5 * (0.00429 * run["drum.speed"] ** 2 + 472.0 * run["mass.speed"] ** 2)
    assert np.all(energy < energy[0] * (1 + 1e-9))
