"""Reduction to independent speeds: bases, redundant and contradictory rows, shafts without inertia, initial speeds."""

from __future__ import annotations

import numpy as np
import pytest

import clutchwork as cw
from support import six_speed

STEEL = cw.Coulomb(static=0.2, kinetic=0.1)

# planetary gearbox of the paper: reduced mass matrix over w1, w2, w4, w8; J1 + k1^2 J3 = 19.37 + 2.78^2 1.89
MASS = [
    [33.9766760, -19.8608760, 0, 0],
    [-19.8608760, 29.7350760, 0, 0],
    [0, 0, 9.56162586, -19.8460521],
    [0, 0, -19.8460521, 71.1604783],
]


def _messages(d):
    return [str(problem) for problem in d.check()]


def _geared(*ratios, **options):
    """Shafts a, b joined by gears of the given ratios, all at once."""
    d = cw.Driveline()
    a, b = d.shaft("a", inertia=1.0, **options), d.shaft("b", inertia=2.0)
    for number, ratio in enumerate(ratios, 1):
        d.add(cw.Gear(f"g{number}", input=a, output=b, ratio=ratio))
    return d, a, b


def test_mass_matrix_of_the_six_speed_gearbox():
    d, _ = six_speed.members({})
    system = d.assemble(independent=("w1", "w2", "w4", "w8"))
    assert system.independent == ("w1", "w2", "w4", "w8")
    np.testing.assert_allclose(system.mass, MASS, rtol=0, atol=5e-7)


def test_gear_ratios_are_exact():
    """w3 = k1 w1 + (1 - k1) w2 with k1 = -2.78, without binary rounding on the way."""
    d, _ = six_speed.members({})
    system = d.assemble(independent=("w1", "w2", "w4", "w8"))
    assert system.basis[2].tolist() == [-2.78, 3.78, 0.0, 0.0]


def test_teeth_and_ratio_agree():
    d = cw.Driveline()
    sun, ring, carrier = (d.shaft(name, inertia=1.0) for name in ("sun", "ring", "carrier"))
    d.add(cw.Planetary("p", sun=sun, ring=ring, carrier=carrier, teeth_sun=30, teeth_ring=70))
    system = d.assemble(independent=("sun", "ring"))
    assert system.basis[2].tolist() == [0.3, 0.7]


def test_double_planets_turn_the_other_way():
    d = cw.Driveline()
    sun, ring, carrier = (d.shaft(name, inertia=1.0) for name in ("sun", "ring", "carrier"))
    d.add(cw.DoublePlanetary("p", sun=sun, ring=ring, carrier=carrier, ratio=3.0))
    assert d.assemble(independent=("sun", "ring")).basis[2].tolist() == [-0.5, 1.5]


def test_external_wheels_turn_opposite_ways():
    d = cw.Driveline()
    a, b = d.shaft("a", inertia=1.0), d.shaft("b", inertia=1.0)
    d.add(cw.Gear("g", input=a, output=b, teeth_input=20, teeth_output=50))
    assert d.assemble(independent=("a",)).basis.tolist() == [[1.0], [-0.4]]


def test_redundant_rows_are_accepted_and_noted():
    d, *_ = _geared(2.5, 2.5)
    system = d.assemble()
    assert system.counts["speeds"] == 1
    assert system.notes == ('cw.Gear("g1") and cw.Gear("g2"): one of them is redundant',)


def test_redundancy_is_seen_through_decimals():
    """0.1 * 3 = 0.3 holds for the numbers as written, not for their binary neighbours."""
    d = cw.Driveline()
    a, b, c = (d.shaft(name, inertia=1.0) for name in "abc")
    d.add(cw.Gear("g1", input=a, output=b, ratio=0.1))
    d.add(cw.Gear("g2", input=b, output=c, ratio=3.0))
    d.add(cw.Gear("g3", input=a, output=c, ratio=0.3))
    assert d.assemble().counts["speeds"] == 1


