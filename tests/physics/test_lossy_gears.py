"""Gears whose friction follows their load: closed forms of efficiency, self-locking, differentials, shared rest."""

from __future__ import annotations

from itertools import permutations
from math import atan, cos, pi, sqrt, tan

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import clutchwork as cw
from support.amount import seeds
from support.lossy_chains import chain, misses

TIGHT = {"rtol": 1e-9, "atol": 1e-11}
CASES = len(seeds(60))


def residual(run):
    # nothing turns over where all stays at rest
    return abs(run.energy.residual) / max(run.energy.turnover, 1e-9)


@pytest.mark.parametrize("speed", [10.0, -10.0])
@pytest.mark.parametrize("torque", [4.0, -4.0])
def test_efficiency_in_four_quadrants(speed, torque):
    """The acceleration of two inertias at constant torques; i, J and efficiencies as in the closed form."""
    ratio, j1, j2, ahead, back = 3.0, 0.2, 1.5, 0.9, 0.8
    d = cw.Driveline("pair")
    a, b = d.shaft("a", inertia=j1, speed=speed), d.shaft("b", inertia=j2)
    d.add(cw.LossyGear("gear", input=a, output=b, ratio=ratio, efficiency=ahead, backward_efficiency=back))
    d.add(cw.Torque("drive", shaft=a, torque=torque))
    run = d.simulate(0.1, **TIGHT)
    # the torque that reaches the input costs 1/efficiency more where the input drives
    h = 1 / ahead if torque * speed > 0 else back
    assert run["a.acceleration"][0] == pytest.approx(torque / (j1 + h * j2 / ratio**2), rel=1e-12)
    assert run["gear.mode"][0] == np.sign(speed)
    assert residual(run) < 1e-8


def test_a_loss_table_is_linear_between_its_rows_and_beyond():
    """Friction alone, over the speed: exponentials between the rows."""
    d = cw.Driveline("coast")
    a, b = d.shaft("a", inertia=1.0, speed=30.0), d.shaft("b", inertia=1e-12)
    rows = ((0.0, 1.0, 1.0, 1.0, 1.0), (10.0, 1.0, 1.0, 2.0, 2.0), (20.0, 1.0, 1.0, 5.0, 5.0))
    d.add(cw.LossyGear("gear", input=a, output=b, ratio=1.0, loss_table=rows))
    run = d.simulate(12.0, **TIGHT)
    # slopes 0.3 above 10 rad/s, where the friction is 0.3 w - 1, and 0.1 below, where it is 0.1 w + 1
    first = np.log((0.3 * 30 - 1) / (0.3 * 10 - 1)) / 0.3
    stop = first + np.log((0.1 * 10 + 1) / 1.0) / 0.1
    assert run.events.of("gear")[0].time == pytest.approx(stop, rel=1e-8)
    assert run["a.speed"][-1] == 0.0


def test_beyond_a_loss_table_no_loss_becomes_a_gain():
    """Friction that falls to zero at twice the last speed, and efficiencies that would rise above one."""
    d = cw.Driveline("runs up")
    a, b = d.shaft("a", inertia=1.0), d.shaft("b", inertia=1.0)
    rows = ((0.0, 0.8, 0.8, 2.0, 2.0), (10.0, 0.9, 0.9, 1.0, 1.0))
    d.add(cw.LossyGear("gear", input=a, output=b, ratio=1.0, loss_table=rows))
    d.add(cw.Torque("drive", shaft=a, torque=10.0))
    run = d.simulate(10.0, rtol=1e-9, atol=1e-11)
    fast = run["a.speed"] > 20.0
    # from there on it loses nothing: 10 N m for 2 kg m2
    assert run["a.acceleration"][fast] == pytest.approx(5.0, rel=1e-9)
    assert np.all(np.diff(-run["gear.work"]) >= -1e-9)
    assert residual(run) < 1e-7


