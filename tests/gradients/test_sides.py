"""Derivatives from the left and from the right: refused where they differ, given on request, right where they agree."""

from __future__ import annotations

import numpy as np
import pytest

import clutchwork as cw
from support import refusals, sided
from support.amount import amount
from support.by_differences import TIGHT
from support.gradient_cases import KINDS

# of the size of a derivative, or of the value over that of the number
CLOSE = 1e-5


def sizes(f, number=0):
    """What derivatives of all values by a number are compared with."""
    return np.maximum(np.abs(f(f.x0)), 1e-6) / (abs(f.x0[number]) or 1.0)


def drawn(make, seed):
    return make(np.random.default_rng(seed))


@pytest.mark.random
@pytest.mark.parametrize("make", sided.DIFFER, ids=lambda make: make.__name__)
def test_sides_that_differ(make):
    """Refused, each side on request; every door says the same."""
    for seed in range(amount(4)):
        case = drawn(make, seed)
        differences = sided.from_both_sides(case, 0)
        f = cw.differentiable(case.model, case.t_end, of=case.of, by=case.by, **TIGHT)
        # a value whose sides agree has its derivative
        size = np.abs(differences).max(axis=0)
        differ = np.abs(differences[0] - differences[1]) > 1e-3 * size + 1e-7 * sizes(f)
        assert differ.any()
        with pytest.raises(cw.NoGradient, match=r'side="right" gives'):
            f.vjp(f.x0, differ.astype(float))
        with pytest.raises(cw.NoGradient, match=r'side="left" gives'):
            f.objective(differ.astype(float))(f.x0)
        np.testing.assert_array_equal(np.isnan(f.batch_jacobian(f.x0[None])[1][0, :, 0]), differ)
        if differ.all():
            with pytest.raises(cw.NoGradient):
                f.gradient()
        for side, wanted in zip(("left", "right"), differences, strict=True):
            found = cw.differentiable(case.model, case.t_end, of=case.of, by=case.by, side=side, **TIGHT)
            room = CLOSE * np.maximum(np.abs(wanted), sizes(f))
            np.testing.assert_array_less(np.abs(found.gradient().matrix[:, 0] - wanted), room + 1e-9)


@pytest.mark.random
@pytest.mark.parametrize("make", sided.AGREE, ids=lambda make: make.__name__)
def test_sides_that_agree(make):
    """Numbers asked for together and one by one, by every door."""
    for seed in range(amount(4)):
        case = drawn(make, seed)
        f = cw.differentiable(case.model, case.t_end, of=case.of, by=case.by, **TIGHT)
        found = f.gradient()
        assert found.problems == ()
        np.testing.assert_allclose(f.vjp(f.x0, np.ones(len(f.of)))[1], found.matrix.sum(axis=0), rtol=1e-6)
        for number in range(len(case.by)):
            left, right = sided.from_both_sides(case, number)
            room = CLOSE * np.maximum(np.abs(left), sizes(f, number))
            np.testing.assert_array_less(np.abs(left - right), 10 * room)
            np.testing.assert_array_less(np.abs(found.matrix[:, number] - 0.5 * (left + right)), 10 * room)


@pytest.mark.parametrize("rtol", [1e-6, 1e-9])
def test_a_bend_inside_of_a_step_is_found_at_any_tolerance(rtol):
    """One of two brakes that hold a shaft reaches its capacity, which is its largest torque."""
    for seed in range(4):
        case = drawn(sided.bends_inside_of_a_step, seed)
        f = cw.differentiable(case.model, case.t_end, of=case.of[0], by=["t.torque.values[2]", "b1.gain"], rtol=rtol)
        values, matrix = f.value_and_jacobian(f.x0)
        capacity = float(np.max(np.abs(case.model.simulate(case.t_end, dt=1e-3)["b1.torque"])))
        np.testing.assert_allclose(values, capacity, rtol=1e-7)
        np.testing.assert_allclose(f(f.x0), capacity, rtol=1e-7)
        np.testing.assert_allclose(matrix[0], [0.0, capacity / f.x0[1]], rtol=1e-6, atol=1e-7)


