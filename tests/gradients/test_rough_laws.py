"""Laws whose torque jumps where no event is, or whose rates have no derivative at some states."""

from __future__ import annotations

import numpy as np
import pytest

import clutchwork as cw

CURVE = {"static": 0.1, "kinetic": 0.08, "speed": 2.0}


def driven(law: cw.Law) -> cw.Driveline:
    """A disc that a torque drives from behind a turning brake disc to ahead of it: the slip passes zero at 0.2 s."""
    d = cw.Driveline("driven")
    s, other = d.shaft("s", inertia=0.1), d.shaft("other", inertia=1.0)
    d.add(cw.PrescribedSpeed("m", shaft=other, speed=10.0))
    d.add(cw.Torque("t", shaft=s, torque=5.0))
    d.add(cw.Clutch("c", base=other, follower=s, friction=law, gain=1e-3, pressure=1e4))
    return d


def test_a_torque_that_jumps_without_an_event_has_no_derivative_behind_it() -> None:
    function = cw.differentiable(
        driven(cw.NaiveSign(**CURVE)), 0.5, of=[cw.at("s.speed", 0.05), "s.speed"], by="t.torque"
    )
    gradient = function.gradient()
    before, behind = gradient.matrix[:, 0]
    step = 1e-4
    expected = (function(function.x0 + step) - function(function.x0 - step)) / (2.0 * step)
    assert before == pytest.approx(expected[0], rel=1e-6)
    assert np.isnan(behind)
    assert "jumps with the sign of its slip" in gradient.problems[0]
    with pytest.raises(cw.ClutchworkError, match="where no event is"):
        function.vjp(function.x0, np.array([0.0, 1.0]))


def test_the_same_law_has_derivatives_where_its_slip_keeps_its_sign() -> None:
    function = cw.differentiable(driven(cw.NaiveSign(**CURVE)), 0.1, of="s.speed", by="t.torque")
    assert function.gradient().matrix[0, 0] == pytest.approx(0.1 / 0.1, rel=0.05)


@pytest.mark.parametrize(("order", "is_noted"), [(0.4, True), (1.0, False), (20.0, False)])
def test_bristles_as_steep_as_one_likes_are_noted(order: float, is_noted: bool) -> None:
    law = cw.Leuven(**CURVE, elements=((2e-5, 0.4), (1e-4, 0.6)), order=order)
    gradient = cw.differentiable(driven(law), 0.1, of="s.speed", by="t.torque").gradient()
    assert any("is below 1" in note for note in gradient.notes) == is_noted


def test_a_jump_at_the_instant_of_an_event_has_no_derivative_behind_it() -> None:
    """A gear with losses turns its load where its speed passes zero, and the slip of the clutch on it does so there."""
    d = cw.Driveline("geared")
    s, load = d.shaft("s", inertia=0.3), d.shaft("load", speed=-4.0)
    d.add(cw.LossyGear("gear", input=s, output=load, ratio=2.0, efficiency=0.7, backward_efficiency=0.4))
    d.add(cw.Torque("t", shaft=s, torque=100.0))
    d.add(cw.Clutch("c", base=d.housing, follower=s, friction=cw.NaiveSign(**CURVE), gain=1e-3, pressure=1e4))
    gradient = cw.differentiable(d, 0.3, of=[cw.at("s.speed", 0.01), "s.speed"], by="load.speed").gradient()
    before, behind = gradient.matrix[:, 0]
    # nearly that of the ratio: the coefficient hardly depends on the slip
    assert before == pytest.approx(2.0, rel=0.1)
    assert np.isnan(behind)
    assert "jumps with the sign of its slip" in gradient.problems[0]


@pytest.mark.parametrize("torque", [5.0, -5.0])
def test_a_slip_that_begins_at_rest_has_not_passed_it(torque: float) -> None:
    d = cw.Driveline("from rest")
    s = d.shaft("s", inertia=0.1)
    d.add(cw.Torque("t", shaft=s, torque=torque))
    d.add(cw.Clutch("c", base=d.housing, follower=s, friction=cw.NaiveSign(**CURVE), gain=1e-3, pressure=1e4))
    assert cw.differentiable(d, 0.1, of="s.speed", by="t.torque").gradient().matrix[0, 0] == pytest.approx(1, rel=0.05)


