"""Random drivelines with rigid play, end stops and clutches, from a seed.

Two to five shafts of 0.02 to 2 kg m2 in a chain; each joint is a backlash, a spring with a backlash beside it, a
clutch, a freewheel, or a gear with play at its output; some shafts have end stops, some friction. Sines drive one or
two shafts.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

import clutchwork as cw

T_END = 1.5


def driveline(seed: int) -> cw.Driveline:
    """The driveline of a seed."""
    draw = np.random.default_rng(seed)
    d = cw.Driveline(f"random {seed}")
    shafts = [
        d.shaft(f"s{i}", inertia=10 ** draw.uniform(-1.7, 0.3), speed=draw.choice([0.0, draw.normal(0, 8)]))
        for i in range(int(draw.integers(2, 6)))
    ]
    for i, (a, b) in enumerate(pairwise(shafts)):
        _joint(d, draw, i, a, b)
    for i, shaft in enumerate(shafts):
        if draw.random() < 0.3:
            width = draw.uniform(0.05, 1.5)
            at = draw.uniform(-width, 0)
            ends = {"lower": at, "upper": at + width}
            if draw.random() < 0.2:
                ends.popitem()
            d.add(
                cw.EndStop(
                    f"e{i}",
                    base=d.housing if draw.random() < 0.6 else shafts[i - 1],
                    follower=shaft,
                    lower_restitution=_restitution(draw),
                    upper_restitution=_restitution(draw),
                    **ends,
                )
            )
        if draw.random() < 0.25:
            law = cw.Coulomb(static=draw.choice([1.0, 1.3]), kinetic=1.0)
            d.add(cw.BearingFriction(f"f{i}", shaft=shaft, friction=law, torque=draw.uniform(0.2, 10)))
    for i in range(int(draw.integers(1, 3))):
        wave = cw.Sine(amplitude=10 ** draw.uniform(0, 2), frequency=draw.uniform(0.3, 6), phase=draw.uniform(0, 6))
        d.add(cw.Torque(f"t{i}", shaft=shafts[int(draw.integers(len(shafts)))], torque=wave))
    return d


def _restitution(draw: np.random.Generator) -> float:
    return float(draw.choice([0.0, 0.0, draw.uniform(0, 0.9), draw.uniform(0.2, 0.7)]))


def _joint(d: cw.Driveline, draw: np.random.Generator, i: int, a: cw.Node, b: cw.Node) -> None:
    kind = draw.choice(["lash", "lash", "spring", "clutch", "freewheel", "gear"])
    if kind == "gear":
        between = d.shaft(f"g{i}", inertia=draw.uniform(0.01, 0.2))
        d.add(cw.Gear(f"gear{i}", input=a, output=between, ratio=draw.choice([-2.0, 0.5, 3.0])))
        a = between
    if kind in ("lash", "spring", "gear"):
        gap = 10 ** draw.uniform(-3, -0.5)
        twist = draw.choice([0.0, gap / 2, -gap / 2, draw.uniform(-gap / 2, gap / 2)])
        d.add(cw.Backlash(f"b{i}", base=a, follower=b, gap=gap, restitution=_restitution(draw), initial_twist=twist))
    if kind == "spring":
        d.add(
            cw.SpringDamper(
                f"k{i}", base=a, follower=b, stiffness=10 ** draw.uniform(1, 3.5), damping=draw.uniform(0, 1)
            )
        )
    ends = {"base": a, "follower": b, "gain": 1.0}
    if kind == "clutch":
        law = cw.Coulomb(static=draw.choice([1.0, 1.2]), kinetic=1.0)
        knots = [(0.0, 0.0), *((0.3 * k, draw.uniform(0, 30)) for k in range(1, 5))]
        d.add(cw.Clutch(f"c{i}", friction=law, normal_force=cw.Table(knots), **ends))
    if kind == "freewheel":
        d.add(cw.OneWayClutch(f"w{i}", base=a, follower=b))


def stops(d: cw.Driveline) -> list[cw.Element]:
    """Its stops."""
    return [element for element in d.elements if isinstance(element, cw.Backlash | cw.EndStop)]


def limits(stop: cw.Element) -> tuple[float, float]:
    """Ends of a stop, infinite where there is none."""
    if isinstance(stop, cw.Backlash):
        return -stop.gap / 2, stop.gap / 2
    lower = -np.inf if stop.lower is None else stop.lower
    return lower, np.inf if stop.upper is None else stop.upper