def test_a_value_without_a_derivative_takes_no_other_with_it():
    case = drawn(sided.starts_at_rest, 0)
    run = case.model.simulate(case.t_end)
    found = run.gradient(of=["b.speed", cw.lock("c")], by=["b.speed", "a.inertia"])
    assert np.isnan(found["b.speed", "b.speed"])
    assert np.isfinite(found["b.speed", "a.inertia"])
    assert np.isnan(found["lock(c)"]).all()
    assert "begins at rest" in found.problems[0]
    assert "NaN: " in repr(found)
    assert np.isfinite(run.gradient(of="b.speed", by="b.speed", side="left").matrix).all()
    with pytest.raises(cw.UseError, match="side is 'up': give 'left' or 'right'"):
        run.gradient(of="a.speed", by="b.speed", side="up")


@pytest.mark.random
def test_hardly_anything_is_refused_without_cause():
    """At most one derivative in a hundred is refused where differences from both sides agree; none is one of two."""
    found = refusals.Count()
    for seed in range(amount(24)):
        kind = list(KINDS)[seed % len(KINDS)]
        found = found + refusals.counted(KINDS[kind](2000 + seed), seed, 4)
    # a value is refused by all of four numbers at once, which is more than a hundredth of a few models
    assert len(found.without_cause) <= max(0.01 * found.pairs, 4), found.without_cause
    assert not found.wrong, found.wrong


def torn_off(drive, grip, inertia, held):
    """A light shaft that its drive tears off at once, beside a heavy one; springs hold some of them."""
    d = cw.Driveline("torn off")
    shafts = {"a": d.shaft("a", inertia=inertia, speed=0.0), "b": d.shaft("b", inertia=1.0, speed=0.0)}
    d.add(cw.Torque("drive", shaft=shafts["a"], torque=drive))
    law = cw.Coulomb(static=1.0, kinetic=1.0)
    d.add(cw.Clutch("c", base=shafts["a"], follower=shafts["b"], friction=law, gain=1.0, normal_force=grip))
    for name in held:
        d.add(cw.SpringDamper(f"k_{name}", base=d.housing, follower=shafts[name], stiffness=300.0, damping=2.0))
    return d


@pytest.mark.parametrize("much", [1.0, 4.0, 50.0])
def test_a_slip_that_begins_at_zero_turns_within_nanoseconds(much):
    """Started backward it slips so for a moment, which the left side sees."""
    drive, grip, inertia = 50.0 * much, 20.0 * much, 0.02
    d = torn_off(drive, grip, inertia, "b")
    found = {
        side: cw.differentiable(d, 0.01, of=cw.maximum("b.acceleration"), by="a.speed", side=side, rtol=1e-9).gradient()
        for side in ("left", "right")
    }
    # it is the largest where the slip turns, behind h / (grip (1 / inertia + 1) + drive / inertia), at -grip so long
    rate = grip * (1.0 / inertia + 1.0) + drive / inertia
    assert found["right"].matrix[0, 0] == pytest.approx(0.0, abs=1e-6)
    # the side is looked at where it lasts for some nanoseconds, whose rates have as many digits
    assert found["left"].matrix[0, 0] == pytest.approx(-2.0 * grip / rate, rel=5e-5)


def test_a_jerk_of_what_slips_backward_for_a_moment():
    """The jerk before the slip turns counts too, though it lasts for less than is looked into."""
    d = torn_off(50.0, 20.0, 0.02, "ab")
    f = cw.differentiable(d, 0.01, of=cw.squared_jerk("a"), by="a.speed", side="left", rtol=1e-9)
    step = 1e-3
    wanted = (f(f.x0)[0] - f(f.x0 - step)[0]) / step
    # a difference from one side
    assert f.gradient().matrix[0, 0] == pytest.approx(wanted, rel=1e-3)


