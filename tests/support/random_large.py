"""Random drivelines with 14 to 40 shafts, from a seed: gears, planetary gears, springs, loops of clutches.

Shafts stand in a row; neighbours are joined by a clutch, a freewheel, a spring or a pair of gears. Some more clutches
lie across, beside others or to the housing, so that locked ones depend on each other; planetary gears tie three shafts;
some speeds are prescribed. Engines give torques with a ripple, loads oppose the motion.
"""

from __future__ import annotations

import math

import numpy as np

import clutchwork as cw

from .sweep import log_uniform

T_END = 0.5


def driveline(seed: int) -> cw.Driveline:
    """The driveline of a seed."""
    rng = np.random.default_rng([seed, 77])
    d = cw.Driveline(f"large {seed}")
    count = int(rng.integers(14, 41))
    inertia = [log_uniform(rng, 0.05, 2.0) for _ in range(count)]
    shafts = [d.shaft(f"s{i}", inertia=j) for i, j in enumerate(inertia)]
    links = 0
    for i in range(count - 1):
        kind = rng.choice(["clutch", "clutch", "clutch", "freewheel", "spring", "gear"])
        base, follower = shafts[i], shafts[i + 1]
        if kind == "spring":
            reduced = 1 / (1 / inertia[i] + 1 / inertia[i + 1])
            omega = 2 * math.pi * log_uniform(rng, 5, 60)
            damping, stiffness = 0.04 * reduced * omega, reduced * omega**2
            d.add(cw.SpringDamper(f"k{i}", base=base, follower=follower, stiffness=stiffness, damping=damping))
        elif kind == "gear":
            d.add(cw.Gear(f"g{i}", input=base, output=follower, ratio=float(rng.choice([-2.0, 0.5, 1.5, 3.0]))))
        else:
            d.add(_contact(rng, str(kind), f"c{links}", base, follower))
            links += 1
    for _ in range(int(rng.integers(0, 6))):
        a = int(rng.integers(0, count - 3))
        b = a + int(rng.integers(1, 4))
        follower = shafts[b] if rng.random() < 0.7 else d.housing
        d.add(_contact(rng, "clutch", f"c{links}", shafts[a], follower))
        links += 1
    for i in range(int(rng.integers(0, 4))):
        a = int(rng.integers(0, count - 4))
        fresh = d.shaft(f"p{i}", inertia=log_uniform(rng, 0.05, 1.0))
        ratio = float(rng.uniform(1.5, 4.0))
        d.add(cw.Planetary(f"row{i}", sun=shafts[a], carrier=shafts[a + 3], ring=fresh, ratio=ratio))
        d.add(_contact(rng, "clutch", f"b{i}", fresh, d.housing))
    if rng.random() < 0.3:
        given = d.shaft("given")
        d.add(cw.PrescribedSpeed("motion", shaft=given, speed=cw.Sine(amplitude=20.0, frequency=1.0, offset=60.0)))
        d.add(_contact(rng, "clutch", "in", given, shafts[int(rng.integers(0, count))]))
    for i in range(3):
        torque = cw.Sine(
            offset=float(rng.uniform(20, 200)), amplitude=float(rng.uniform(0, 80)), frequency=log_uniform(rng, 0.5, 8)
        )
        d.add(cw.Torque(f"engine{i}", shaft=shafts[int(rng.integers(0, count))], torque=torque))
    d.add(cw.ResistingTorque("load", shaft=shafts[-1], torque=30.0, speed=1.0))
    return d


def _contact(rng: np.random.Generator, kind: str, name: str, base: cw.Node, follower: cw.Node) -> cw.Component:
    if kind == "freewheel":
        return cw.OneWayClutch(name, base=base, follower=follower)
    law = cw.Exponential(static=0.16, slow=0.14, fast=0.09, speed=20.0)
    times = np.sort(rng.uniform(0.0, T_END, 3))
    points = [(0.0, float(rng.uniform(0, 1500))), *((float(t), float(rng.uniform(-200, 1500))) for t in times)]
    return cw.Clutch(name, base=base, follower=follower, friction=law, gain=1.0, normal_force=cw.Table(points))
