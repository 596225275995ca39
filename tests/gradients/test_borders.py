"""Borders of tables and laws, plateaus, and what round-off would make of derivatives that are zero."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.gradients.grazing import AT, BY_NAME, passed_unseen, sets
from support import by_differences

COULOMB = cw.Coulomb(static=0.12, kinetic=0.1)
TIGHT: dict[str, Any] = {"rtol": 1e-10, "atol": 1e-12}


def stalling() -> cw.Driveline:
    """An engine that is braked below the speed from which on it burns, and comes back."""
    d = cw.Driveline("stalling")
    e, w = d.shaft("e", inertia=0.3, speed=100.0), d.shaft("w", inertia=1.0)
    full, drag = ((0.0, 100.0), (300.0, 150.0), (500.0, 90.0)), ((0.0, -10.0), (500.0, -40.0))
    d.add(cw.Engine("eng", shaft=e, throttle=0.6, full_load=full, motoring=drag, stall_speed=60.0))
    d.add(cw.Torque("t", shaft=e, torque=cw.Table([(0.0, -60.0), (0.5, -160.0), (1.0, -20.0)])))
    d.add(cw.SpringDamper("k", base=e, follower=w, stiffness=300.0, damping=2.0))
    return d


def compared(model: cw.Driveline, t_end: float, of: Any, by: list[str], **options: Any) -> None:
    """Derivatives are those of differences at a tight tolerance."""
    function = cw.differentiable(model, t_end, of=of, by=by, **options)
    scales = by_differences.scales(model.simulate(t_end, rtol=1e-8), function.task.outputs)
    for one in by_differences.compared(function, function.jacobian(function.x0), scales):
        assert np.all(one.missed < 1e-6), str(one)


def test_a_border_at_which_a_torque_jumps_moves_with_it() -> None:
    of = ["e.speed", cw.at("e.speed", 0.4), cw.minimum("e.speed"), cw.peak("k.torque"), cw.squared_jerk("w")]
    compared(stalling(), 0.6, of, ["eng.stall_speed", "e.inertia"], **TIGHT)


def test_a_band_in_which_a_coefficient_is_another_one_moves_with_it() -> None:
    d = cw.Driveline("band")
    a, b = d.shaft("a", inertia=0.3, speed=30.0), d.shaft("b", inertia=0.8)
    law = cw.Karnopp(static=0.16, kinetic=0.1, speed=4.0, band=1.0)
    d.add(cw.Clutch("c", base=a, follower=b, friction=law, gain=5e-4, pressure=2e5))
    d.add(cw.SpringDamper("k", base=b, follower=d.housing, stiffness=60.0, damping=0.5))
    compared(d, 1.0, ["b.speed", cw.at("a.speed", 0.9), "c.heat"], ["c.friction.band", "a.inertia"], **TIGHT)


@pytest.mark.parametrize("rtol", [1e-6, 1e-9, 1e-12])
def test_what_moves_nothing_yet_takes_no_shorter_steps(rtol: float) -> None:
    # before it stalls round-off is all that a derivative by that speed has
    function = cw.differentiable(
        stalling(), 0.01, of="e.speed", by="eng.stall_speed", rtol=rtol, atol=rtol / 100, max_steps=3000
    )
    assert abs(function.gradient().matrix[0, 0]) < 1e-12


@pytest.mark.parametrize("side", ["left", "right", None])
def test_a_plateau_has_the_derivative_of_all_of_it(side: str | None) -> None:
    d = cw.Driveline("plateau")
    a, b = d.shaft("a", inertia=0.3, speed=20.0), d.shaft("b", inertia=0.8)
    law = cw.Dahl(kinetic=0.1, stiffness=50.0, exponent=0.5)
    d.add(cw.Clutch("c", base=a, follower=b, friction=law, gain=5e-4, pressure=2e5))
    found = d.simulate(0.3, **TIGHT).gradient(of=cw.maximum("c.torque"), by="c.friction.kinetic", side=side)
    assert found.matrix[0, 0] == pytest.approx(100.0, rel=1e-9)


def test_a_jerk_of_a_shaft_without_inertia_that_jumps_where_a_step_moves_is_refused() -> None:
    d = cw.Driveline("light")
    a, m, b = d.shaft("a", inertia=0.3, speed=20.0), d.shaft("m"), d.shaft("b", inertia=0.8)
    d.add(cw.SpringDamper("k1", base=a, follower=m, stiffness=400.0, damping=3.0))
    d.add(cw.SpringDamper("k2", base=m, follower=b, stiffness=900.0, damping=1.0))
    d.add(cw.Torque("t", shaft=m, torque=cw.Step(height=30.0, start=0.3, offset=5.0)))
    of, by = [cw.squared_jerk("m"), cw.squared_jerk("a"), "m.speed"], ["t.torque.start", "t.torque.height"]
    found = d.simulate(1.0, rtol=1e-8, atol=1e-10).gradient(of=of, by=by)
    assert np.isnan(found.matrix).tolist() == [[True, False], [False, False], [False, False]]
    assert "squared_jerk(m)" in found.problems[0]
    assert "without inertia" in found.problems[0]


@pytest.mark.parametrize("rtol", [1e-5, 1e-6])
def test_a_product_is_refused_where_a_gradient_is(rtol: float) -> None:
    d = cw.Driveline("light")
    a, m, b = d.shaft("a", inertia=0.3, speed=20.0), d.shaft("m"), d.shaft("b", inertia=0.8)
    d.add(cw.SpringDamper("k1", base=a, follower=m, stiffness=400.0, damping=3.0))
    d.add(cw.SpringDamper("k2", base=m, follower=b, stiffness=900.0, damping=1.0))
    d.add(cw.Torque("t", shaft=m, torque=cw.Step(height=0.1, start=0.3, offset=5.0)))
    d.add(cw.Torque("u", shaft=a, torque=cw.Table([(0.0513 * i, 1.0 + 0.1 * (i % 3)) for i in range(20)])))
    # so many that they are followed back
    by = ["t.torque.start", "t.torque.height"] + [f"u.torque.values[{i}]" for i in range(1, 21)]
    f = cw.differentiable(d, 1.0, of=cw.squared_jerk("m"), by=by, rtol=rtol, atol=1e-2 * rtol)
    assert np.isnan(f.gradient().matrix[0]).tolist() == [True] + [False] * 21
    with pytest.raises(cw.NoGradient, match="without inertia"):
        f.vjp(f.x0, [1.0])


def test_steps_at_one_instant_move_apart() -> None:
    d = cw.Driveline("two steps")
    a, b = d.shaft("a", inertia=0.3, speed=20.0), d.shaft("b", inertia=0.8)
    d.add(cw.SpringDamper("k", base=a, follower=b, stiffness=400.0, damping=3.0))
    d.add(cw.Torque("t1", shaft=a, torque=cw.Step(height=30.0, start=0.3, offset=5.0)))
    d.add(cw.Torque("t2", shaft=b, torque=cw.Step(height=-70.0, start=0.3, offset=5.0)))
    compared(d, 1.0, ["a.speed", "b.speed", "k.torque"], ["t1.torque.start", "t2.torque.start"], **TIGHT)


def test_a_jump_that_stays_where_it_is_moves_no_extreme() -> None:
    d = cw.Driveline("light")
    a, m, b = d.shaft("a", inertia=0.3, speed=10.0), d.shaft("m"), d.shaft("b", inertia=0.8)
    d.add(cw.SpringDamper("k1", base=a, follower=m, stiffness=400.0, damping=3.0))
    d.add(cw.SpringDamper("k2", base=m, follower=b, stiffness=900.0, damping=1.0))
    d.add(cw.Torque("t", shaft=m, torque=cw.Table([(0.0, 20.0), (0.4, 20.0), (0.4, -12.0), (0.6, 6.0)])))
    of = [cw.minimum("m.speed"), cw.squared_jerk("b"), cw.peak("k1.torque")]
    compared(d, 0.7, of, ["t.torque.values[2]", "t.torque.values[3]"], **TIGHT)


def test_the_last_of_many_bounces_is_as_well_known_as_the_first() -> None:
    d = cw.Driveline("bounces")
    a, b = d.shaft("a", inertia=0.3, speed=4.0), d.shaft("b", inertia=0.8)
    d.add(cw.Backlash("k", base=a, follower=b, gap=0.15, restitution=0.3))
    d.add(cw.Torque("t", shaft=a, torque=10.0))
    d.add(cw.Damper("r", base=b, follower=d.housing, damping=0.3))
    compared(d, 0.3, [cw.lock("k"), "k.heat", "b.speed"], ["a.inertia", "t.torque"], **TIGHT)


def test_a_lag_that_is_not_there_yet_is_refused_alone() -> None:
    d = cw.Driveline("lag")
    e = d.shaft("e", inertia=0.3, speed=100.0)
    d.add(cw.Engine("eng", shaft=e, throttle=0.6, full_load=((0.0, 100.0), (500.0, 90.0))))
    d.add(cw.BearingFriction("f", shaft=e, friction=COULOMB, torque=5.0))
    # a lag would be a state of its own, behind which others stand elsewhere in the rows
    found = d.simulate(0.2).gradient(of=["housing.torque", "e.speed"], by=["eng.lag", "e.inertia"])
    assert np.isnan(found.matrix).tolist() == [[True, False], [True, False]]


def test_a_lag_that_comes_and_goes_leaves_nothing_behind() -> None:
    d = cw.Driveline("lag")
    e = d.shaft("e", inertia=0.3, speed=100.0)
    d.add(cw.Engine("eng", shaft=e, throttle=0.6, full_load=((0.0, 100.0), (500.0, 90.0))))
    d.add(cw.BearingFriction("f", shaft=e, friction=COULOMB, torque=5.0))
    function = cw.differentiable(d, 0.2, of=["e.speed", "f.heat"], by=["eng.lag", "e.inertia"])
    with_lag = np.array([0.05, 0.3])
    first, lagging = function(function.x0), function(with_lag)
    # values are remembered of the last point that was differentiated, none here
    assert np.array_equal(function(function.x0), first)
    assert np.array_equal(function(with_lag), lagging)
    assert function(function.x0)[1] == pytest.approx(d.simulate(0.2)["f.heat"][-1], rel=1e-5)


def overrunning(*, reverses: bool) -> cw.Driveline:
    """A freewheel drives a disc, and a clutch beside it holds with the freewheel, or nothing against it.

    The torque that drives both falls through zero, where both let go at once.
    """
    d = cw.Driveline("overrunning")
    a, b = d.shaft("a", inertia=0.3), d.shaft("b", inertia=0.02)
    torque: Any = cw.Ramp(height=-25.0, duration=0.5, start=0.1, offset=10.0) if reverses else 0.0
    d.add(cw.Torque("t", shaft=a, torque=torque))
    d.add(cw.OneWayClutch("f", base=a, follower=b))
    d.add(cw.FundamentalClutch("c", base=b, follower=a, kinetic=0.0, lower=-2.0, upper=0.0))
    return d


@pytest.mark.parametrize("rtol", [1e-6, 1e-9])
def test_a_set_whose_load_passes_zero_lets_go_when_it_does(rtol: float) -> None:
    names = ["t.torque.offset", "t.torque.height", "t.torque.duration", "t.torque.start"]
    of = [cw.break_away("f"), cw.break_away("c")]
    function = cw.differentiable(overrunning(reverses=True), 0.6, of=of, by=names, rtol=rtol, atol=rtol / 100)
    # the torque is zero at the start of the ramp and so much of it as its offset is of its height
    expected = [0.5 / 25.0, 0.5 * 10.0 / 25.0**2, 10.0 / 25.0, 1.0]
    np.testing.assert_allclose(function.gradient().matrix, [expected, expected], rtol=1e-7)


def pressed() -> cw.Driveline:
    """A screw that is pressed against a stop, by a torque that turns."""
    d = cw.Driveline("pressed")
    a, m = d.shaft("a", inertia=0.1, angle=0.03), d.mass("m", mass=50.0)
    d.add(cw.Torque("t", shaft=a, torque=cw.Ramp(height=25.0, duration=0.5, start=0.1, offset=-10.0)))
    d.add(cw.EndStop("stop", follower=a, lower=-0.1, upper=0.03))
    d.add(cw.Leadscrew("screw", screw=a, mass=m, lead=0.035, radius=0.074, friction_coefficient=0.0283))
    return d


RAMP = ["t.torque.offset", "t.torque.height", "t.torque.duration", "t.torque.start"]


# seed 220235: the stop holds all of any load one way, so that no bound of the screw has anything left
@pytest.mark.parametrize("rtol", [1e-6, 1e-9])
def test_a_screw_that_is_pressed_against_a_stop_lets_go_when_its_torque_turns(rtol: float) -> None:
    of = [cw.break_away("stop"), cw.break_away("screw")]
    found = cw.differentiable(pressed(), 0.35, of=of, by=RAMP, rtol=rtol, atol=rtol / 100).gradient()
    expected = [-0.5 / 25.0, -0.5 * 10.0 / 25.0**2, 10.0 / 25.0, 1.0]
    np.testing.assert_allclose(found.matrix, [expected, expected], rtol=1e-7)


def test_a_set_that_shows_nothing_of_when_it_lets_go_has_no_derivatives_behind_that() -> None:
    # time, guard, component, rate, and by how much it parts from others: a rate of zero is one that was not found
    system, (guard,) = pressed().assemble(), sets()
    lets_go = np.array([[0.3, guard, 2.0, 0.0, 0.0], [0.3, guard, 2.0, 5.0, 0.0]])
    ((time, why),) = passed_unseen(system, lets_go)
    assert time == 0.3
    assert "stop lets go at 0.3 s with others" in why


# one of both loads stays: the larger one of both, or the smaller one
@pytest.mark.parametrize("other", [3.0, 1.0, -1.0, -3.0])
def test_two_stops_let_go_when_the_sum_of_both_loads_turns(other: float) -> None:
    d = pressed()
    a, b = d.shafts[0], d.shaft("b", inertia=0.1, angle=0.03)
    d.add(cw.Torque("beside", shaft=b, torque=other))
    d.add(cw.EndStop("second", follower=b, lower=-0.1, upper=0.03))
    law = cw.Coulomb(static=0.1, kinetic=0.1)
    d.add(cw.Clutch("joins", base=a, follower=b, friction=law, gain=200.0, pressure=1.0, locked=True))
    found = cw.differentiable(d, 0.5, of=[cw.break_away("stop")], by=[*RAMP, "beside.torque"], **TIGHT).gradient()
    risen = 10.0 - other
    expected = [-0.5 / 25.0, -0.5 * risen / 25.0**2, risen / 25.0, 1.0, -0.5 / 25.0]
    assert found.values[0] == pytest.approx(0.1 + 0.5 * risen / 25.0, rel=1e-9)
    np.testing.assert_allclose(found.matrix, [expected], rtol=1e-7)


def test_a_set_that_is_closed_without_load_has_a_side_for_each_sign_of_it() -> None:
    # one way both move together, the other way the disc stays behind
    model = overrunning(reverses=False)
    for side, expected in (("right", 0.6 / 0.32), ("left", 0.0)):
        function = cw.differentiable(model, 0.6, of="b.speed", by="t.torque", side=side)
        assert function.gradient().matrix[0, 0] == pytest.approx(expected, rel=1e-9, abs=1e-12)
    with pytest.raises(cw.ClutchworkError, match="closed without load"):
        cw.differentiable(model, 0.6, of="b.speed", by="t.torque").gradient()


@pytest.mark.parametrize("rtol", [1e-6, 1e-9])
def test_a_peak_at_the_end_of_a_long_step_moves_with_its_knot(rtol: float) -> None:
    # the slip is prescribed, so steps are as long as they like, and the friction winds up until the pressure ends
    d = cw.Driveline("wound")
    s, law = d.shaft("s", inertia=0.1), cw.Mykhalevych(static=0.12, kinetic=0.1, elastic=0.02, speed=2.0, viscous=0.3)
    d.add(cw.PrescribedSpeed("m", shaft=s, speed=1.0))
    pressure = cw.Pulse(height=1e5, period=1.0, width=0.04)
    d.add(cw.Clutch("c", base=d.housing, follower=s, friction=law, gain=1e-3, pressure=pressure))
    found = cw.differentiable(d, 0.1, of=cw.peak("c.torque"), by="c.pressure.width", rtol=rtol, atol=rtol / 100)
    wound = 0.04 / 0.02 + 0.3 * 0.5
    torque = 100.0 * (0.12 * np.tanh(wound) - 0.02 * (1.0 - np.exp(-(0.5**2))))
    assert found(found.x0) == pytest.approx(torque, rel=1e-9)
    assert found.gradient().matrix[0, 0] == pytest.approx(100.0 * 0.12 / np.cosh(wound) ** 2 / 0.02, rel=1e-6)


def test_shares_of_a_set_have_no_kink_where_two_capacities_are_equal() -> None:
    # a freewheel counts with the mean of what both clutches carry, which is half of it all
    d = cw.Driveline("set")
    a, b = d.shaft("a", inertia=0.3), d.shaft("b", inertia=0.2)
    d.add(cw.Torque("t", shaft=a, torque=30.0))
    d.add(cw.Brake("holds", shaft=b, friction=COULOMB, gain=1.0, normal_force=1e4))
    d.add(cw.OneWayClutch("f", base=a, follower=b))
    for name in ("c1", "c2"):
        d.add(cw.Clutch(name, base=a, follower=b, friction=COULOMB, gain=1.0, normal_force=200.0))
    function = cw.differentiable(d, 0.1, of=["f.torque", "c1.torque", "c2.torque"], by="c1.gain")
    assert function(function.x0) == pytest.approx([15.0, 7.5, 7.5], rel=1e-12)
    # of the load half a share of one capacity in both, whose derivative is that of T1 / (2 (T1 + T2))
    assert function.gradient().matrix[:, 0] == pytest.approx([0.0, 30.0 / 8.0, -30.0 / 8.0], rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("rests", [0.0, 0.02])
def test_a_wheel_that_rests_at_a_point_of_its_table_has_a_side_for_each_way_that_the_point_moves(rests: float) -> None:
    # the ratio of the speeds is that of the first point, below which the table is held
    d = cw.Driveline("coupling")
    a, b = d.shaft("a", inertia=0.1, speed=1.0 if rests else 0.0), d.shaft("b", inertia=0.2, speed=30.0)
    d.add(cw.Brake("holds", shaft=a, friction=COULOMB, gain=1.0, normal_force=40.0 / rests if rests else 1e4))
    table = {"speed_ratio": (0.0, 0.3, 1.0), "capacity": (3e-4, 2e-4, 0.0)}
    d.add(cw.FluidCoupling("c", base=a, follower=b, **table))
    step = 1e-5
    for side, way in (("left", -step), ("right", step)):
        function = cw.differentiable(d, 0.2, of="b.speed", by="c.speed_ratio.values[1]", side=side)
        expected = (function(function.x0 + way) - function(function.x0)) / way
        assert function.gradient().matrix[0, 0] == pytest.approx(expected[0], rel=1e-3, abs=1e-9)
    with pytest.raises(cw.ClutchworkError, match=r"at a border of its table|from one piece to another"):
        cw.differentiable(d, 0.2, of="b.speed", by="c.speed_ratio.values[1]").gradient()


@pytest.mark.parametrize("seed", range(4))
def test_what_rests_at_a_point_of_a_table_does_so_to_round_off(seed: int) -> None:
    # two gears make the ratio of the speeds that is a point of the table, but for the last digit of their product
    rng = np.random.default_rng(seed)
    first, speed = rng.uniform(0.5, 2.0), rng.uniform(10.0, 40.0)
    d = cw.Driveline("coupling")
    a, b, c = (d.shaft(name, inertia=0.1) for name in "abc")
    d.add(cw.PrescribedSpeed("m", shaft=b, speed=speed))
    d.add(cw.Gear("g1", input=b, output=c, ratio=1.0 / first))
    d.add(cw.Gear("g2", input=c, output=a, ratio=first / 0.3))
    d.add(cw.FluidCoupling("f", base=a, follower=b, speed_ratio=(0.0, 0.3, 1.0), capacity=(3e-4, 2e-4, 0.0)))
    with pytest.raises(cw.ClutchworkError, match=r"at a border of its table|from one piece to another"):
        cw.differentiable(d, 0.1, of="f.heat", by="f.speed_ratio.values[2]").gradient()


def warmed() -> tuple[cw.Driveline, cw.Shaft]:
    d = cw.Driveline("warmed")
    a = d.shaft("a", inertia=1.0, speed=50.0)
    hot, cold = d.thermal("hot", capacity=1000.0, temperature=400.0), d.ambient("cold", temperature=300.0)
    table = [(0.0, 1.0), (50.0, 2.0), (100.0, 5.0)]
    d.add(cw.Convection("fan", hot=hot, cold=cold, conductance=table, speed=a))
    return d, a


def test_a_fan_that_turns_at_a_point_of_its_table_has_a_side_for_each_way() -> None:
    model, _ = warmed()
    for side, way in (("left", -1e-3), ("right", 1e-3)):
        function = cw.differentiable(model, 1.0, of="hot.temperature", by="a.speed", side=side)
        expected = (function(function.x0 + way) - function(function.x0)) / way
        assert function.gradient().matrix[0, 0] == pytest.approx(expected[0], rel=1e-3)
    with pytest.raises(cw.ClutchworkError, match=r"one piece to another|border of its table"):
        cw.differentiable(model, 1.0, of="hot.temperature", by="a.speed").gradient()


def test_a_prescribed_speed_that_jumps_by_nothing_jumps_with_its_height() -> None:
    # both shafts of a differential are prescribed, so that the jump is an impulse at the third one
    d = cw.Driveline("jump")
    s0, s1, s2 = (d.shaft(name, inertia=own) for name, own in (("s0", 0.6), ("s1", 0.01), ("s2", 0.2)))
    free = d.shaft("free", inertia=0.3)
    d.add(cw.Differential("d", carrier=s0, left=s2, right=s1))
    d.add(cw.PrescribedSpeed("m1", shaft=s1, speed=5.0))
    d.add(cw.PrescribedSpeed("m0", shaft=s0, speed=cw.Step(height=0.0, start=0.05, offset=-20.0)))
    d.add(cw.SpringDamper("k", base=s2, follower=free, stiffness=20.0, damping=0.1))
    function = cw.differentiable(d, 0.1, of=["m1.work", "m0.work", "s2.speed", "free.speed"], by="m0.speed.height")
    step = 1e-3
    expected = (function(function.x0 + step) - function(function.x0 - step)) / (2.0 * step)
    assert function.gradient().matrix[:, 0] == pytest.approx(expected, rel=1e-6)


def together(torque: float) -> cw.Driveline:
    """Two discs that a clutch of 12.5 N m holds together, which carries four fifths of a torque."""
    d = cw.Driveline("together")
    a, b = d.shaft("a", inertia=0.2), d.shaft("b", inertia=0.8)
    d.add(cw.Clutch("c", base=a, follower=b, friction=cw.Coulomb(static=0.125, kinetic=0.1), gain=5e-4, pressure=2e5))
    d.add(cw.Torque("t", shaft=a, torque=torque))
    return d


def test_a_clutch_that_holds_all_that_it_can_from_the_start_has_one_side() -> None:
    # a little more torque breaks it away, and the speed jumps
    function = cw.differentiable(together(15.625), 2.0, of="b.speed", by="t.torque")
    with pytest.raises(cw.NoGradient, match=r'holds all that it can, from 0 s on.*side="left" gives 2$'):
        function.gradient()
    assert cw.differentiable(together(15.6), 2.0, of="b.speed", by="t.torque").gradient().matrix == pytest.approx(2.0)


def test_a_reason_is_that_of_the_number_it_concerns() -> None:
    # the load of the brake is zero up to 0.1 s; that another clutch locks at a bend later changes nothing there
    d = cw.Driveline("reasons")
    a, b = d.shaft("a", inertia=0.2, speed=10.0), d.shaft("b", inertia=0.2, speed=10.0)
    d.add(cw.Torque("t", shaft=a, torque=30.0))
    ramp = cw.Table([(0.0, 0.0), (0.1, 0.0), (0.6, 1e5), (3.0, 1e5)])
    d.add(cw.Brake("b1", shaft=b, friction=COULOMB, gain=5e-4, pressure=ramp))
    d.add(cw.OneWayClutch("f", base=a, follower=b))
    late = cw.Table([(0.0, 0.0), (1.0, 0.0), (1.3, 3e5), (3.0, 3e5)])
    d.add(cw.Clutch("k1", base=a, follower=b, friction=COULOMB, gain=5e-4, pressure=late))
    with pytest.raises(cw.NoGradient, match=r"b1.pressure is 0 from 0 to 0.1 s"):
        cw.differentiable(d, 1.5, of="b.speed", by="b1.pressure.values[2]").gradient()


def test_freewheels_in_a_ring_let_go_at_instants_of_their_own() -> None:
    # all loads pass zero at one instant; a little torque at one of the discs parts these
    d = cw.Driveline("ring")
    a, b, c = d.shaft("a", inertia=0.3), d.shaft("b", inertia=0.02), d.shaft("c", inertia=0.1)
    d.add(cw.Torque("t", shaft=a, torque=cw.Ramp(height=-25.0, duration=0.5, start=0.1, offset=10.0)))
    d.add(cw.Torque("tc", shaft=c, torque=0.0))
    for name, base, follower in (("f1", a, b), ("f2", b, c), ("f3", a, c)):
        d.add(cw.OneWayClutch(name, base=base, follower=follower))
    with pytest.raises(cw.ClutchworkError, match="move apart"):
        cw.differentiable(d, 0.6, of="c.speed", by="tc.torque").gradient()
    step = 1e-4
    for side, way in (("left", -step), ("right", step)):
        function = cw.differentiable(d, 0.6, of="c.speed", by="tc.torque", side=side)
        expected = (function(function.x0 + way) - function(function.x0)) / way
        assert function.gradient().matrix[0, 0] == pytest.approx(expected[0], rel=1e-3)


@pytest.mark.parametrize("seed", range(4))
def test_a_sprag_clutch_whose_torque_ends_overruns_whatever_its_round_off(seed: int) -> None:
    # right above zero it was taken for one at the torque at which it gives way, of hundreds of N m
    rng = np.random.default_rng(seed)
    d = cw.Driveline("overruns")
    a, b = d.shaft("a", inertia=rng.uniform(0.05, 0.9)), d.shaft("b", inertia=rng.uniform(0.05, 0.9))
    m0, m1, s0 = d.mass("m0", mass=rng.uniform(1, 90)), d.mass("m1", mass=2.0), d.shaft("s0", inertia=0.004)
    swing = {"amplitude": rng.uniform(5, 30), "frequency": rng.uniform(5, 20), "offset": rng.uniform(0, 2)}
    d.add(cw.Torque("t", shaft=a, torque=cw.Sine(**swing)))
    d.add(cw.SpringDamper("k", base=s0, follower=b, stiffness=rng.uniform(20, 900), damping=0.0))
    rolls = cw.Coulomb(static=0.0, kinetic=0.0)
    d.add(cw.SpragClutch("f", base=a, follower=b, holding=rng.uniform(100, 1000), friction=rolls))
    d.add(cw.LossyGear("g", input=m0, output=m1, efficiency=0.667, ratio=-0.317))
    assert not any(event.cause == "fault" for event in d.simulate(0.5).events)
    function = cw.differentiable(d, 0.5, of="b.speed", by=["t.torque.amplitude", "a.inertia"])
    runs = function.engine.runs
    causes = runs.forward(runs.point(function.x0)).primal.events[:, AT["cause"]]
    assert len(causes)
    assert BY_NAME["fault"] not in causes


def launch() -> tuple[cw.Driveline, str]:
    """A turbine at stall, where the table of its converter begins."""
    d = cw.Driveline("launch")
    pump, turbine = d.shaft("pump", inertia=0.16, speed=190.0), d.shaft("first", inertia=0.12, speed=0.0)
    table = {"speed_ratio": [0.0, 0.4, 0.7, 1.0], "torque_ratio": [2.0, 1.6, 1.2, 1.0]}
    d.add(cw.TorqueConverter("tc", impeller=pump, turbine=turbine, capacity=[0.0035, 0.0034, 0.003, 0.0], **table))
    return d, "first.speed"


def shoes() -> tuple[cw.Driveline, str]:
    """A centrifugal clutch at the speed at which its shoes leave their springs."""
    d = cw.Driveline("shoes")
    s, b = d.shaft("first", inertia=0.2, speed=100.0), d.shaft("b", inertia=0.3)
    drum = {"mass": 0.1, "radius": 0.05, "drum_radius": 0.06, "onset": 100.0}
    d.add(cw.CentrifugalClutch("e", base=s, follower=b, friction=cw.Coulomb(static=0.3, kinetic=0.25), **drum))
    d.add(cw.Torque("t", shaft=s, torque=5.0))
    return d, "first.speed"


@pytest.mark.parametrize("begins", [launch, shoes])
def test_what_is_asked_of_the_start_itself_has_sides_there(begins: Any) -> None:
    """What the motion leaves at once moves no end of it, but an extreme at the start, and what is summed of jerks."""
    model, by = begins()
    of = [cw.peak("first.acceleration"), cw.squared_jerk("first"), "first.speed"]
    sides = {side: cw.differentiable(model, 0.2, of=of, by=by, side=side, **TIGHT) for side in (None, "left", "right")}
    f = sides[None]
    both, tried = f.gradient(), 1e-4
    assert np.isnan(both.matrix[:2, 0]).all()
    assert "begins where it" in both.problems[0]
    middle, above, below = f(f.x0), f(f.x0 + tried), f(f.x0 - tried)
    for side, there in (("left", (middle - below) / tried), ("right", (above - middle) / tried)):
        found = sides[side].gradient().matrix[:, 0]
        known = np.isfinite(found)
        assert known[[0, 2]].all()
        # one-sided differences know as many digits
        assert found[known] == pytest.approx(there[known], rel=1e-3, abs=1e-6)
