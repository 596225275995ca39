"""What the engine must survive: every failure mode that its design names, one test each, under that name."""

from __future__ import annotations

import math
import warnings

import numpy as np
import pytest

import clutchwork as cw
from support.runs import EXACT, TIGHT, assert_switches, at_end, clutch, over, switches


def held(d: cw.Driveline, name: str, shaft: cw.Node, **given: float) -> None:
    """Add a brake of constant capacity."""
    d.add(clutch(name, d.housing, shaft, **given))


def test_several_clutches_locking_at_one_instant() -> None:
    """Five equal discs around a hub, all slips end in the same instant; speeds from momentum."""
    d = cw.Driveline("star")
    hub = d.shaft("hub", inertia=1.0, speed=60.0)
    for i in range(5):
        d.add(clutch(f"c{i}", hub, d.shaft(f"s{i}", inertia=0.2), kinetic=4.0))
    run = d.simulate(4.0, **TIGHT)
    lock = 60.0 / (20.0 / 1.0 + 4.0 / 0.2)
    assert_switches(run, [(lock, f"c{i}", "backward", "locked") for i in range(5)])
    assert len({s[0] for s in switches(run)}) == 1
    # 1e-10: what the specification asks of unique speeds with several locked clutches
    assert [at_end(run, f"s{i}.speed") for i in range(5)] == pytest.approx([30.0] * 5, rel=1e-10)


@pytest.mark.parametrize("order", [(0, 1, 2), (2, 1, 0), (1, 2, 0)])
def test_several_clutches_locking_whatever_their_order(order: tuple[int, ...]) -> None:
    """Two clutches in parallel and one behind them: the order of the elements does not move the speeds."""
    d = cw.Driveline("order")
    a, b, c = d.shaft("a", inertia=0.3, speed=80.0), d.shaft("b", inertia=0.5), d.shaft("c", inertia=0.9)
    parts = [clutch("k0", a, b, kinetic=9.0), clutch("k1", a, b, kinetic=5.0), clutch("k2", b, c, kinetic=6.0)]
    for i in order:
        d.add(parts[i])
    run = d.simulate(5.0, **TIGHT)
    assert {s[1] for s in switches(run) if s[3] == "locked"} == {"k0", "k1", "k2"}
    expected = 80.0 * 0.3 / 1.7
    assert [at_end(run, f"{n}.speed") for n in "abc"] == pytest.approx([expected] * 3, rel=1e-10)


def test_break_away_of_one_makes_another_lock() -> None:
    """a runs after b when its brake lets go, so that the clutch between them locks.

    b1 (static 10, kinetic 2 N m) holds a against a pull of 20 t and, from 0.1 s on, against the 4 N m with which c
    slips on b, which 5 N m drive: it lets go at 0.3 s.
    """
    d = cw.Driveline("row")
    a, b = d.shaft("a", inertia=0.5), d.shaft("b", inertia=2.0)
    d.add(cw.Torque("pull", shaft=a, torque=cw.Table([(0.0, 0.0), (10.0, 200.0)])))
    d.add(cw.Torque("drive", shaft=b, torque=cw.Table([(0.0, 0.0), (0.1, 0.0), (0.1, 5.0)])))
    held(d, "b1", a, static=10.0, kinetic=2.0)
    d.add(clutch("c", a, b, kinetic=4.0))
    run = d.simulate(0.4, **TIGHT)
    # b1 carries 20 t + 4 from 0.1 s; b has gained (5 - 4)/2 (t - 0.1) then
    lead = 0.5 * 0.2
    # slip of c: lead + 0.5 x - (20 (0.3) + 4 - 2) x/0.5 - 20 x^2 = 0 with x = t - 0.3
    x = (-(16 - 0.5) + math.sqrt(15.5**2 + 80 * lead)) / 40
    assert_switches(
        run,
        [(0.1, "c", "locked", "forward"), (0.3, "b1", "locked", "forward"), (0.3 + x, "c", "forward", "locked")],
    )