def test_contradictory_rows_are_named_and_no_others():
    d, a, _ = _geared(2.0, 3.0)
    c = d.shaft("c", inertia=1.0)
    d.add(cw.Gear("innocent", input=a, output=c, ratio=5.0))
    (message,) = _messages(d)
    assert 'cw.Gear("g1") and cw.Gear("g2"): contradict each other' in message
    assert 'shaft "a"' in message
    assert "innocent" not in message


def test_contradiction_around_a_loop():
    d = cw.Driveline()
    a, b, c = (d.shaft(name, inertia=1.0) for name in "abc")
    for name, first, second, ratio in (("ab", a, b, 2), ("bc", b, c, 2), ("ca", c, a, 0.26)):
        d.add(cw.Gear(name, input=first, output=second, ratio=ratio))
    (message,) = _messages(d)
    assert all(f'cw.Gear("{name}")' in message for name in ("ab", "bc", "ca"))


def test_a_shaft_that_a_gear_holds_still():
    d = cw.Driveline()
    d.add(cw.Gear("g", input=d.shaft("a", inertia=1.0), output=d.housing, ratio=2.0))
    assert _messages(d) == ['cw.Gear("g"): holds shaft "a" at rest permanently; use the housing in place of the shaft']


def test_prescribed_speeds_that_follow_from_each_other():
    d, a, b = _geared(2.0)
    d.add(cw.PrescribedSpeed("p1", shaft=a, speed=1.0))
    d.add(cw.PrescribedSpeed("p2", shaft=b, speed=2.0))
    (message,) = _messages(d)
    assert "prescribe speeds that follow from each other" in message
    assert all(name in message for name in ('"g1"', '"p1"', '"p2"'))


def test_prescribed_speed_drives_the_geared_shaft():
    d, a, b = _geared(2.0)
    c = d.shaft("c", inertia=4.0)
    d.add(cw.PrescribedSpeed("p", shaft=a, speed=cw.Step(height=10.0, start=1.0, offset=6.0)))
    d.add(cw.Damper("d", base=b, follower=c, damping=1.0))
    system = d.assemble()
    assert system.independent == ("c",)
    assert system.basis_prescribed.tolist() == [[1.0], [0.5], [0.0]]
    assert system.element_rate_prescribed.tolist() == [[-0.5]]
    assert system.mass.tolist() == [[4.0]]
    assert system.mass_prescribed.tolist() == [[0.0]]


def test_prescribed_slip_couples_the_masses():
    d = cw.Driveline()
    a, b = d.shaft("a", inertia=1.0), d.shaft("b", inertia=3.0)
    d.add(cw.PrescribedSpeed("p", shaft=a, base=b, speed=2.0))
    system = d.assemble()
    assert system.independent == ("b",)
    assert system.mass.tolist() == [[4.0]]
    assert system.mass_prescribed.tolist() == [[1.0]]


def test_wheel_joins_shaft_and_mass():
    d = cw.Driveline()
    shaft, mass = d.shaft("axle", inertia=2.0), d.mass("car", mass=1000.0, speed=6.0)
    d.add(cw.RollingWheel("wheel", shaft=shaft, mass=mass, radius=0.3))
    system = d.assemble()
    assert system.independent == ("car",)
    assert system.mass[0, 0] == pytest.approx(1000 + 2 / 0.09, rel=1e-15)
    assert system.basis[0, 0] * system.initial_speed[0] == pytest.approx(20.0)


# --- forced choice ---


@pytest.mark.parametrize(
    ("wanted", "words"),
    [
        (("a", "x"), "'x': is not a shaft"),
        (("a", "b"), "'b': follows from a"),
        (("b",), "misses c"),
    ],
)
def test_a_choice_that_does_not_fit_is_told(wanted, words):
    d, *_ = _geared(2.0)
    d.shaft("c", inertia=1.0)
    with pytest.raises(cw.ModelError) as caught:
        d.assemble(independent=wanted)
    assert words in str(caught.value)


