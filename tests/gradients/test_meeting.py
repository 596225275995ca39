"""Gradients where things happen at one instant: knots that meet, contacts that lock together, jumps, flat pieces."""

from __future__ import annotations

import numpy as np
import pytest

import clutchwork as cw

LINING = cw.Coulomb(static=0.1, kinetic=0.1)


def pushed(*tables, inertia=1.0):
    """A shaft under torques."""
    d = cw.Driveline("pushed")
    a = d.shaft("a", inertia=inertia)
    for number, points in enumerate(tables, 1):
        d.add(cw.Torque(f"t{number}", shaft=a, torque=cw.Table(points)))
    return d


def equal_clutches():
    """One engine and two equal clutches with equal loads."""
    d = cw.Driveline("equal")
    engine = d.shaft("engine", inertia=1.0, speed=100.0)
    for number in (1, 2):
        load = d.shaft(f"load{number}", inertia=2.0)
        d.add(cw.Clutch(f"c{number}", base=engine, follower=load, friction=LINING, gain=1e-3, pressure=1e5))
    return d


def test_ordinates_of_a_flat_piece_have_derivatives():
    d = cw.Driveline("flat")
    a, b = d.shaft("a", inertia=1.0), d.shaft("b", inertia=2.0, speed=10.0)
    pressure = cw.Table([(0.0, 1e5), (0.2, 2e5), (0.6, 2e5), (1.0, 1e5)])
    lining = cw.Coulomb(static=1.0, kinetic=1.0)
    d.add(cw.Clutch("c1", base=a, follower=b, friction=lining, gain=1e-6, pressure=pressure))
    by = ["c1.pressure.values[2]", "c1.pressure.values[3]"]
    found = cw.differentiable(d, 1.0, of=["b.speed", cw.at("b.speed", 0.5)], by=by).gradient().matrix
    # areas under the hats of both ordinates, over twice the inertia
    until = [0.1 + 0.4 / 2, 0.4 / 2 + 0.4 / 2], [0.1 + 0.3 - 0.3**2 / 0.8, 0.3**2 / 0.8]
    np.testing.assert_allclose(found, -1e-6 / 2.0 * np.array(until), rtol=1e-9)


@pytest.mark.parametrize("of", [cw.lock("c1"), cw.lock("c2")], ids=str)
def test_contacts_that_lock_together_are_refused_where_a_number_parts_them(of):
    model = equal_clutches()
    with pytest.raises(cw.NoGradient, match="two events at 4 s, of which c1 is one, move apart"):
        cw.differentiable(model, 20.0, of=of, by="c1.gain").gradient()
    # before they lock there is one
    found = cw.differentiable(model, 20.0, of=cw.at("load1.speed", 1.0), by="c1.gain").gradient()
    assert found.matrix[0, 0] == pytest.approx(0.1 * 1e5 / 2.0, rel=1e-9)
    # where all turn together momentum alone decides, whichever locked first
    found = cw.differentiable(model, 20.0, of="load1.speed", by="c1.gain").gradient()
    assert found.matrix[0, 0] == pytest.approx(0.0, abs=1e-6)


def test_contacts_that_lock_together_have_derivatives_by_what_moves_both():
    found = cw.differentiable(equal_clutches(), 20.0, of=[cw.lock("c2"), "load2.speed"], by="engine.speed").gradient()
    # 10 N m each: 1 / (20 / 1 + 10 / 2) s per rad/s, and momentum
    np.testing.assert_allclose(found.matrix[:, 0], [1.0 / 25.0, 1.0 / 5.0], rtol=1e-9)


FIRST, SECOND = [(0.0, 0.0), (0.5, 1.0), (1.0, 5.0)], [(0.0, 0.0), (0.5, 1.0), (1.0, 7.0)]


@pytest.mark.parametrize("by", [["t1.torque.times[2]"], ["t1.torque.times[2]", "t2.torque.times[2]"]])
def test_a_squared_jerk_has_a_kink_where_knots_meet(by):
    with pytest.raises(cw.NoGradient, match=r"squared_jerk\(a\) has a kink at 0.5 s, where knots meet"):
        cw.differentiable(pushed(FIRST, SECOND), 1.0, of=cw.squared_jerk("a"), by=by).gradient()
    # speeds have none
    found = cw.differentiable(pushed(FIRST, SECOND), 1.0, of="a.speed", by=by).gradient()
    np.testing.assert_allclose(found.matrix[0], [-5.0 / 2, -7.0 / 2][: len(by)], rtol=1e-9)


def test_a_squared_jerk_has_its_derivative_where_knots_are_apart():
    second = [(0.0, 0.0), (0.4, 1.0), (1.0, 7.0)]
    found = cw.differentiable(pushed(FIRST, second), 1.0, of=cw.squared_jerk("a"), by="t1.torque.times[2]").gradient()

    def jerk(t):
        # rates of both torques: 1 / t and 2.5 up to 0.4 s, then 1 / t and 10 up to t, then 4 / (1 - t) and 10
        return 0.4 * (1 / t + 2.5) ** 2 + (t - 0.4) * (1 / t + 10) ** 2 + (1 - t) * (4 / (1 - t) + 10) ** 2

    assert found.values[0] == pytest.approx(jerk(0.5), rel=1e-9)
    assert found.matrix[0, 0] == pytest.approx((jerk(0.5 + 1e-5) - jerk(0.5 - 1e-5)) / 2e-5, rel=1e-7)