def test_torque_reversal_through_zero_while_locked() -> None:
    """A hundred reversals of a locked clutch: no event, and the slip stays exactly zero."""
    d = cw.Driveline("reversals")
    a, b = d.shaft("a", inertia=1.0), d.shaft("b", inertia=1.0)
    d.add(cw.Torque("drive", shaft=a, torque=cw.Sine(amplitude=19.0, frequency=50.0)))
    d.add(clutch("c", a, b, kinetic=9.6))
    run = d.simulate(1.0)
    assert switches(run) == []
    assert np.all(run["c.slip"] == 0.0)


# a dip of less than 1e-9 of the speeds is below what the guards resolve, so -1e-7 is the shallowest
@pytest.mark.parametrize("gap", [1e-3, 1e-6, 1e-9, -1e-7, -1e-6, -1e-3])
def test_slip_that_grazes_zero(gap: float) -> None:
    """Speed gap + 5 (t - 1)^2 under a friction of 2 N m that it overcomes before and after.

    A positive gap: never at rest. A negative one: it reaches zero before 1 s and is then held or turned by the law.
    """
    d = cw.Driveline("graze")
    a = d.shaft("a", inertia=1.0, speed=5.0 + gap)
    # dw/dt = 10 (t - 1) = drive - 2
    d.add(cw.Torque("drive", shaft=a, torque=cw.Table([(0.0, -8.0), (2.0, 12.0)])))
    held(d, "b", a, kinetic=2.0)
    run = d.simulate(2.0, **TIGHT)
    if gap > 0:
        assert switches(run) == []
        assert at_end(run, "a.speed") == pytest.approx(5.0 + gap, rel=1e-9)
        return
    # at rest from 1 - sqrt(-gap/5) on; the drive of 2 - 10 sqrt(-gap/5) is within the capacity; leaves at 1 s
    rest = 1.0 - math.sqrt(-gap / 5)
    # a grazing crossing is located as well as the slope allows: round-off of 1e-15 x 5 over the slope there
    assert_switches(
        run, [(rest, "b", "forward", "locked"), (1.0, "b", "locked", "forward")], max(EXACT, 1e-14 / math.sqrt(-gap))
    )
    assert at_end(run, "a.speed") == pytest.approx(5.0, rel=1e-9)


def test_slip_that_passes_zero_and_goes_on() -> None:
    """Driven through zero with more than the capacity: one event, forward to backward, no stick between."""
    d = cw.Driveline("passes")
    a = d.shaft("a", inertia=1.0, speed=1.0)
    d.add(cw.Torque("drive", shaft=a, torque=-50.0))
    held(d, "b", a, static=20.0, kinetic=10.0)
    run = d.simulate(0.1, **TIGHT)
    assert_switches(run, [(1 / 60, "b", "forward", "backward")])
    assert at_end(run, "a.speed") == pytest.approx(-40.0 * (0.1 - 1 / 60), rel=1e-9)


def test_zero_capacity_is_no_contact() -> None:
    """An open clutch whose slip passes zero: no event, no torque, state open all the time."""
    d = cw.Driveline("open")
    a = d.shaft("a", inertia=1.0, speed=1.0)
    d.add(cw.Torque("drive", shaft=a, torque=-10.0))
    d.add(
        cw.Clutch(
            "b", base=d.housing, follower=a, friction=cw.Coulomb(static=1.0, kinetic=1.0), gain=1.0, normal_force=0.0
        )
    )
    d.add(
        cw.Clutch(
            "n",
            base=d.housing,
            follower=a,
            friction=cw.Coulomb(static=1.0, kinetic=1.0),
            gain=1.0,
            normal_force=cw.Table([(0.0, -5.0), (0.6, -5.0), (0.7, 1.0)]),
        )
    )
    run = d.simulate(0.5, **TIGHT)
    assert len(run.events.changes()) == 0
    for name in ("b", "n"):
        assert set(run[f"{name}.state"]) == {"open"}
        assert np.all(run[f"{name}.torque"] == 0.0)
    assert at_end(run, "a.speed") == pytest.approx(-4.0, rel=1e-12)


