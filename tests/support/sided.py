"""Drivelines with kinks, or what looks like one: derivatives from the left and from the right differ, or agree."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

import clutchwork as cw
from clutchwork.base.errors import ModelError

from .by_differences import TIGHT

Rng = np.random.Generator
# width of a difference, of the size of a number
WIDTH = 1e-5


class Case(NamedTuple):
    """A driveline, and what is asked of it."""

    model: cw.Driveline
    t_end: float
    of: list[Any]
    by: list[str]


def from_both_sides(case: Case, number: int) -> tuple[np.ndarray, np.ndarray]:
    """Differences of runs by a number to the left and to the right; NaN where the driveline refuses a side."""
    f = cw.differentiable(case.model, case.t_end, of=case.of, by=case.by[number], **TIGHT)
    here, found = float(f.x0[0]), list[np.ndarray]()
    for step in (-WIDTH * (abs(here) or 1.0), WIDTH * (abs(here) or 1.0)):
        try:
            values = [f([here + place * step]) for place in range(3)]
        except ModelError:
            values = [np.full(len(f.of), np.nan)] * 3
        found.append((-1.5 * values[0] + 2.0 * values[1] - 0.5 * values[2]) / step)
    return found[0], found[1]


def lining(rng: Rng) -> Any:
    kinetic = float(rng.uniform(0.08, 0.12))
    return cw.Coulomb(static=kinetic * float(rng.uniform(1.05, 1.4)), kinetic=kinetic)


def inertia(rng: Rng) -> float:
    return float(10 ** rng.uniform(-1.0, 0.5))


# -------------------------------------------------------------------------------------------------- both sides differ


def starts_at_rest(rng: Rng) -> Case:
    """A shaft that a bearing holds, and a clutch drives."""
    d = cw.Driveline("rest")
    a, b = d.shaft("a", inertia=inertia(rng), speed=60.0), d.shaft("b", inertia=inertia(rng), speed=0.0)
    d.add(cw.Clutch("c", base=a, follower=b, friction=lining(rng), gain=1.0, normal_force=150.0))
    d.add(cw.BearingFriction("f", shaft=b, friction=cw.Coulomb(static=8.0, kinetic=7.0), torque=1.0))
    return Case(d, 0.2, ["a.speed", "b.speed"], ["b.speed"])


def breaks_away_at_a_bend(rng: Rng) -> Case:
    """A torque that rises reaches the capacity of a brake where its force begins to fall."""
    d, knot, force, mu = (
        cw.Driveline("bend"),
        float(rng.uniform(0.3, 0.6)),
        float(rng.uniform(50.0, 200.0)),
        lining(rng),
    )
    a = d.shaft("a", inertia=inertia(rng))
    end = force * float(rng.uniform(0.0, 0.5))
    press = cw.Table([(0.0, force), (knot, force), (1.0, end)])
    d.add(cw.Brake("b", shaft=a, friction=mu, gain=1.0, normal_force=press))
    d.add(cw.Torque("t", shaft=a, torque=cw.Ramp(height=mu.static * force / knot, duration=1.0)))
    by = str(rng.choice(["t.torque.height", "b.friction.static", "b.gain", "b.normal_force.times[2]"]))
    return Case(d, 1.0, [cw.break_away("b"), "a.speed"], [by])


def presses_from_zero(rng: Rng) -> Case:
    """A force that is zero for a while."""
    d, knot = cw.Driveline("zero"), float(rng.uniform(0.2, 0.6))
    a, b = d.shaft("a", inertia=inertia(rng), speed=100.0), d.shaft("b", inertia=inertia(rng))
    press = cw.Table([(0.0, 0.0), (knot, 0.0), (1.0, 20.0)])
    d.add(cw.Clutch("c", base=a, follower=b, friction=lining(rng), gain=1.0, normal_force=press))
    return Case(d, 0.8, ["a.speed", "c.heat"], [f"c.normal_force.values[{rng.integers(1, 3)}]"])


def begins_with_the_run(rng: Rng) -> Case:
    """A step at the start of the run, or one that ends it."""
    d, start = cw.Driveline("step"), float(rng.choice([0.0, 1.0]))
    a = d.shaft("a", inertia=inertia(rng), speed=10.0)
    d.add(cw.LinearTorque("load", shaft=a, nominal_torque=-5.0, nominal_speed=100.0))
    d.add(cw.Torque("t", shaft=a, torque=cw.Step(height=float(rng.uniform(5.0, 20.0)), start=start)))
    return Case(d, 1.0, ["a.speed"], ["t.torque.start"])


def has_equal_peaks(rng: Rng) -> Case:
    """Two peaks of an acceleration that are equal."""
    d, top = cw.Driveline("equal"), float(rng.uniform(2.0, 9.0))
    a = d.shaft("a", inertia=inertia(rng))
    d.add(cw.Torque("t", shaft=a, torque=cw.Table([(0.0, 0.0), (0.2, top), (0.4, 0.0), (0.7, top), (1.0, 0.0)])))
    return Case(d, 1.0, [cw.maximum("a.acceleration")], [f"t.torque.values[{rng.choice([2, 4])}]"])


def is_largest_for_a_while(rng: Rng) -> Case:
    """A speed that is largest on a plateau, along which its derivative grows."""
    d, top = cw.Driveline("plateau"), float(rng.uniform(2.0, 9.0))
    a = d.shaft("a", inertia=inertia(rng))
    points = [(0.0, top), (0.3, top), (0.3, 0.0), (0.7, 0.0), (0.7, -top), (1.0, -top)]
    d.add(cw.Torque("t", shaft=a, torque=cw.Table(points)))
    return Case(d, 1.0, [cw.maximum("a.speed")], [f"t.torque.values[{rng.choice([3, 4])}]"])


def peaks_at_the_end(rng: Rng) -> Case:
    """A knot at the end of the run at which an acceleration is largest."""
    d = cw.Driveline("end")
    a = d.shaft("a", inertia=inertia(rng))
    d.add(cw.Torque("t", shaft=a, torque=cw.Table([(0.0, 1.0), (1.0, float(rng.uniform(3.0, 9.0))), (2.0, 0.0)])))
    return Case(d, 1.0, [cw.maximum("a.acceleration")], ["t.torque.times[2]"])


DIFFER: tuple[Callable[[Rng], Case], ...] = (
    starts_at_rest,
    breaks_away_at_a_bend,
    presses_from_zero,
    begins_with_the_run,
    has_equal_peaks,
    is_largest_for_a_while,
    peaks_at_the_end,
)

# --------------------------------------------------------------------------------------------------- both sides agree


def locks_in_a_triangle(rng: Rng) -> Case:
    """Three clutches in a ring: two lock at one instant, for one of them follows from the others."""
    d = cw.Driveline("triangle")
    a, b, c = (d.shaft(name, inertia=inertia(rng), speed=v) for name, v in zip("abc", (120.0, 40.0, 30.0), strict=True))
    for name, x, y, force in (("c1", a, b, 2e5), ("c2", a, c, 3e5), ("c3", b, c, 6e5)):
        d.add(cw.Clutch(name, base=x, follower=y, friction=lining(rng), gain=5e-4, pressure=force))
    d.add(cw.SpringDamper("k", base=c, follower=d.shaft("e", inertia=0.4), stiffness=3e3, damping=2.0))
    return Case(d, 1.0, ["a.speed", "c1.heat"], ["a.inertia", "c1.pressure", "k.stiffness", "c2.gain"])


def peaks_at_lock_up(rng: Rng) -> Case:
    """The torque of a shaft is largest where the clutch locks."""
    d, top = cw.Driveline("lock-up"), float(rng.uniform(1.5e5, 3e5))
    e, g, w = (d.shaft("e", inertia=0.2, speed=100.0), d.shaft("g", inertia=0.05), d.shaft("w", inertia=inertia(rng)))
    law = cw.Exponential(static=0.12, slow=0.11, fast=0.09, speed=10.0)
    press = cw.Table([(0.0, 0.0), (0.3, top), (1.0, 2.0 * top)])
    d.add(cw.Clutch("c", base=e, follower=g, friction=law, gain=5e-4, pressure=press))
    d.add(cw.SpringDamper("k", base=g, follower=w, stiffness=2e5, damping=40.0))
    d.add(cw.QuadraticTorque("drag", shaft=w, nominal_torque=-5.0, nominal_speed=50.0))
    return Case(d, 2.0, [cw.peak("k.torque")], ["c.gain", "e.inertia"])


def passes_what_does_nothing(rng: Rng) -> Case:
    """A speed passes zero slowly beside a brake without force."""
    d = cw.Driveline("open")
    a = d.shaft("a", inertia=inertia(rng), speed=float(rng.choice([0.0, 1e-3])))
    d.add(cw.Brake("b", shaft=a, friction=lining(rng), gain=1.0, normal_force=0.0))
    d.add(cw.Torque("t", shaft=a, torque=cw.Sine(amplitude=float(rng.uniform(1.0, 4.0)), frequency=1.0)))
    return Case(d, 1.3, ["a.speed", "a.angle"], ["t.torque.amplitude", "a.speed"])


def locks_beside_others(rng: Rng) -> Case:
    """Two drivelines that have nothing to do with each other, whose clutches lock at one instant."""
    d, mu, j = cw.Driveline("beside"), lining(rng), inertia(rng)
    for name in ("1", "2"):
        a, b = d.shaft(f"a{name}", inertia=j, speed=80.0), d.shaft(f"b{name}", inertia=2.0 * j)
        d.add(cw.Clutch(f"c{name}", base=a, follower=b, friction=mu, gain=1.0, normal_force=200.0 * j))
    return Case(d, 5.0, ["a1.speed", cw.lock("c1"), "c2.heat"], ["a1.inertia", "c2.gain", "a2.speed"])


def begins_at_a_round_time(rng: Rng) -> Case:
    """A ramp that begins with the run, and one at 1 s."""
    d, start = cw.Driveline("ramp"), float(rng.choice([0.0, 1.0]))
    a = d.shaft("a", inertia=inertia(rng), speed=10.0)
    d.add(cw.LinearTorque("load", shaft=a, nominal_torque=-5.0, nominal_speed=100.0))
    signal: Any = cw.Ramp(height=float(rng.uniform(5.0, 20.0)), start=start, duration=0.5)
    if rng.random() < 0.5:
        signal = cw.Sine(amplitude=float(rng.uniform(5.0, 20.0)), frequency=1.3, start=start)
    d.add(cw.Torque("t", shaft=a, torque=signal))
    return Case(d, 2.0, ["a.speed", cw.at("a.speed", 1.5)], ["t.torque.start", "a.inertia"])


def bends_inside_of_a_step(rng: Rng) -> Case:
    """Two brakes hold one shaft, of which one reaches its capacity."""
    d, ratio, mu = cw.Driveline("brakes"), float(rng.uniform(1.5, 4.0)), lining(rng)
    s, u = d.shaft("s", inertia=inertia(rng)), d.shaft("u", inertia=inertia(rng))
    d.add(cw.Gear("g", input=s, output=u, ratio=ratio))
    weak, strong = float(rng.uniform(20.0, 40.0)), float(rng.uniform(500.0, 800.0))
    d.add(cw.Brake("b1", shaft=s, friction=mu, gain=1.0, normal_force=weak))
    d.add(cw.Brake("b2", shaft=u, friction=mu, gain=1.0, normal_force=strong))
    top = mu.static * (weak + strong / ratio) * float(rng.uniform(0.8, 0.9))
    d.add(cw.Torque("t", shaft=s, torque=cw.Table([(0.0, 0.0), (0.2, top), (0.4, 0.0)])))
    return Case(d, 0.4, [cw.peak("b1.torque"), cw.peak("b2.torque")], ["t.torque.values[2]", "b1.gain"])


def starts_with_another(rng: Rng) -> Case:
    """A clutch holds two shafts that turn alike: a start value beside that is soon lost."""
    d, speed = cw.Driveline("alike"), float(rng.uniform(20.0, 60.0))
    b, c = d.shaft("b", inertia=inertia(rng), speed=speed), d.shaft("c", inertia=inertia(rng), speed=speed)
    d.add(cw.Clutch("hold", base=b, follower=c, friction=lining(rng), gain=1.0, normal_force=300.0))
    d.add(cw.LinearTorque("load", shaft=c, nominal_torque=-5.0, nominal_speed=100.0))
    return Case(d, 0.5, ["b.speed", "c.angle"], ["b.speed", "c.inertia", "c.speed"])


AGREE: tuple[Callable[[Rng], Case], ...] = (
    starts_with_another,
    locks_in_a_triangle,
    peaks_at_lock_up,
    passes_what_does_nothing,
    locks_beside_others,
    begins_at_a_round_time,
    bends_inside_of_a_step,
)
