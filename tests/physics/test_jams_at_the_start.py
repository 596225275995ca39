"""A gear that locks itself and jams at the very start: an event, and its energy in the balance."""

from __future__ import annotations

import math

import numpy as np
import pytest

import clutchwork as cw
from support.amount import seeds


def hoist(seed: int) -> cw.Driveline:
    """A worm that locks itself and is stopped by the inertia of its wheel, with a spring, a clutch or a gear beside."""
    rng = np.random.default_rng([seed, 27])
    lead, ratio = float(rng.uniform(0.03, 0.07)), float(rng.choice([-1.0, 1.0]) * rng.uniform(10.0, 60.0))
    speed = float(rng.choice([-1.0, 1.0]) * rng.uniform(0.5, 5.0))
    d = cw.Driveline(f"hoist {seed}")
    worm, wheel = d.shaft("worm", inertia=1e-4), d.shaft("wheel", inertia=float(rng.uniform(1.0, 4.0)), speed=speed)
    d.add(cw.WormGear("g", worm=worm, wheel=wheel, ratio=ratio, lead_angle=lead, friction_coefficient=0.1))
    # slows the worm, so that the wheel pushes
    d.add(cw.Torque("t", shaft=worm, torque=-math.copysign(0.05, ratio * speed)))
    law = cw.Coulomb(static=0.2, kinetic=0.15)
    load = d.shaft("load", inertia=0.5, speed=float(rng.uniform(-3.0, 3.0)))
    kind = int(rng.integers(3))
    if kind == 0:
        d.add(cw.SpringDamper("s", base=wheel, follower=load, stiffness=300.0, damping=2.0))
    elif kind == 1:
        d.add(cw.Clutch("s", base=wheel, follower=load, friction=law, gain=1.0, normal_force=5.0))
    return d


@pytest.mark.random
@pytest.mark.parametrize("seed", seeds(40))
def test_the_energy_of_a_jam_at_the_start_is_in_an_event_and_in_the_balance(seed: int) -> None:
    run = hoist(seed).simulate(0.1, rtol=1e-8)
    (jam,) = (event for event in run.events if event.time == 0.0)
    assert (jam.element, jam.cause) == ("g", "impulse")
    lost = jam.energy_before - jam.energy_after
    assert run["g.heat"][0] == pytest.approx(lost, rel=1e-9)
    assert run["wheel.speed"][0] == pytest.approx(0.0, abs=1e-12)
    assert run.energy.heat["g"] == pytest.approx(run["g.heat"][-1], rel=1e-9)
    assert abs(run.energy.residual) < 1e-6 * run.energy.turnover


def test_what_slips_again_behind_the_start_has_an_event() -> None:
    """A rack that is declared locked is stopped; the balance of a shaft without inertia then lets it go at once."""
    d = cw.Driveline("rack")
    pinion, light, support = (
        d.shaft("pinion", inertia=0.005),
        d.shaft("light"),
        d.shaft("support", inertia=0.02, speed=-100.0),
    )
    mass = d.mass("mass", mass=1.0)
    d.add(cw.TorsionalDamper("coil", base=d.housing, follower=pinion, torque=[(-0.2, -140.0), (0.2, 110.0)]))
    d.add(cw.Damper("drag", base=light, follower=support, damping=1.0))
    rows = ((0.0, 0.6, 0.8, 0.0, 0.0),)
    d.add(cw.RackPinion("rack", shaft=pinion, mass=mass, support=support, radius=1.0, loss_table=rows, locked=True))
    run = d.simulate(0.02)
    state = None
    for event in run.events.of("rack"):
        assert state in (None, event.before)
        state = event.after
    assert len(run.events.of("rack")) > 1
