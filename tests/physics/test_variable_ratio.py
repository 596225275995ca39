"""Ratios that vary: closed forms, SciPy, energy, events beside them. docs/theory/varying-ratios.md"""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import clutchwork as cw
from support.runs import TIGHT

J1, J2 = 0.4, 1.5


def two(ratio, speed=50.0, **more):
    """Two inertias with a ratio between them."""
    d = cw.Driveline("two")
    a, b = d.shaft("a", inertia=J1), d.shaft("b", inertia=J2, speed=speed)
    d.add(cw.VariableRatio("v", input=a, output=b, ratio=ratio, **more))
    return d, a, b


def clean(run):
    """The energy balance closes."""
    energy = run.energy
    assert abs(energy.residual) <= 1e-8 * max(energy.turnover, 0.5 * J2 * 50.0**2)


SMOOTH = {
    "ramp": (cw.Ramp(offset=3.0, height=-2.0, duration=1.0), lambda t: 3.0 - 2.0 * np.minimum(t, 1.0)),
    "sine": (
        cw.Sine(amplitude=0.8, frequency=2.0, offset=1.5),
        lambda t: 1.5 + 0.8 * np.sin(4.0 * np.pi * np.asarray(t)),
    ),
    "through zero": (cw.Table([(0.0, 1.0), (1.0, -1.0)]), lambda t: np.interp(t, [0.0, 1.0], [1.0, -1.0])),
}


@pytest.mark.parametrize("name", SMOOTH)
def test_free_inertias_keep_their_energy_while_the_ratio_moves(name):
    signal, ratio = SMOOTH[name]
    run = two(signal)[0].simulate(1.5, dt=0.01, rtol=1e-9)
    i, w = ratio(run.time), run["b.speed"]
    energy = (i**2 * J1 + J2) * w**2
    # relative to it; the error of a run of some hundred steps at rtol 1e-9
    assert np.ptp(energy) <= 2e-8 * energy[0]
    assert np.max(abs(run["a.speed"] - i * w)) <= 1e-7 * np.max(abs(w))
    clean(run)


def test_a_ramp_under_torques_as_scipy_has_it():
    d, a, b = two(cw.Ramp(offset=3.0, height=-2.0, duration=1.0))
    d.add(cw.Torque("drive", shaft=a, torque=50.0))
    d.add(cw.Torque("load", shaft=b, torque=-20.0))
    run = d.simulate(1.0, dt=0.01, rtol=1e-9)

    def slope(t, w, term=1.0):
        i = 3.0 - 2.0 * t
        return (i * 50.0 - 20.0 + term * 2.0 * i * J1 * w) / (i * i * J1 + J2)

    exact, without = (
        solve_ivp(slope, (0.0, 1.0), [50.0], rtol=1e-11, atol=1e-11, args=(term,)).y[0, -1] for term in (1.0, 0.0)
    )
    assert run["b.speed"][-1] == pytest.approx(exact, rel=1e-8)
    # what the term of the rate makes is no small matter
    assert abs(exact - without) > 0.05 * exact
    # the torque that users read is that on the input, and power goes through
    assert np.allclose(run["v.torque"], J1 * run["a.acceleration"] - 50.0, rtol=1e-9, atol=1e-9)
    assert np.allclose(run["v.torque"] * run["a.speed"], -run["v.output.torque"] * run["b.speed"], rtol=1e-8)
    clean(run)


@pytest.mark.parametrize("to", [0.5, 0.0, -1.0])
def test_a_jump_keeps_the_energy_and_not_the_momentum(to):
    run = two(cw.Step(offset=2.0, height=to - 2.0, start=0.5))[0].simulate(1.0, dt=0.1, rtol=1e-9)
    expected = 50.0 * np.sqrt((4.0 * J1 + J2) / (to**2 * J1 + J2))
    assert run["b.speed"][-1] == pytest.approx(expected, rel=1e-12)
    assert run["a.speed"][-1] == pytest.approx(to * expected, rel=1e-12, abs=1e-12)
    clean(run)


