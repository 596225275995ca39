"""Springs and dampers that meet at shafts without inertia, against closed forms and the limit of vanishing inertia."""

from __future__ import annotations

from math import exp

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import clutchwork as cw
from support.amount import part
from support.declarations import Coil, OiledCoil

RATE = st.floats(20.0, 500.0)
DAMPING = st.floats(0.5, 20.0)


def _join(d, name, kind, base, follower, size):
    """One link: a spring, a damper, both, or springs whose fields have other names."""
    made = {
        "spring": lambda: cw.Spring(name, base=base, follower=follower, stiffness=size),
        "coil": lambda: Coil(name, base=base, follower=follower, rate=size),
        "damper": lambda: cw.Damper(name, base=base, follower=follower, damping=0.05 * size),
        "both": lambda: cw.SpringDamper(name, base=base, follower=follower, stiffness=size, damping=0.05 * size),
        "oiled": lambda: OiledCoil(name, base=base, follower=follower, rate=size, oil=0.05 * size),
    }
    return d.add(made[kind]())


def _chain(links, inertia=0.0):
    """Links between a shaft of 1 kg m2 at 3 rad/s and one of 2 kg m2, through shafts of a given inertia."""
    d = cw.Driveline("chain")
    shafts = [d.shaft("first", inertia=1.0, speed=3.0)]
    shafts += [d.shaft(f"x{number}", inertia=inertia) for number in range(1, len(links))]
    shafts += [d.shaft("last", inertia=2.0)]
    for number, (kind, size) in enumerate(links):
        _join(d, f"l{number}", kind, shafts[number], shafts[number + 1], size)
    return d


@pytest.mark.parametrize("kind", ["spring", "coil"])
def test_any_springs_in_series_are_one_spring(kind):
    sizes = (300.0, 500.0, 200.0)
    alone = _chain([("spring", 1.0 / sum(1.0 / size for size in sizes))]).simulate(1.0, dt=0.05, rtol=1e-9, atol=1e-11)
    system = _chain([(kind, size) for size in sizes]).assemble()
    assert system.counts["speeds"] == 2
    run = cw.simulate(system, 1.0, dt=0.05, rtol=1e-9, atol=1e-11)
    np.testing.assert_allclose(run["last.speed"], alone["last.speed"], atol=1e-7)
    for number in range(3):
        np.testing.assert_allclose(run[f"l{number}.torque"], alone["l0.torque"], atol=1e-6)
    assert run.energy.elastic == pytest.approx(alone.energy.elastic, rel=1e-6)


@given(k1=RATE, k2=RATE, c=DAMPING)
@settings(max_examples=part(25), deadline=None)
def test_a_damper_between_springs_is_a_maxwell_element(k1, k2, c):
    """At a steady rate v the torque is c v (1 - exp(-k t/c)), k that of both springs in series."""
    d = cw.Driveline("maxwell")
    end, x, y = d.shaft("end"), d.shaft("x"), d.shaft("y")
    d.add(cw.PrescribedSpeed("motion", shaft=end, speed=2.0))
    d.add(cw.Spring("k1", base=d.housing, follower=x, stiffness=k1))
    d.add(cw.Damper("c", base=x, follower=y, damping=c))
    d.add(cw.Spring("k2", base=y, follower=end, stiffness=k2))
    system = d.assemble()
    assert any("series" in note for note in system.notes)
    run = cw.simulate(system, 0.5, dt=0.05, rtol=1e-9, atol=1e-11)
    k = k1 * k2 / (k1 + k2)
    expected = [-c * 2.0 * (1.0 - exp(-k * t / c)) for t in run.time]
    for name in ("k1", "c", "k2"):
        np.testing.assert_allclose(run[f"{name}.torque"], expected, atol=1e-5 * c)
    assert abs(run.energy.residual) <= 1e-6 * run.energy.turnover


LINK = st.tuples(st.sampled_from(["spring", "coil", "damper", "both", "oiled"]), RATE)


