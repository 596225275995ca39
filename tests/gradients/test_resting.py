"""What rests exactly where a little more acts and a little less does not: derivatives of either side, none silently."""

from __future__ import annotations

import numpy as np
import pytest

import clutchwork as cw

TIGHT = {"rtol": 1e-9, "atol": 1e-12}
SIDES = ("left", "right")
GRIP = cw.Coulomb(static=0.125, kinetic=0.1)


def both(d, t_end, of, by, match):
    """Derivatives from the left and from the right of what is refused, with these words, without a side."""
    with pytest.raises(cw.NoGradient, match=match):
        cw.differentiable(d, t_end, of=of, by=by, **TIGHT).gradient()
    return [cw.differentiable(d, t_end, of=of, by=by, side=side, **TIGHT).gradient().matrix for side in SIDES]


def discs():
    d = cw.Driveline("discs")
    return d, d.shaft("e", inertia=0.2, speed=100.0), d.shaft("l", inertia=0.8)


def with_piston(command, **given):
    d, e, f = discs()
    piston = d.add(cw.PressureActuator("x", command=command, lag=0.05, **given))
    d.add(cw.Clutch("c", base=e, follower=f, friction=GRIP, gain=1e-3, pressure=piston))
    return d


@pytest.mark.parametrize("fill_time", [0.0, 0.1])
def test_a_command_that_rests_on_its_spring_for_a_while(fill_time):
    """It presses later by what the areas below its pressure say, which the lag only shifts."""
    d = with_piston(cw.Table([(0.0, 5e4), (0.3, 5e4), (0.6, 2e5)]), spring=5e4, fill_time=fill_time)
    by, per = ["x.spring", "x.command.values[1]", "x.command.values[2]"], 1e-3 * 0.1 / 0.2
    # a piston that has to be filled fills with the area of its command; the table has two triangles, of 0.15 s each
    left, right = both(d, 1.5, "e.speed", by, r"x\.command is 50000, as x\.spring, from 0 to 0\.3 s")
    lag = 0.05
    np.testing.assert_allclose(left[0] / per, [1.5 - lag, 0.0, -0.15], rtol=1e-6, atol=1e-6)
    np.testing.assert_allclose(right[0] / per, [1.2 - lag, -0.15, -0.3], rtol=1e-6, atol=1e-6)


def test_a_spring_that_is_zero_under_a_command_of_zero():
    """Less of the spring is not allowed, and more of it acts only once the command does."""
    d = cw.Driveline("brake")
    m = d.mass("m", mass=1.0, speed=5.0)
    command = cw.Table([(0.0, 0.0), (0.1, 0.0), (0.3, 2e5)])
    piston = d.add(cw.PressureActuator("x", command=command, lag=0.05, fill_time=0.1))
    d.add(cw.Brake("b", shaft=m, friction=cw.Coulomb(static=1.0, kinetic=1.0), gain=1e-5, pressure=piston))
    with pytest.raises(cw.NoGradient, match=r"a little more of x\.spring acts"):
        cw.differentiable(d, 1.0, of="m.speed", by="x.spring", **TIGHT).gradient()
    right = cw.differentiable(d, 1.0, of="m.speed", by="x.spring", side="right", **TIGHT).gradient().matrix
    assert right[0, 0] == pytest.approx(1e-5 * (0.9 - 0.05), rel=1e-5)


def test_a_filled_piston_whose_command_begins_on_its_spring():
    """Both sides agree where it has to be filled again, and have another value than the run at the point says."""
    step = cw.Step(offset=5e4, height=1.5e5, start=0.3)
    d = with_piston(step, spring=5e4, fill_time=0.1, filled=True)
    found = cw.differentiable(d, 1.5, of=cw.lock("c"), by=["x.spring", "x.command.offset"], **TIGHT)
    x, far = found.x0, np.array([1.0, 0.0])
    tight = cw.differentiable(d, 1.5, of=cw.lock("c"), by=["x.spring", "x.command.offset"], rtol=1e-11, atol=1e-14)
    wanted = (tight(x + far) - tight(x - far))[0] / 2.0
    np.testing.assert_allclose(found.gradient().matrix[0], [wanted, -wanted], rtol=1e-5)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_pressure_that_rests_on_the_threshold_of_its_plates(sign):
    d, e, f = discs()
    plates = {"gain": 1e-3, "threshold": 4e4, "pressure": sign * 4e4, "reversed": sign < 0.0}
    d.add(cw.PlateContact("c", base=e, follower=f, friction=GRIP, **plates))
    by, per = ["c.threshold", "c.pressure"], 1e-3 * 0.1 / 0.2
    left, right = both(d, 1.0, "e.speed", by, r"c\.pressure is -?40000, as c\.threshold, from 0 to 1 s")
    np.testing.assert_allclose(left[0] / per, [1.0, 0.0 if sign > 0 else 1.0], rtol=1e-6, atol=1e-9)
    np.testing.assert_allclose(right[0] / per, [0.0, -1.0 if sign > 0 else 0.0], rtol=1e-6, atol=1e-9)