def test_against_scipy_between_the_flips():
    """One gear in slip whose load changes its sign with a sine: the same motion by another integrator."""
    j1, j2, ratio, ahead, back = 0.3, 2.0, 2.0, 0.7, 0.6
    d = cw.Driveline("flips")
    a, b = d.shaft("a", inertia=j1, speed=50.0), d.shaft("b", inertia=j2)
    d.add(cw.LossyGear("gear", input=a, output=b, ratio=ratio, efficiency=ahead, backward_efficiency=back))
    d.add(cw.Torque("drive", shaft=a, torque=cw.Sine(amplitude=5.0, frequency=1.0)))
    d.add(cw.Torque("load", shaft=b, torque=-0.5))
    run = d.simulate(2.0, **TIGHT)

    def rate(t, y):
        # N = J2 w'/i^2 + load/i, T = h N: the larger loss of both branches
        drive, load = 5.0 * np.sin(2 * pi * t), 0.5 / ratio
        for h in (1 / ahead, back):
            acceleration = (drive - h * load) / (j1 + h * j2 / ratio**2)
            passed = j2 / ratio**2 * acceleration + load
            if (passed >= 0) == (h > 1):
                return [acceleration]
        raise AssertionError

    # the solver is kept short over the kinks, which it cannot see
    other = solve_ivp(rate, (0, 2.0), [50.0], rtol=1e-10, atol=1e-10, max_step=1e-3)
    assert run["a.speed"][-1] == pytest.approx(other.y[0, -1], rel=1e-8)
    assert not run.events.of("gear")


@pytest.mark.parametrize("first_seed", range(0, CASES, 20))
def test_random_chains_keep_the_law_of_the_modelica_library(first_seed):
    """Loss torques over the torques at the ports, which follow from the accelerations and not from the loads."""
    for seed in range(first_seed, first_seed + 20):
        made = chain(seed)
        run = made.driveline.simulate(1.5, **TIGHT)
        assert run.status == "done", f"{seed}: {run.message}"
        assert max(misses(run, made).values()) < 1e-8, seed
        assert residual(run) < 1e-8, seed


@pytest.mark.parametrize(("coefficient", "holds"), [(0.12, True), (0.05, False)])
def test_a_worm_locks_itself_below_the_friction_angle(coefficient, holds):
    """The load at the wheel starts it or never does; lowering must be driven with -(h_back) N."""
    lead, ratio, load = 0.1, 30.0, -20.0
    rho = atan(coefficient / cos(0.349))
    assert (lead <= rho) == holds
    d = cw.Driveline("hoist")
    a, b = d.shaft("worm", inertia=1e-3), d.shaft("wheel", inertia=0.5)
    d.add(cw.WormGear("gear", worm=a, wheel=b, ratio=ratio, lead_angle=lead, friction_coefficient=coefficient))
    d.add(cw.Torque("load", shaft=b, torque=cw.Ramp(height=load, duration=1.0)))
    d.add(cw.Torque("motor", shaft=a, torque=cw.Ramp(height=-0.5, duration=1.0, start=1.0)))
    run = d.simulate(2.0, **TIGHT)
    event = run.events.of("gear")[0]
    if holds:
        # the worm must give what its flanks hold beyond the load
        driven = -load / ratio * tan(lead - rho) / tan(lead)
        assert event.time == pytest.approx(1.0 - driven / 0.5, rel=1e-9)
        assert np.all(run["wheel.speed"][run.time < event.time] == 0.0)
    else:
        assert event.time < 1e-6
    assert residual(run) < 1e-8


def test_a_worm_that_cannot_follow_its_load_jams():
    """J_worm + h J_wheel/i^2 < 0: when the load turns round, the gear stops at once, and all its energy is heat."""
    d = cw.Driveline("jam")
    a, b = d.shaft("worm", inertia=1e-3, speed=100.0), d.shaft("wheel", inertia=2.0)
    d.add(cw.WormGear("gear", worm=a, wheel=b, ratio=30.0, lead_angle=0.05, friction_coefficient=0.15))
    d.add(cw.Torque("motor", shaft=a, torque=cw.Ramp(height=-0.5, duration=1.0, offset=0.5)))
    d.add(cw.BearingFriction("bearing", shaft=a, torque=0.01, friction=cw.Coulomb(static=1.0, kinetic=1.0)))
    run = d.simulate(1.0, **TIGHT)
    event = run.events.of("gear")[0]
    assert (event.before, event.after, event.cause) == ("forward", "locked", "jam")
    # nothing goes on to the wheel once the motor gives no more than the bearing takes
    assert event.time == pytest.approx(0.98, abs=1e-9)
    assert event.energy_after == 0.0
    assert run["worm.speed"][-1] == 0.0
    assert residual(run) < 1e-8