@pytest.mark.parametrize("ramp", [0.0, 0.1])
def test_capacity_drops_to_zero_while_locked(ramp: float) -> None:
    """A held shaft is let go when the pressure vanishes, at a stroke or along a ramp; it opens at the end."""
    d = cw.Driveline("drops")
    a = d.shaft("a", inertia=0.5)
    d.add(cw.Torque("drive", shaft=a, torque=5.0))
    d.add(cw.Clutch("b", base=d.housing, follower=a, **over([(0.0, 20.0), (0.3, 20.0), (0.3 + ramp, 0.0)])))
    run = d.simulate(1.0, **TIGHT)
    leaves = 0.3 + ramp * 15 / 20
    first = run.events.of("b").changes()[0]
    assert first.before == "locked"
    assert first.time == pytest.approx(leaves, abs=EXACT)
    assert run["b.state"][-1] == "open"
    # along the ramp: 5 - (5 - 20/ramp x) for 0.025 s, then 5 N m
    gained = 0.5 * 5 * (ramp * 0.25) + 5 * (0.7 - ramp)
    assert at_end(run, "a.speed") == pytest.approx(gained / 0.5, rel=1e-9)


def test_capacity_drops_to_zero_without_load() -> None:
    """Nothing pulls at the locked clutch when its pressure vanishes: it opens and the slip stays zero."""
    d = cw.Driveline("drops unloaded")
    a, b = d.shaft("a", inertia=0.5, speed=7.0), d.shaft("b", inertia=0.5, speed=7.0)
    d.add(cw.Clutch("c", base=a, follower=b, **over([(0.0, 20.0), (0.3, 20.0), (0.3, 0.0), (0.6, 0.0), (0.6, 20.0)])))
    run = d.simulate(1.0, times=[0.1, 0.5, 0.9], **TIGHT)
    assert list(run["c.state"]) == ["locked", "open", "locked"]
    assert np.all(run["c.slip"] == 0.0)


@pytest.mark.parametrize("load", [0.0, 3.0])
def test_pressure_rises_on_a_clutch_at_exactly_zero_slip(load: float) -> None:
    """Both shafts at 7 rad/s, the clutch closes along a ramp: it sticks as soon as its capacity covers the load.

    With a load of 3 N m from 0.2 s on, when the ramp 40 (t - 0.1) already gives 4 N m, nothing ever slips.
    """
    d = cw.Driveline("rises")
    a, b = d.shaft("a", inertia=0.5, speed=7.0), d.shaft("b", inertia=0.5, speed=7.0)
    d.add(cw.Torque("load", shaft=a, torque=cw.Table([(0.0, 0.0), (0.2, 0.0), (0.2, 2 * load)])))
    d.add(cw.Clutch("c", base=a, follower=b, **over([(0.0, 0.0), (0.1, 0.0), (1.1, 40.0)])))
    run = d.simulate(1.0, times=[0.05, 0.15, 0.9], **TIGHT)
    assert list(run["c.state"]) == ["open", "locked", "locked"]
    assert np.all(run["c.slip"] == 0.0)
    assert at_end(run, "c.torque") == pytest.approx(load, abs=1e-12)


def test_noise_on_the_pressure() -> None:
    """Pressure noise of 30 % at 2 kHz, also below zero: the run ends, energy closes, friction never makes power."""
    rng = np.random.default_rng(7)
    times = np.arange(0.0, 0.5, 5e-4)
    noisy = np.clip(times * 200.0, 0, 40.0) * (1 + 0.3 * rng.standard_normal(len(times))) - 1.0
    d = cw.Driveline("noise")
    a, b = d.shaft("a", inertia=0.2, speed=50.0), d.shaft("b", inertia=0.3)
    d.add(cw.Torque("drive", shaft=a, torque=cw.Sine(amplitude=25.0, frequency=7.0)))
    law = cw.Coulomb(static=1.2, kinetic=1.0)
    table = cw.Table([(float(t), float(p)) for t, p in zip(times, noisy, strict=True)])
    d.add(cw.Clutch("c", base=a, follower=b, friction=law, gain=1.0, normal_force=table))
    run = d.simulate(0.5, rtol=1e-9, atol=1e-11)
    assert run.status == "done"
    assert "locked" in set(run["c.state"])
    # round-off of a slip at the very instant of its zero
    assert np.max(run["c.power"]) <= 1e-12 * np.max(np.abs(run["c.power"]))
    assert abs(run.energy.residual) <= 1e-8 * run.energy.turnover