@given(links=st.lists(LINK, min_size=2, max_size=5))
@settings(max_examples=part(40), deadline=None)
def test_every_chain_of_springs_and_dampers_moves_as_with_vanishing_inertia(links):
    d = _chain(links)
    assert [str(problem) for problem in d.check()] == []
    run = d.simulate(0.3, dt=0.05, rtol=1e-8, atol=1e-10, method="rodas5p")
    light = _chain(links, 1e-7).simulate(0.3, dt=0.05, rtol=1e-8, atol=1e-10, method="rodas5p")
    for name in ("first", "last"):
        np.testing.assert_allclose(run[f"{name}.speed"], light[f"{name}.speed"], atol=3e-4)
    # every link carries the same torque
    for number in range(1, len(links)):
        np.testing.assert_allclose(run[f"l{number}.torque"][1:], run["l0.torque"][1:], atol=2e-4)
    assert abs(run.energy.residual) <= 1e-5 * max(run.energy.turnover, 1e-3)


def test_springs_around_a_damper_that_do_not_balance_are_refused():
    d = cw.Driveline("maxwell")
    a, x, y, b = d.shaft("a", inertia=1.0), d.shaft("x"), d.shaft("y"), d.shaft("b", inertia=1.0)
    d.add(Coil("k1", base=a, follower=x, rate=30.0, wound=0.1))
    d.add(cw.Damper("c", base=x, follower=y, damping=1.0))
    d.add(cw.Spring("k2", base=y, follower=b, stiffness=10.0))
    (problem,) = d.check()
    words = 'shaft "x" and shaft "y" without inertia: its springs pull it with -3 N m at the start'
    assert words in str(problem)


@pytest.mark.parametrize(
    ("other", "named"),
    [
        (lambda d, x: cw.Torque("t", shaft=x, torque=1.0), 'cw.Torque("t")'),
        (lambda d, x: cw.WetDrag("w", base=d.housing, follower=x, peak=1.0, speed=2.0), 'cw.WetDrag("w")'),
        (lambda d, x: cw.ResistingTorque("r", shaft=x, torque=1.0, speed=2.0), 'cw.ResistingTorque("r")'),
        (lambda d, x: cw.SpeedTorque("s", shaft=x, torque=[(0.0, 1.0), (9.0, 0.0)]), 'cw.SpeedTorque("s")'),
    ],
)
@pytest.mark.parametrize("through", [False, True], ids=["beside", "behind a damper"])
def test_springs_beside_what_is_none_are_refused_by_name(other, named, through):
    d = cw.Driveline("mixed")
    a, x = d.shaft("a", inertia=1.0), d.shaft("x")
    d.add(cw.Spring("k", base=a, follower=x, stiffness=30.0))
    y = d.shaft("y") if through else x
    if through:
        d.add(cw.Damper("c", base=x, follower=y, damping=1.0))
    d.add(other(d, y))
    (problem,) = d.check()
    assert f"nothing else determines its motion: {named} is neither spring nor damper" in str(problem)


def test_accelerations_behind_a_knot_keep_the_balance_of_a_shaft_without_inertia():
    """Torques at a sun without inertia change alike, also beside a worm whose friction follows its load."""
    d = cw.Driveline("behind")
    sun, ring, carrier = d.shaft("sun"), d.shaft("ring", inertia=0.03), d.shaft("carrier")
    end, wheel = d.shaft("end", inertia=0.02), d.shaft("wheel", inertia=0.5)
    d.add(cw.Planetary("planetary", sun=sun, ring=ring, carrier=carrier, ratio=3.0))
    d.add(cw.SpringDamper("light", base=d.housing, follower=sun, stiffness=70.0, damping=0.05))
    d.add(cw.SpringDamper("stiff", base=carrier, follower=end, stiffness=300.0, damping=0.7))
    d.add(cw.WormGear("worm", worm=ring, wheel=wheel, ratio=20.0, lead_angle=0.2, friction_coefficient=0.05))
    d.add(cw.Torque("drive", shaft=end, torque=cw.Table([(0.0, 1.0), (0.02, 1.0), (0.03, 3.0), (0.05, 0.0)])))
    run = d.simulate(0.05, output="steps")
    behind = np.flatnonzero(np.isin(run.time, (0.02, 0.03)))
    assert len(behind) >= 2
    v, a = ({name: run[f"{name}.{what}"] for name in ("sun", "carrier", "end")} for what in ("speed", "acceleration"))
    light = 70.0 * v["sun"] + 0.05 * a["sun"]
    stiff = 300.0 * (v["end"] - v["carrier"]) + 0.7 * (a["end"] - a["carrier"])
    # the carrier feels 1 + 3 times the torque of the sun; inside of a step the slope is that of the interpolant
    np.testing.assert_allclose(light[behind], stiff[behind] / 4.0, atol=1e-6)