def test_a_pressure_that_reaches_the_threshold_and_stays():
    d, e, f = discs()
    press = cw.Table([(0.0, 0.0), (0.2, 4e4), (0.5, 4e4), (0.6, 2e5)])
    d.add(cw.PlateContact("c", base=e, follower=f, friction=GRIP, gain=1e-3, threshold=4e4, pressure=press))
    by, per = ["c.threshold", "c.pressure.values[2]", "c.pressure.values[3]"], 1e-3 * 0.1 / 0.2
    left, right = both(d, 1.0, "e.speed", by, r"c\.pressure is 40000, as c\.threshold, from 0\.2 to 0\.5 s")
    np.testing.assert_allclose(left[0] / per, [0.8, 0.0, -0.05], rtol=1e-6, atol=1e-6)
    np.testing.assert_allclose(right[0] / per, [0.5, -0.15, -0.2], rtol=1e-6, atol=1e-6)


def test_a_pressure_that_touches_the_threshold_at_a_knot():
    """A little more of it acts for a while that grows with how much: the derivative is zero on both sides."""
    d, e, f = discs()
    press = cw.Table([(0.0, 0.0), (0.2, 4e4), (0.5, 0.0)])
    d.add(cw.PlateContact("c", base=e, follower=f, friction=GRIP, gain=1e-3, threshold=4e4, pressure=press))
    found = cw.differentiable(d, 1.0, of="e.speed", by=["c.threshold", "c.pressure.values[2]"], **TIGHT).gradient()
    np.testing.assert_allclose(found.matrix, 0.0, atol=1e-9)


def differences(d, t_end, of, by, h):
    """Differences on both sides, the error of first order in h left out."""
    function = cw.differentiable(d, t_end, of=of, by=by, rtol=1e-12, atol=1e-15)
    x = function.x0

    def slopes(step):
        return np.array([(function(x + step * one) - function(x))[0] / step for one in np.eye(len(x)) * x])

    return [(2.0 * slopes(sign * h / 2.0) - slopes(sign * h)) / x for sign in (-1.0, 1.0)]


def thrown(kind):
    """A shaft that turns exactly at the onset of weights until a torque drives it on."""
    d, e, f = discs()
    d.add(cw.Torque("t", shaft=e, torque=cw.Step(height=10.0, start=0.3)))
    law = cw.Coulomb(static=0.35, kinetic=0.3)
    if kind == "flyweights":
        weights = d.add(cw.Flyweights("w", mass=0.1, radius=0.03, onset=100.0, speed=e))
        d.add(cw.Brake("c", shaft=e, friction=law, gain=0.5, normal_force=weights))
        return d, "w.onset"
    shoes = {"shoes": 2, "mass": 0.1, "radius": 0.06, "drum_radius": 0.08, "onset": 100.0}
    d.add(cw.CentrifugalClutch("c", base=e, follower=f, friction=law, **shoes))
    return d, "c.onset"


@pytest.mark.parametrize("kind", ["flyweights", "clutch"])
def test_a_speed_that_rests_at_the_onset_of_weights(kind):
    d, onset = thrown(kind)
    found = both(d, 1.0, "e.speed", [onset, "e.speed"], "the load of c rests at zero up to 0.3 s")
    for side, wanted in zip(found, differences(d, 1.0, "e.speed", [onset, "e.speed"], 1e-7), strict=True):
        np.testing.assert_allclose(side[0], wanted, rtol=3e-5)


def test_a_prescribed_speed_that_rests_at_the_onset_of_weights():
    """For a higher onset the drum is driven from 0.5 s on, for a lower one from the start."""
    d = cw.Driveline("prescribed")
    e, f = d.shaft("e", inertia=0.1), d.shaft("f", inertia=0.3)
    d.add(cw.PrescribedSpeed("p", shaft=e, speed=cw.Table([(0.0, 100.0), (0.5, 100.0), (0.8, 150.0)])))
    shoes = {"shoes": 2, "mass": 0.1, "radius": 0.06, "drum_radius": 0.08, "onset": 100.0}
    d.add(cw.CentrifugalClutch("c", base=e, follower=f, friction=GRIP, **shoes))
    left, right = both(d, 1.0, "f.speed", "c.onset", "the load of c rests at zero up to 0.5 s")
    per = -0.1 * 2 * 0.08 * 0.1 * 0.06 * 2 * 100.0 / 0.3
    assert left[0, 0] == pytest.approx(1.0 * per, rel=1e-6)
    # the lag shows for a while that grows with how much higher the onset is
    assert right[0, 0] == pytest.approx(0.5 * per, rel=1e-4)