@pytest.mark.parametrize("inertia", [1e-3, 1e-6, 1e-9])
def test_two_clutches_in_series_with_a_tiny_inertia_between(inertia: float) -> None:
    """The weaker of the two slips, whatever the inertia between them: lock time from momentum to first order in it."""
    d = cw.Driveline("series")
    a, m, b = d.shaft("a", inertia=0.2, speed=100.0), d.shaft("m", inertia=inertia), d.shaft("b", inertia=0.8)
    d.add(clutch("strong", m, a, kinetic=12.0))
    d.add(clutch("weak", b, m, kinetic=10.0))
    run = d.simulate(2.0, **TIGHT)
    locks = {s[1]: s[0] for s in switches(run) if s[3] == "locked"}
    # first the piece between is caught by the stronger clutch, then 0.2 + inertia runs down on the weaker one
    caught = 100.0 / (12.0 / 0.2 + 2.0 / inertia)
    speed = 100.0 - 60.0 * caught
    rest = (speed - 10.0 / 0.8 * caught) / (10.0 / (0.2 + inertia) + 10.0 / 0.8)
    assert locks["strong"] == pytest.approx(caught, abs=EXACT)
    assert locks["weak"] == pytest.approx(caught + rest, abs=EXACT)
    assert at_end(run, "b.speed") == pytest.approx(20.0 / (1.0 + inertia), rel=1e-9)


def test_two_clutches_in_series_with_a_massless_shaft_between() -> None:
    """Refused with the name of the shaft: nothing says how it moves while both clutches slip."""
    d = cw.Driveline("massless")
    a, m, b = d.shaft("a", inertia=0.2, speed=100.0), d.shaft("between", inertia=0.0), d.shaft("b", inertia=0.8)
    d.add(clutch("c1", a, m, kinetic=12.0))
    d.add(clutch("c2", m, b, kinetic=10.0))
    with pytest.raises(Exception, match="between") as caught:
        d.assemble()
    assert "inertia" in str(caught.value)


def test_tie_up() -> None:
    """Two gears of different ratio engaged at once, with the output loaded: it locks solid, unique at rest.

    Minimum-norm torques weighted by capacity: they balance the drive and share it; the housing takes the rest.
    """
    d = cw.Driveline("tie-up")
    a, b = d.shaft("a", inertia=0.3), d.shaft("b", inertia=0.4)
    high, low = d.shaft("high", inertia=0.05), d.shaft("low", inertia=0.05)
    d.add(cw.Gear("g1", input=a, output=high, ratio=1.5))
    d.add(cw.Gear("g2", input=a, output=low, ratio=3.0))
    d.add(clutch("c1", high, b, kinetic=40.0))
    d.add(clutch("c2", low, b, kinetic=60.0))
    d.add(cw.Torque("drive", shaft=a, torque=10.0))
    run = d.simulate(0.5, **TIGHT)
    assert set(run["c1.state"]) == {"locked"}
    assert set(run["c2.state"]) == {"locked"}
    assert np.all(run["a.speed"] == 0.0)
    # at rest: drive = T1/1.5 + T2/3 and T1 + T2 = 0
    assert at_end(run, "c1.torque") == pytest.approx(10.0 / (1 / 1.5 - 1 / 3), rel=1e-9)
    assert at_end(run, "c2.torque") == pytest.approx(-10.0 / (1 / 1.5 - 1 / 3), rel=1e-9)