def test_a_jump_is_the_limit_of_a_fast_ramp():
    def after(ratio):
        d, a, b = two(ratio)
        c = d.shaft("c", inertia=0.3)
        d.add(cw.VariableRatio("other", input=b, output=c, ratio=1.7))
        d.add(cw.Torque("drive", shaft=a, torque=30.0))
        return d.simulate(0.3, **TIGHT)["c.speed"][-1]

    jump = after(cw.Step(offset=2.0, height=-1.4, start=0.1))
    errors = [abs(after(cw.Ramp(offset=2.0, height=-1.4, start=0.1, duration=h)) - jump) for h in (1e-3, 1e-4)]
    assert errors[1] < 0.2 * errors[0] < 1e-2


def test_a_clutch_beside_a_jump_slips_after_it():
    d, a, _b = two(cw.Step(offset=2.0, height=-1.0, start=0.5))
    e = d.shaft("e", inertia=0.2, speed=100.0)
    d.add(
        cw.Clutch(
            "c",
            base=e,
            follower=a,
            friction=cw.Coulomb(static=1.0, kinetic=1.0),
            gain=40.0,
            normal_force=1.0,
            locked=True,
        )
    )
    run = d.simulate(1.5, dt=0.05, rtol=1e-9)
    assert [(event.before, event.after) for event in run.events.changes()] == [
        ("locked", "backward"),
        ("backward", "locked"),
    ]
    clean(run)


def test_it_slips_beyond_its_capacity_and_grips_again():
    d, a, _b = two(cw.Ramp(offset=3.0, height=-2.0, duration=1.0), capacity=30.0)
    d.add(cw.Torque("drive", shaft=a, torque=cw.Table([(0.0, 10.0), (0.5, 50.0), (1.0, 0.0)])))
    run = d.simulate(4.0, dt=0.01, rtol=1e-9)
    i = 3.0 - 2.0 * np.minimum(run.time, 1.0)
    assert [event.after for event in run.events.changes()] == ["forward", "locked"]
    slip = run["a.speed"] - i * run["b.speed"]
    assert np.allclose(run["v.slip"], slip, atol=1e-6)
    slides = run["v.mode"] != 0
    assert np.allclose(run["v.torque"][slides], -30.0)
    assert np.max(abs(slip[~slides])) <= 1e-6
    assert run.energy.heat["v"] > 100.0
    clean(run)


def test_a_shaft_without_inertia_follows():
    d = cw.Driveline("massless")
    a, b = d.shaft("a", inertia=0.0), d.shaft("b", inertia=J2, speed=50.0)
    d.add(cw.VariableRatio("v", input=a, output=b, ratio=cw.Ramp(offset=3.0, height=-2.0, duration=1.0)))
    d.add(cw.Torque("drive", shaft=a, torque=50.0))
    run = d.simulate(1.0, dt=0.1, rtol=1e-9)
    # the mean ratio is 2, and no inertia makes a term of the rate
    assert run["b.speed"][-1] == pytest.approx(50.0 + 2.0 * 50.0 / J2, rel=1e-10)
    assert np.allclose(run["v.torque"], -50.0)
    clean(run)


def test_two_shafts_without_inertia_are_refused():
    d = cw.Driveline("massless")
    a, b = d.shaft("a", inertia=0.0), d.shaft("b", inertia=0.0)
    d.add(cw.VariableRatio("v", input=a, output=b, ratio=2.0))
    found = [str(problem) for problem in d.check()]
    assert any('joins shaft "a" and shaft "b" without inertia' in one for one in found), found


def test_speeds_that_contradict_the_ratio_are_refused():
    d = cw.Driveline("start")
    a, b = d.shaft("a", inertia=1.0, speed=90.0), d.shaft("b", inertia=1.0, speed=50.0)
    d.add(cw.VariableRatio("v", input=a, output=b, ratio=2.0))
    (problem,) = d.check()
    assert "has the ratio 2 at the start, which contradicts the initial speed" in str(problem)


