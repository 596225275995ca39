"""Cranks and cams that turn at a dead point against what is held: they jam, or what holds gives way.

docs/theory/varying-ratios.md
"""

from __future__ import annotations

from math import pi

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.run.failure import JAMS


def crank(speed: float) -> tuple[cw.Driveline, cw.Node]:
    """A crank that turns at its outer dead point, so that its mass must go backward."""
    d = cw.Driveline("crank")
    shaft, mass = d.shaft("shaft", inertia=1.0, speed=speed), d.mass("mass", mass=1.0)
    d.add(cw.CrankSlider("crank", shaft=shaft, mass=mass, radius=0.01, rod=1.0))
    return d, mass


def test_a_sprag_in_front_of_a_crank_rolls_over() -> None:
    """The force of a crank grows beyond all bounds towards its dead point."""
    d, mass = crank(2.0)
    d.add(cw.SpragClutch("sprag", base=d.housing, follower=mass, holding=1e3))
    run = d.simulate(0.1)
    (event,) = run.events
    assert (event.element, event.cause, event.time) == ("sprag", "fault", 0.0)
    # nothing else takes power: what the crank has is shared by both, as well as the tolerance of 1e-6 keeps it
    assert 0.5 * (run["shaft.speed"] ** 2 + run["mass.speed"] ** 2) == pytest.approx(2.0, rel=1e-5)


def test_a_freewheel_in_front_of_a_crank_jams_and_says_why() -> None:
    d, mass = crank(2.0)
    d.add(cw.OneWayClutch("blocks", base=d.housing, follower=mass))
    with pytest.warns(cw.StoppedEarly):
        run = d.simulate(0.1)
    assert run.status == "jammed"
    assert f"{JAMS['turned'][0]} at 'blocks'" in run.message


def test_a_screw_that_its_nut_cannot_turn_has_no_torques_before_a_crank() -> None:
    d, mass = crank(2.0)
    screw = d.shaft("screw", inertia=1.0)
    d.add(cw.Leadscrew("nut", screw=screw, mass=mass, lead=0.01, radius=0.01, friction_coefficient=0.5))
    with pytest.warns(cw.StoppedEarly):
        run = d.simulate(0.1)
    assert run.status == "unbalanced"
    assert "'nut'" in run.message


def cams(speed: float) -> cw.Driveline:
    """Two cams with grooves on one mass, at their lowest points; one shaft turns, the other at a speed of its own."""
    d = cw.Driveline("cams")
    mass, rise = d.mass("mass", mass=1.0), 0.05
    quarters = [k * 0.5 * pi for k in range(5)]
    # the periodic spline through the five points
    bend = 12.0 * rise / pi**2
    for name, start in (("one", 5.0), ("other", speed)):
        shaft = d.shaft(name, inertia=1.0, speed=start)
        lift = list(zip(quarters, (0.0, rise, 2.0 * rise, rise, 0.0), strict=True))
        curvature = (bend, 0.0, -bend, 0.0, bend)
        d.add(cw.CamProfile(f"{name}.cam", shaft=shaft, mass=mass, lift=lift, curvature=curvature))
    return d