def test_tie_up_at_speed_is_braked_to_rest() -> None:
    """The same, closed at speed: friction brings it to rest, energy closes."""
    d = cw.Driveline("tie-up at speed")
    a, b = d.shaft("a", inertia=0.3, speed=90.0), d.shaft("b", inertia=0.4, speed=60.0)
    high, low = d.shaft("high", inertia=0.05, speed=60.0), d.shaft("low", inertia=0.05, speed=30.0)
    d.add(cw.Gear("g1", input=a, output=high, ratio=1.5))
    d.add(cw.Gear("g2", input=a, output=low, ratio=3.0))
    d.add(clutch("c1", high, b, kinetic=40.0))
    d.add(clutch("c2", low, b, kinetic=25.0))
    # high and b turn as one: 0.506 kg m2 at a, slowed by 25/3 N m, stand still after 5.5 s
    run = d.simulate(8.0, rtol=1e-9, atol=1e-11)
    assert abs(at_end(run, "a.speed")) <= 1e-12
    assert abs(at_end(run, "b.speed")) <= 1e-12
    assert abs(run.energy.residual) <= 1e-8 * run.energy.turnover


def test_two_contacts_along_the_same_direction() -> None:
    """Two equal clutches side by side are one of twice the capacity: same event, equal shares."""
    d = cw.Driveline("side by side")
    a, b = d.shaft("a", inertia=0.2, speed=100.0), d.shaft("b", inertia=0.8)
    d.add(cw.Torque("drive", shaft=a, torque=cw.Table([(0.0, 0.0), (1.7, 0.0), (2.7, 40.0)])))
    for name in ("c1", "c2"):
        d.add(clutch(name, a, b, kinetic=5.0))
    run = d.simulate(2.5, **TIGHT)
    # carried: 0.8 of 40 (t - 1.7) = 10 at 1.7 + 10/32
    expected = [(1.6, "backward", "locked"), (1.7 + 10 / 32, "locked", "backward")]
    assert_switches(run, [(t, c, x, y) for t, x, y in expected for c in ("c1", "c2")])
    held = (run.time > 1.61) & (run.time < 2.0)
    # minimum norm weighted by equal capacities: equal shares; round-off is divided by the weight of 1e-7
    assert run["c1.torque"][held] == pytest.approx(run["c2.torque"][held], abs=1e-7)


def test_locked_initial_state_with_inconsistent_speeds() -> None:
    """An impulse with its energy loss reported; momentum is kept to 1e-12."""
    d = cw.Driveline("impulse")
    a, b, c = d.shaft("a", inertia=0.2, speed=10.0), d.shaft("b", inertia=0.3, speed=-4.0), d.shaft("c", inertia=0.1)
    law = cw.Coulomb(static=1.0, kinetic=1.0)
    d.add(cw.Clutch("c1", base=a, follower=b, friction=law, gain=1.0, normal_force=50.0, locked=True))
    d.add(cw.Clutch("c2", base=b, follower=c, friction=law, gain=1.0, normal_force=50.0, locked=True))
    run = d.simulate(0.1, times=[0.0, 0.1], **TIGHT)
    common = (0.2 * 10 - 0.3 * 4) / 0.6
    for name in "abc":
        assert run[f"{name}.speed"] == pytest.approx([common] * 2, rel=1e-12)
    lost = 0.5 * (0.2 * 100 + 0.3 * 16) - 0.5 * 0.6 * common**2
    assert run.energy.impulses == pytest.approx(lost, rel=1e-12)
    # the loss is part of the balance, not a hole in it
    assert abs(run.energy.residual) <= 1e-12 * lost
    assert any(e.cause == "impulse" for e in run.events)


@pytest.mark.parametrize(
    "law",
    [
        lambda: cw.Coulomb(static=0.3, kinetic=0.4),
        lambda: cw.Exponential(static=0.13, slow=0.14, fast=0.065, speed=10.0),
        lambda: cw.CoefficientTable(static=0.3, kinetic=[(0.0, 0.4), (10.0, 0.2)]),
    ],
)
def test_kinetic_above_static_is_rejected_with_names(law) -> None:
    with pytest.raises(Exception, match="c1") as caught:  # noqa: PT012
        d = cw.Driveline("upside down")
        a = d.shaft("a", inertia=0.3)
        d.add(cw.Clutch("c1", base=d.housing, follower=a, friction=law(), gain=1.0, normal_force=1.0))
        d.assemble()
    assert "static" in str(caught.value)