def test_beside_a_prescribed_speed():
    d = cw.Driveline("bench")
    a, b = d.shaft("a", inertia=J1), d.shaft("b", inertia=J2)
    d.add(cw.PrescribedSpeed("motor", shaft=a, speed=cw.Ramp(offset=20.0, height=30.0, duration=1.0)))
    d.add(cw.VariableRatio("v", input=a, output=b, ratio=cw.Ramp(offset=1.0, height=1.0, duration=1.0)))
    run = d.simulate(1.0, dt=0.05, rtol=1e-9)
    t = run.time
    assert np.allclose(run["b.speed"], (20.0 + 30.0 * t) / (1.0 + t), rtol=1e-9)
    # the source carries both inertias
    assert run["motor.work"][-1] == pytest.approx(
        0.5 * J1 * (50.0**2 - 20.0**2) + 0.5 * J2 * (25.0**2 - 20.0**2), rel=1e-8
    )
    clean(run)


def test_a_ratio_that_follows_through_a_lag():
    d = cw.Driveline("lag")
    a, b = d.shaft("a", inertia=J1), d.shaft("b", inertia=J2, speed=50.0)
    lag = d.add(cw.RatioActuator("lag", command=cw.Step(offset=2.0, height=-1.0, start=0.1), lag=0.2))
    d.add(cw.VariableRatio("v", input=a, output=b, ratio=lag))
    run = d.simulate(1.0, dt=0.05, rtol=1e-9)
    i = 2.0 - np.where(run.time > 0.1, 1.0 - np.exp(-np.maximum(run.time - 0.1, 0.0) / 0.2), 0.0)
    energy = (i**2 * J1 + J2) * run["b.speed"] ** 2
    assert np.allclose(run["a.speed"], i * run["b.speed"], rtol=1e-7)
    assert np.ptp(energy) <= 2e-8 * energy[0]
    clean(run)


@pytest.mark.parametrize("leaves", [cw.Step(height=-0.4, start=0.5), cw.Ramp(height=-0.4, duration=0.1, start=0.5)])
def test_a_ratio_that_leaves_zero_beside_the_housing_jams(leaves):
    """At zero the shaft is free, at any other ratio it stands: nothing could take its energy."""
    d = cw.Driveline("grounded")
    a = d.shaft("a", inertia=1.0, speed=3.0)
    d.add(cw.VariableGear("gear", input=d.housing, output=a, ratio=leaves))
    with pytest.warns(cw.StoppedEarly):
        run = d.simulate(1.0)
    assert (run.status, run.time[-1], run["a.speed"][-1]) == ("jammed", 0.5, 3.0)
    assert "'gear'" in run.message
    clean(run)


def test_a_ratio_that_jumps_from_zero_beside_what_another_holds_jams():
    """No fast change leads there: the energy of what turns would have nowhere to go."""
    d = cw.Driveline("held")
    a, b = d.shaft("a", inertia=1.0), d.shaft("b", inertia=1.0, speed=10.0)
    d.add(cw.VariableGear("holds", input=d.housing, output=a, ratio=1.0))
    d.add(cw.VariableGear("gear", input=a, output=b, ratio=cw.Step(height=-1.0, start=0.5)))
    with pytest.warns(cw.StoppedEarly):
        run = d.simulate(1.0)
    assert (run.status, run.time[-1], run["b.speed"][-1]) == ("jammed", 0.5, 10.0)


def test_a_ratio_that_leaves_zero_where_two_others_hold_jams_at_once():
    """A rack and a sprocket of another radius hold the mass: round-off does not move it with torques of its inverse."""
    d = cw.Driveline("rack")
    m, pinion, wheel, motor = d.mass("m", mass=0.366), d.shaft("pinion"), d.shaft("wheel"), d.shaft("motor")
    d.add(cw.RackPinion("rack", shaft=pinion, mass=m, radius=0.133))
    d.add(cw.PolygonSprocket("sprocket", shaft=pinion, mass=m, teeth=84, pitch=0.00837))
    d.add(cw.RollingWheel("rolls", shaft=wheel, mass=m, radius=0.443))
    ratio = cw.Ramp(height=9.24, duration=0.0068, start=0.05)
    d.add(cw.VariableRatio("gear", input=wheel, output=motor, ratio=ratio))
    d.add(cw.PrescribedSpeed("drive", shaft=motor, speed=1.54))
    with pytest.warns(cw.StoppedEarly, match="'gear'"):
        run = d.simulate(0.1)
    assert (run.status, run.time[-1], run["m.speed"][-1]) == ("jammed", 0.05, 0.0)
    assert not run["gear.torque"].any()
    assert not run["sprocket.torque"].any()


