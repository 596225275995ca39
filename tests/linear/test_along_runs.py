"""Along a run d/dt (rate of x) is A rate + B du/dt, and d/dt y is C rate + D du/dt: pieces of laws and all."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.declare.schema import Role
from support import random_drivelines, samples
from support.runs import TIGHT

H = 1e-6  # s


def along(run: Any, at: float) -> float | None:
    """The largest part of a rate or slope that a linear system misses; None where a mode or a piece changes nearby."""
    outputs = [name for name in run.names if name.endswith((".speed", ".torque", ".slip", ".twist", ".capacity"))]
    outputs += [name for name in run.names if name.endswith((".power", ".temperature"))]
    systems = [cw.linearise(run, at=t, outputs=outputs) for t in (at - H, at, at + H)]
    before, here, after = systems
    if before.contacts != after.contacts or before.states != after.states or here.states != after.states:
        return None
    if np.abs(before.A - after.A).max(initial=0.0) > 1e-2 * np.abs(here.A).max(initial=1.0):
        return None
    slope = (np.array(list(after.input.values())) - np.array(list(before.input.values()))) / (2 * H)
    rate = np.array(list(here.rate.values()))
    bend = (np.array(list(after.rate.values())) - np.array(list(before.rate.values()))) / (2 * H)
    moved = (np.array([after.output[n] for n in outputs]) - np.array([before.output[n] for n in outputs])) / (2 * H)
    walked = (np.array(list(after.state.values())) - np.array(list(before.state.values()))) / (2 * H)
    pairs = [
        (here.A @ rate + here.B @ slope, bend, [here.rate[n] for n in here.states]),
        (here.C @ rate + here.D @ slope, moved, [here.output[n] for n in outputs]),
        (rate, walked, [here.state[n] for n in here.states]),
    ]
    # what a number of this size moves within its round-off, which the solver leaves, over the time between
    noise = 1e-12 / H
    missed = [
        np.abs(found - true) / (np.abs(true).max(initial=0.0) + noise * np.abs(size) + 1e-3)
        for found, true, size in pairs
    ]
    return float(max(part.max(initial=0.0) for part in missed))


# differences over 2 us of what swings with less than 1e4 1/s, and round-off of rates over it
CLOSE = 2e-3


def rubbing(law: cw.Law) -> cw.Driveline:
    """A disc on a spring that is driven in both directions against a brake with a law."""
    d = cw.Driveline(type(law).__name__)
    a, b = d.shaft("a", inertia=0.05), d.shaft("b", inertia=0.4)
    d.add(cw.Torque("drive", shaft=a, torque=cw.Sine(amplitude=6.0, frequency=2.0)))
    d.add(cw.SpringDamper("k", base=a, follower=b, stiffness=300.0, damping=0.2))
    force = cw.Sine(amplitude=3.0, frequency=7.0, offset=15.0)
    d.add(cw.Brake("brake", shaft=b, friction=law, gain=1.0, normal_force=force))
    return d


@cache
def run_of(cls: Any) -> Any:
    return rubbing(samples.law(cls)).simulate(0.6, **TIGHT)


CLIMBING = [cls for cls in samples.declared(Role.LAW) if cls is not cw.NaiveSign]


@pytest.mark.parametrize("cls", CLIMBING, ids=lambda cls: cls.__name__)
def test_every_law_in_both_directions(cls):
    missed = [along(run_of(cls), at) for at in np.linspace(0.031, 0.577, 9)]
    told = [part for part in missed if part is not None]
    assert len(told) >= 6
    assert max(told) < CLOSE


@pytest.mark.parametrize("seed", range(8))
def test_random_drivelines(seed):
    run = random_drivelines.describe(seed).driveline().simulate(random_drivelines.T_END, **TIGHT)
    told = [part for at in np.linspace(0.07, 1.93, 6) if (part := along(run, at)) is not None]
    assert len(told) >= 4
    assert max(told) < CLOSE