def test_chains_keep_neighbours_together():
    d = cw.Driveline()
    order = [3, 0, 5, 1, 4, 2]
    nodes = {number: d.shaft(f"s{number}", inertia=1.0 + number) for number in order}
    for number in range(5):
        d.add(cw.Damper(f"d{number}", base=nodes[number], follower=nodes[number + 1], damping=1.0))
    names = list(d.assemble().independent)
    assert names in ([f"s{k}" for k in range(6)], [f"s{k}" for k in range(6)][::-1])


# --- shafts without inertia ---


def _between(*elements):
    """a - x - b with a shaft x without inertia, joined by elements of the given sorts."""
    d = cw.Driveline()
    a, x, b = d.shaft("a", inertia=1.0), d.shaft("x"), d.shaft("b", inertia=1.0)
    for number, (make, base, follower) in enumerate(zip(elements, (a, x), (x, b), strict=True), 1):
        d.add(make(f"e{number}", base=base, follower=follower))
    return d


def _spring(stiffness, **more):
    return lambda name, **ends: cw.Spring(name, stiffness=stiffness, **more, **ends)


def _shaft(stiffness, damping):
    return lambda name, **ends: cw.SpringDamper(name, stiffness=stiffness, damping=damping, **ends)


def _clutch(name, **ends):
    return cw.Clutch(name, friction=STEEL, gain=1.0, pressure=1.0, **ends)


def test_springs_in_series_give_a_row():
    system = _between(_spring(30.0), _spring(10.0)).assemble()
    assert system.counts["speeds"] == 2
    assert system.massless.tolist() == [0, 0]
    assert system.basis[1].tolist() == [0.75, 0.25]
    assert "series" in system.notes[0]


def test_damped_shaft_without_inertia_is_a_massless_speed():
    system = _between(_shaft(30.0, 1.0), _spring(10.0)).assemble()
    place = system.independent.index("x")
    assert system.massless[place] == 1
    assert not system.mass[place].any()
    assert not system.mass[:, place].any()


def test_springs_in_series_out_of_balance():
    (message,) = _messages(_between(_spring(30.0, initial_twist=0.1), _spring(10.0)))
    assert 'shaft "x" without inertia: its springs pull it with -3 N m at the start' in message
    assert _messages(_between(_spring(30.0, initial_twist=0.1), _spring(10.0, initial_twist=0.3))) == []


def test_given_speed_of_a_shaft_between_springs_is_no_contradiction():
    d = cw.Driveline()
    a, x, b = d.shaft("a", inertia=1.0, speed=4.0), d.shaft("x", speed=0.0), d.shaft("b", inertia=1.0, speed=0.0)
    d.add(cw.Spring("k1", base=a, follower=x, stiffness=1.0))
    d.add(cw.Spring("k2", base=x, follower=b, stiffness=1.0))
    assert _messages(d) == []


@pytest.mark.parametrize("first", [_spring(300.0), _shaft(300.0, 1e-9)], ids=["series", "massless"])
def test_a_shaft_without_inertia_between_springs_moves_as_in_closed_form(first):
    """Two inertias of 1 kg m2 on 300 and 500 N m/rad in series; one starts at 10 rad/s."""
    d = cw.Driveline()
    a, x, b = d.shaft("a", inertia=1.0, speed=10.0), d.shaft("x"), d.shaft("b", inertia=1.0)
    d.add(first("k1", base=a, follower=x))
    d.add(cw.Spring("k2", base=x, follower=b, stiffness=500.0))
    run = d.simulate(1.0, dt=0.01, rtol=1e-9, atol=1e-9)
    swing = 5.0 * np.cos(np.sqrt(2 * 187.5) * run.time)
    np.testing.assert_allclose(run["a.speed"], 5.0 + swing, rtol=0, atol=1e-6)
    np.testing.assert_allclose(run["b.speed"], 5.0 - swing, rtol=0, atol=1e-6)
    # at the very start the vanishing damper alone holds the massless shaft
    np.testing.assert_allclose(run["x.speed"][1:], (5.0 - 0.25 * swing)[1:], rtol=0, atol=1e-5)