def test_ten_thousand_events_without_accumulating_error() -> None:
    """Stick-slip of a belt for 5000 cycles: the last event is where the closed form puts it."""
    stiffness, speed, mass, hold, slide = 4000.0, 5.0, 0.8, 15.0, 10.0
    d = cw.Driveline("belt")
    puller, block = d.mass("puller", mass=1.0, speed=speed), d.mass("block", mass=mass)
    d.add(cw.PrescribedSpeed("pull", shaft=puller, speed=speed))
    d.add(cw.Spring("spring", base=puller, follower=block, stiffness=stiffness))
    d.add(clutch("floor", d.housing, block, static=hold, kinetic=slide))
    omega = math.sqrt(stiffness / mass)
    slip = 2 / omega * (math.pi - math.atan((hold - slide) * omega / (stiffness * speed)))
    stick = 2 * (hold - slide) / (stiffness * speed)
    first, cycles = hold / (stiffness * speed), 5000
    t_end = first + cycles * (slip + stick) + 0.5 * slip
    run = d.simulate(t_end, dt=t_end, **TIGHT)
    found = switches(run)
    assert len(found) == 2 * cycles + 1
    # each cycle starts from exact rest at exactly the static force, so errors add up linearly at most:
    # 10 000 events x 1e-12 s of integration error each
    assert found[-1][0] == pytest.approx(first + cycles * (slip + stick), abs=1e-8)


def test_zeno_sequence_is_bounded_and_named() -> None:
    """A controller-like cascade: pressure pulses that shrink geometrically to an instant, on a driven shaft.

    75 pulses within 1 us around 1 s, each locking and releasing: more than 50 events in a microsecond end the run with
    a status that names the contact, and the trajectory so far stays.
    """
    points = [(0.0, 0.0), (1.0, 0.0)]
    t = 1.0
    for _ in range(75):
        points += [(t, 50.0), (t + 5e-9, 50.0), (t + 5e-9, 0.0), (t + 1e-8, 0.0)]
        t += 1e-8
    d = cw.Driveline("zeno")
    a = d.shaft("a", inertia=1e-9)
    d.add(cw.Torque("drive", shaft=a, torque=cw.Table([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0)])))
    d.add(cw.Clutch("chatter", base=d.housing, follower=a, **over(points)))
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        run = d.simulate(2.0)
    assert run.status == "zeno"
    assert "chatter" in run.message
    assert caught
    assert 0.9 < run.time[-1] <= 1.0 + 2e-6


def test_load_just_above_capacity_lets_go() -> None:
    """A load 1e-9 above the capacity (open in the prototype) must start to slip, one 1e-9 below must not."""
    for excess, state in ((1e-9, "forward"), (-1e-9, "locked")):
        d = cw.Driveline("edge")
        a = d.shaft("a", inertia=1.0)
        d.add(cw.Torque("drive", shaft=a, torque=10.0 * (1 + excess)))
        held(d, "b", a, static=10.0, kinetic=8.0)
        run = d.simulate(0.5)
        assert run["b.state"][-1] == state


def test_load_creeping_just_above_capacity_lets_go() -> None:
    """A sine whose peak is a little above the capacity: it lets go near the peak, where the margin grazes zero.

    1e-7 is two orders above what the guards resolve.
    """
    for excess, moves in ((1e-5, True), (1e-7, True), (-1e-9, False)):
        d = cw.Driveline("peak")
        a = d.shaft("a", inertia=1.0)
        d.add(cw.Torque("drive", shaft=a, torque=cw.Sine(amplitude=10.0 * (1 + excess), frequency=1.0)))
        held(d, "b", a, static=10.0, kinetic=8.0)
        run = d.simulate(0.5, rtol=1e-9, atol=1e-11)
        assert bool(switches(run)) == moves, f"peak {excess:g} above the capacity"


def test_forced_contact_whose_acceleration_reverses() -> None:
    """After break-away the load drops within a millisecond: the contact sticks again instead of slipping backward."""
    d = cw.Driveline("reverses")
    a = d.shaft("a", inertia=1.0)
    points = [(0.0, 9.0), (1.0, 11.0), (1.001, 0.0)]
    d.add(cw.Torque("drive", shaft=a, torque=cw.Table(points)))
    held(d, "b", a, static=10.0, kinetic=9.999)
    run = d.simulate(2.0, **TIGHT)
    found = switches(run)
    assert [s[2:] for s in found] == [("locked", "forward"), ("forward", "locked")]
    assert found[0][0] == pytest.approx(0.5, abs=EXACT)
    assert at_end(run, "a.speed") == 0.0


