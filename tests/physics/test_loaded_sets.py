"""Sets of locked contacts of which some follow loads: how they give way."""

from __future__ import annotations

import numpy as np
import pytest

import clutchwork as cw

DRY = cw.Coulomb(static=0.3, kinetic=0.3)
WORM = {"ratio": 6.889, "lead_angle": 0.163, "friction_coefficient": 0.0918}


def wedge() -> cw.Driveline:
    """A gear that locks itself backward before a lossy one, and torques that draw both backward."""
    d = cw.Driveline("wedge")
    s1, s0, s2 = (d.shaft(name, inertia=inertia) for name, inertia in (("s1", 0.2), ("s0", 0.01), ("s2", 2.0)))
    d.add(cw.LossyGear("e1", input=s1, output=s0, ratio=0.2, efficiency=0.95, backward_efficiency=-0.2))
    d.add(cw.LossyGear("e2", input=s0, output=s2, ratio=0.25, efficiency=0.85))
    d.add(cw.Torque("load", shaft=s2, torque=-53.0))
    d.add(cw.Torque("drive", shaft=s1, torque=cw.Ramp(height=-400.0, duration=1.0)))
    return d


def axle(rng: np.random.Generator | None = None) -> cw.Driveline:
    """A worm and a limited slip between brakes, of which the first opens: with given or with random numbers."""
    given = {"preload": 0.0, "share": 0.368, "press": 3.604e5, "torque": -437.7, "gain": 1.02e-4}
    if rng is not None:
        low, high = np.array([0.0, 0.05, 1e5, -500.0, 1e-4]), np.array([40.0, 0.4, 1e6, 500.0, 1e-3])
        given = dict(zip(given, rng.uniform(low, high).tolist(), strict=True))
    d = cw.Driveline("axle")
    s1, s3, s4, s5 = (
        d.shaft(name, inertia=inertia) for name, inertia in (("s1", 0.08), ("s3", 1.3), ("s4", 0.1), ("s5", 0.5))
    )
    d.add(cw.WormGear("g", worm=s1, wheel=s4, **WORM))
    opens = cw.Ramp(height=-1e6, duration=1.0, offset=1e6)
    d.add(cw.Brake("b1", shaft=s1, friction=DRY, gain=given["gain"], pressure=opens))
    d.add(cw.Differential("e6", carrier=s4, left=s3, right=s5, share=given["share"], preload=given["preload"]))
    d.add(cw.Brake("b5", shaft=s5, friction=DRY, gain=0.001, pressure=given["press"]))
    d.add(cw.Torque("t3", shaft=s3, torque=given["torque"]))
    return d


def test_a_wedge_gives_way_as_the_load_draws_it() -> None:
    """What holds it best are torques within it that would let its gears go in two ways."""
    run = wedge().simulate(1.0)
    assert run.status == "done"
    assert [(one.element, one.after) for one in run.events] == [("e1", "backward"), ("e2", "backward")]
    # backward the first gear drives the second one, and the load helps: the balances of three shafts
    drive = -400.0 * run.events[0].time
    acceleration = (0.19 * drive - 53.0 / 0.2125) / (0.01 + 8.0 / 0.2125 + 0.19 * 0.04)
    assert run.events[1].slip_acceleration == pytest.approx(acceleration, rel=1e-6)
    assert run.events[0].slip_acceleration == pytest.approx(0.2 * acceleration, rel=1e-6)


def test_a_member_that_holds_on_does_not_move() -> None:
    """The brake behind the differential holds more than it is asked for, the others give way together."""
    run = axle().simulate(0.1)
    assert run.status == "done"
    assert {(one.element, one.after) for one in run.events} == {
        ("b1", "backward"),
        ("g", "backward"),
        ("e6", "backward"),
    }
    # the carrier takes what both sides get, of which the limited slip makes one more
    carrier = 437.7 / (0.5 * (1.0 + 2.0 * 0.368))
    first = run.events[0].time
    before = run.at([first * (1.0 - 1e-9)])
    assert before["b5.torque"][0] == pytest.approx(-(carrier - 437.7), rel=1e-6)
    assert before["b1.torque"][0] == pytest.approx(0.3 * 1.02e-4 * (1e6 - 1e6 * first), rel=1e-6)


@pytest.mark.parametrize("seed", range(40))
def test_members_slip_against_their_torques(seed: int) -> None:
    run = axle(np.random.default_rng([seed, 27])).simulate(1.0)
    assert run.status == "done"
    for one in run.events:
        if (one.before, one.cause) == ("locked", "torque limit"):
            way = 1.0 if one.after == "forward" else -1.0
            assert way * one.torque_before <= 1e-6 * (1.0 + abs(one.torque_before)), one


