"""Relatives of the disc clutch against closed forms; the marks make the parity table of the documentation."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import clutchwork as cw
from support.runs import EXACT, TIGHT, assert_switches, at_end

feature = pytest.mark.feature

ONE = cw.Coulomb(static=1.0, kinetic=1.0)
LINING = cw.Coulomb(static=0.4, kinetic=0.3)


def wheel(speed: float = 20.0, inertia: float = 0.5) -> tuple[cw.Driveline, cw.Node]:
    """A driveline with one turning shaft."""
    d = cw.Driveline("wheel")
    return d, d.shaft("wheel", inertia=inertia, speed=speed)


def first_torque(d: cw.Driveline, name: str) -> float:
    """Torque of a contact at the start."""
    return float(d.simulate(1e-3)[f"{name}.torque"][0])


# ---------------------------------------------------------------- fundamental clutch


@feature("fundamental clutch: kinetic torque and static limits as signals")
@feature("fundamental clutch: slip and mode as outputs")
def test_fundamental_clutch_slips_with_one_torque_and_holds_between_two_limits() -> None:
    """8 N m slow 0.5 kg m2 from 20 rad/s; then a ramp 20 t breaks it away forward at -lower, backward at upper."""
    for sign, limit, state in ((1.0, 9.0, "forward"), (-1.0, 15.0, "backward")):
        d, shaft = wheel()
        ramp = cw.Table([(0.0, 0.0), (1.5, 0.0), (3.5, sign * 40.0)])
        d.add(cw.Torque("pull", shaft=shaft, torque=ramp))
        d.add(
            cw.FundamentalClutch(
                "c", base=d.housing, follower=shaft, kinetic=8.0, upper=15.0, lower=-9.0, tolerance=0.0
            )
        )
        run = d.simulate(2.5, **TIGHT)
        assert_switches(run, [(20.0 * 0.5 / 8.0, "c", "forward", "locked"), (1.5 + limit / 20.0, "c", "locked", state)])
        assert run["c.torque"][0] == pytest.approx(-8.0, rel=1e-12)
        assert run["c.mode"][0] == 1
        assert 0 in run["c.mode"]
        assert run["c.slip"][0] == 20.0


@feature("fundamental clutch: never locks above the velocity tolerance")
def test_fundamental_clutch_never_locks_above_the_tolerance() -> None:
    """A constant slip of 0.1 rad/s: locked within a tolerance of 0.2 at most, never with 0.01."""
    d, shaft = wheel(speed=0.1)
    d.add(cw.PrescribedSpeed("p", shaft=shaft, speed=0.1))
    d.add(cw.FundamentalClutch("c", base=d.housing, follower=shaft, kinetic=1.0, upper=1e6, lower=-1e6, tolerance=0.01))
    assert "locked" not in d.simulate(1.0)["c.state"]


def test_fundamental_clutch_that_only_holds() -> None:
    """No kinetic torque: it coasts, and where its slip passes zero it holds."""
    d, shaft = wheel()
    d.add(cw.Torque("pull", shaft=shaft, torque=-5.0))
    d.add(cw.FundamentalClutch("c", base=d.housing, follower=shaft, kinetic=0.0, upper=15.0, lower=-9.0, tolerance=0.0))
    run = d.simulate(3.0, **TIGHT)
    assert_switches(run, [(20.0 * 0.5 / 5.0, "c", "forward", "locked")])
    assert at_end(run, "c.torque") == pytest.approx(5.0, rel=1e-12)


# ---------------------------------------------------------------- plates and cones


@feature("family: disc brake")
def test_disc_brake() -> None:
    """T = mu P (pi/4 b^2) r n."""
    d, shaft = wheel()
    d.add(cw.DiskBrake("b", shaft=shaft, friction=LINING, radius=0.12, bore=0.04, pads=2, pressure=5e5))
    torque = 0.3 * 5e5 * math.pi / 4 * 0.04**2 * 0.12 * 2
    run = d.simulate(1.0, **TIGHT)
    assert run["b.torque"][0] == pytest.approx(-torque, rel=1e-13)
    assert_switches(run, [(20.0 * 0.5 / torque, "b", "forward", "locked")])


@feature("family: cone clutch")
def test_cone_clutch() -> None:
    """T = mu F r / sin(alpha), r of the ring that the cone covers."""
    d, shaft = wheel()
    ring = {"outer_diameter": 0.1, "inner_diameter": 0.08}
    d.add(cw.ConeClutch("k", base=d.housing, follower=shaft, friction=LINING, **ring, half_angle=0.2, force=300.0))
    radius = 2 / 3 * (0.05**3 - 0.04**3) / (0.05**2 - 0.04**2)
    assert first_torque(d, "k") == pytest.approx(-0.3 * 300.0 * radius / math.sin(0.2), rel=1e-13)


@feature("family: centrifugal clutch")
def test_centrifugal_clutch_closes_above_its_onset_speed() -> None:
    """At a steady speed the torque is mu n R m r (w^2 - w0^2), below the onset nothing."""
    for speed, closed in ((300.0, True), (140.0, False)):
        d = cw.Driveline("chain saw")
        engine, drum = d.shaft("engine", speed=speed), d.shaft("drum", inertia=1e3)
        d.add(cw.PrescribedSpeed("p", shaft=engine, speed=speed))
        d.add(
            cw.CentrifugalClutch(
                "c",
                base=engine,
                follower=drum,
                friction=LINING,
                shoes=3,
                mass=0.02,
                radius=0.03,
                drum_radius=0.04,
                onset=150.0,
            )
        )
        torque = 0.3 * 3 * 0.04 * 0.02 * 0.03 * (300.0**2 - 150.0**2) if closed else 0.0
        run = d.simulate(0.05)
        np.testing.assert_allclose(run["c.torque"], torque, rtol=1e-9)
        assert set(run["c.state"]) == {"backward" if closed else "open"}


def test_centrifugal_clutch_follows_a_speed_with_a_lag() -> None:
    """Speed 1000 t: the lagged square is w^2 - 2 a lag w + 2 a^2 lag^2 once the start has decayed."""
    d = cw.Driveline("rise")
    engine, drum = d.shaft("engine"), d.shaft("drum", inertia=1e6)
    d.add(cw.PrescribedSpeed("p", shaft=engine, speed=cw.Table([(0.0, 0.0), (1.0, 1000.0)])))
    d.add(
        cw.CentrifugalClutch(
            "c",
            base=engine,
            follower=drum,
            friction=ONE,
            shoes=1,
            mass=1.0,
            radius=1.0,
            drum_radius=1.0,
            onset=0.0,
            lag=0.01,
        )
    )
    run = d.simulate(0.5, **TIGHT)
    assert at_end(run, "c.torque") == pytest.approx(500.0**2 - 2 * 10.0 * 500.0 + 2 * 10.0**2, rel=1e-9)


# ---------------------------------------------------------------- bands and shoes


@feature("family: band brake")
@pytest.mark.parametrize("turned", [False, True])
def test_band_brake_energises_itself_in_one_direction(turned: bool) -> None:
    """F r (e^(mu phi) - 1) where the drum pulls the band on, F r (1 - e^(-mu phi)) where it pulls it off."""
    for speed in (20.0, -20.0):
        d, shaft = wheel(speed)
        d.add(cw.BandBrake("b", shaft=shaft, friction=LINING, radius=0.1, wrap=4.7, force=200.0, reversed=turned))
        on = (speed > 0.0) != turned
        torque = 20.0 * (math.expm1(0.3 * 4.7) if on else -math.expm1(-0.3 * 4.7))
        run = d.simulate(2.0, **TIGHT)
        assert run["b.torque"][0] == pytest.approx(-math.copysign(torque, speed), rel=1e-13)
        assert_switches(run, [(20.0 * 0.5 / torque, "b", "forward" if speed > 0 else "backward", "locked")])


def test_band_brake_holds_more_in_one_direction() -> None:
    """A ramp 10 t breaks it away at the static torque of its direction."""
    for sign, state in ((1.0, "forward"), (-1.0, "backward")):
        d, shaft = wheel(0.0)
        d.add(cw.Torque("pull", shaft=shaft, torque=cw.Table([(0.0, 0.0), (30.0, sign * 300.0)])))
        d.add(cw.BandBrake("b", shaft=shaft, friction=LINING, radius=0.1, wrap=3.0, force=200.0, locked=True))
        limit = 20.0 * (math.expm1(0.4 * 3.0) if sign > 0 else -math.expm1(-0.4 * 3.0))
        assert_switches(d.simulate(limit / 10.0 + 0.1, **TIGHT), [(limit / 10.0, "b", "locked", state)])


@pytest.mark.parametrize("pull", [50.0, -50.0])
def test_a_band_brake_at_rest_has_the_capacity_of_the_way_it_begins_to_slip(pull: float) -> None:
    """Its law has no torque without slip, so that the torque of the first row says nothing of the way."""
    d, shaft = wheel(0.0)
    d.add(cw.Torque("pull", shaft=shaft, torque=pull))
    law = cw.Tanh(kinetic=0.3, speed=0.1)
    d.add(cw.BandBrake("b", shaft=shaft, friction=law, radius=0.1, wrap=3.0, force=200.0))
    run = d.simulate(0.01)
    limit = 20.0 * (math.expm1(0.3 * 3.0) if pull > 0 else -math.expm1(-0.3 * 3.0))
    assert run["b.capacity"] == pytest.approx(limit, rel=1e-12)


SHOES: dict[str, Any] = {"radius": 0.15, "hinge": 0.12, "arm": 0.2, "start": 0.2, "end": 2.2, "force": 1500.0}


def shoe(mu: float, leads: bool) -> float:
    """Torque of one shoe by integrating its pressure p sin(theta) numerically."""
    theta = np.linspace(SHOES["start"], SHOES["end"], 200_001)
    r, a = SHOES["radius"], SHOES["hinge"]
    normal = np.trapezoid(a * np.sin(theta) ** 2, theta)
    friction = np.trapezoid(mu * np.sin(theta) * (r - a * np.cos(theta)), theta)
    torque = np.trapezoid(mu * r * np.sin(theta), theta)
    return float(torque * SHOES["force"] * SHOES["arm"] / (normal - friction if leads else normal + friction))


@feature("family: double-shoe brake")
@pytest.mark.parametrize("speed", [20.0, -20.0])
def test_double_shoe_brake(speed: float) -> None:
    """Simplex: one leading and one trailing shoe; duplex: two leading ones forward, two trailing ones backward."""
    for leading in ("simplex", "duplex"):
        d, shaft = wheel(speed)
        d.add(cw.DoubleShoeBrake("b", shaft=shaft, friction=LINING, leading=leading, **SHOES))
        torque = shoe(0.3, True) + shoe(0.3, False) if leading == "simplex" else 2 * shoe(0.3, speed > 0.0)
        # 1e-9: the trapezoids
        assert first_torque(d, "b") == pytest.approx(-math.copysign(torque, speed), rel=1e-9)


def test_a_shoe_whose_coefficient_rises_to_self_locking_grabs_and_never_drives() -> None:
    """A coefficient 0.3 + 0.1 x slip passes the one at which a leading shoe needs no force."""
    d = cw.Driveline("rising")
    shaft = d.shaft("s", inertia=1.0)
    d.add(cw.PrescribedSpeed("motion", shaft=shaft, speed=cw.Table([(0.0, 1.0), (1.0, 40.0)])))
    law = cw.Stribeck(static=0.3, kinetic=0.3, speed=1.0, viscous=0.1)
    d.add(cw.DoubleShoeBrake("b", shaft=shaft, friction=law, leading="duplex", **SHOES))
    run = d.simulate(1.0)
    # it rises with the slip at first, and beyond the pole is above all that a shoe holds before half of it
    torque, slow = -run["b.torque"], run["s.speed"] < 2.0
    assert np.all(torque > 0.0)
    assert torque[-1] > 10.0 * torque[slow].max()


def test_a_shoe_that_locks_by_itself_is_named() -> None:
    d, shaft = wheel()
    law = cw.Coulomb(static=1.5, kinetic=1.0)
    d.add(cw.DoubleShoeBrake("b", shaft=shaft, friction=law, **SHOES))
    assert any("locks up by itself" in str(problem) for problem in d.check())


def test_a_shoe_with_a_broken_law_is_told_of_the_law_alone() -> None:
    d, shaft = wheel()
    law: Any = cw.Coulomb(static="high", kinetic=1.0)  # type: ignore[arg-type]
    d.add(cw.DoubleShoeBrake("b", shaft=shaft, friction=law, **SHOES))
    (problem,) = d.check()
    assert problem.quantity == "friction.static"


# ---------------------------------------------------------------- freewheels, limiters


@feature("family: one-way clutch")
@feature("family: sprag clutch")
def test_freewheels_hold_backward_slip_and_a_sprag_rolls_over() -> None:
    """A ramp -10 t: the one-way clutch holds it for good, the sprag clutch gives way at 30 N m, at 3 s."""
    pull = cw.Table([(0.0, 0.0), (10.0, -100.0)])
    d, shaft = wheel(0.0)
    d.add(cw.Torque("pull", shaft=shaft, torque=pull))
    d.add(cw.OneWayClutch("f", base=d.housing, follower=shaft, locked=True))
    assert at_end(d.simulate(5.0), "f.torque") == pytest.approx(50.0, rel=1e-9)
    d, shaft = wheel(0.0)
    d.add(cw.Torque("pull", shaft=shaft, torque=pull))
    d.add(cw.SpragClutch("f", base=d.housing, follower=shaft, holding=30.0, locked=True))
    run = d.simulate(4.0, **TIGHT)
    # the instant itself is one bit before or behind
    held = run.time < 3.0 - 1e-9
    np.testing.assert_allclose(run["f.torque"][held], 10.0 * run.time[held], atol=1e-9)
    assert at_end(run, "f.torque") == 0.0
    assert at_end(run, "wheel.speed") == pytest.approx(-5.0 * (4.0**2 - 3.0**2) / 0.5, rel=1e-9)


def test_a_sprag_clutch_overruns_against_its_drag() -> None:
    d, shaft = wheel(20.0)
    d.add(cw.SpragClutch("f", base=d.housing, follower=shaft, holding=30.0, drag=2.0))
    run = d.simulate(6.0, **TIGHT)
    assert run["f.torque"][0] == pytest.approx(-2.0, rel=1e-12)
    assert_switches(run, [(20.0 * 0.5 / 2.0, "f", "forward", "locked")])


@feature("family: torque limiter")
def test_torque_limiter_slips_when_its_torque_is_exceeded() -> None:
    """A ramp 10 t on 0.5 kg m2, as much behind the limiter, which carries half of it: it slips at 8 N m, at 1.6 s."""
    d = cw.Driveline("limiter")
    a, b = d.shaft("a", inertia=0.5), d.shaft("b", inertia=0.5)
    d.add(cw.Torque("pull", shaft=a, torque=cw.Table([(0.0, 0.0), (10.0, 100.0)])))
    d.add(cw.TorqueLimiter("t", base=a, follower=b, torque=8.0, friction=cw.Coulomb(static=1.0, kinetic=0.75)))
    run = d.simulate(2.0, **TIGHT)
    assert_switches(run, [(1.6, "t", "locked", "backward")])
    assert at_end(run, "t.torque") == pytest.approx(6.0, rel=1e-12)


@feature("viscous loss: drag that falls with speed")
def test_wet_drag_rises_to_a_peak_and_falls_beyond_it() -> None:
    torques = []
    for slip in (1.0, 20.0, 50.0, 100.0, 400.0):
        d, shaft = wheel(slip)
        d.add(cw.PrescribedSpeed("p", shaft=shaft, speed=slip))
        d.add(cw.WetDrag("w", base=d.housing, follower=shaft, peak=3.0, speed=50.0))
        x = slip / 50.0
        torques.append(-first_torque(d, "w"))
        assert torques[-1] == pytest.approx(6.0 * x / (1.0 + x * x), rel=1e-13)
    assert max(torques) == torques[2] == pytest.approx(3.0, rel=1e-13)


# ---------------------------------------------------------------- teeth


def dogs(speed: float = 0.0, **given: Any) -> cw.Driveline:
    """A dog clutch between a turning shaft of 0.5 kg m2 and one of 0.1 kg m2 at rest."""
    d = cw.Driveline("dogs")
    hub, gear = d.shaft("hub", inertia=0.5), d.shaft("gear", inertia=0.1, speed=speed)
    values = {"teeth": 12, "gap": 0.05, "stiffness": 2e4, "damping": 2.0, "command": 1.0, **given}
    d.add(cw.DogClutch("dog", base=hub, follower=gear, **values))
    return d


@feature("family: dog clutch")
def test_dog_clutch_meshes_when_aligned_and_takes_torque_over_its_backlash() -> None:
    """At rest and aligned: a torque of 6 N m turns the gear by half the gap, then both shafts go together."""
    d = dogs()
    d.add(cw.Torque("pull", shaft=d.nodes[1], torque=cw.Table([(0.0, 0.0), (0.3, 0.0), (0.4, 6.0), (5.0, 6.0)])))
    run = d.simulate(3.0, rtol=1e-9, atol=1e-11)
    assert at_end(run, "dog.sleeve") == pytest.approx(1.0, abs=1e-6)
    slip = run["gear.speed"] - run["hub.speed"]
    assert abs(slip[-1]) < 1e-3
    # the flank carries what accelerates the hub
    assert -at_end(run, "dog.torque") == pytest.approx(6.0 * 0.5 / 0.6, rel=1e-2)
    assert at_end(run, "dog.angle") == pytest.approx(0.025 + 5.0 / 2e4, rel=1e-2)


@feature("family: dog clutch")
def test_tooth_on_tooth_blocks_until_it_is_turned() -> None:
    """Half a pitch off: the sleeve stops at the tips and waits; a slow turn of the gear lets it in."""
    pitch = 2 * math.pi / 12
    d = dogs(initial_angle=pitch / 2)
    blocked = d.simulate(1.0)
    assert at_end(blocked, "dog.sleeve") == pytest.approx(0.5, abs=1e-9)
    assert at_end(blocked, "dog.torque") == 0.0
    turning = dogs(speed=0.5, initial_angle=pitch / 2)
    run = turning.simulate(2.0, rtol=1e-9, atol=1e-11)
    assert at_end(run, "dog.sleeve") > 0.9
    # the gap arrives after half a pitch less half a gap
    arrival = (pitch / 2 - 0.025) / 0.5
    waiting = (run.time > 0.05) & (run.time < arrival)
    np.testing.assert_allclose(run["dog.sleeve"][waiting], 0.5, atol=1e-9)
    assert np.all(run["dog.sleeve"][run.time > arrival + 0.1] > 0.9)


@feature("family: dog clutch")
def test_teeth_do_not_mesh_above_their_speed() -> None:
    """A brake slows the gear from 50 rad/s with 2 N m, 20 rad/s2: below 5 rad/s, after 2.25 s, the teeth mesh."""
    d = dogs(speed=50.0)
    d.add(cw.BearingFriction("brake", shaft=d.nodes[1], friction=ONE, torque=2.0))
    run = d.simulate(3.0, rtol=1e-9, atol=1e-10)
    fast = (run.time > 0.1) & (run.time < 2.25)
    np.testing.assert_allclose(run["dog.sleeve"][fast], 0.5, atol=1e-9)
    assert np.all(run["dog.torque"][run.time < 2.25] == 0.0)
    assert at_end(run, "dog.sleeve") > 0.9
    assert abs(at_end(run, "gear.speed") - at_end(run, "hub.speed")) < 0.2


def test_dog_clutch_lets_go_when_the_sleeve_is_pulled() -> None:
    d = dogs(engaged=True, command=cw.Table([(0.0, 1.0), (0.5, 1.0), (0.5, 0.0), (9.0, 0.0)]))
    d.add(cw.Torque("pull", shaft=d.nodes[1], torque=3.0))
    run = d.simulate(1.5, rtol=1e-9, atol=1e-11)
    assert np.any(run["dog.torque"][run.time < 0.5] < -1.0)
    assert np.all(run["dog.torque"][run.time > 0.6] == 0.0)
    # apart, the gear alone takes the torque
    late = run.time > 0.7
    slope = np.polyfit(run.time[late], run["gear.speed"][late], 1)[0]
    assert slope == pytest.approx(30.0, rel=1e-6)


def test_a_gap_as_wide_as_the_pitch_is_named() -> None:
    assert any("not below the pitch" in str(problem) for problem in dogs(gap=0.6).check())
    d = cw.Driveline("sleeve")
    hub, gear = d.shaft("hub", inertia=1.0), d.shaft("gear", inertia=1.0)
    cone = {"friction": LINING, "force": 1.0, "radius": 0.1, "half_angle": 0.1}
    d.add(cw.Synchroniser("s", hub=hub, forward=gear, **cone, gap=0.5, command=1.0))
    assert any("not below the pitch" in str(problem) for problem in d.check())


@feature("family: synchroniser")
@pytest.mark.parametrize("command", [1.0, -1.0])
def test_synchroniser_brings_either_gear_to_the_speed_of_the_hub_and_holds_it(command: float) -> None:
    """The cone slows the chosen gear with mu F r/sin(alpha); the dog teeth then hold more than the cone could."""
    d = cw.Driveline("gearbox")
    hub = d.shaft("hub", inertia=50.0, speed=100.0)
    gears = {
        "forward": d.shaft("first", inertia=0.02, speed=180.0),
        "backward": d.shaft("second", inertia=0.02, speed=70.0),
    }
    shift = cw.Table([(0.0, 0.0), (0.1, 0.0), (0.1, command), (9.0, command)])
    d.add(
        cw.Synchroniser(
            "s",
            hub=hub,
            **gears,
            friction=cw.Coulomb(static=0.1, kinetic=0.1),
            force=500.0,
            radius=0.04,
            half_angle=0.12,
            stiffness=5e4,
            damping=5.0,
            command=shift,
        )
    )
    side, other = ("forward", "backward") if command > 0 else ("backward", "forward")
    torque = 0.1 * 500.0 * 0.04 / math.sin(0.12)
    chosen = gears[side]
    d.add(
        cw.Torque(
            "load", shaft=chosen, torque=cw.Table([(0.0, 0.0), (0.5, 0.0), (0.7, -3 * torque), (9.0, -3 * torque)])
        )
    )
    run = d.simulate(1.0, rtol=1e-8, atol=1e-9)
    name = chosen.name
    # the sleeve reaches nothing before the cone has done its work
    start = abs(chosen.speed - 100.0)
    synchronous = 0.1 + 0.02 * start / torque
    assert np.all(run[f"s.{side}_dog.torque"][run.time < synchronous - 0.02] == 0.0)
    assert abs(run[f"{name}.speed"][-1] - run["hub.speed"][-1]) < 0.2
    assert abs(run[f"s.{side}_dog.torque"][-1]) > 1.5 * torque
    # nothing happens to the other gear
    assert run[f"{gears[other].name}.speed"][-1] == pytest.approx(gears[other].speed, rel=1e-12)
    assert np.all(run[f"s.{other}_cone.torque"] == 0.0)


# ---------------------------------------------------------------- actuation


def piston(command: cw.Signal | float, until: float, **given: Any) -> Any:
    """A run of a piston on a brake that does nothing else."""
    d, shaft = wheel(1000.0, inertia=1e6)
    actuator = d.add(cw.PressureActuator("p", command=command, **{"lag": 0.05, **given}))
    d.add(cw.DiskBrake("b", shaft=shaft, friction=ONE, radius=0.1, bore=0.1, pressure=actuator))
    return d.simulate(until, **TIGHT)


@feature("actuation: first-order lag")
def test_pressure_follows_its_command_with_a_lag() -> None:
    run = piston(4e5, 0.3)
    np.testing.assert_allclose(run["p.pressure"], 4e5 * -np.expm1(-run.time / 0.05), rtol=1e-9, atol=1e-3)
    torque = at_end(run, "p.pressure") * math.pi / 4 * 0.01 * 0.1 * 2
    assert at_end(run, "b.torque") == pytest.approx(-torque, rel=1e-12)


@feature("actuation: return spring")
@feature("actuation: fill phase")
def test_a_piston_fills_against_its_spring_before_it_presses() -> None:
    """Filled in 0.1 s at 2e5 Pa above the spring, so in 0.05 s at 4e5 Pa; then a lag towards what the spring leaves."""
    run = piston(4.5e5, 0.4, fill_time=0.1, fill_pressure=2e5, spring=0.5e5)
    assert np.max(np.abs(run["b.torque"][run.time < 0.05 - 1e-9])) == 0.0
    later = run.time > 0.05
    expected = 4e5 * -np.expm1(-(run.time[later] - 0.05) / 0.05)
    np.testing.assert_allclose(run["p.pressure"][later], expected, rtol=1e-6, atol=1.0)
    # below the spring nothing is ever filled
    assert at_end(piston(0.4e5, 0.4, fill_time=0.1, fill_pressure=2e5, spring=0.5e5), "b.torque") == 0.0


@feature("actuation: return spring")
def test_the_return_spring_empties_the_piston() -> None:
    """Without command it gives up its pressure below that of the spring, and is empty again in the end."""
    run = piston(
        cw.Table([(0.0, 3e5), (0.5, 3e5), (0.5, 0.0), (9.0, 0.0)]), 3.0, fill_time=0.05, fill_pressure=1e5, spring=0.5e5
    )
    assert at_end(run, "b.torque") == 0.0
    assert at_end(run, "p.pressure") == pytest.approx(-0.05 * 1e5 / 0.05, rel=1e-3)


@feature("actuation: limits of the rate")
def test_pressure_rises_and_falls_within_its_limits() -> None:
    """Up with 2e6 Pa/s until 4e5 - p = lag * 2e6, from there on with the lag; down with 1e6 Pa/s likewise."""
    command = cw.Table([(0.0, 4e5), (0.6, 4e5), (0.6, 0.0), (9.0, 0.0)])
    run = piston(command, 1.5, rise=2e6, fall=1e6)
    knee = (4e5 - 0.05 * 2e6) / 2e6
    rising = run.time <= knee
    np.testing.assert_allclose(run["p.pressure"][rising], 2e6 * run.time[rising], rtol=1e-9)
    lagging = (run.time > knee) & (run.time <= 0.6)
    expected = 4e5 - 1e5 * np.exp(-(run.time[lagging] - knee) / 0.05)
    np.testing.assert_allclose(run["p.pressure"][lagging], expected, rtol=1e-7)
    falling = (run.time > 0.61) & (run.time < 0.6 + (at_time(run, 0.6) - 0.05 * 1e6) / 1e6)
    np.testing.assert_allclose(
        run["p.pressure"][falling], at_time(run, 0.6) - 1e6 * (run.time[falling] - 0.6), rtol=1e-7
    )


def at_time(run: Any, time: float) -> float:
    """Pressure of the piston at a time."""
    return float(np.interp(time, run.time, run["p.pressure"]))


@feature("inputs: pedal travel over a diaphragm spring")
def test_pedal_over_a_diaphragm_spring() -> None:
    """Each travel of the pedal has its clamp force; a ratio of 5 and 1 mm of free travel lie between."""
    force = [(0.0, 5000.0), (4e-3, 2000.0), (8e-3, 0.0)]
    for pedal, expected in ((0.0, 5000.0), (0.005, 5000.0), (0.015, 3500.0), (0.035, 1000.0), (0.06, 0.0)):
        d, shaft = wheel(1000.0, inertia=1e6)
        spring = cw.DiaphragmSpring(
            "spring", force=force, ratio=0.2, free_travel=1e-3, travel=pedal, interpolation="linear"
        )
        d.add(spring)
        d.add(
            cw.DiskClutch(
                "c", base=d.housing, follower=shaft, friction=LINING, radius=0.1, surfaces=2, normal_force=spring
            )
        )
        run = d.simulate(0.1, **TIGHT)
        # it starts where the pedal is
        np.testing.assert_allclose(run["spring.clamp_force"], expected, rtol=1e-9, atol=1e-6)
        assert at_end(run, "c.torque") == pytest.approx(-0.3 * 2 * 0.1 * expected, rel=1e-9, abs=1e-6)


def test_a_piston_that_presses_at_the_start() -> None:
    run = piston(3e5, 0.1, filled=True, initial_pressure=3e5)
    np.testing.assert_allclose(run["p.pressure"], 3e5, rtol=1e-12)
    d, _ = wheel()
    d.add(cw.PressureActuator("p", command=0.0, lag=0.1, initial_pressure=1.0))
    assert any("not filled" in str(problem) for problem in d.check())


def test_a_diaphragm_spring_starts_at_the_travel_that_is_given() -> None:
    given: dict[str, Any] = {"force": [(0.0, 4000.0), (5e-3, 0.0)], "interpolation": "linear"}
    assert cw.DiaphragmSpring("s", travel=cw.Table([(0.0, 2e-3), (1.0, 0.0)]), **given).initial_states() == (2400.0,)
    controlled = cw.Sampled(lambda time, readings: 0.0, 0.01)
    assert cw.DiaphragmSpring("s", travel=controlled, **given).initial_states() == (4000.0,)
    assert cw.DiaphragmSpring("s", travel=controlled, initial_travel=1.0, **given).initial_states() == (0.0,)


# ---------------------------------------------------------------- wear on its own


@feature("wear: a state that grows with the energy of sliding")
def test_wear_of_a_brake() -> None:
    d, shaft = wheel(20.0)
    brake = d.add(cw.DiskBrake("b", shaft=shaft, friction=ONE, radius=0.1, bore=0.05, normal_force=50.0))
    d.add(cw.Wear("w", rate=1e-12, area=2e-3, heat=cw.HeatFlow(brake)))
    run = d.simulate(2.0, **TIGHT)
    assert at_end(run, "w.depth") == pytest.approx(1e-12 / 2e-3 * 0.5 * 0.5 * 20.0**2, rel=1e-9)


# ---------------------------------------------------------------- properties


@feature("beyond: several clutches at once")
@feature("beyond: events at their exact instant")
def test_two_clutches_lock_at_their_instants() -> None:
    """A shaft between two at rest: both slips fall, the second one to lock meets the first pair."""
    d = cw.Driveline("two")
    left, middle, right = d.shaft("l", inertia=0.4), d.shaft("m", inertia=0.5, speed=50.0), d.shaft("r", inertia=0.4)
    plates: dict[str, Any] = {"friction": ONE, "radius": 0.1, "surfaces": 1, "normal_force": 100.0, "tolerance": 0.0}
    d.add(cw.DiskClutch("c1", base=middle, follower=left, **plates))
    d.add(cw.DiskClutch("c2", base=middle, follower=right, **plates))
    lock = 50.0 / (20.0 / 0.5 + 10.0 / 0.4)
    run = d.simulate(1.0, **TIGHT)
    assert_switches(run, [(lock, "c1", "backward", "locked"), (lock, "c2", "backward", "locked")], EXACT)


SLIPS = st.floats(-200.0, 200.0).filter(lambda x: abs(x) > 1e-3)


@given(
    speed=SLIPS,
    pressure=st.floats(1e4, 4e5),
    drag=st.floats(0.0, 0.3),
    load=st.floats(-30.0, 30.0),
    capacity=st.floats(50.0, 2000.0),
    smooth=st.booleans(),
)
def test_torque_within_capacity_power_never_positive_and_the_energy_closes(
    speed: float, pressure: float, drag: float, load: float, capacity: float, smooth: bool
) -> None:
    """With a thermal mass and a coefficient over temperature and slip, at every sample."""
    law = cw.FrictionMap(
        temperatures=[300.0, 400.0, 600.0],
        speeds=[0.0, 50.0, 150.0],
        static=[0.4, 0.35, 0.25],
        kinetic=[[0.35, 0.3, 0.28], [0.3, 0.27, 0.25], [0.2, 0.17, 0.15]],
        interpolation="smooth" if smooth else "linear",
        extrapolation="nearest",
    )
    d = cw.Driveline("random")
    base, follower = d.shaft("base", inertia=0.7), d.shaft("follower", inertia=0.3, speed=speed)
    d.add(cw.Torque("load", shaft=base, torque=cw.Sine(amplitude=load, frequency=1.3)))
    c1 = cw.DiskClutch(
        "c1",
        base=base,
        follower=follower,
        friction=law,
        radius=0.1,
        area=1e-3,
        pressure=pressure,
        drag=drag,
        thermal_mass=capacity,
    )
    d.add(c1)
    d.add(cw.Conduction("air", hot=c1.plates, cold=d.ambient("around", temperature=290.0), conductance=20.0))
    run = d.simulate(1.5, rtol=1e-10, atol=1e-11)
    assert run.status == "done"
    friction = run["c1.torque"] + (drag * run["c1.slip"])
    # round-off at the very instant of break-away
    assert np.all(np.abs(friction) <= run["c1.capacity"] * (1 + 1e-8) + 1e-8)
    assert np.max(run["c1.power"]) <= 1e-12 * max(1.0, float(np.max(np.abs(run["c1.power"]))))
    assert abs(run.energy.residual) <= 1e-8 * max(run.energy.turnover, 1.0)