def test_a_ratio_that_leaves_zero_beside_the_housing_goes_on_at_rest():
    d = cw.Driveline("grounded")
    a = d.shaft("a", inertia=1.0)
    d.add(cw.VariableGear("gear", input=d.housing, output=a, ratio=cw.Step(height=-0.4, start=0.5)))
    d.add(cw.Torque("push", shaft=a, torque=cw.Step(height=5.0, start=0.6)))
    assert d.simulate(1.0)["a.speed"][-1] == 0.0


@pytest.mark.parametrize("capacity", [200.0, 20000.0])
def test_it_slips_before_a_ratio_at_which_it_holds_nothing(capacity):
    """Both sides on the housing, its carrier is held by 1 - ratio of its torque: by nothing where the ratio passes 1.
    Nothing moves up to there, so steps are long, and the torques at their ends are far from the capacity."""
    push, begin, duration = 30.0, 4.0, 0.1
    d = cw.Driveline("carrier")
    a = d.shaft("a", inertia=1.0)
    d.add(cw.Torque("push", shaft=a, torque=push))
    ramp = cw.Ramp(offset=begin, height=-2.0 * begin, duration=duration)
    d.add(cw.VariableRatio("v", input=d.housing, output=d.housing, support=a, ratio=ramp, capacity=capacity))
    run = d.simulate(duration, output="steps")
    leaves, turns, grips = run.events.changes()
    rate = 2.0 * begin / duration
    # it leaves where the torque push/(ratio - 1) reaches the capacity; from there the acceleration is push less
    # capacity |ratio - 1|, and the speed zero again after 1 + sqrt(2) of the way to the pole behind it
    pole, way = (begin - 1.0) / rate, push / capacity / rate
    assert leaves.time == pytest.approx(pole - way, abs=1e-6 * way)
    assert turns.time == pytest.approx(pole, abs=1e-6 * way)
    assert grips.time == pytest.approx(pole + (1.0 + np.sqrt(2.0)) * way, abs=1e-6 * way)
    assert [one.cause for one in (leaves, turns, grips)] == ["torque limit", "slip zero", "slip zero"]
    assert np.max(abs(run["v.torque"])) <= capacity * (1.0 + 1e-6)
    clean(run)


def test_two_that_share_slip_before_a_ratio_at_which_both_hold_nothing():
    """In parallel they depend on each other, and hold together what one of their capacities does."""
    push, begin, duration, capacity = 30.0, 4.0, 0.1, 20000.0
    d = cw.Driveline("carrier")
    a = d.shaft("a", inertia=1.0)
    d.add(cw.Torque("push", shaft=a, torque=push))
    ramp = cw.Ramp(offset=begin, height=-2.0 * begin, duration=duration)
    for name, share in (("one", 0.75), ("other", 0.25)):
        sides = {"input": d.housing, "output": d.housing, "support": a}
        d.add(cw.VariableRatio(name, **sides, ratio=ramp, capacity=share * capacity))
    run = d.simulate(duration, output="steps")
    rate = 2.0 * begin / duration
    pole, way = (begin - 1.0) / rate, push / capacity / rate
    leaves = run.events.changes()[:2]
    assert {event.element for event in leaves} == {"one", "other"}
    assert [event.time for event in leaves] == pytest.approx([pole - way] * 2, abs=1e-6 * way)
    assert np.max(abs(run["one.torque"])) <= 0.75 * capacity * (1.0 + 1e-6)
    clean(run)