def pressed_later(phase, height=4351.0):
    """A brake of some torque whose pressure passes zero at the start, and by how much its jerk falls for more of it."""
    frequency, factor, inertia = 1.9, 3.9159 / height, 0.1
    d = cw.Driveline("begins")
    s = d.shaft("s", inertia=inertia, speed=0.0)
    d.add(cw.Torque("t", shaft=s, torque=6.0))
    law = cw.Coulomb(static=0.09, kinetic=0.09)
    wave = cw.Sine(amplitude=height, frequency=frequency, phase=phase, offset=-height * np.sin(phase))
    d.add(cw.Brake("b", shaft=s, friction=law, gain=factor / 0.09, pressure=wave))
    rise = 2 * np.pi * frequency * height * np.cos(phase)
    return d, (factor * rise / inertia) ** 2 / rise


@pytest.mark.parametrize("height", [4351.0, 4e5])
def test_a_pressure_that_begins_at_zero_may_begin_later(height):
    """The jerk of a brake from there on lasts for less time; a pressure below zero for a nanosecond is not seen."""
    d, earlier = pressed_later(0.0, height)
    for side, wanted in (("left", earlier), ("right", 0.0)):
        f = cw.differentiable(d, 0.05, of=cw.squared_jerk("s"), by="b.pressure.offset", side=side)
        assert f.gradient().matrix[0, 0] == pytest.approx(wanted, rel=1e-6, abs=1e-6)


@pytest.mark.parametrize("phase", [-0.3, -np.pi / 6])
@pytest.mark.parametrize("by", [["amplitude", "phase"], ["offset", "amplitude"], ["offset", "phase"]])
def test_numbers_that_move_a_pressure_at_zero_against_each_other(phase, by):
    """Two of them together leave it where it is: each is looked at alone."""
    d, _ = pressed_later(phase)
    names = [f"b.pressure.{name}" for name in by]
    for side in ("left", "right"):
        both = cw.differentiable(d, 0.05, of=cw.squared_jerk("s"), by=names, side=side).gradient().matrix[0]
        alone = [
            cw.differentiable(d, 0.05, of=cw.squared_jerk("s"), by=name, side=side).gradient().matrix[0, 0]
            for name in names
        ]
        assert both == pytest.approx(alone, rel=1e-6, abs=1e-6)
    with pytest.raises(cw.NoGradient):
        cw.differentiable(d, 0.05, of=cw.squared_jerk("s"), by=names).gradient()


@pytest.mark.parametrize("turns", [1, 2, -1])
def test_a_size_that_moves_the_start_of_a_wave_by_round_off_has_a_derivative(turns):
    """The sine of whole turns is some 1e-16."""
    values = [
        cw.differentiable(pressed_later(phase)[0], 0.05, of=cw.squared_jerk("s"), by="b.pressure.amplitude").gradient()
        for phase in (0.0, 2 * np.pi * turns)
    ]
    assert values[1].matrix[0, 0] == pytest.approx(values[0].matrix[0, 0], rel=1e-6)


def test_a_pressure_at_zero_beside_a_number_at_a_kink_of_the_driveline():
    """A torque that begins with the run has no derivative by when it begins; the others have theirs."""
    d, earlier = pressed_later(0.0)
    d.add(cw.Torque("more", shaft=d.shafts[0], torque=cw.Step(height=0.5, start=0.0)))
    names = ["more.torque.start", "b.pressure.offset", "b.pressure.amplitude"]
    found = cw.differentiable(d, 0.05, of=[cw.squared_jerk("s"), "s.speed"], by=names, side="left").gradient()
    assert found.matrix[0, 1] == pytest.approx(earlier, rel=1e-6)
    assert np.isfinite(found.matrix[:, 2]).all()