def tie_up(share: np.ndarray | None = None) -> cw.Driveline:
    """A box at rest whose brakes change over, on a hill, with shares of given numbers: seven contacts follow loads."""
    given = np.array([-15.76, 17.05, 0.1794, 0.407, 0.1234, 0.1078, 0.08871, 0.1493, 0.2507, 0.09394, 9.098e5, -0.1449])
    given = (given if share is None else given * share).tolist()
    d = cw.Driveline("tie-up of an 8HP70 at rest")
    s0, s1, s2 = (d.shaft(name, inertia=inertia) for name, inertia in (("s0", 0.08), ("s1", 0.2), ("s2", 1.3)))
    s3, s4, m5 = d.shaft("s3"), d.shaft("s4", inertia=0.5), d.mass("m5", mass=1163.0)
    d.add(cw.Torque("e1", shaft=s0, torque=given[0]))
    d.add(cw.BearingFriction("e2", shaft=s0, friction=cw.Coulomb(static=1.0, kinetic=0.8), torque=given[1]))
    shift = {
        "A": {"pressure": cw.Ramp(height=-1e6, duration=given[2], start=given[3], offset=1e6)},
        "B": {"pressure": cw.Ramp(height=-1e6, duration=given[4], start=given[5], offset=1e6)},
        "D": {"pressure": cw.Ramp(height=1e6, duration=given[6], start=given[7])},
        "E": {"pressure": cw.Ramp(height=1e6, duration=given[8], start=given[9])},
    }
    box = {"gearbox": "zf-8hp70", "gear": "1", "torque": 192.5, "inertia": 0.018, "shift": shift, "efficiency": 0.9732}
    d.add(cw.Transmission("e3", input=s0, output=s1, **box))
    d.add(cw.LossyGear("e4", input=s1, output=s3, ratio=3.572, efficiency=0.912))
    d.add(cw.Differential("e5", carrier=s3, left=s2, right=s4, share=0.2854))
    pads = cw.Stribeck(static=0.2721, kinetic=0.2267, speed=0.04511)
    d.add(cw.Brake("e6", shaft=s4, friction=pads, gain=0.001, pressure=given[10]))
    tyre = cw.Coulomb(static=0.9585, kinetic=0.4632)
    d.add(cw.RollingContact("e7", shaft=s2, mass=m5, friction=tyre, radius=0.3, load=3506.0))
    d.add(cw.Vehicle("e8", mass=m5, slope=given[11]))
    return d


def above_capacity(run: cw.Trajectory, name: str) -> float:
    """Largest torque in N m that a contact at rest holds above what it can."""
    held = run[f"{name}.state"] == "locked"
    assert held.any()
    return float(np.max(np.abs(run[f"{name}.torque"][held]) - run[f"{name}.capacity"][held]))


def test_many_members_that_follow_loads_hold_what_they_can() -> None:
    """With six of them and more not all lines of their bounds are tried: those that are found must not be poor ones."""
    run = tie_up().simulate(0.26)
    assert run.status == "done"
    assert above_capacity(run, "e2") <= 1e-5


@pytest.mark.parametrize("seed", [2, 126, 135])
def test_ties_of_random_numbers_hold_what_they_can(seed: int) -> None:
    share = np.random.default_rng([seed, 29]).uniform(0.7, 1.3, 12)
    run = tie_up(share).simulate(0.6)
    assert run.status == "done"
    assert max(above_capacity(run, name) for name in ("e2", "e3.B")) <= 1e-5


def tree(rng: np.random.Generator) -> cw.Driveline:
    """Shafts that gears with losses and limited slips join, with brakes of which some open, and torques."""
    d = cw.Driveline("tree")
    free = [d.shaft(f"s{i}", inertia=float(10 ** rng.uniform(-2, 0.5))) for i in range(9)]
    nodes = [free.pop()]
    for number in range(int(rng.integers(2, 5))):
        kind, at, name = int(rng.integers(3)), nodes[int(rng.integers(len(nodes)))], f"e{number}"
        first = free.pop()
        nodes.append(first)
        if kind == 0:
            losses = {"efficiency": rng.uniform(0.7, 0.98), "backward_efficiency": rng.uniform(0.1, 0.95)}
            d.add(cw.LossyGear(name, input=at, output=first, ratio=rng.uniform(0.2, 4.0), **losses))
        elif kind == 1:
            worm = {"lead_angle": rng.uniform(0.05, 0.3), "friction_coefficient": rng.uniform(0.03, 0.15)}
            d.add(cw.WormGear(name, worm=at, wheel=first, ratio=rng.uniform(3.0, 10.0), **worm))
        else:
            nodes.append(free.pop())
            d.add(cw.Differential(name, carrier=at, left=first, right=nodes[-1], share=rng.uniform(0.05, 0.4)))
    for number, node in enumerate(nodes):
        press, most = 10 ** rng.uniform(5, 6), rng.uniform(-500.0, 500.0)
        opens = cw.Ramp(height=-press, duration=1.0, offset=press)
        if rng.random() < 0.7:
            pressure = opens if rng.random() < 0.6 else press
            d.add(cw.Brake(f"b{number}", shaft=node, friction=DRY, gain=10 ** rng.uniform(-4, -3), pressure=pressure))
        if rng.random() < 0.6:
            torque = cw.Ramp(height=most, duration=1.0) if rng.random() < 0.5 else most
            d.add(cw.Torque(f"t{number}", shaft=node, torque=torque))
    return d