def test_a_leadscrew_lifts_from_its_efficiency_on():
    weight, lead, radius, coefficient = 490.5, 0.005, 0.01, 0.15
    angle = atan(lead / (2 * pi * radius))
    d = cw.Driveline("table")
    screw, table = d.shaft("screw", inertia=1e-4), d.mass("table", mass=50.0)
    d.add(cw.Leadscrew("nut", screw=screw, mass=table, lead=lead, radius=radius, friction_coefficient=coefficient))
    d.add(cw.Torque("weight", shaft=table, torque=-weight))
    d.add(cw.Torque("motor", shaft=screw, torque=cw.Ramp(height=2.0, duration=1.0)))
    run = d.simulate(1.0, **TIGHT)
    needed = weight * radius * tan(angle + atan(coefficient / cos(0.349)))
    assert run.events.of("nut")[0].time == pytest.approx(needed / 2.0, rel=1e-9)
    assert residual(run) < 1e-8


def test_a_screw_slips_in_the_instant_in_which_its_load_passes_zero():
    """Without a load it holds nothing: a hundredth of the ramp, in which nothing moves before, is enough to be seen."""
    lead, radius, coefficient, torque, force, end = 0.005, 0.01, 0.15, 0.01, 2000.0, 1.0
    angle = atan(lead / (2 * pi * radius))
    d = cw.Driveline("vice")
    screw, jaw = d.shaft("screw", inertia=1e-3), d.mass("jaw", mass=50.0)
    d.add(cw.Leadscrew("nut", screw=screw, mass=jaw, lead=lead, radius=radius, friction_coefficient=coefficient))
    d.add(cw.Torque("hand", shaft=screw, torque=torque))
    d.add(cw.Torque("load", shaft=jaw, torque=cw.Ramp(offset=-force, height=2.0 * force, duration=end)))
    run = d.simulate(end, **TIGHT)
    # where the load is what the torque lifts
    held = torque / (radius * tan(angle + atan(coefficient / cos(0.349))))
    leaves, grips = run.events.of("nut")[:2]
    assert (leaves.cause, grips.after) == ("torque limit", "locked")
    assert leaves.time == pytest.approx(0.5 * end * (1.0 - held / force), rel=1e-9)
    # the other way it holds any load, and what it moved in between is braked by that at once
    assert leaves.time < grips.time < 0.5 * end * (1.0 + 2e-2)
    assert run["screw.speed"][-1] == 0.0
    assert residual(run) < 1e-8


@pytest.mark.parametrize(("top", "bottom"), [(0.1, -0.1), (1.5, -1.5), (1.6, -1.5), (0.7, -1.2), (1.0, -0.1)])
def test_a_screw_on_a_slope_that_levels_out_lets_go_at_one_slope(top, bottom):
    """A motor turns a self-locking screw as soon as m g (sin a + c cos a) is little enough, however fast that passes
    by: behind level ground the screw holds again."""
    mass, torque, lead, radius, coefficient, rolling = 80.0, 1.0, 0.001, 0.03, 1.0, 0.012
    d = cw.Driveline("screw")
    screw, car = d.shaft("screw", inertia=1.0), d.mass("car", mass=mass)
    d.add(cw.Torque("motor", shaft=screw, torque=torque))
    slope = cw.Table(points=[(0.0, top), (1.0, bottom)])
    d.add(cw.Vehicle("hill", mass=car, slope=slope, rolling_coefficient=rolling))
    sizes = {"lead": lead, "radius": radius, "friction_coefficient": coefficient}
    d.add(cw.Leadscrew("nut", screw=screw, mass=car, **sizes))
    run = d.simulate(1.0)
    driven = torque / (radius * tan(atan(lead / (2 * pi * radius)) + atan(coefficient / cos(0.349))))
    share = driven / (mass * 9.80665)

    def beyond(x):
        return (x + rolling) / sqrt(1 + x * x) - share

    let_go = brentq(beyond, -0.1, 0.1, xtol=1e-15)
    assert len(run.events) > 0
    # the instant is known to the round-off of loads that are 30 times larger
    assert top + (bottom - top) * run.events[0].time == pytest.approx(let_go, rel=1e-10)