def test_it_slips_where_the_torque_has_a_zero_beside_the_pole():
    """A brake on the other shaft carries push x ratio/(ratio - 1): one sign at both ends of a step over 0 and 1."""
    push, capacity = 30.0, 200.0
    d = cw.Driveline("carrier")
    a, b = d.shaft("a", inertia=1.0), d.shaft("b", inertia=1.0)
    d.add(cw.Torque("push", shaft=a, torque=push))
    ramp = cw.Ramp(offset=4.0, height=-8.0, duration=0.1)
    d.add(cw.VariableGear("v", input=d.housing, output=b, support=a, ratio=ramp))
    law = cw.Coulomb(static=0.1, kinetic=0.1)
    d.add(cw.Brake("brake", shaft=b, friction=law, gain=1.0, normal_force=capacity / 0.1))
    run = d.simulate(0.1, output="steps")
    ratio = 1.0 / (1.0 - push / capacity)
    assert run.events[0].time == pytest.approx(0.1 * (4.0 - ratio) / 8.0, rel=1e-6)
    assert run.events[0].cause == "torque limit"
    assert np.max(abs(run["brake.torque"])) <= capacity * (1.0 + 1e-6)
    clean(run)


@pytest.mark.parametrize("to", [0.238, 2.0, -0.5, -3.0])
@pytest.mark.parametrize("side", ["input", "output"])
def test_a_jump_beside_a_prescribed_shaft_is_work_of_its_source(to, side):
    """To the other side of zero too: the kinetic energy is what the source has done."""
    d = cw.Driveline("jump")
    a, b = d.shaft("a", inertia=1.0), d.shaft("b", inertia=0.5)
    ratio = cw.Step(offset=-1.2, height=to + 1.2, start=0.05)
    d.add(cw.VariableGear("gear", input=a, output=b, ratio=ratio))
    d.add(cw.PrescribedSpeed("motion", shaft=a if side == "input" else b, speed=cw.Table([(0.0, 0.0), (1.0, -10.0)])))
    run = d.simulate(0.2)
    energy = 0.5 * run["a.speed"] ** 2 + 0.25 * run["b.speed"] ** 2
    assert run["a.speed"][-1] == pytest.approx(to * run["b.speed"][-1], rel=1e-12)
    # to the tolerance of the work
    np.testing.assert_allclose(run["motion.work"], energy, rtol=0, atol=1e-6 * energy.max())


@pytest.mark.parametrize("start", [0.0, 0.2])
def test_it_slips_between_the_housing_and_a_prescribed_shaft(start):
    """At ratio 0 it holds the housing; where the ratio leaves zero nothing can hold."""
    d = cw.Driveline("prescribed")
    shaft = d.shaft("s", inertia=1.0)
    ratio = cw.Table([(start, 0.0), (start + 0.5, 1.0)])
    d.add(cw.VariableRatio("v", input=d.housing, output=shaft, ratio=ratio, capacity=3.0))
    d.add(cw.PrescribedSpeed("motor", shaft=shaft, speed=5.0))
    end = start + 0.5
    run = d.simulate(end, **TIGHT)
    assert run.status == "done"
    assert run["v.slip"][-1] == pytest.approx(-5.0, rel=1e-9)
    assert abs(run["v.torque"][-1]) == pytest.approx(3.0, rel=1e-9)
    # capacity times the integral of the slip
    assert run.energy.heat["v"] == pytest.approx(3.0 * 0.5 * 5.0 * 0.5, rel=1e-7)


def test_an_impulse_beside_a_freewheel_that_a_ratio_holds_keeps_momentum() -> None:
    """The gear turns a light shaft with its support: a freewheel between them never slips, and takes no part."""
    d = cw.Driveline("light")
    one, other, third = (d.shaft(name, inertia=1.0) for name in ("one", "other", "third"))
    light = d.shaft("light", inertia=0.0, speed=60.0)
    d.add(cw.OneWayClutch("freewheel", base=light, follower=other))
    d.add(cw.TorqueSensor("rigid", base=one, follower=other))
    d.add(cw.VariableGear("gear", input=one, output=light, support=other, ratio=-7.81))
    d.add(cw.SpragClutch("sprag", base=third, follower=other, holding=1.0, locked=True))
    run = d.simulate(0.1)
    for name in ("one", "other", "third", "light"):
        assert run[f"{name}.speed"] == pytest.approx(40.0, rel=1e-12)
    assert abs(run.energy.residual) <= 1e-9 * run.energy.turnover