@pytest.mark.parametrize("drag", [1e-7, 3e-7, 1e-6, 4e-6, 1e-5])
@pytest.mark.parametrize("speed", [10.0, 20.0, 40.0])
@pytest.mark.parametrize("outer", [True, False])
def test_a_flank_opens_right_behind_the_dead_point_of_a_ram_that_rubs(outer: bool, speed: float, drag: float) -> None:
    """Nanometres of arm: with the bend x'' of the ram the crank loses (m x''^2 w^2 + F |x''|) per angle behind it.

    The flywheel, which drag D brakes, is left where that has brought the acceleration of the crank J1 to -D / J2.
    """
    own, wheel_inertia, mass, force, radius, rod = 1.0, 2.0, 5.0, 16.0, 0.1, 0.4
    d = cw.Driveline("crank and flywheel")
    crank = d.shaft("crank", inertia=own, speed=speed)
    wheel = d.shaft("wheel", inertia=wheel_inertia, speed=speed)
    ram = d.mass("ram", mass=mass)
    d.add(cw.Backlash("play", base=crank, follower=wheel, gap=0.02, initial_twist=-0.01))
    d.add(cw.Torque("drag", shaft=wheel, torque=-drag))
    phase = (0.0 if outer else pi) - 0.05
    d.add(cw.CrankSlider("slider", shaft=crank, mass=ram, radius=radius, rod=rod, phase=phase))
    lining = cw.Coulomb(static=1.0, kinetic=0.8)
    d.add(cw.BearingFriction("guide", shaft=ram, friction=lining, torque=force / 0.8))
    run = d.simulate(0.07 / speed, rtol=1e-9, atol=1e-12)
    assert run.status == "done"
    turned, opened = run.events
    assert (turned.element, opened.element, opened.after) == ("guide", "play", "open")
    bend = radius * (1.0 + radius / rod) if outer else radius * (1.0 - radius / rod)
    w = float(run.at([turned.time])["crank.speed"][0])
    behind = drag * own / wheel_inertia / (mass * bend**2 * w**2 + force * bend) / w
    # round-off of the torques at which it is let go is that of picoseconds
    assert opened.time - turned.time == pytest.approx(behind, rel=1e-3, abs=1e-11)
    loses = drag / wheel_inertia * (run.time[-1] - opened.time)
    left = float(run.at([opened.time])["wheel.speed"][0])
    assert run["wheel.speed"][-1] == pytest.approx(left - loses, rel=1e-12)


def test_a_cam_at_rest_cannot_start_with_a_mass_that_another_moves() -> None:
    """At the dead point its ratio is zero, and its shaft has no torque to turn by: no motion keeps both ratios."""
    with pytest.warns(cw.StoppedEarly):
        run = cams(0.0).simulate(0.1, output="steps")
    assert run.status == "jammed"
    assert JAMS["ratio"][0] in run.message
    # it ends before the turning shaft is stopped for nothing
    assert run["one.speed"] == pytest.approx(5.0, rel=1e-6)


def test_two_cams_that_start_alike_go_on() -> None:
    run = cams(5.0).simulate(0.1)
    assert run.status == "done"
    # of the speeds, what their tolerance of 1e-6 makes of one
    assert run["one.speed"] == pytest.approx(run["other.speed"], rel=1e-5)


def test_a_cam_that_is_held_right_behind_its_dead_point() -> None:
    """The surface has no speed to speak of where it meets the follower; the shaft stops for good, with its energy."""
    d = cw.Driveline("press")
    shaft, mass = d.shaft("shaft", inertia=1.0), d.mass("mass", mass=1.0)
    d.add(cw.Torque("drive", shaft=shaft, torque=1.0))
    lift = [(0.0, 0.0), (pi / 2, 0.0157), (3 * pi / 2, 0.0157), (2 * pi, 0.0)]
    d.add(cw.Cam("cam", shaft=shaft, mass=mass, lift=lift, initial_gap=1e-14))
    d.add(cw.PrescribedSpeed("held", shaft=mass, speed=0.0))
    run = d.simulate(0.01)
    assert run.status == "done"
    (event,) = run.events
    assert event.energy_before == pytest.approx(0.5 * event.time**2, rel=1e-6)
    assert event.energy_after <= 1e-12 * event.energy_before
    assert abs(run.energy.residual) <= 1e-6 * event.energy_before


