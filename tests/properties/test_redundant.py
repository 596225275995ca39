"""Locked contacts in parallel and in loops: the set lets go when the load exceeds what all of them together can hold.

What they can hold is a linear programme: the largest load whose torques at rest fit into the bounds of every contact.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from scipy.optimize import linprog

import clutchwork as cw
from support.amount import amount
from support.sweep import log_uniform, simulate, stopped, sweep

# torques and events against the linear programme, relative
EXACT = 1e-8
# of the largest capacity: what round-off may leave outside of a bound
BOUND = 1e-9
RAMP_START = 0.1
RAMP_END = 1.1
HOUSING = -1


@dataclass(frozen=True)
class Hold:
    """A contact that holds torques from `low` to `high` on its follower; base -1 is the housing."""

    kind: str
    base: int
    follower: int
    low: float
    high: float
    kinetic: float = 1.0


@dataclass(frozen=True)
class Net:
    """Shafts at rest, what holds them, and loads that rise together from zero: `load` is reached at the end."""

    count: int
    holds: tuple[Hold, ...]
    load: tuple[float, ...]

    def matrix(self) -> np.ndarray:
        """Torques on the shafts over the torques of the contacts."""
        rows = np.zeros((self.count, len(self.holds)))
        for i, hold in enumerate(self.holds):
            if hold.base != HOUSING:
                rows[hold.base, i] -= 1.0
            if hold.follower != HOUSING:
                rows[hold.follower, i] += 1.0
        return rows

    def strength(self) -> float:
        """Largest share of the load that is held; infinite where freewheels take all of it."""
        size = max(abs(x) for x in self.load)
        equal = np.hstack([self.matrix(), np.array(self.load)[:, None] / size])
        bounds = [(hold.low, hold.high) for hold in self.holds] + [(0.0, None)]
        cost = np.append(np.zeros(len(self.holds)), -1.0)
        found = linprog(cost, A_eq=equal, b_eq=np.zeros(self.count), bounds=bounds, method="highs-ds")
        return np.inf if found.status == 3 else float(found.x[-1]) / size

    def driveline(self) -> cw.Driveline:
        d = cw.Driveline("net")
        members = [d.shaft(f"s{i}", inertia=0.1 * (i + 1)) for i in range(self.count)] + [d.housing]
        for i, hold in enumerate(self.holds):
            d.add(contact(f"h{i}", hold, members[hold.base], members[hold.follower]))
        for i, torque in enumerate(self.load):
            ramp = cw.Ramp(height=torque, start=RAMP_START, duration=RAMP_END - RAMP_START)
            d.add(cw.Torque(f"t{i}", shaft=members[i], torque=ramp))
        return d


def contact(name: str, hold: Hold, base: cw.Node, follower: cw.Node) -> Any:
    law = cw.Coulomb(static=1.0, kinetic=hold.kinetic)
    if hold.kind == "freewheel":
        return cw.OneWayClutch(name, base=base, follower=follower)
    if hold.kind == "sprag":
        return cw.SpragClutch(name, base=base, follower=follower, holding=hold.high, drag=-hold.low, friction=law)
    if hold.kind == "limiter":
        return cw.TorqueLimiter(name, base=base, follower=follower, torque=hold.high, friction=law)
    return cw.Clutch(name, base=base, follower=follower, friction=law, gain=1.0, normal_force=hold.high)


def hold(rng: np.random.Generator, base: int, follower: int, kinds: tuple[str, ...]) -> Hold:
    kind = kinds[int(rng.integers(len(kinds)))]
    if rng.random() < 0.5:
        base, follower = follower, base
    torque, kinetic = log_uniform(rng, 0.1, 100.0), float(rng.uniform(0.5, 1.0))
    if kind == "freewheel":
        return Hold(kind, base, follower, 0.0, np.inf)
    if kind == "sprag":
        return Hold(kind, base, follower, -torque * float(rng.uniform(0.01, 0.3)), torque, kinetic)
    return Hold(kind, base, follower, -torque, torque, kinetic)


def one_shaft(rng: np.random.Generator, kinds: tuple[str, ...]) -> Net:
    holds = tuple(hold(rng, HOUSING, 0, kinds) for _ in range(int(rng.integers(2, 7))))
    return Net(1, holds, (log_uniform(rng, 1.0, 500.0) * (1 if rng.random() < 0.5 else -1),))


def several_shafts(rng: np.random.Generator, kinds: tuple[str, ...]) -> Net:
    """A tree that reaches the housing, and links more that close loops."""
    count = int(rng.integers(2, 5))
    pairs = [(int(rng.integers(-1, i)), i) for i in range(count)]
    for _ in range(int(rng.integers(1, 4))):
        a, b = rng.choice(np.arange(-1, count), 2, replace=False)
        pairs.append((int(a), int(b)))
    holds = tuple(hold(rng, a, b, kinds) for a, b in pairs)
    return Net(count, holds, tuple(float(x) for x in rng.uniform(-100.0, 100.0, count)))


def outside(net: Net, run: Any) -> str:
    """Contacts whose torque leaves its bounds at a row; what slips has its kinetic torque or less."""
    scale = max(h.high for h in net.holds if np.isfinite(h.high)) if any(np.isfinite(h.high) for h in net.holds) else 0
    slack = BOUND * max(scale, max(abs(x) for x in net.load))
    found = []
    for i, h in enumerate(net.holds):
        torque = run[f"h{i}.torque"]
        if torque.min() < h.low - slack or torque.max() > h.high + slack:
            found.append(f"h{i} ({h.kind}) {torque.min():.6g} to {torque.max():.6g}, holds {h.low:.6g} to {h.high:.6g}")
    return "; ".join(found)


def lets_go(net: Net) -> str:
    """Nothing moves and nothing happens before the limit, something moves behind it."""
    strength = net.strength()
    if strength < 1e-9:
        return ""
    limit = RAMP_START + (RAMP_END - RAMP_START) * strength
    # loads of a ramp of which all is held go on as they are
    held = strength >= 1.0
    t_end = RAMP_END + 0.2 if held else min(limit + 0.2 * (limit - RAMP_START), RAMP_END)
    run = simulate(net.driveline(), t_end, points=200)
    if text := stopped(run) or outside(net, run):
        return text
    before = run.time < (t_end if held else limit * (1 - EXACT))
    speeds = np.array([run[f"s{i}.speed"] for i in range(net.count)])
    if np.max(np.abs(speeds[:, before]), initial=0.0) > 0.0:
        return f"moves before its limit of {limit:.9g} s"
    early = [e for e in run.events.changes() if e.time < limit * (1 - EXACT)]
    if early:
        return f"event at {early[0].time:.9g} s of {early[0].element} ({early[0].after}), lets go at {limit:.9g} s"
    if held or t_end - limit < 1e-6:
        return ""
    first = min((e.time for e in run.events.changes()), default=np.inf)
    if not abs(first - limit) <= EXACT * limit or not np.max(np.abs(speeds[:, -1])) > 0.0:
        return f"lets go at {first:.9g} s, must at {limit:.9g} s"
    return ""


FRICTION = ("clutch", "limiter")
ALL = ("clutch", "limiter", "freewheel", "sprag")


@pytest.mark.random
def test_friction_on_one_shaft() -> None:
    sweep(lambda seed: lets_go(one_shaft(np.random.default_rng([seed, 10]), FRICTION)), amount())


@pytest.mark.random
def test_friction_and_freewheels_on_one_shaft() -> None:
    sweep(lambda seed: lets_go(one_shaft(np.random.default_rng([seed, 11]), ALL)), amount())


@pytest.mark.random
def test_friction_over_several_shafts() -> None:
    sweep(lambda seed: lets_go(several_shafts(np.random.default_rng([seed, 12]), FRICTION)), amount())


@pytest.mark.random
def test_friction_and_freewheels_over_several_shafts() -> None:
    sweep(lambda seed: lets_go(several_shafts(np.random.default_rng([seed, 13]), ALL)), amount())


def filling(seed: int) -> str:
    """Brakes and freewheels on one standing shaft that fill and empty, together always strong enough.

    No torque leaves its bounds, none acts against the others, friction alone is shared by capacity, and nothing is
    told of a shaft that does not move but that its contacts open and close.
    """
    rng = np.random.default_rng([seed, 14])
    load = log_uniform(rng, 1.0, 50.0)
    d = cw.Driveline("filling")
    a = d.shaft("a", inertia=log_uniform(rng, 0.01, 1.0))
    one = cw.Coulomb(static=1.0, kinetic=float(rng.uniform(0.6, 1.0)))
    d.add(cw.Brake("b0", shaft=a, friction=one, gain=1.0, normal_force=load * log_uniform(rng, 1.01, 10.0)))
    count = int(rng.integers(2, 5))
    for i in range(1, count):
        times = np.cumsum(rng.uniform(0.05, 0.4, 4))
        levels = load * np.exp(rng.uniform(np.log(0.01), np.log(20.0), 4)) * (rng.random(4) < 0.6)
        force = cw.Table([(float(t), float(y)) for t, y in zip(times, levels, strict=True)])
        d.add(cw.Brake(f"b{i}", shaft=a, friction=one, gain=1.0, normal_force=force))
    wheels = int(rng.integers(0, 3))
    for i in range(wheels):
        d.add(cw.OneWayClutch(f"f{i}", base=d.housing if i == 0 else a, follower=a if i == 0 else d.housing))
    turned = -1.0 if rng.random() < 0.5 else 1.0
    d.add(cw.Torque("t", shaft=a, torque=cw.Sine(amplitude=turned * load, frequency=log_uniform(rng, 0.5, 5.0))))
    run = simulate(d, 1.0)
    if text := stopped(run):
        return text
    slack = BOUND * 100.0 * load
    brakes = np.array([run[f"b{i}.torque"] for i in range(count)])
    capacity = np.array([run[f"b{i}.capacity"] for i in range(count)])
    total = brakes.sum(axis=0)
    if np.max(np.abs(run["a.speed"])) > 0.0:
        return f"moves, to {np.max(np.abs(run['a.speed'])):.3g} rad/s"
    if np.max(np.abs(brakes) - capacity) > slack:
        return f"a torque is {np.max(np.abs(brakes) - capacity):.3g} N m beyond its capacity"
    for i in range(wheels):
        if run[f"f{i}.torque"].min() < -slack:
            return f"freewheel f{i} pulls with {run[f'f{i}.torque'].min():.3g} N m"
    if np.max(-brakes * np.sign(total)) > slack:
        return f"a brake drives with {np.max(-brakes * np.sign(total)):.3g} N m"
    if not wheels:
        error = np.max(np.abs(brakes - total * capacity / capacity.sum(axis=0)))
        if error > 1e-6 * load:
            return f"shares are off by {error:.3g} N m of {load:.3g} N m"
    told = [e for e in run.events.changes() if "open" not in (e.before, e.after)]
    return "" if not told else f"{told[0].element} {told[0].before} -> {told[0].after} at {told[0].time:.9g} s"


@pytest.mark.random
def test_filling_brakes_on_a_standing_shaft() -> None:
    sweep(filling, amount())


@pytest.mark.parametrize(("inertia", "gains", "load"), [(0.1, (50.0, 30.0), 20.0), (0.3, (20.0, 45.0), 12.0)])
def test_a_row_before_a_set_gives_way_is_in_balance(inertia, gains, load):
    """Two clutches at their limit beside a freewheel and a flank, which carry the rest: shaft c turns with a."""
    d = cw.Driveline("loop")
    a, b, c = (d.shaft(name, inertia=own, speed=10.0) for name, own in (("a", 0.1), ("b", 1.0), ("c", inertia)))
    law, fading = cw.Coulomb(static=1.0, kinetic=1.0), cw.Ramp(height=-1.0, duration=0.5, offset=1.0)
    for name, gain in zip(("first", "second"), gains, strict=True):
        d.add(cw.Clutch(name, base=a, follower=b, friction=law, gain=gain, normal_force=fading, locked=True))
    d.add(cw.OneWayClutch("freewheel", base=b, follower=c))
    d.add(cw.Backlash("flank", base=a, follower=c, gap=0.02, initial_twist=-0.01))
    d.add(cw.Torque("wave", shaft=a, torque=cw.Sine(amplitude=50.0, frequency=2.0)))
    d.add(cw.Torque("on_c", shaft=c, torque=load))
    d.add(cw.Torque("on_b", shaft=b, torque=20.0))
    run = d.simulate(1.0)
    assert any(event.cause == "torque limit" for event in run.events.of("first"))
    missing = inertia * run["c.acceleration"] - load - run["freewheel.torque"] - run["flank.torque"]
    # round-off of torques of some tens of N m
    assert np.abs(missing).max() < 1e-11 * 50.0