@pytest.mark.parametrize(
    ("force", "number", "of", "words"),
    [
        # faster than the unit of a force in a microsecond
        (cw.Ramp(height=2000.0, duration=0.01), "offset", cw.squared_jerk("s"), "is 0 at its knot"),
        (cw.Sine(amplitude=800.0, frequency=40.0), "offset", cw.squared_jerk("s"), "is 0 at its knot"),
        # a wave without size presses for either sign
        (cw.Sine(amplitude=0.0, frequency=1.3), "amplitude", "s.speed", "a little less acts another way"),
        (cw.Sine(amplitude=0.0, frequency=1.3, phase=0.4, start=0.1), "amplitude", "s.speed", "acts another way"),
    ],
)
def test_a_force_that_is_zero_and_acts_for_a_little_more_or_less(force, number, of, words):
    """Each side has the derivative of differences."""
    d = cw.Driveline("presses")
    s = d.shaft("s", inertia=0.1, speed=0.0)
    d.add(cw.Torque("t", shaft=s, torque=6.0))
    law = cw.Coulomb(static=0.09, kinetic=0.09)
    d.add(cw.Brake("b", shaft=s, friction=law, gain=0.01, normal_force=force))
    by, end = f"b.normal_force.{number}", 0.004 if not isinstance(of, str) else 0.5
    f = cw.differentiable(d, end, of=of, by=by, **TIGHT)
    for side, step in (("left", -1e-2), ("right", 1e-2)):
        found = cw.differentiable(d, end, of=of, by=by, side=side, rtol=1e-8).gradient().matrix[0, 0]
        assert found == pytest.approx((f(f.x0 + step)[0] - f(f.x0)[0]) / step, rel=1e-5, abs=1e-8)
    with pytest.raises(cw.NoGradient, match=words):
        f.gradient()


def pressed_by(**given):
    """Two shafts beside a clutch that little presses."""
    d = cw.Driveline("unpressed")
    a, b = d.shaft("a", inertia=0.2, speed=100.0), d.shaft("b", inertia=0.4, speed=50.0)
    law = cw.Coulomb(static=0.13, kinetic=0.11)
    piston = cw.PressureActuator("p", lag=0.05, **given.pop("piston")) if "piston" in given else None
    if piston is not None:
        d.add(piston)
        given["pressure"] = piston
    d.add(cw.Clutch("c", base=a, follower=b, friction=law, gain=1e-3, **given))
    d.add(cw.Torque("t", shaft=a, torque=2.0))
    return d


ZEROS = [
    ({"pressure": 0.0}, "c.pressure"),
    ({"pressure": cw.Table([(0.0, 0.0), (1.0, 0.0)])}, "c.pressure.values[2]"),
    ({"pressure": cw.Step(height=0.0, start=0.2)}, "c.pressure.height"),
    ({"normal_force": 0.0}, "c.normal_force"),
    # a piston without a command, whose pressure is zero too
    ({"piston": {"command": 0.0}}, "p.command"),
    ({"piston": {"command": cw.Table([(0.0, 0.0), (0.3, 0.0), (0.3, 1e5), (0.5, 0.0)])}}, "p.command.values[1]"),
]


@pytest.mark.parametrize("rtol", [1e-6, 1e-9])
@pytest.mark.parametrize(("given", "by"), ZEROS)
def test_a_number_that_is_zero_has_no_size_that_hides_what_a_little_more_does(rtol, given, by):
    """Of one pascal more the speeds change by some millionths of themselves."""
    d, of = pressed_by(**given), ["a.speed", "b.speed", "c.heat"]
    f = cw.differentiable(d, 1.0, of=of, by=by, rtol=rtol)
    tight = cw.differentiable(d, 1.0, of=of, by=by, **TIGHT)
    wanted = (tight(tight.x0 + 1.0) - tight(tight.x0)) / 1.0
    with pytest.raises(cw.NoGradient, match=r'is 0 from 0.* side="right" gives'):
        f.gradient()
    found = cw.differentiable(d, 1.0, of=of, by=by, side="right", rtol=rtol).gradient()
    np.testing.assert_allclose(found.matrix[:, 0], wanted, rtol=2e-5)
    assert found.problems == ()


def test_a_value_that_is_zero_hides_nothing_of_others():
    """A power that is zero throughout has no size by which one pascal would be little."""
    d, by = pressed_by(pressure=0.0), "c.pressure"
    alone = cw.differentiable(d, 1.0, of="a.speed", by=by, side="right").gradient().matrix
    beside = cw.differentiable(d, 1.0, of=["a.speed", cw.maximum("c.power")], by=by, side="right").gradient().matrix
    assert alone[0, 0] < 0.0
    np.testing.assert_allclose(beside[0], alone[0], rtol=1e-9)