def test_a_sprag_that_overruns_at_the_start_leaves_a_lossy_set_at_rest():
    """Nothing acts on the set and what is locked behind it; the shaft before the sprag is accelerated alone."""
    d = cw.Driveline("overrun")
    a, b, c, e = (d.shaft(name, inertia=inertia) for name, inertia in zip("abce", (0.5, 0.77, 0.08, 0.4), strict=True))
    d.add(cw.Torque("drive", shaft=a, torque=-16.85))
    d.add(cw.SpragClutch("sprag", base=a, follower=b, holding=11.6))
    losses = {"efficiency": 0.7, "bearing_torque": 0.15}
    d.add(cw.LossyPlanetary("set", sun=d.housing, ring=c, carrier=b, ratio=1.5, **losses))
    law = cw.Coulomb(static=0.1, kinetic=0.1)
    d.add(cw.Clutch("locked", base=c, follower=e, friction=law, gain=1.0, normal_force=1000.0, locked=True))
    run = d.simulate(0.01, **TIGHT)
    assert run.status == "done"
    assert run["a.speed"][-1] == pytest.approx(-16.85 / 0.5 * 0.01, rel=1e-9)
    assert max(abs(run[f"{name}.speed"]).max() for name in "bce") == 0.0


def test_what_drives_a_screw_again_is_answered_by_its_efficiency():
    """The jaw drives the screw, whose rotor slows down; then the rotor is faster at once, and its clutch slips. On the
    line of a driving jaw the friction would be more than the clutch gives, and stop the screw that is pushed."""
    lead, radius, coefficient, mass, inertia, capacity = 0.005, 0.03, 0.1, 10.0, 1e-6, 20.0
    angle = atan(lead / (2 * pi * radius))
    efficiency = tan(angle) / tan(angle + atan(coefficient / cos(0.349)))
    d = cw.Driveline("struck")
    rotor, screw = d.shaft("rotor", inertia=1.0), d.shaft("screw", inertia=inertia)
    jaw = d.mass("jaw", mass=mass)
    speed = cw.Table([(0.0, 100.0), (0.1, 99.0), (0.1, 150.0), (1.0, 150.0)])
    d.add(cw.PrescribedSpeed("motor", shaft=rotor, speed=speed))
    law = cw.Coulomb(static=1.0, kinetic=1.0)
    d.add(cw.TorqueLimiter("clutch", base=rotor, follower=screw, torque=capacity, friction=law))
    d.add(cw.Leadscrew("nut", screw=screw, mass=jaw, lead=lead, radius=radius, friction_coefficient=coefficient))
    run = d.simulate(0.10005, **TIGHT)
    moved = mass * (lead / (2 * pi)) ** 2
    wanted = efficiency * capacity / (moved + efficiency * inertia)
    assert run["clutch.slip"][-1] < 0.0
    assert run["screw.acceleration"][-1] == pytest.approx(wanted, rel=1e-9)
    assert residual(run) < 1e-8


def test_a_planetary_set_loses_nothing_as_a_block_and_by_its_rolling_power_else():
    ratio, efficiency = 2.6, 0.95
    d = cw.Driveline("set")
    sun, ring, carrier = d.shaft("sun", inertia=1e-9), d.shaft("ring", inertia=1.0), d.shaft("carrier", inertia=5.0)
    d.add(cw.LossyPlanetary("set", sun=sun, ring=ring, carrier=carrier, ratio=ratio, efficiency=efficiency))
    d.add(cw.Torque("drive", shaft=sun, torque=10.0))
    d.add(cw.BearingFriction("brake", shaft=ring, torque=1e3, friction=cw.Coulomb(static=1.0, kinetic=1.0)))
    run = d.simulate(0.5, **TIGHT)
    assert run["set.torque_support"][-1] == pytest.approx(10.0 * (1 + efficiency * ratio), rel=1e-6)
    # the power that rolls in the meshes is that of the sun over the carrier
    rolling = 10.0 * (run["sun.speed"][-1] - run["carrier.speed"][-1])
    assert -run["set.power"][-1] == pytest.approx((1 - efficiency) * rolling, rel=1e-6)
    d = cw.Driveline("block")
    sun, ring, carrier = (d.shaft(name, inertia=1.0, speed=5.0) for name in ("sun", "ring", "carrier"))
    d.add(cw.LossyPlanetary("set", sun=sun, ring=ring, carrier=carrier, ratio=ratio, efficiency=efficiency))
    shares = (1.0, ratio, 1.0 + ratio)
    # torques in the ratio of a block that is not loaded inside
    for node in (sun, ring, carrier):
        d.add(cw.Torque(f"t_{node.name}", shaft=node, torque=1.0))
    run = d.simulate(1.0, **TIGHT)
    assert np.all(run["set.mode"] == 0)
    assert run.energy.heat["set"] == 0.0
    assert shares[0] + shares[1] == pytest.approx(shares[2])