def test_many_candidates_at_once() -> None:
    """Twelve brakes in a row of twelve driven discs, all at rest: held, and held together."""
    d = cw.Driveline("many")
    shafts = [d.shaft(f"s{i}", inertia=0.1 + 0.01 * i) for i in range(12)]
    for i, shaft in enumerate(shafts):
        held(d, f"b{i}", shaft, kinetic=2.0)
        if i:
            d.add(clutch(f"c{i}", shafts[i - 1], shaft, kinetic=1.0))
    d.add(cw.Torque("drive", shaft=shafts[0], torque=cw.Table([(0.0, 0.0), (10.0, 50.0)])))
    run = d.simulate(1.0, **TIGHT)
    # first disc: brake 2 and clutch 1 hold 3 N m of 5 t
    found = switches(run)
    assert {s[1] for s in found} == {"b0", "c1"}
    assert [s[0] for s in found] == pytest.approx([0.6] * len(found), abs=EXACT)


def test_no_creep_at_99_9_percent_of_capacity() -> None:
    """A held shaft does not move: angle and speed exactly zero over many steps (MuJoCo's frictionloss creeps here)."""
    d = cw.Driveline("creep")
    a = d.shaft("a", inertia=0.1)
    d.add(cw.Torque("drive", shaft=a, torque=cw.Sine(amplitude=9.99, frequency=5.0)))
    held(d, "b", a, kinetic=10.0)
    run = d.simulate(10.0, max_step=1e-4)
    assert switches(run) == []
    assert np.all(run["a.speed"] == 0.0)
    assert np.all(run["a.angle"] == 0.0)


@pytest.mark.parametrize("inertia", [1e-12, 1e12])
def test_extreme_inertias(inertia: float) -> None:
    """1e-12 and 1e12 kg m2: no crash, no silent NaN, lock time from the closed form."""
    d = cw.Driveline("extreme")
    a = d.shaft("a", inertia=inertia, speed=50.0)
    held(d, "b", a, kinetic=10.0)
    lock = inertia * 50.0 / 10.0
    run = d.simulate(2 * lock, **TIGHT)
    found = switches(run)
    assert [s[2:] for s in found] == [("forward", "locked")]
    assert found[0][0] == pytest.approx(lock, rel=1e-9)


def test_double_crossings_within_a_step() -> None:
    """Slip that dips below zero and comes back within one step of the solver, for many depths: none is missed.

    The speed is a parabola under a friction of 2 N m: where it dips by more than 1e-6 rad/s it must be held.
    """
    depths = np.logspace(-6, -1, 20)
    for depth in depths:
        d = cw.Driveline("dip")
        a = d.shaft("a", inertia=1.0, speed=5.0 - depth)
        d.add(cw.Torque("drive", shaft=a, torque=cw.Table([(0.0, -8.0), (2.0, 12.0)])))
        held(d, "b", a, kinetic=2.0)
        run = d.simulate(2.0, rtol=1e-3, atol=1e-5)
        assert [s[2:] for s in switches(run)] == [("forward", "locked"), ("locked", "forward")], depth


def test_a_sign_law_chatters_where_an_open_clutch_passes_zero_with_it() -> None:
    """Each of its reversals is an event of the clutch beside it too: they count all the same."""
    d = cw.Driveline("beside")
    a = d.shaft("a", inertia=0.1, speed=3.0)
    law = cw.NaiveSign(static=0.3, kinetic=0.3, speed=1.0)
    d.add(cw.Brake("signs", shaft=a, friction=law, gain=1.0, normal_force=10.0))
    d.add(cw.Brake("open", shaft=a, friction=cw.Coulomb(static=0.3, kinetic=0.3), gain=1.0, normal_force=0.0))
    with pytest.warns(cw.StoppedEarly):
        run = d.simulate(1.0, max_steps=5000)
    assert run.status == "chatter"
    assert "'signs'" in run.message
