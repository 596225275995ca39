"""Rules of the event logic that only a corner case needs: one small model for each, which fails without the rule."""

from __future__ import annotations

import itertools
import math
from typing import Any

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.interpolate import PchipInterpolator

import clutchwork as cw
from support.runs import TIGHT, at_end, clutch

ONE = cw.Coulomb(static=1.0, kinetic=1.0)


def brake(name: str, shaft: cw.Node, force: cw.SignalLike, friction: cw.Law = ONE, **fields: Any) -> cw.Brake:
    """Brake whose load [N m], for a coefficient of 1, is a signal."""
    return cw.Brake(name, shaft=shaft, friction=friction, gain=1.0, normal_force=force, **fields)


def disc(*brakes: tuple[str, cw.SignalLike], torque: cw.SignalLike = 0.0, speed: float = 0.0) -> cw.Driveline:
    """1 kg m2 under a torque, with brakes of a name and a load each."""
    d = cw.Driveline("disc")
    a = d.shaft("a", inertia=1.0, speed=speed)
    d.add(cw.Torque("drive", shaft=a, torque=torque))
    for name, force in brakes:
        d.add(brake(name, a, force))
    return d


def told(run: Any) -> list[tuple[float, str, str, str, str]]:
    """Events as (time [s], contact, before, after, cause)."""
    return [(e.time, e.element, e.before, e.after, e.cause) for e in run.events]


# ---------------------------------------------------------------- break-away


def test_a_forced_break_away_is_forgotten_when_time_goes_on() -> None:
    """Two brakes of 10 N m on one shaft break away together, and hold together 6 N m when it has come to rest."""
    load = cw.Table([(0.0, 0.0), (1.0, 30.0), (1.0, 6.0), (9.0, 6.0)])
    run = disc(("b1", 10.0), ("b2", 10.0), torque=load).simulate(3.0)
    assert [at_end(run, f"{name}.torque") for name in ("b1", "b2")] == pytest.approx([-3.0, -3.0], rel=1e-9)
    assert [run[f"{name}.state"][-1] for name in ("b1", "b2")] == ["locked", "locked"]


def test_a_knot_that_takes_the_margin_of_a_contact_is_told_as_an_input() -> None:
    """The torque steps beyond what the brake holds: the input breaks it away, and it never carried too much."""
    run = disc(("b", 3.0), torque=cw.Step(height=5.0, start=1.0)).simulate(2.0)
    assert told(run) == [(1.0, "b", "locked", "forward", "input")]
    assert run.events[0].torque_before == 0.0


def test_a_knot_that_takes_the_margin_of_a_set_is_told_as_an_input() -> None:
    """As with one brake, where two hold the load together."""
    run = disc(("b1", 3.0), ("b2", 3.0), torque=cw.Step(height=8.0, start=1.0)).simulate(2.0)
    assert told(run) == [(1.0, name, "locked", "forward", "input") for name in ("b1", "b2")]
    assert [e.torque_before for e in run.events] == [0.0, 0.0]


def test_prescribed_speeds_part_at_their_knot() -> None:
    """Both turn at 10 rad/s until one begins to fall at 1 s: the clutch between them slips from that very instant."""
    d = cw.Driveline("rigid")
    a, b = d.shaft("a", inertia=1.0), d.shaft("b", inertia=1.0)
    d.add(cw.PrescribedSpeed("pa", shaft=a, speed=10.0))
    d.add(cw.PrescribedSpeed("pb", shaft=b, speed=cw.Table([(0.0, 10.0), (1.0, 10.0), (3.0, 5.0)])))
    d.add(clutch("c", a, b, kinetic=3.0))
    assert told(d.simulate(2.0)) == [(1.0, "c", "locked", "backward", "input")]


def test_a_set_reaches_its_limit_between_two_points_of_equal_load() -> None:
    """Two brakes hold 1 N m; a sine of 1.02 N m has its peak in the middle of a step and is above it only there."""
    omega, phase = 20 * math.pi, math.pi / 2 - 0.75
    load = cw.Sine(amplitude=1.02, frequency=10.0, phase=phase)
    run = disc(("b1", 0.5), ("b2", 0.5), torque=load).simulate(0.03, work=False, first_step=1.5 / omega)
    assert [e.element for e in run.events][:2] == ["b1", "b2"]
    assert run.events[0].time == pytest.approx((math.asin(1 / 1.02) - phase) / omega, abs=1e-9)


