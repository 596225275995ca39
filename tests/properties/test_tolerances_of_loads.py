"""Friction that follows a load and may lock below a slip of its own; friction of springs that a speed presses.

Where the first cannot lock it goes on the way it moves, so that it never drives. The heat of the second is all that its
spring does not keep, the part that the speed winds into it left out.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from support.amount import amount
from support.any_model import rows
from support.lossy_chains import table
from support.sweep import log_uniform, simulate, stopped, sweep

T_END = 0.5


def lossy(seed: int) -> cw.Driveline:
    """Gears with losses or a limited slip, each with a tolerance, driven back and forth through springs and play."""
    rng = np.random.default_rng([seed, 31])
    d = cw.Driveline(f"tolerance {seed}")
    a, b, c = (d.shaft(name, inertia=log_uniform(rng, 0.01, 1.0), speed=None) for name in "abc")
    ratio, own = float(rng.choice([-1.0, 1.0])) * log_uniform(rng, 0.4, 3.0), log_uniform(rng, 1e-3, 1.0)
    if rng.random() < 0.6:
        d.add(cw.Mesh("first", input=a, output=b, ratio=ratio, loss_table=table(rng), tolerance=own))
    else:
        bias = float(rng.uniform(1.2, 5.0))
        d.add(cw.Differential("first", carrier=d.housing, left=a, right=b, bias=bias, tolerance=own))
    if rng.random() < 0.5:
        d.add(cw.ElasticBacklash("play", base=b, follower=c, gap=0.02, stiffness=log_uniform(rng, 100.0, 1e4)))
    else:
        d.add(cw.SpringDamper("spring", base=b, follower=c, stiffness=log_uniform(rng, 100.0, 1e4), damping=0.1))
    wave = {"frequency": float(rng.uniform(1.0, 8.0)), "phase": float(rng.uniform(0.0, 6.0))}
    d.add(cw.Torque("push", shaft=a, torque=cw.Sine(amplitude=log_uniform(rng, 1.0, 100.0), **wave)))
    d.add(cw.Torque("load", shaft=c, torque=float(rng.normal(0.0, 5.0))))
    return d


def drives(seed: int) -> str:
    run = simulate(lossy(seed), T_END)
    return stopped(run) or "; ".join(f"{fault.key}: {fault.words}" for fault in rows.faults(run))


@pytest.mark.random
def test_what_cannot_lock_goes_on_the_way_it_moves() -> None:
    sweep(drives, amount(100))


def pressed(seed: int) -> Any:
    """A damper whose friction grows with the speed of its base, which swings."""
    rng = np.random.default_rng([seed, 32])
    d = cw.Driveline(f"pressed {seed}")
    plates = d.thermal("plates", capacity=500.0)
    a, b = d.shaft("a", inertia=0.05, speed=float(rng.uniform(20.0, 150.0))), d.shaft("b", inertia=0.2)
    friction = {"friction_limit": [1.0, 2.0], "friction_stiffness": [300.0, 500.0]}
    grows = [log_uniform(rng, 1e-5, 1e-3) for _ in range(2)]
    torque = [(-0.5, -200.0), (0.5, 200.0)]
    ends = {"base": a, "follower": b, "heat": plates}
    d.add(cw.TorsionalDamper("damper", torque=torque, friction_speed=grows, **ends, **friction))
    wave = cw.Sine(amplitude=float(rng.uniform(20.0, 200.0)), frequency=float(rng.uniform(1.0, 10.0)))
    d.add(cw.Torque("push", shaft=a, torque=wave))
    return d


def misses(seed: int) -> str:
    """How far the energies are from closing, with what the plates took."""
    run = simulate(pressed(seed), T_END)
    # some end where sliding and sticking follow each other without end, which is open
    share = abs(run.energy.residual) / run.energy.turnover if run.finished else 0.0
    return "" if share < 2e-4 else f"residual {share:.1e} of the turnover"


@pytest.mark.random
def test_heat_is_what_a_spring_does_not_keep() -> None:
    sweep(misses, amount(60))