def test_a_pressure_of_a_gearbox_that_is_zero():
    """Of an open brake, which moves the speeds by a ten-millionth of themselves for a pascal."""
    d = cw.Driveline("shift")
    turbine, wheels = d.shaft("turbine", inertia=0.2, speed=233.23), d.shaft("wheels", inertia=30.0)
    d.add(cw.Transmission("box", input=turbine, output=wheels, gearbox="zf-8hp70", gear="3"))
    d.add(cw.Torque("engine", shaft=turbine, torque=100.0))
    wanted = {"of": ["turbine.speed", "wheels.speed"], "by": "box.A.pressure"}
    f = cw.differentiable(d, 0.3, **wanted, **TIGHT)
    with pytest.raises(cw.NoGradient, match='side="right" gives'):
        cw.differentiable(d, 0.3, **wanted).gradient()
    found = cw.differentiable(d, 0.3, side="right", **wanted).gradient().matrix[:, 0]
    np.testing.assert_allclose(found, (f(f.x0 + 100.0) - f(f.x0)) / 100.0, rtol=1e-4)


def test_a_piston_that_begins_without_pressure():
    """A little is felt until it has emptied; where a command fills it at once there is a derivative."""
    by, of, tight = "p.initial_pressure", ["a.speed", "b.speed"], {"rtol": 1e-9, "atol": 1e-11}
    resting = pressed_by(piston={"command": 0.0, "filled": True})
    with pytest.raises(cw.NoGradient, match="p begins with pressure zero"):
        cw.differentiable(resting, 1.0, of=of, by=by, **tight).gradient()
    found = cw.differentiable(resting, 1.0, of=of, by=by, side="right", **tight).gradient().matrix[:, 0]
    # the torque for a pascal falls with the lag
    impulse = 1e-3 * 0.11 * 0.05
    np.testing.assert_allclose(found, [-impulse / 0.2, impulse / 0.4], rtol=1e-4)
    filling = pressed_by(piston={"command": 1e4, "filled": True})
    found = cw.differentiable(filling, 1.0, of=of, by=by).gradient().matrix[:, 0]
    np.testing.assert_allclose(found, [-impulse / 0.2, impulse / 0.4], rtol=1e-4)


def tied(scale=1.0):
    """Two shafts whose start speeds are both given, a gear that ties them, and one that is far faster."""
    d = cw.Driveline("tied")
    a, b = d.shaft("a", inertia=0.1, speed=10.0), d.shaft("b", inertia=0.2, speed=5.0)
    d.add(cw.Gear("g", input=a, output=b, ratio=2.0))
    d.add(cw.Torque("t", shaft=a, torque=1.0))
    d.shaft("far", inertia=1.0, speed=10.0 * scale)
    return d


@pytest.mark.parametrize(
    ("by", "scale"), [("a.speed", 1.0), ("b.speed", 1.0), ("g.ratio", 1.0), ("a.speed", 1e3), ("b.speed", 1e3)]
)
def test_a_number_that_others_tie_has_no_derivative(by, scale):
    """A little of contradiction is forgiven as round-off, which makes no value beside it."""
    f = cw.differentiable(tied(scale), 1.0, of=["a.speed", cw.maximum("b.speed")], by=[by, "t.torque"], side="right")
    with pytest.raises(cw.ModelError, match="contradicts the initial speed"):
        f(f.x0 * np.array([1.01, 1.0]))
    found = f.gradient()
    assert np.isnan(found.matrix[:, 0]).all()
    assert np.isfinite(found.matrix[:, 1]).all()
    (problem,) = found.problems
    assert "others tie it" in problem
    assert "contradicts the initial speed" in problem
    assert "remove this one" in problem


def test_tied_numbers_do_not_move_those_in_doubt_beside_them():
    """Three start values of contacts at rest, looked at together."""
    d = tied()
    names = ["a.speed"]
    for number in range(3):
        s = d.shaft(f"s{number}", inertia=1.0, speed=0.0)
        d.add(cw.Brake(f"b{number}", shaft=s, friction=cw.Coulomb(static=0.1, kinetic=0.1), gain=1.0, normal_force=0.0))
        names.append(f"s{number}.speed")
    found = cw.differentiable(d, 1.0, of=["a.speed", "s0.speed", "s1.speed", "s2.speed"], by=names).gradient()
    assert np.isnan(found.matrix[:, 0]).all()
    np.testing.assert_allclose(found.matrix[:, 1:], np.eye(4)[:, 1:], atol=1e-9)


