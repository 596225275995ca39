"""Random drivelines with 2 to 6 contacts, parallel ones, loops and freewheels among them, from a seed.

Two to five shafts of 0.02 to 2 kg m2; contacts lie between neighbours, beside one another, and to the housing. Springs
couple shafts that no contact couples, an engine gives 50 to 400 N m with a ripple, a load opposes the motion. Pressures
fill, hold and empty along tables, or swing as sines that reach below zero.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

import clutchwork as cw

from .sweep import log_uniform

T_END = 1.0
KINDS = ("clutch", "clutch", "clutch", "clutch", "freewheel", "band", "limiter", "sprag")


def driveline(seed: int, *, simple: bool = False) -> cw.Driveline:
    """The driveline of a seed; simple: friction clutches and freewheels alone, with realistic pressures from tables."""
    rng = np.random.default_rng([seed, 40])
    d = cw.Driveline(f"contacts {seed}")
    count = int(rng.integers(2, 6))
    inertia = [log_uniform(rng, 0.02, 2.0) for _ in range(count)]
    speed = [float(rng.uniform(-50, 300)) if rng.random() < 0.6 else 0.0 for _ in range(count)]
    members = [d.shaft(f"s{i}", inertia=j, speed=w) for i, (j, w) in enumerate(zip(inertia, speed, strict=True))]
    members.append(d.housing)
    engine = log_uniform(rng, 50, 400)
    pairs = _pairs(rng, count)
    for i, pair in enumerate(pairs):
        ends = [members[k] for k in (pair if rng.random() < 0.5 else pair[::-1])]
        kind = KINDS[int(rng.integers(5 if simple else len(KINDS)))]
        d.add(_contact(rng, kind, f"c{i}", ends, engine, simple=simple))
    for i in range(count - 1):
        if (i, i + 1) not in pairs:
            reduced = 1 / (1 / inertia[i] + 1 / inertia[i + 1])
            omega = 2 * math.pi * log_uniform(rng, 5, 60)
            damping = 2 * log_uniform(rng, 0.005, 0.1) * reduced * omega
            stiffness = reduced * omega**2
            d.add(
                cw.SpringDamper(f"k{i}", base=members[i], follower=members[i + 1], stiffness=stiffness, damping=damping)
            )
    ripple = {"amplitude": engine * float(rng.uniform(0, 0.5)), "frequency": log_uniform(rng, 0.3, 8)}
    d.add(cw.Torque("engine", shaft=members[0], torque=cw.Sine(offset=engine * float(rng.uniform(0.5, 1)), **ripple)))
    load = {"torque": engine * float(rng.uniform(0.1, 0.9)), "speed": log_uniform(rng, 0.5, 5)}
    d.add(cw.ResistingTorque("load", shaft=members[count - 1], **load))
    return d


def contacts(d: cw.Driveline) -> list[Any]:
    """The contacts of such a driveline, as added."""
    return [element for element in d.elements if element.name.startswith("c")]


def _pairs(rng: np.random.Generator, count: int) -> list[tuple[int, int]]:
    """Two to six pairs of members, some of them twice or more; the housing is the last member."""
    total, pairs = int(rng.integers(2, 7)), [(0, 1)]
    while len(pairs) < total:
        chance = rng.random()
        if chance < 0.4:
            pairs.append(pairs[int(rng.integers(len(pairs)))])
        elif chance < 0.75:
            first = int(rng.integers(0, count - 1))
            pairs.append((first, first + 1))
        elif chance < 0.9:
            pairs.append((int(rng.integers(count)), count))
        else:
            a, b = sorted(int(x) for x in rng.choice(count, 2, replace=False))
            pairs.append((a, b))
    return pairs


def _law(rng: np.random.Generator) -> Any:
    kinetic = float(rng.uniform(0.08, 0.15))
    static = kinetic * (1.0 if rng.random() < 0.3 else float(rng.uniform(1.02, 1.4)))
    if rng.random() < 0.3:
        return cw.Coulomb(static=static, kinetic=kinetic)
    if rng.random() < 0.5:
        return cw.Stribeck(static=static, kinetic=kinetic, speed=log_uniform(rng, 1, 30))
    return cw.Exponential(
        static=static, slow=kinetic, fast=kinetic * float(rng.uniform(0.5, 1)), speed=log_uniform(rng, 5, 100)
    )


def _pressure(rng: np.random.Generator, *, simple: bool) -> Any:
    """From 0 to 1: fills, holds or modulates, empties."""
    if not simple and rng.random() < 0.25:
        sine = {"amplitude": float(rng.uniform(0.2, 0.8)), "offset": float(rng.uniform(0.0, 0.6))}
        return cw.Sine(**sine, frequency=log_uniform(rng, 0.5, 10), phase=float(rng.uniform(0, 6)))
    count = int(rng.integers(3, 7))
    times = np.sort(rng.uniform(0.0, T_END, count)) + 1e-3 * np.arange(count)
    level = rng.uniform(0.0, 1.0, count) * (rng.random(count) < 0.8)
    return cw.Table([(float(t), float(x)) for t, x in zip(times, level, strict=True)])


def _contact(rng: np.random.Generator, kind: str, name: str, ends: list[Any], engine: float, *, simple: bool) -> Any:
    base, follower = ends
    torque, law = engine * log_uniform(rng, 0.1, 4), _law(rng)
    if kind == "freewheel":
        return cw.OneWayClutch(name, base=base, follower=follower)
    one = cw.Coulomb(static=1.0, kinetic=float(rng.uniform(0.6, 1.0)))
    if kind == "sprag":
        return cw.SpragClutch(name, base=base, follower=follower, friction=one, holding=torque, drag=0.05 * torque)
    if kind == "limiter":
        return cw.TorqueLimiter(name, base=base, follower=follower, friction=one, torque=torque, locked=False)
    pressure = _pressure(rng, simple=simple)
    if kind == "band":
        share = (
            cw.Table([(t, 0.5 * torque * x) for t, x in pressure.points]) if isinstance(pressure, cw.Table) else torque
        )
        return cw.BandBrake(name, shaft=follower, base=base, friction=law, radius=1.0, wrap=3.0, force=share)
    return cw.Clutch(
        name, base=base, follower=follower, friction=law, gain=torque / law.sliding(), normal_force=pressure
    )