def test_only_what_the_mechanism_of_a_set_moves_breaks_away() -> None:
    """Clutches join three shafts in a ring, two of them braked: the brakes give way, the clutches have no part."""
    for first, second in itertools.product(np.linspace(1.0, 8.0, 8), repeat=2):
        d = cw.Driveline("mechanism")
        s = [d.shaft(f"s{i}", inertia=0.5) for i in range(3)]
        contacts = [(d.housing, s[1], 4.0), (d.housing, s[2], 2.8), (s[1], s[2], 10.7), (s[0], s[1], 11.6)]
        for i, (base, follower, torque) in enumerate([*contacts, (s[0], s[2], 14.7)]):
            d.add(clutch(f"c{i}", base, follower, kinetic=torque))
        for shaft, torque in zip(s, (first, second, 16.0 - first - second), strict=True):
            d.add(cw.Torque(f"on {shaft.name}", shaft=shaft, torque=cw.Ramp(height=float(torque), duration=1.0)))
        run = d.simulate(1.0, work=False, points=2)
        assert [t[1:4] for t in told(run)] == [(name, "locked", "forward") for name in ("c0", "c1")]
        assert [e.time for e in run.events] == pytest.approx([6.8 / 16.0] * 2, abs=1e-9)


def test_a_release_that_turns_round_when_another_follows_is_taken_back() -> None:
    """A step of 8 N m tears at a brake through a clutch: the clutch slips, and its kinetic 1 N m the brake can hold.

    At first the static 4 N m of the clutch overload the brake, whose share of the acceleration is the larger one.
    """
    d = cw.Driveline("release")
    a, b = d.shaft("a", inertia=1.0), d.shaft("b", inertia=1.0)
    d.add(clutch("brake", d.housing, a, kinetic=1.5, static=2.0))
    d.add(clutch("clutch", a, b, kinetic=1.0, static=4.0))
    d.add(cw.Torque("drive", shaft=b, torque=cw.Step(height=8.0, start=1.0)))
    run = d.simulate(2.0)
    assert told(run) == [(1.0, "clutch", "locked", "forward", "input")]
    assert at_end(run, "brake.torque") == pytest.approx(-1.0, rel=1e-12)
    assert at_end(run, "b.speed") == pytest.approx(7.0, rel=1e-9)


def test_a_sprag_that_a_step_overloads_gives_way_for_good() -> None:
    """It holds 5 N m; 8 N m roll it over, and it does not catch the shaft when that has come back to rest."""
    d = cw.Driveline("sprag")
    a = d.shaft("a", inertia=1.0)
    d.add(cw.SpragClutch("s", base=d.housing, follower=a, holding=5.0))
    load = cw.Table(
        [(0.0, 0.0), (1.0, 0.0), (1.0, -8.0), (2.0, -8.0), (2.0, 8.0), (3.5, 8.0), (3.5, -2.0), (9.0, -2.0)]
    )
    d.add(cw.Torque("load", shaft=a, torque=load))
    run = d.simulate(7.0)
    assert (run.events[0].time, run.events[0].cause) == (1.0, "fault")
    # -8 rad/s after 2 s, 4 rad/s after 3.5 s, then on with -2 N m
    assert at_end(run, "a.speed") == pytest.approx(4.0 - 2.0 * 3.5, rel=1e-9)


# ---------------------------------------------------------------- loads that open and close


def test_a_load_that_rises_from_zero_is_decided_with_the_start() -> None:
    """A brake whose force begins to rise at 0 s holds from then on: there is no event of its closing."""
    run = disc(("b", cw.Ramp(height=10.0, duration=1.0))).simulate(1.0)
    assert run["b.state"][0] == "locked"
    assert told(run) == []