def test_gear_and_bearing_hold_together_until_both_are_at_their_limit():
    """A brake at the output presses the gear: both together hold (1/efficiency) times the brake, less its own share."""
    ahead, ratio, brake, bearing = 0.6, 2.0, 3.0, 0.7
    d = cw.Driveline("held")
    a, b = d.shaft("a", inertia=0.4), d.shaft("b", inertia=1.0)
    d.add(cw.LossyGear("gear", input=a, output=b, ratio=ratio, efficiency=ahead))
    law = cw.Coulomb(static=1.0, kinetic=1.0)
    d.add(cw.BearingFriction("brake", shaft=b, torque=brake, friction=law))
    d.add(cw.BearingFriction("bearing", shaft=a, torque=bearing, friction=law))
    d.add(cw.Torque("drive", shaft=a, torque=cw.Ramp(height=10.0, duration=1.0)))
    run = d.simulate(1.0, **TIGHT)
    starts = [event for event in run.events if event.before == "locked"]
    assert {event.element for event in starts} == {"gear", "brake", "bearing"}
    # N = brake/ratio, T = N/efficiency
    limit = bearing + brake / ratio / ahead
    assert all(event.time == pytest.approx(limit / 10.0, rel=1e-9) for event in starts)
    held = run.time < starts[0].time
    assert np.all(np.abs(run["gear.torque"][held]) <= run["gear.capacity"][held] + 1e-9)
    assert residual(run) < 1e-8


@pytest.mark.parametrize("bias", [1.0, 2.5, 4.0])
def test_the_bias_of_a_torque_sensing_differential(bias):
    d = cw.Driveline("axle")
    case, left, right = d.shaft("case", inertia=0.1), d.shaft("left", inertia=0.5), d.shaft("right", inertia=0.5)
    d.add(cw.Differential("diff", carrier=case, left=left, right=right, bias=bias))
    d.add(cw.Torque("drive", shaft=case, torque=100.0))
    d.add(cw.Damper("ice", base=d.housing, follower=left, damping=1.0))
    d.add(cw.Damper("asphalt", base=d.housing, follower=right, damping=10.0))
    run = d.simulate(20.0, **TIGHT)
    assert run["diff.torque_right"][-1] / run["diff.torque_left"][-1] == pytest.approx(bias, rel=1e-9)
    assert run["left.speed"][-1] > run["right.speed"][-1]
    assert residual(run) < 1e-8


def test_preload_holds_both_sides_without_torque():
    d = cw.Driveline("axle")
    case, left, right = d.shaft("case", inertia=0.1), d.shaft("left", inertia=0.5), d.shaft("right", inertia=0.5)
    d.add(cw.Differential("diff", carrier=case, left=left, right=right, preload=20.0))
    d.add(cw.Torque("pull", shaft=left, torque=cw.Ramp(height=100.0, duration=1.0)))
    run = d.simulate(1.0, **TIGHT)
    # the common motion takes half: the friction must give T/2, with equal inertias
    assert run.events.of("diff")[0].time == pytest.approx(0.4, rel=1e-9)


def test_wheel_and_differential_that_can_only_slip_together_are_one_event():
    """One wheel on ice: it slips when its share, less the friction of the differential, exceeds what the ice holds."""
    radius, mass, inertia, share, ice, asphalt = 0.3, 1000.0, 0.5, 0.2, 300.0, 4000.0
    d = cw.Driveline("start")
    case = d.shaft("case", inertia=0.01)
    car = d.mass("car", mass=mass)
    law = cw.Coulomb(static=1.0, kinetic=0.9)
    sides = []
    for name, grip in (("left", ice), ("right", asphalt)):
        shaft, tread = d.shaft(name, inertia=inertia), d.mass(f"{name}_tread")
        sides.append(shaft)
        d.add(cw.RollingWheel(f"{name}_wheel", shaft=shaft, mass=tread, radius=radius))
        d.add(cw.Clutch(f"{name}_tyre", base=tread, follower=car, friction=law, gain=1.0, normal_force=grip))
    d.add(cw.Differential("diff", carrier=case, left=sides[0], right=sides[1], share=share, locked=True))
    d.add(cw.Torque("drive", shaft=case, torque=cw.Ramp(height=1000.0, duration=1.0)))
    run = d.simulate(1.0, **TIGHT)
    starts = [event for event in run.events if event.before == "locked"]
    assert {event.element for event in starts} == {"diff", "left_tyre"}
    assert len({event.time for event in starts}) == 1
    # torque T of the case: a = T/(radius (m + (2 J + Jc)/r^2)); at the limit T_c (1/2 - share) = ice r + J a/r
    effective = mass * radius + (2 * inertia + 0.01) / radius
    case_share = 1 - 0.01 / radius / effective
    limit = ice * radius / (case_share * (0.5 - share) - inertia / radius / effective)
    assert starts[0].time == pytest.approx(limit / 1000.0, rel=1e-9)