def test_a_squared_jerk_has_a_kink_where_a_knot_is_at_an_end_of_the_run():
    for number, time in ((1, 0.0), (3, 1.0)):
        function = cw.differentiable(pushed(FIRST), 1.0, of=cw.squared_jerk("a"), by=f"t1.torque.times[{number}]")
        with pytest.raises(cw.NoGradient, match=rf"has a kink at {time:g} s"):
            function.gradient()


STEP = [(0.0, 0.0), (0.5, 1.0), (0.5, 3.0), (1.0, 1.0)]


def test_a_jump_within_a_phase_has_rows_on_both_sides():
    wanted = {"most": cw.maximum("a.acceleration"), "jerk": cw.squared_jerk("a"), "torque": cw.maximum("t1.torque")}
    by = ["t1.torque.values[3]", "t1.torque.times[2]"]
    function = cw.differentiable(pushed(STEP), 1.0, of=wanted, by=by)
    values, matrix = function.value_and_jacobian(function.x0)
    # slopes of 2 and -4 for half a second each, beside the jump
    np.testing.assert_allclose(values, [3.0, 10.0, 3.0], rtol=1e-9)
    np.testing.assert_allclose(matrix, [[1.0, 0.0], [8.0, -4.0 + 16.0], [1.0, 0.0]], rtol=1e-6, atol=1e-9)
    np.testing.assert_allclose(function.batch([function.x0])[0], values, rtol=1e-9)
    run = cw.simulate(pushed(STEP), 1.0, output="steps")
    there = run["a.acceleration"][run.time == 0.5]
    np.testing.assert_allclose(there, [1.0, 3.0], rtol=1e-12)
    swept = cw.sweep(pushed(STEP), 1.0, vary={"t1.torque": [cw.Table(STEP)]}, outputs=list(wanted.values()))
    np.testing.assert_allclose([swept[one.name][0] for one in wanted.values()], values, rtol=1e-9)


def test_what_bends_with_a_knot_is_not_asked_for_at_its_instant():
    function = cw.differentiable(pushed(FIRST), 1.0, of=cw.at("a.acceleration", 0.5), by="t1.torque.times[2]")
    with pytest.raises(cw.NoGradient, match=r"is asked for at a knot that moves, 0\.5 s; ask before or behind it"):
        function.gradient()
    jumps = cw.differentiable(pushed(STEP), 1.0, of=cw.at("a.speed", 0.5), by="t1.torque.times[2]")
    with pytest.raises(cw.NoGradient, match="is asked for at a knot that moves"):
        jumps.gradient()
    # a speed has its derivative at a knot of a torque that only bends
    found = cw.differentiable(pushed(FIRST), 1.0, of=cw.at("a.speed", 0.5), by="t1.torque.times[2]").gradient()
    assert found.matrix[0, 0] == pytest.approx(-0.5, rel=1e-9)


def test_equal_extremes_of_a_signal_that_is_zero_there_are_one():
    d = cw.Driveline("rest")
    a, b = d.shaft("a", inertia=1.0, speed=1.0), d.shaft("b", inertia=1.0)
    d.add(cw.Clutch("c1", base=a, follower=b, friction=LINING, gain=1.0, normal_force=1.0))
    found = cw.differentiable(d, 20.0, of=cw.maximum("c1.slip"), by="c1.gain").gradient()
    assert found.values[0] == pytest.approx(0.0, abs=1e-12)
    assert found.matrix[0, 0] == pytest.approx(0.0, abs=1e-9)


def test_equal_extremes_of_a_slip_that_is_round_off_are_one():
    """Gears, losses and a closed clutch hold all shafts; the slip is zero but for 1e-18 rad/s from the gear rows."""
    d = cw.Driveline("held")
    a, b = d.shaft("a", inertia=0.362), d.shaft("b", inertia=0.172)
    c, e = d.shaft("c", inertia=0.339, speed=0.0), d.shaft("e", inertia=0.601)
    d.add(cw.Planetary("p", sun=a, ring=b, carrier=c, ratio=2.21))
    d.add(cw.Planetary("q", sun=b, ring=a, carrier=e, ratio=1.43))
    losses = [(0.0, 0.799, 0.385, 0.0, 0.0), (10000.0, 0.436, 0.930, 0.0, 0.0)]
    d.add(cw.LossyGear("g", input=c, output=b, support=a, ratio=0.6, loss_table=losses))
    points = [(0.002618, -24.14), (0.005857, 26.92), (0.02967, -13.51), (0.02967, 0.0)]
    d.add(cw.Torque("drive", shaft=a, torque=cw.Table(points)))
    law = cw.CoefficientTable(static=0.458, kinetic=[(0.0, 0.111), (29.4, 0.0925)])
    load = cw.Sine(amplitude=716862.0, frequency=4.881889763779528, offset=-476500.0, damping=7.34)
    d.add(cw.PlateContact("k", base=c, follower=b, friction=law, gain=0.000317, pressure=load))
    found = cw.differentiable(d, 0.127, of=cw.maximum("k.slip"), by="a.inertia").gradient()
    assert abs(found.values[0]) < 1e-15
    assert abs(found.matrix[0, 0]) < 1e-12