@pytest.mark.parametrize(("start", "share"), [(1.0, 0.7), (1.1, 0.7), (1.3, 0.83)])
def test_loads_that_rise_from_zero_together_hold_from_the_first_instant(start: float, share: float) -> None:
    """A clutch drags with F, a brake holds up to twice `share` F, and F passes zero: it must not slip by round-off."""
    d = disc(torque=0.0)
    a, driven = d.nodes[0], d.shaft("driven", inertia=1.0)
    d.add(cw.PrescribedSpeed("p", shaft=driven, speed=10.0))

    def rising(factor: float) -> cw.Table:
        return cw.Table([(0.0, -factor * start), (3.0, factor * (3.0 - start))])

    d.add(cw.Clutch("c", base=driven, follower=a, friction=ONE, gain=1.0, normal_force=rising(1.0)))
    d.add(brake("b", a, rising(share), cw.Coulomb(static=2.0, kinetic=2.0)))
    run = d.simulate(2.0)
    assert run.status == "done"
    assert [(e.element, e.before, e.after) for e in run.events] == [("b", "open", "locked")]
    assert run.events[0].time == pytest.approx(start, abs=1e-12)


def test_a_freewheel_whose_clutch_is_relieved_does_not_drive() -> None:
    """The force on the parallel clutch steps from 1 N to -1 N: 1 rad/s2 of braking until then, nothing after."""
    d = cw.Driveline("freewheel")
    a = d.shaft("a", inertia=1.0, speed=10.0)
    force = cw.Step(height=-2.0, start=1.0, offset=1.0)
    d.add(cw.OneWayClutch("f", base=d.housing, follower=a, friction=ONE, normal_force=force))
    assert at_end(d.simulate(3.0), "a.speed") == pytest.approx(9.0, rel=1e-9)


def test_a_freewheel_that_overruns_feels_its_clutch_close() -> None:
    """The freewheel may transmit all the time; that its parallel clutch closes is a change of its own."""
    d = cw.Driveline("freewheel")
    a = d.shaft("a", inertia=1.0, speed=10.0)
    force = cw.Step(height=1.0, start=1.0)
    d.add(cw.OneWayClutch("f", base=d.housing, follower=a, friction=ONE, normal_force=force))
    assert at_end(d.simulate(3.0), "a.speed") == pytest.approx(8.0, rel=1e-9)


def test_an_open_contact_at_rest_takes_the_direction_in_which_it_starts() -> None:
    """An open brake, 1 N m forward for 1 s and backward after: it passes zero at 2 s, and that is told."""
    load = cw.Table([(0.0, 1.0), (1.0, 1.0), (1.0, -1.0), (9.0, -1.0)])
    run = disc(("b", 0.0), torque=load).simulate(3.0)
    assert [t[1:] for t in told(run)] == [("b", "forward", "backward", "passing")]
    assert run.events[0].time == pytest.approx(2.0, abs=1e-9)


# ---------------------------------------------------------------- slip zero


def test_a_slip_that_starts_behind_zero_within_round_off_is_at_zero() -> None:
    """A brake that slips forward from -5e-11 rad/s, which counts as rest, is not stopped by passing zero."""
    run = disc(("b", 1.0), torque=1.0 + 1e-6, speed=-5e-11).simulate(2.0)
    assert run.status == "done"
    assert at_end(run, "a.speed") == pytest.approx(2e-6, rel=1e-3)


def test_a_contact_that_starts_to_slip_leaves_zero_as_the_motion_does() -> None:
    """A sine breaks a brake away just below its peak, without acceleration: one short slip in each half period."""
    run = disc(("b", 1.0), torque=cw.Sine(amplitude=1.001, frequency=50.0)).simulate(0.04)
    assert run.status == "done"
    assert [e.after for e in run.events] == ["forward", "locked", "backward", "locked"] * 2


def test_an_impulse_that_brings_others_to_rest_locks_them_too() -> None:
    """A brake may lock below 1 rad/s and stops the shaft: the other brake on it is at rest and must not go on."""
    d = disc(speed=10.0)
    d.add(brake("b1", d.nodes[0], 5.0, tolerance=1.0))
    d.add(brake("b2", d.nodes[0], 5.0))
    run = d.simulate(2.0)
    assert [run[f"{name}.state"][-1] for name in ("b1", "b2")] == ["locked", "locked"]
    assert [at_end(run, f"{name}.torque") for name in ("b1", "b2")] == pytest.approx([0.0, 0.0], abs=1e-12)