def test_a_loop_of_rigid_gears_with_losses_is_named():
    d = cw.Driveline("loop")
    a, b = d.shaft("a", inertia=1.0), d.shaft("b", inertia=1.0)
    d.add(cw.LossyGear("lossy", input=a, output=b, ratio=2.0, efficiency=0.9))
    d.add(cw.Gear("twin", input=a, output=b, ratio=2.0))
    with pytest.raises(cw.ModelError, match=r'"lossy".*closes a loop of rigid parts with .*"twin"'):
        d.simulate(1.0)


@pytest.mark.parametrize("seed", range(40))
def test_gears_in_series_without_friction_of_their_own(seed):
    """At rest together they hold any load or none: runs end, and every row is finite."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(2, 5))
    d = cw.Driveline("series")
    shafts = [d.shaft(f"s{i}", inertia=float(10 ** rng.uniform(-2.3, 0.3))) for i in range(n + 1)]
    for i in range(n):
        ratio = float(rng.choice([-1.0, 1.0]) * rng.uniform(0.4, 4))
        efficiency = float(rng.uniform(0.6, 1.0))
        d.add(cw.LossyGear(f"g{i}", input=shafts[i], output=shafts[i + 1], ratio=ratio, efficiency=efficiency))
    stiffness = float(10 ** rng.uniform(2, 4))
    d.add(cw.SpringDamper("spring", base=d.housing, follower=shafts[-1], stiffness=stiffness, damping=1.0))
    through_zero = cw.Table([(0.0, 10.0), (0.5, 0.0), (1.0, -10.0)])
    wave = cw.Sine(amplitude=float(rng.uniform(5, 40)), frequency=float(rng.uniform(0.5, 4)))
    d.add(cw.Torque("drive", shaft=shafts[0], torque=through_zero if seed % 2 else wave))
    run = d.simulate(1.0)
    assert (run.status, run.time[-1]) == ("done", 1.0), run.message
    assert all(np.all(np.isfinite(run[name])) for name in run.names if run[name].dtype.kind == "f")
    # one motion has all of them: they let go, turn and stop together
    assert all(
        {event.element for event in run.events if event.time == at} == {f"g{i}" for i in range(n)}
        for at in {event.time for event in run.events}
    )


@pytest.mark.parametrize("seed", seeds(20))
def test_what_breaks_away_elsewhere_moves_no_load_at_rest(seed):
    """How a load at rest is shared does not depend on what slips in a driveline that nothing joins to it."""
    rng = np.random.default_rng(seed)
    ratios, efficiencies = rng.choice([2.0, -3.0, 0.5], 2), rng.uniform(0.6, 0.95, 2)
    forces, torque = rng.uniform(0.3, 2.0, 3), float(rng.uniform(0.05, 0.9))
    law = cw.Coulomb(static=0.3, kinetic=0.3)

    def run(push):
        d = cw.Driveline("two")
        shafts = [d.shaft(name, inertia=0.1) for name in "abc"]
        d.add(cw.Torque("t", shaft=shafts[0], torque=torque))
        for i, shaft in enumerate(shafts):
            d.add(cw.Brake(f"b{i}", shaft=shaft, friction=law, gain=1.0, normal_force=float(forces[i])))
        for i in range(2):
            gear = {"ratio": float(ratios[i]), "efficiency": float(efficiencies[i])}
            d.add(cw.LossyGear(f"g{i}", input=shafts[i], output=shafts[i + 1], **gear))
        p, q = d.shaft("p", inertia=0.1), d.shaft("q", inertia=0.1)
        d.add(cw.Torque("u", shaft=p, torque=cw.Table([(0.0, 0.0), (0.5, 0.0), (0.5, push), (1.0, push)])))
        d.add(cw.LossyGear("h", input=p, output=q, ratio=2.0, efficiency=0.7))
        d.add(cw.Brake("hold", shaft=q, friction=law, gain=1.0, normal_force=1.0))
        return d.simulate(1.0, times=[0.4, 0.8, 1.0])

    rests, slips = run(0.0), run(1.0)
    if np.any(rests["a.speed"] != 0.0):
        pytest.skip("what is held is held at no time")
    assert abs(slips["p.speed"][-1]) > 0.1
    for name in ("g0", "g1", "b0", "b1", "b2"):
        # shares of one load to round-off
        assert slips[f"{name}.torque"] == pytest.approx(rests[f"{name}.torque"], abs=1e-12), name


DRIVE, LOAD = 20.0, 5.0


def loop(inertias, gear, contacts, efficiency):
    """Shafts that turn together: contacts from shaft to shaft and a lossy gear of ratio 1 close a loop."""
    d = cw.Driveline("loop")
    shaft = {name: d.shaft(name, inertia=own, speed=10.0) for name, own in inertias.items()}
    d.add(cw.LossyGear("g", input=shaft[gear[0]], output=shaft[gear[1]], ratio=1.0, efficiency=efficiency))
    law = cw.Coulomb(static=1.0, kinetic=1.0)
    for name, (base, follower, force) in contacts.items():
        ends = {"base": shaft[base], "follower": shaft[follower]}
        if force == np.inf:
            d.add(cw.OneWayClutch(name, **ends))
        else:
            d.add(cw.PlateContact(name, **ends, friction=law, gain=1.0, normal_force=force, locked=True))
    d.add(cw.Torque("drive", shaft=shaft["s"], torque=DRIVE))
    d.add(cw.Torque("load", shaft=shaft["b"], torque=-LOAD))
    return d.simulate(0.05, **TIGHT)


@pytest.mark.parametrize("weak_first", [True, False])
@pytest.mark.parametrize("strong", [1e3, np.inf], ids=["clutch", "freewheel"])
@pytest.mark.parametrize("efficiency", [0.8, 0.95])
def test_a_gear_in_a_loop_loses_what_the_strong_path_lets_it_carry(efficiency, strong, weak_first):
    """Two locked contacts close a loop over a gear that turns; one of them holds next to nothing."""
    contacts = {"weak": ("s", "b", 1e-3), "strong": ("s", "a", strong)}
    order = contacts if weak_first else dict(reversed(contacts.items()))
    run = loop({"s": 0.1, "a": 0.2, "b": 0.5}, "ab", order, efficiency)
    expected = (DRIVE - LOAD / efficiency) / (0.1 + 0.2 + 0.5 / efficiency)
    # the weak clutch may take a thousandth of a newton metre
    assert run["s.acceleration"] == pytest.approx(expected, rel=1e-3)
    lost = (1.0 / efficiency - 1.0) * (LOAD + 0.5 * expected)
    assert run["g.torque"] == pytest.approx(-lost, rel=1e-3)
    assert np.all(np.abs(run["weak.torque"]) <= 1e-3 * (1 + 1e-9))
    assert residual(run) < 1e-9


@pytest.mark.parametrize("order", list(permutations(["A", "B", "weak"])), ids="-".join)
@pytest.mark.parametrize(("first", "second"), [(5.0, 0.01), (0.1, 0.2)])
def test_a_weak_clutch_beside_a_chain_of_strong_ones_carries_nothing_whatever_the_inertias(order, first, second):
    contacts = {"A": ("s", "a", 1e3), "B": ("a", "c", 1e3), "weak": ("s", "b", 1e-3)}
    inertias = {"s": first, "a": second, "c": 0.1, "b": 0.5}
    run = loop(inertias, "cb", {name: contacts[name] for name in order}, 0.8)
    expected = (DRIVE - LOAD / 0.8) / (first + second + 0.1 + 0.5 / 0.8)
    assert run["s.acceleration"] == pytest.approx(expected, rel=1e-3)
    assert np.all(np.abs(run["weak.torque"]) <= 1e-3 * (1 + 1e-9))