@pytest.mark.parametrize("other", [_spring(10.0), _shaft(10.0, 1.0), _clutch], ids=["spring", "damped", "clutch"])
def test_contact_at_a_shaft_without_inertia(other):
    (message,) = _messages(_between(_clutch, other))
    assert 'shaft "x": inertia is missing at cw.Clutch("e1")' in message
    assert "give it inertia > 0 kg m2" in message


def test_lone_shaft_without_inertia():
    d = cw.Driveline()
    d.shaft("a", inertia=1.0)
    d.shaft("x")
    d.mass("m")
    messages = _messages(d)
    assert (
        'shaft "x": inertia is missing, and nothing else determines its motion; give it inertia > 0 kg m2'
        in messages[0]
    )
    assert 'mass "m": mass is missing' in messages[1]


def test_geared_shaft_needs_no_inertia():
    d = cw.Driveline()
    a, x = d.shaft("a", inertia=1.0), d.shaft("x")
    d.add(cw.Gear("g", input=a, output=x, ratio=2.0))
    assert d.assemble().independent == ("a",)


def test_empty_driveline():
    assert _messages(cw.Driveline()) == ['driveline: has no shaft; add one: d.shaft("engine", inertia=0.2)']


# --- initial speeds ---


def _start(d):
    system = d.assemble()
    return dict(zip((node.name for node in system.nodes), system.basis @ system.initial_speed, strict=True))


def test_geared_shaft_takes_the_speed_that_follows():
    d, *_ = _geared(4.0, speed=100.0)
    assert _start(d) == {"a": 100.0, "b": 25.0}


def test_free_members_start_at_rest_in_order():
    d = cw.Driveline()
    sun, ring, carrier = d.shaft("s", inertia=1.0, speed=90.0), d.shaft("r", inertia=1.0), d.shaft("c", inertia=9.0)
    d.add(cw.Planetary("p", sun=sun, ring=ring, carrier=carrier, ratio=2.0))
    assert _start(d) == pytest.approx({"s": 90.0, "r": 0.0, "c": 30.0})


def test_contradictory_initial_speeds_are_named():
    d = cw.Driveline()
    a, b = d.shaft("a", inertia=1.0, speed=100.0), d.shaft("b", inertia=1.0, speed=30.0)
    d.shaft("c", inertia=1.0, speed=7.0)
    d.add(cw.Gear("g", input=a, output=b, ratio=4.0))
    (message,) = _messages(d)
    assert message.startswith('shaft "b": speed = 30 rad/s: contradicts the initial speed of shaft "a", which gives 25')


def test_a_speed_that_the_gear_at_the_start_gives_is_not_called_one_that_was_written():
    d = cw.Driveline()
    engine, axle = d.shaft("engine", inertia=0.2, speed=150.0), d.shaft("axle", inertia=1.0)
    car = d.mass("car", mass=1300.0, speed=6.0)
    d.add(cw.Transmission("box", gearbox="zf-8hp70", input=engine, output=axle, gear="3"))
    d.add(cw.RollingWheel("wheel", shaft=axle, mass=car, radius=0.3))
    messages = _messages(d)
    assert any("follows from the start of 'box', and contradicts the initial speed of" in one for one in messages)
    assert all("give the speed of one side alone at the start" in one for one in messages if "box." in one)


def test_rounded_initial_speeds_are_no_contradiction():
    d = cw.Driveline()
    a, b = d.shaft("a", inertia=1.0, speed=100.0), d.shaft("b", inertia=1.0, speed=33.33333)
    d.add(cw.Gear("g", input=a, output=b, ratio=3.0))
    assert _messages(d) == []


def test_speed_that_contradicts_a_prescribed_one():
    d = cw.Driveline()
    d.add(cw.PrescribedSpeed("p", shaft=d.shaft("a", inertia=1.0, speed=5.0), speed=3.0))
    (message,) = _messages(d)
    assert "contradicts the prescribed speeds, which give 3 rad/s" in message