def test_a_step_that_is_cut_must_land_on_its_event() -> None:
    """Friction rises just before rest, between two stages of a long step: the time of rest counts all of the rise."""
    tolerance, peak, width = 1e-8, 3.0, 0.03
    rise = quad(lambda x: (peak - 1) * math.exp(-x * x) / (1 + (peak - 1) * math.exp(-x * x)), 0, 8)[0]
    law = cw.Stribeck(static=peak, kinetic=1.0, speed=width)
    for speed in np.linspace(1.0, 3.0, 101):
        d = disc(speed=float(speed))
        d.add(brake("b", d.nodes[0], 1.0, law))
        run = d.simulate(2 * float(speed), rtol=tolerance, atol=tolerance, method="dopri5", work=False, points=2)
        # some 0.02 s are lost by steps that fly over the rise
        assert run.events[0].time == pytest.approx(speed - rise * width, abs=100 * tolerance)


# ---------------------------------------------------------------- steps


@pytest.mark.parametrize("work", [True, False])
def test_steps_resolve_a_sine_that_moves_nothing(work: bool) -> None:
    """A locked shaft feels nothing of a torque of 50 Hz; its first peak above what the brake holds breaks it away."""
    load = cw.Sine(amplitude=1.001, frequency=50.0, start=5.0)
    run = disc(("b", 1.0), torque=load).simulate(5.5, work=work)
    assert run.events[0].time == pytest.approx(5.0 + math.asin(1 / 1.001) / (100 * math.pi), abs=1e-9)


@pytest.mark.parametrize("work", [True, False])
def test_steps_resolve_a_decay_that_moves_nothing(work: bool) -> None:
    """30 exp(-50 s) sin(5 s) is above 1 N m for some 0.02 s only, far less than a step without its decay."""
    load = cw.Sine(amplitude=30.0, frequency=2.5 / math.pi, start=5.0, damping=50.0)
    run = disc(("b", 1.0), torque=load).simulate(6.0, work=work)
    s = run.events[0].time - 5.0
    assert 30 * math.exp(-50 * s) * math.sin(5 * s) == pytest.approx(1.0, rel=1e-6)


def test_steps_resolve_a_sine_for_the_work() -> None:
    """Whatever the tolerance, the work of a torque of 1 Hz closes the balance."""
    d = disc(torque=cw.Sine(amplitude=1.0, frequency=1.0))
    d.add(cw.Damper("damper", base=d.housing, follower=d.nodes[0], damping=0.5))
    run = d.simulate(5.0, rtol=1e-2, atol=1e-2)
    assert abs(run.energy.residual) <= 1e-3 * run.energy.turnover


def test_work_under_prescribed_speed_is_exact_though_no_state_feels_the_torque() -> None:
    """Slip rises to 100 rad/s in 1 s; the coefficient falls from 1 to 0.1 within some 0.1 rad/s."""
    d = cw.Driveline("work")
    a = d.shaft("a", inertia=1.0)
    d.add(cw.PrescribedSpeed("p", shaft=a, speed=cw.Ramp(height=100.0, duration=1.0)))
    d.add(brake("b", a, 1.0, cw.Exponential(static=1.0, slow=1.0, fast=0.1, speed=3.0)))
    run = d.simulate(1.0)
    exact = (0.1 * 100.0**2 / 2 + 0.9 * 3.0**2) / 100.0
    assert run.energy.heat["b"] == pytest.approx(exact, rel=1e-7)


def test_heat_of_a_prescribed_speed_is_no_stiff_surprise() -> None:
    """The heat of a damper under a prescribed sine has the derivative by time that the method needs for its order."""
    d = cw.Driveline("heat")
    a, node = d.shaft("a", inertia=1.0), d.thermal("n", capacity=1.0, temperature=300.0)
    d.add(cw.PrescribedSpeed("p", shaft=a, speed=cw.Sine(amplitude=10.0, frequency=0.5 / math.pi)))
    d.add(cw.Damper("damper", base=d.housing, follower=a, damping=1.0, heat=node))
    run = d.simulate(2.0, work=False)
    assert at_end(run, "n.heat") == pytest.approx(100 * (1.0 - math.sin(4.0) / 4), rel=1e-6)
    # 20 with it, some 700 without
    assert run.statistics["steps"] < 100


def test_rows_of_dopri5_between_its_steps_keep_the_tolerance() -> None:
    """Its dense output is less accurate than its steps, and the rows come from there: a pendulum over three periods."""
    for tolerance in (1e-4, 1e-6, 1e-8):
        d = disc(speed=1.0)
        d.add(cw.Spring("spring", base=d.housing, follower=d.nodes[0], stiffness=1.0))
        run = d.simulate(20.0, rtol=tolerance, atol=tolerance, method="dopri5", points=2000)
        assert np.max(np.abs(run["a.speed"] - np.cos(run.time))) < 5 * tolerance