@pytest.mark.parametrize("beside", ["nothing", "a shaft", "a transmission"])
def test_a_cam_at_its_dead_point_before_a_mass_that_is_held_jams(beside: str) -> None:
    """It is pushed from where nothing holds it to where nothing can turn it, however fast others turn."""
    d = cw.Driveline("held")
    shaft, mass = d.shaft("shaft", inertia=1.0), d.mass("mass", mass=1.0)
    if beside != "nothing":
        fast = d.shaft("fast", inertia=1.0, speed=1e4)
    if beside == "a transmission":
        ratio = cw.Sine(amplitude=0.5, frequency=50.0, offset=1.0)
        d.add(cw.VariableRatio("turns", input=fast, output=d.shaft("other", inertia=1.0), ratio=ratio))
    d.add(cw.Torque("drive", shaft=shaft, torque=1.0))
    lift, bend = 0.0157, 12.0 * 0.0157 / (2.0 * pi**2)
    quarters = [(k * 0.5 * pi, x) for k, x in enumerate((0.0, 0.5 * lift, lift, 0.5 * lift, 0.0))]
    d.add(cw.CamProfile("cam", shaft=shaft, mass=mass, lift=quarters, curvature=(bend, 0.0, -bend, 0.0, bend)))
    d.add(cw.VariableGear("holds", input=d.housing, output=mass, ratio=1.0))
    with pytest.warns(cw.StoppedEarly):
        run = d.simulate(0.5, output="steps")
    assert run.status == "jammed"
    assert JAMS["ratio"][0] in run.message
    # before its ratio counts: up to there the mass moves by less than what counts as zero
    assert abs(run["shaft.angle"][-1]) < 1e-4
    assert np.max(abs(run["mass.speed"])) < 1e-9


def test_a_cam_that_is_driven_towards_its_dead_point_by_its_follower_ends_while_time_tells_its_steps_apart() -> None:
    """Its speed grows beyond all bounds there, in steps that shrink without being rejected."""
    d = cw.Driveline("driven")
    shaft, mass = d.shaft("shaft", inertia=0.005), d.mass("mass", mass=0.5)
    lift, bend = 0.0065, 12.0 * 0.0065 / (2.0 * pi**2)
    quarters = [(k * 0.5 * pi, x) for k, x in enumerate((0.0, 0.5 * lift, lift, 0.5 * lift, 0.0))]
    curvature = (bend, 0.0, -bend, 0.0, bend)
    d.add(cw.CamProfile("cam", shaft=shaft, mass=mass, lift=quarters, curvature=curvature, phase=-0.06))
    d.add(cw.PrescribedSpeed("motion", shaft=mass, speed=cw.Sine(amplitude=0.8, frequency=2.0, phase=1.98)))
    with pytest.warns(cw.StoppedEarly):
        run = d.simulate(0.5, output="steps", rtol=1e-9)
    assert run.status == "jammed"
    time, speed, acceleration = run.time[-20:], run["shaft.speed"][-20:], run["shaft.acceleration"][-20:]
    # the bound of the core, and what differences of two times miss
    assert np.diff(time).min() >= 0.9 * 1e-14 * max(1e-2, time[-1])
    # the trapezoids miss 4e-4 where the acceleration changes by 6 % in a step, which is known to one in 50
    passed = 0.5 * (acceleration[1:] + acceleration[:-1]) * np.diff(time)
    np.testing.assert_allclose(np.diff(speed), passed, rtol=0.02)


@pytest.mark.parametrize("begin", [0.0, 3600.0, 864000.0])
@pytest.mark.parametrize(("first", "last"), [(1.0, 0.02), (0.02, 1.0)])
def test_a_shaft_without_inertia_behind_a_small_ratio_goes_on(begin: float, first: float, last: float) -> None:
    """What is left of its share in the row counts, not how soon it would be gone beside how late it is."""
    d = cw.Driveline("late")
    a, b = d.shaft("a", inertia=1.0, speed=10.0), d.shaft("b")
    ratio = cw.Ramp(height=last - first, duration=0.02, start=begin, offset=first)
    d.add(cw.VariableRatio("r", input=a, output=b, ratio=ratio))
    run = d.simulate(begin + 0.03, t_start=begin)
    assert run.status == "done"
    assert run["b.speed"][-1] == pytest.approx(10.0 / last, rel=1e-6)