def test_a_belt_whose_centrifugal_tension_is_its_preload():
    d, e, f = discs()
    belt = {"radius_base": 0.1, "radius_follower": 0.06, "centre_distance": 0.35, "friction_coefficient": 0.3}
    d.add(cw.BeltDrive("x", base=e, follower=f, preload=100.0, mass_per_length=1.0, **belt))
    by = ["x.preload", "x.mass_per_length", "e.speed"]
    found = both(d, 0.5, "e.speed", by, "the load of x rests at zero up to 0.5 s")
    for side, wanted in zip(found, differences(d, 0.5, "e.speed", by, 1e-6), strict=True):
        np.testing.assert_allclose(side[0], wanted, rtol=1e-5, atol=1e-7)


def test_weights_that_never_reach_their_onset_cost_no_more():
    d, _ = thrown("clutch")
    function = cw.differentiable(d, 0.2, of="e.speed", by=["c.lag", "e.inertia"], **TIGHT)
    point = function.engine.runs.point(function.x0)
    known, lines = function.engine.lines(point)
    assert not function.engine._doubts(point, known, lines)


def sprag(load, **given):
    d = cw.Driveline("sprag")
    f = d.shaft("f", inertia=0.8)
    d.add(cw.SpragClutch("c", base=d.housing, follower=f, **given))
    d.add(cw.Torque("t", shaft=f, torque=load))
    return d