def test_an_element_that_was_put_onto_its_limit_has_not_passed_it() -> None:
    """Elements of Leuven that slide stay at their limits: round-off there does not break them loose again and again."""
    elements = ((2e-5, 0.1), (5e-5, 0.2), (1e-4, 0.3), (2e-4, 0.4))
    law = cw.Leuven(static=0.15, kinetic=0.1, speed=2.0, viscous=1e-3, elements=elements, order=20.0, damping=0.0)
    for torque in np.linspace(0.1, 2.0, 12):
        d = cw.Driveline("presliding")
        a = d.shaft("a", inertia=0.1)
        load = cw.Table([(0.0, float(torque)), (0.2, float(torque)), (0.2, 0.0), (9.0, 0.0)])
        d.add(cw.Torque("drive", shaft=a, torque=load))
        d.add(cw.Spring("spring", base=d.housing, follower=a, stiffness=200.0))
        d.add(brake("b", a, 1.2, law))
        assert d.simulate(1.0, rtol=2e-4, atol=2e-4, work=False, points=2).status == "done"


# ---------------------------------------------------------------- teeth, tables, knots


def test_a_collision_of_stiff_teeth_is_not_stepped_over() -> None:
    """0.3 kg m2 hit a flank without damping and come back as fast, whatever the stiffness [N m/rad]."""
    for stiffness in np.geomspace(1e9, 1e11, 41):
        d = cw.Driveline("teeth")
        a = d.shaft("a", inertia=0.3, speed=0.14)
        teeth: dict[str, Any] = {"teeth": 3, "gap": 0.2, "stiffness": float(stiffness), "damping": 0.0}
        d.add(cw.DogClutch("dog", base=d.housing, follower=a, **teeth, command=1.0, engaged=True))
        run = d.simulate(1.0, rtol=1e-5, atol=1e-5, points=2)
        assert at_end(run, "a.speed") == pytest.approx(-0.14, rel=0.02)


def test_a_sleeve_on_a_tooth_forgives_a_slip_just_above_its_limit() -> None:
    """It stands on a tooth when the slip rises 0.4 % above the limit: less than 1 % keeps it there, and it meshes."""
    d = cw.Driveline("teeth")
    a = d.shaft("a", inertia=1.0)
    d.add(cw.PrescribedSpeed("p", shaft=a, speed=cw.Table([(0.0, 4.5), (0.02, 4.5), (0.05, 5.02), (9.0, 5.02)])))
    teeth: dict[str, Any] = {"teeth": 3, "gap": 0.2, "stiffness": 1e3, "speed": 5.0}
    d.add(cw.DogClutch("dog", base=d.housing, follower=a, **teeth, command=1.0, initial_angle=1.0))
    assert at_end(d.simulate(0.22), "dog.sleeve") > 0.7


@pytest.mark.parametrize("mirrored", [False, True])
@pytest.mark.parametrize(
    "values",
    [
        pytest.param((0.30, 0.20, 0.19), id="parabola"),
        pytest.param((0.31, 0.30, 0.10), id="no turn"),
        pytest.param((0.31, 0.30, 0.50), id="at most three secants"),
    ],
)
def test_end_slopes_of_smooth_tables(values: tuple[float, float, float], mirrored: bool) -> None:
    """The slope at an end is that of the parabola through three points, kept monotone: against SciPy's pchip."""
    points = list(zip((0.0, 10.0, 20.0), values[::-1] if mirrored else values, strict=True))
    law = cw.FrictionTable(static=0.6, kinetic=points, interpolation="smooth")
    expected = PchipInterpolator(*zip(*points, strict=True))
    for slip in (0.5, 3.0, 8.0, 12.0, 17.0, 19.5):
        d = disc(speed=slip)
        d.add(brake("b", d.nodes[0], 1.0, law))
        assert -d.simulate(1e-6)["b.torque"][0] == pytest.approx(float(expected(slip)), rel=1e-12)