@pytest.mark.parametrize("torque", [20.0, -20.0])
@pytest.mark.parametrize(("speed", "closed"), [(5.0, 0.0), (-5.0, 0.0), (0.0, 0.3), (0.0, 0.4)])
def test_a_slip_that_others_stop_and_let_go_has_not_passed_zero(speed: float, closed: float, torque: float) -> None:
    """A brake holds the shaft for a while, or the clutch closes on a shaft at rest, also as the brake lets go: it slips
    anew, either way."""
    d = cw.Driveline("let go")
    s = d.shaft("s", inertia=2.0, speed=speed)
    d.add(cw.Torque("t", shaft=s, torque=cw.Table(((0.0, 0.0), (0.4, 0.0), (0.4, torque), (1.0, torque)))))
    held = cw.Table(((0.0, 4e5), (0.4, 4e5), (0.4, 0.0), (0.8, 0.0)))
    d.add(cw.Brake("b", shaft=s, friction=cw.Coulomb(static=0.1, kinetic=0.1), gain=1e-3, pressure=held))
    closing = cw.Step(height=1e4, start=closed)
    d.add(cw.Clutch("c", base=d.housing, follower=s, friction=cw.NaiveSign(**CURVE), gain=1e-3, pressure=closing))
    found = cw.differentiable(d, 0.7, of="s.speed", by="c.gain").gradient().matrix[0, 0]
    # a coefficient of nearly 0.08 over 0.3 s
    assert found == pytest.approx(-np.sign(torque) * 0.09 * 1e4 * 0.3 / 2.0, rel=0.3)


def locking(law: cw.Law) -> cw.Driveline:
    """Two discs that a clutch brings to one speed."""
    d = cw.Driveline("locking")
    a, b = d.shaft("a", inertia=0.3, speed=20.0), d.shaft("b", inertia=0.5)
    d.add(cw.Clutch("c", base=a, follower=b, friction=law, gain=5e-4, pressure=5e5))
    return d


@pytest.mark.parametrize("rtol", [1e-6, 1e-8, 1e-10])
def test_a_torque_whose_slope_no_polynomial_follows_is_noted(rtol: float) -> None:
    """The largest torque of a clutch that locks is what it holds statically, but for a power of its slip."""
    law = cw.Stribeck(static=0.18, kinetic=0.14, speed=6.0, shape="power", exponent=1.5)
    function = cw.differentiable(locking(law), 0.6, of=cw.peak("c.torque"), by="c.gain", rtol=rtol, atol=rtol / 100)
    gradient = function.gradient()
    assert gradient.matrix[0, 0] == pytest.approx(5e5 * 0.18, rel=1e-3)
    assert any("fewer digits" in note for note in gradient.notes)


@pytest.mark.parametrize("rtol", [1e-6, 1e-7, 1e-8])
def test_extremes_where_bristles_turn_are_noted(rtol: float) -> None:
    """Their rates have another slope on both sides of a slip of zero, at which no step ends."""
    law = cw.LuGre(static=0.18, kinetic=0.14, speed=6.0, stiffness=2.0, damping=0.0)
    of = [cw.peak("b.acceleration"), cw.squared_jerk("b"), "b.speed"]
    gradients = [
        cw.differentiable(locking(law), 0.6, of=of, by="c.gain", rtol=rtol, atol=rtol / 100).gradient()
        for rtol in (rtol, 1e-11)
    ]
    assert [name in " ".join(gradients[0].notes) for name in ("peak(b.acc", "squared_jerk(b)", "b.speed:")] == [
        True,
        True,
        False,
    ]
    assert gradients[0].matrix[0, 0] == pytest.approx(151330.51, rel=3e-4)


def test_extremes_far_from_where_bristles_turn_are_not() -> None:
    law = cw.LuGre(static=0.18, kinetic=0.14, speed=6.0, stiffness=2.0, damping=0.0)
    function = cw.differentiable(locking(law), 0.05, of=cw.peak("b.acceleration"), by="c.gain", rtol=1e-8, atol=1e-10)
    assert function.gradient().notes == ()


@pytest.mark.parametrize("rtol", [1e-9, 1e-11])
def test_a_jerk_without_bound_has_no_derivative_that_is_known(rtol: float) -> None:
    """Towards rest the jerk of a power below one grows without bound: runs of two tolerances may agree by chance."""
    d = cw.Driveline("brake")
    a = d.shaft("a", inertia=0.2, speed=50.0)
    law = cw.Stribeck(static=0.11, kinetic=0.1, speed=20.0, shape="power", exponent=0.9)
    d.add(cw.Brake("c", shaft=a, friction=law, gain=5e-4, pressure=2e5))
    function = cw.differentiable(d, 2.0, of=[cw.squared_jerk("a"), "a.angle"], by="c.gain", rtol=rtol, atol=rtol / 100)
    assert np.isnan(function.gradient().matrix[0, 0])