def against(run: cw.Trajectory) -> list[cw.Event]:
    """Contacts that were let go one way and driven the other."""
    ways = {"forward": 1.0, "backward": -1.0}
    limits = [one for one in run.events if (one.before, one.cause) == ("locked", "torque limit")]
    return [one for one in limits if ways.get(one.after, 0.0) * one.slip_acceleration < -1e-6]


def test_what_gives_way_accelerates_the_way_it_was_let_go() -> None:
    """Trees of 2 to 4 gears, of which one in some hundred is wedged so that no choice of ways is sound."""
    runs = {seed: tree(np.random.default_rng([seed, 28])).simulate(1.0) for seed in range(300)}
    assert {run.status for run in runs.values()} <= {"done", "jammed"}
    assert len([seed for seed, run in runs.items() if against(run)]) <= 1


def test_torques_before_a_step_are_those_of_the_row_before_it() -> None:
    """A torque jumps; how the set shared its load until then follows from the loads of that instant."""
    d = cw.Driveline("worm and limited slip")
    s1, s2, s5, s6 = (d.shaft(name, inertia=1.0) for name in ("s1", "s2", "s5", "s6"))
    d.add(cw.Torque("drive", shaft=s1, torque=cw.Step(height=10.0, start=0.125, offset=10.0)))
    d.add(cw.WormGear("worm", worm=s1, wheel=s2, ratio=5.0, lead_angle=0.3, friction_coefficient=0.15))
    d.add(cw.LimitedSlip("axle", carrier=s2, left=s5, right=s6, preload=2.0, drive=0.1))
    for name, shaft, friction, force in (("left", s5, 0.1, 400.0), ("right", s6, 0.25, 80.0)):
        pads = cw.Coulomb(static=friction, kinetic=friction)
        d.add(cw.Brake(name, shaft=shaft, friction=pads, gain=1.0, normal_force=force))
    d.add(cw.Torque("grade", shaft=s6, torque=7.5))
    run = d.simulate(0.3, rtol=1e-9)
    changed = [one for one in run.events if one.time == 0.125]
    assert {one.element for one in changed} == {"worm", "axle", "right"}
    before = int(np.searchsorted(run.time, 0.125, side="left"))
    for one in changed:
        assert one.torque_before == pytest.approx(run[f"{one.element}.torque"][before], rel=1e-9)
        assert abs(one.torque_before) <= run[f"{one.element}.capacity"][before] * (1.0 + 1e-9)


@pytest.mark.parametrize("loss", [0.03, 0.06, 0.1])
@pytest.mark.parametrize("strong", [80.0, 100.0, 140.0])
@pytest.mark.parametrize("opens", [0.4, 0.5, 0.7])
def test_a_brake_that_opens_hands_its_load_to_the_other_one(loss: float, strong: float, opens: float) -> None:
    """Two gears turn with the load of the stronger of two brakes: at the instant at which that is all that it holds,
    the other one takes it, and from then on they turn as they do once the first is open."""
    d = cw.Driveline("hands over")
    s0, s1 = d.shaft("s0", inertia=0.5, speed=-50.0), d.shaft("s1", inertia=0.1, speed=0.0)
    p1, p3 = d.shaft("p1", inertia=0.05), d.shaft("p3", inertia=0.2)
    for name, carrier, friction in (("a", p1, 1.0), ("b", p3, 0.0)):
        teeth = {"teeth_sun": 30, "teeth_ring": 70, "efficiency": 1.0 - loss, "bearing_torque": friction}
        d.add(cw.LossyPlanetary(name, sun=s0, ring=s1, carrier=carrier, **teeth))
    lining = cw.Coulomb(static=1.0, kinetic=1.0)
    d.add(cw.BearingFriction("weak", shaft=p1, friction=lining, torque=18.0))
    d.add(cw.Brake("b6", shaft=s0, friction=lining, gain=20.0, normal_force=1.0))
    force = cw.Table([(0.0, 1.0), (0.3, 1.0), (opens, 0.0)])
    d.add(cw.Brake("strong", shaft=p3, friction=lining, gain=strong, normal_force=force))
    run = d.simulate(opens + 0.1, rtol=1e-8)
    assert run.status == "done"
    held = float(run.at([0.25])["strong.torque"][0])
    # what is left of its capacity is its torque
    changes = opens - abs(held) / strong * (opens - 0.3)
    before, after = 0.3 + 0.999 * (changes - 0.3), changes + 0.01 * (opens - changes)
    rows = run.at([before, after, opens - 1e-6, opens + 0.05])
    assert rows["strong.torque"] == pytest.approx([held, 0.0, 0.0, 0.0], rel=1e-9, abs=1e-12)
    for gear in ("a", "b"):
        assert rows[f"{gear}.torque"] == pytest.approx(rows[f"{gear}.capacity"], rel=1e-9, abs=1e-12)
        assert rows[f"{gear}.torque"][1:] == pytest.approx(np.full(3, rows[f"{gear}.torque"][3]), rel=1e-9, abs=1e-12)
    assert rows["weak.torque"][1:] == pytest.approx(np.full(3, rows["weak.torque"][3]), rel=1e-9)
    assert abs(rows["a.torque"][1] / rows["a.torque"][0] - 1.0) > 1e-3