def test_many_signals_with_a_knot_each_within_a_microsecond_are_no_zeno_sequence() -> None:
    """Knots are counted for each signal on its own: 60 of them step within 60 ns."""
    d = cw.Driveline("knots")
    for i in range(60):
        step = cw.Step(height=1.0, start=1.0 + 1e-9 * i)
        d.add(cw.Torque(f"t{i}", shaft=d.shaft(f"s{i}", inertia=1.0), torque=step))
    run = d.simulate(2.0, **TIGHT)
    assert run.status == "done"
    assert at_end(run, "s59.speed") == pytest.approx(1.0, rel=1e-6)


def test_a_contact_that_leaves_zero_beside_a_stiff_spring_is_not_brought_back() -> None:
    """The true slope replaces that of the interpolant only where that one leaves zero the wrong way.

    A brake that holds 1 N m sticks and slips beside 1000 N m/rad under a slow sine, at a coarse tolerance.
    """
    for tolerance in (1e-2, 5e-3):
        d = cw.Driveline("brake and spring")
        a = d.shaft("a", inertia=0.1)
        d.add(brake("b", a, 1.0))
        d.add(cw.Torque("t", shaft=a, torque=cw.Sine(amplitude=2.5, frequency=0.35)))
        d.add(cw.Spring("s", base=d.housing, follower=a, stiffness=1000.0))
        assert d.simulate(3.0, rtol=tolerance, atol=tolerance).status == "done"


def test_an_element_of_gms_on_its_way_back_does_not_turn_the_slip() -> None:
    """Where the slip reverses, an element may be beyond its limit by the error of the step: it returns."""
    elements = ((2e-5, 0.1), (5e-5, 0.2), (1e-4, 0.3), (2e-4, 0.4))
    law = cw.GMS(static=0.15, kinetic=0.1, speed=2.0, viscous=1e-3, elements=elements, attraction=100.0)
    d = cw.Driveline("reversal")
    a = d.shaft("a", inertia=1.0)
    speed = cw.Table([(0.0, 0.0), (0.23, -1.7e-3), (0.31, 0.9e-3), (9.0, 0.9e-3)])
    d.add(cw.PrescribedSpeed("p", shaft=a, speed=speed))
    d.add(brake("b", a, 1.0, law))
    assert d.simulate(0.6, rtol=1e-6, atol=1e-6).status == "done"


def test_what_settles_at_once_behind_a_jump_is_seen_in_all_rows() -> None:
    """A slip follows its load within a microsecond: one long step would end right and be wrong in between."""
    d = cw.Driveline("settles")
    a = d.shaft("a", inertia=0.01)
    d.shaft("fast", inertia=1.0, speed=500.0)
    load = cw.Pulse(height=3e4, period=0.4, width=0.1, offset=1e4, start=0.2)
    d.add(cw.Torque("drive", shaft=a, torque=1.0))
    d.add(brake("b", a, load, cw.Tanh(kinetic=1.0, speed=1.0)))
    run = d.simulate(1.0, method="rodas5p", rtol=1e-8)
    edges = np.array([0.0, 0.2, 0.3, 0.6, 0.7])
    settled = np.abs(run.time[:, None] - edges).min(axis=1) > 1e-4
    slip = 0.5 * np.arctanh(1.0 / run["b.normal_force"])
    # the tolerance is that of the fast shaft, 5e-6 rad/s, of which a slip of 1e-4 rad/s has ten
    np.testing.assert_allclose(run["a.speed"][settled], slip[settled], rtol=0.01)
    # 1 N m on 0.01 kg m2 is 100 rad/s2
    assert np.abs(run["a.acceleration"][settled]).max() < 1.0


@pytest.mark.parametrize("weaker", ["first", "second"])
def test_brakes_that_are_declared_locked_but_cannot_both_be(weaker: str) -> None:
    """Between a prescribed speed and the housing no impulse brings both to rest: the weaker one slips."""
    d = cw.Driveline("contradiction")
    a, b = d.shaft("a"), d.shaft("b", inertia=1.0)
    d.add(cw.PrescribedSpeed("p", shaft=a, speed=-55.5))
    loads = (1.0, 5.0) if weaker == "first" else (5.0, 1.0)
    d.add(cw.Clutch("first", base=a, follower=b, friction=ONE, gain=1.0, normal_force=loads[0], locked=True))
    d.add(brake("second", b, loads[1], locked=True))
    run = d.simulate(0.1, **TIGHT)
    # 1 N m over the prescribed speed, and nothing else
    assert run.energy.heat[weaker] == pytest.approx(1.0 * 55.5 * 0.1, rel=1e-9)
    assert abs(run.energy.residual) < 1e-9
    held = {"first": 0.0, "second": -55.5}[weaker]
    np.testing.assert_allclose(run["b.speed"], held, atol=1e-9)