def test_no_value_is_looked_at_farther_away_for_another_one():
    # what feels the start is looked at far from it, where derivatives of others are no line any more
    d = cw.Driveline("launch")
    w, car = d.shaft("w", inertia=1.0, speed=0.0), d.mass("car", mass=400.0, speed=0.0)
    d.add(cw.Tyre("t", shaft=w, mass=car, radius=0.3, load=4e3, low_speed_damping=1e3))
    d.add(cw.Vehicle("v", mass=car, drag_area=0.5))
    d.add(cw.Torque("tq", shaft=w, torque=cw.Table([(0.0, 0.0), (0.3, 220.0), (1.0, 200.0), (1.0, 0.0)])))
    grip, press = cw.Coulomb(static=0.14, kinetic=0.117), cw.Table([(0.0, 0.0), (1.0, 0.0), (1.2, 1.8e6)])
    d.add(cw.Brake("b", shaft=w, friction=grip, gain=5e-3, pressure=press))
    of = ["car.speed", cw.integral("car.speed"), cw.lock("b")]
    alone, beside = (
        cw.differentiable(d, 2.0, of=some, by="b.gain", rtol=1e-6).gradient().matrix
        for some in (of, [*of, cw.minimum("tq.work")])
    )
    np.testing.assert_array_equal(beside[:3], alone)


@pytest.mark.parametrize("filled", [False, True])
@pytest.mark.parametrize("fill_time", [0.0, 0.1])
def test_a_piston_whose_command_balances_its_spring(fill_time, filled):
    """A little more fills it, or presses the plates; a little less empties it, or does nothing."""
    d = pressed_by(piston={"command": 5e4, "spring": 5e4, "filled": filled, "fill_time": fill_time})
    wanted = {"of": "p.pressure", "by": ["p.command", "p.spring"], "rtol": 1e-9, "atol": 1e-11}
    with pytest.raises(cw.NoGradient, match=r"p\.pressure stays at its start value"):
        cw.differentiable(d, 0.3, **wanted).gradient()
    left, right = (cw.differentiable(d, 0.3, side=side, **wanted).gradient().matrix[0] for side in ("left", "right"))
    # it fills or empties evenly, and the pressure nears the command with the lag of 0.05 s
    evenly, pressed = 0.3 / 0.05, 1.0 - np.exp(-0.3 / 0.05)
    more = pressed if filled or not fill_time else evenly
    less = evenly if filled and fill_time else 0.0
    np.testing.assert_allclose(left, [less, -more], rtol=1e-6)
    np.testing.assert_allclose(right, [more, -less], rtol=1e-6)


def struck(**given):
    """A shaft that meets another behind a play of 0.1 rad, at 5 rad/s, without rebound."""
    d = cw.Driveline("struck")
    a, b = d.shaft("a", inertia=0.2, speed=5.0), d.shaft("b", inertia=0.3)
    d.add(cw.Backlash("e", base=a, follower=b, gap=0.1, **given))
    return d, a, b


def test_a_stop_without_restitution_bounces_for_a_little_more():
    """Of what remains of 5 rad/s both share 2 rad/s; a rebound e gives the struck shaft 2 e more."""
    d, _, _ = struck()
    wanted = {"of": ["a.speed", "b.speed", "e.heat"], "by": "e.restitution"}
    with pytest.raises(cw.NoGradient, match=r'with restitution 0, and bounces .* side="right" gives'):
        cw.differentiable(d, 0.02, **wanted | {"of": "b.speed"}).gradient()
    found = cw.differentiable(d, 0.02, side="right", **wanted).gradient().matrix[:, 0]
    np.testing.assert_allclose(found, [-3.0, 2.0, 0.0], rtol=1e-9, atol=1e-9)
    # before it is struck nothing depends on it
    before = cw.differentiable(d, 0.005, **wanted).gradient()
    assert not before.matrix.any()
    assert before.problems == ()