def test_a_load_that_is_exactly_the_drag_of_a_freewheel():
    """A little more load, or less drag, and it overruns."""
    by = ["c.drag", "t.torque"]
    left, right = both(sprag(5.0, holding=60.0, drag=5.0), 1.0, "f.speed", by, "c is loaded exactly to its drag at 1 s")
    np.testing.assert_allclose(left[0], [-1.25, 0.0], rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(right[0], [0.0, 1.25], rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize(
    ("load", "free", "at"),
    [
        (-50.0, "t.torque", 1.2),
        (cw.Table([(0.0, 0.0), (0.3, -50.0), (1.0, 0.0)]), "t.torque.values[2]", 0.3),
        (cw.Ramp(height=-50.0, duration=0.3), "t.torque.height", 0.3),
    ],
    ids=["constant", "peak", "ramp"],
)
def test_a_load_that_is_exactly_what_a_freewheel_holds(load, free, at):
    """Where a little more makes it roll over speeds jump: there is no derivative from that side."""
    d = sprag(load, holding=50.0)
    with pytest.raises(cw.NoGradient, match=rf"c is loaded exactly to its holding at {at} s"):
        cw.differentiable(d, 1.2, of="f.speed", by=["c.holding", free], **TIGHT).gradient()
    with pytest.raises(cw.NoGradient):
        d.simulate(1.2).gradient(of="f.speed", by="c.holding")
    right = cw.differentiable(d, 1.2, of="f.speed", by=["c.holding", free], side="right", **TIGHT).gradient().matrix
    np.testing.assert_allclose(right[0], 0.0, atol=1e-9)


def test_a_load_below_what_a_freewheel_holds_is_not_in_doubt():
    found = cw.differentiable(sprag(-49.9, holding=50.0), 1.0, of="f.speed", by=["c.holding", "t.torque"], **TIGHT)
    np.testing.assert_array_equal(found.gradient().matrix, 0.0)


def on_a_bend(prescribed):
    """A brake whose coefficient begins to grow with the slip exactly where it turns."""
    d = cw.Driveline("bend")
    e = d.shaft("e", inertia=0.2, **({} if prescribed else {"speed": 100.0}))
    law = cw.Formula("m+c*max(v-w,0)", m=0.1, c=0.01, w=100.0)
    d.add(cw.Brake("b", shaft=e, friction=law, gain=1e-3, pressure=1e5))
    if prescribed:
        d.add(cw.PrescribedSpeed("p", shaft=e, speed=100.0))
    else:
        d.add(cw.Torque("t", shaft=e, torque=cw.Table([(0.0, 10.0), (0.3, 10.0), (0.6, 12.0)])))
    return d


def test_a_formula_that_rests_on_its_bend():
    """A speed that settles at it, and with it how the speed at the start dies away."""
    by, of = ["b.friction.w", "e.speed"], "e.speed"
    left, right = both(on_a_bend(prescribed=False), 1.0, of, by, "the formula of b is at a bend at 0.3 s")
    # more speed decays with 0.2 s from the start on, less speed from when the torque rises
    rate = 0.01 * 1e-3 * 1e5 / 0.2
    assert right[0, 1] == pytest.approx(np.exp(-rate), rel=1e-5)
    assert left[0, 0] == pytest.approx(1.0 - np.exp(-rate), rel=1e-5)
    for side, wanted in zip((left, right), differences(on_a_bend(prescribed=False), 1.0, of, by, 1e-8), strict=True):
        np.testing.assert_allclose(side[0], wanted, rtol=5e-3)


def test_a_formula_that_is_held_on_its_bend():
    by, of = ["b.friction.w", "b.friction.c"], "b.heat"
    found = [
        cw.differentiable(on_a_bend(prescribed=True), 1.0, of=of, by=by, side=side, **TIGHT).gradient().matrix
        for side in SIDES
    ]
    none = cw.differentiable(on_a_bend(prescribed=True), 1.0, of=of, by=by, **TIGHT).gradient()
    assert np.isnan(none.matrix[0, 0])
    assert "the formula of b is at a bend at 1 s" in none.problems[0]
    np.testing.assert_allclose(found, [[[-100.0, 0.0]], [[0.0, 0.0]]], atol=1e-9)


def towards_a_stop(upper, **given):
    """A mass of 1 kg that moves with 1 m/s towards a stop."""
    d = cw.Driveline("stop")
    m = d.mass("m", mass=1.0, position=0.0, speed=1.0)
    d.add(cw.EndStop("e", follower=m, upper=upper, **given))
    return d, m


def test_a_brake_that_stops_a_mass_exactly_at_a_stop():
    """The stop holds it for more speed, the brake for less."""
    d, m = towards_a_stop(0.5)
    d.add(cw.Brake("b", shaft=m, friction=cw.Coulomb(static=1.0, kinetic=1.0), gain=1.0, normal_force=1.0))
    by = ["e.upper", "m.speed", "b.gain"]
    left, right = both(d, 1.5, "m.position", by, "e is only just reached at 1 s")
    np.testing.assert_allclose(left[0], [1.0, 1.0, 0.0], rtol=1e-6, atol=1e-9)
    np.testing.assert_allclose(right[0], [0.0, 0.0, -0.5], rtol=1e-6, atol=1e-9)


def test_a_bounce_where_a_torque_jumps():
    """Struck before it, half of the speed is lost without the torque; struck later, with what the torque added."""
    d, m = towards_a_stop(1.0, upper_restitution=0.5)
    d.add(cw.Torque("t", shaft=m, torque=cw.Step(height=0.5, start=1.0)))
    by = ["e.upper", "m.speed"]
    left, right = both(d, 1.5, ["m.position", "m.speed"], by, "e is struck at 1 s, where a signal jumps")
    np.testing.assert_allclose(left, [[1.5, -0.375], [0.0, 0.25]], rtol=1e-6, atol=1e-9)
    np.testing.assert_allclose(right, [[1.125, -0.75], [-0.75, -0.5]], rtol=1e-6, atol=1e-9)


def test_a_stop_that_is_struck_at_the_end():
    d, _ = towards_a_stop(1.0, upper_restitution=0.5)
    of, by = [cw.maximum("m.position"), cw.integral("m.speed")], ["e.upper", "m.speed"]
    left, right = both(d, 1.0, of, by, "an event is at the end of the run, 1 s")
    np.testing.assert_allclose(left, [[1.0, 1.0], [1.5, 1.0]], rtol=1e-6, atol=1e-9)
    np.testing.assert_allclose(right, [[0.0, 0.0], [0.0, -0.5]], rtol=1e-6, atol=1e-9)
    # the instant itself is one as long as it is there
    found = cw.differentiable(d, 1.0, of=cw.integral("m.speed"), by="m.mass", **TIGHT).gradient()
    assert found.matrix[0, 0] == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("end", [{"upper": 0.5, "lower": -3.0}, {"gap": 1.0}], ids=["stop", "backlash"])
def test_a_mass_that_is_at_rest_at_an_end_as_the_run_ends(end):
    """It turns round there, and no blow tells of it."""
    d = cw.Driveline("turns")
    m = d.mass("m", mass=1.0, position=0.0, speed=1.0)
    if "gap" in end:
        d.add(cw.Backlash("e", base=d.housing, follower=m, **end))
    else:
        d.add(cw.EndStop("e", follower=m, **end))
    d.add(cw.Torque("t", shaft=m, torque=-1.0))
    with pytest.raises(cw.NoGradient, match=r"e is (reached at the end of the run|only just reached)"):
        cw.differentiable(d, 1.0, of="m.speed", by=["m.speed", "t.torque"], **TIGHT).gradient()