def test_a_ratio_that_leaves_zero_against_a_motion_jams() -> None:
    """At zero it leaves the output free, from then on it would have to stop it at once."""
    d = cw.Driveline("leaves zero")
    a = d.shaft("a", inertia=0.5, speed=10.0)
    ratio = cw.Ramp(height=0.3, duration=0.1, start=0.2)
    d.add(cw.VariableGear("gear", input=d.housing, output=a, ratio=ratio))
    d.add(brake("b", a, 0.5))
    # another one lets go at that instant, so that all is decided there
    other = d.shaft("other", inertia=1.0)
    d.add(brake("lets go", other, 1.0, locked=True))
    d.add(cw.Torque("pull", shaft=other, torque=cw.Step(height=3.0, start=0.2)))
    with pytest.warns(cw.StoppedEarly, match=r"stopped at 0\.2 s: .* break the ratio of a transmission at 'gear'"):
        run = d.simulate(0.4, **TIGHT)
    assert run.status == "jammed"
    assert run["a.speed"][-1] == pytest.approx(10.0 - 0.5 * 0.2 / 0.5, rel=1e-9)
    assert abs(run.energy.residual) < 1e-9


@pytest.mark.parametrize("inertia", [0.01, 0.3, 0.37, 1.0, 20.0])
def test_a_clutch_beside_brakes_that_contradict_each_other_stays_locked(inertia: float) -> None:
    """Impulses without bound leave round-off to contacts that contradict nothing, however little they hold."""
    d = cw.Driveline("third")
    a, b, c = d.shaft("a"), d.shaft("b", inertia=0.37), d.shaft("c", inertia=inertia)
    d.add(cw.PrescribedSpeed("p", shaft=a, speed=-55.5))
    d.add(cw.Clutch("first", base=a, follower=b, friction=ONE, gain=1.0, normal_force=5.0, locked=True))
    d.add(brake("second", b, 1.0, locked=True))
    d.add(cw.Clutch("third", base=b, follower=c, friction=ONE, gain=1.0, normal_force=0.1, locked=True))
    run = d.simulate(0.1, **TIGHT)
    np.testing.assert_allclose(run["c.speed"], -55.5, rtol=1e-9)
    assert run.energy.heat["third"] == pytest.approx(0.0, abs=1e-8)


@pytest.mark.parametrize("ratio", [cw.Ramp(height=0.3, duration=0.1), cw.Sine(amplitude=0.3, frequency=2.0)])
def test_a_ratio_that_begins_to_leave_zero_against_a_motion_jams(ratio: cw.SignalLike) -> None:
    d = cw.Driveline("begins at zero")
    d.add(cw.VariableGear("gear", input=d.housing, output=d.shaft("a", inertia=0.5, speed=10.0), ratio=ratio))
    with pytest.warns(cw.StoppedEarly, match="break the ratio of a transmission at 'gear'"):
        assert d.simulate(0.4).status == "jammed"


@pytest.mark.parametrize("beside", [False, True])
def test_a_ratio_that_leaves_zero_with_the_speed_that_is_prescribed(beside: bool) -> None:
    """Ten times the speed, at zero and from there on: nothing has to change, whatever else is decided then."""
    d = cw.Driveline("both leave zero")
    a, b = d.shaft("a"), d.shaft("b", inertia=0.5, speed=10.0)
    d.add(cw.PrescribedSpeed("p", shaft=a, speed=cw.Ramp(height=3.0, duration=0.1, start=0.2)))
    ratio = cw.Ramp(height=0.3, duration=0.1, start=0.2)
    d.add(cw.VariableGear("gear", input=a, output=b, ratio=ratio))
    if beside:
        other = d.shaft("other", inertia=1.0)
        d.add(brake("lets go", other, 1.0, locked=True))
        d.add(cw.Torque("pull", shaft=other, torque=cw.Step(height=3.0, start=0.2)))
    run = d.simulate(0.4)
    assert run.status == "done"
    np.testing.assert_allclose(run["b.speed"], 10.0, rtol=1e-6)