def test_a_stop_that_is_pressed_closes_with_any_small_restitution():
    d, a, b = struck()
    d.add(cw.Torque("t", shaft=a, torque=10.0))
    d.add(cw.Damper("l", base=d.housing, follower=b, damping=0.5))
    found = cw.differentiable(d, 0.5, of=["a.speed", "b.speed", "e.heat"], by="e.restitution").gradient()
    np.testing.assert_allclose(found.matrix, 0.0, atol=1e-6)
    assert found.problems == ()


def coasting(part):
    """A driven gear or differential whose torque runs backward."""
    d = cw.Driveline("coasting")
    if part == "gear":
        a, b = d.shaft("g", inertia=0.2, speed=6.0), d.shaft("h", inertia=0.3)
        d.add(cw.LossyGear("p", input=a, output=b, ratio=2.0, efficiency=1.0))
    else:
        a, b, c = d.shaft("g", inertia=0.2), d.shaft("l", inertia=0.2, speed=6.0), d.shaft("r", inertia=0.3, speed=4.0)
        d.add(cw.LimitedSlip("p", carrier=a, left=b, right=c, preload=20.0))
        d.add(cw.Damper("wheel", base=d.housing, follower=c, damping=0.5))
    d.add(cw.Torque("t", shaft=a, torque=-50.0))
    return d


@pytest.mark.parametrize(
    ("part", "by", "side"), [("gear", "efficiency", -1.0), ("slip", "drive", 1.0), ("slip", "coast", 1.0)]
)
def test_what_has_no_losses_has_some_for_a_little_less_of_its_efficiency(part, by, side):
    """Without losses both directions of the power have the same equations, and derivatives of their own."""
    d = coasting(part)
    wanted = {"of": ["g.speed", "p.heat"], "by": f"p.{by}", **TIGHT}
    f = cw.differentiable(d, 0.05, **wanted)
    values = [f(f.x0 + side * step) for step in (0.0, 1e-4, 2e-4)]
    true = side * (-3.0 * values[0] + 4.0 * values[1] - values[2]) / 2e-4
    sided = cw.differentiable(d, 0.05, side="left" if side < 0.0 else "right", **wanted).gradient().matrix[:, 0]
    np.testing.assert_allclose(sided, true, rtol=1e-5, atol=1e-8)
    # without asking for a side the same is given, or nothing
    found = d.simulate(0.05, **TIGHT).gradient(of=wanted["of"], by=["g.inertia", wanted["by"]])
    given = found.matrix[:2, 1]
    assert np.isnan(given).all() or np.allclose(given, true, rtol=1e-5, atol=1e-8)


def axle(differential):
    """Two equal wheels, driven alike, behind a differential that does not couple them, until one is braked."""
    d = cw.Driveline("axle")
    carrier = d.shaft("carrier", inertia=0.1)
    left, right = d.shaft("left", inertia=1.0), d.shaft("right", inertia=1.0)
    d.add(differential("x", carrier=carrier, left=left, right=right))
    d.add(cw.Torque("drive", shaft=carrier, torque=100.0))
    for name, wheel in (("on_left", left), ("on_right", right)):
        d.add(cw.Damper(name, base=d.housing, follower=wheel, damping=20.0))
    d.add(cw.Torque("braked", shaft=left, torque=cw.Ramp(height=-50.0, duration=0.25, start=0.15)))
    return d


def test_what_is_locked_without_capacity_does_not_hold():
    """A limited slip without preload is an open differential where its share is zero."""
    of, by = [cw.at("right.speed", [0.05]), "left.speed", "x.heat"], ["left.inertia", "on_left.damping"]
    slips = axle(lambda *given, **ports: cw.LimitedSlip(*given, coast=0.1, **ports))
    found = cw.differentiable(slips, 0.6, of=of, by=by, **TIGHT).gradient().matrix
    wanted = cw.differentiable(axle(cw.OpenDifferential), 0.6, of=of[:2], by=by, **TIGHT).gradient().matrix
    np.testing.assert_allclose(found[:2], wanted, rtol=1e-5)
    np.testing.assert_allclose(found[2], 0.0, atol=1e-9)
