"""Growth with size: a chain of n shafts and n - 1 clutches."""

from __future__ import annotations

from collections.abc import Iterator

import clutchwork as cw
from benchmarks.core import Prepared
from benchmarks.report import Row

T_END = 2.0


def chain(n: int) -> cw.Driveline:
    """Shafts of different size, clutches with exponential friction, a sine at one end and a load at the other."""
    d = cw.Driveline(f"chain of {n}")
    shafts = [d.shaft(f"s{i}", inertia=0.2 + 0.1 * (i % 5), speed=100.0 * (1 - i / n)) for i in range(n)]
    for i in range(n - 1):
        law = cw.Exponential(static=0.16, slow=0.14, fast=0.09, speed=20.0)
        force = cw.Sine(amplitude=40.0, frequency=0.3 + 0.07 * (i % 7), offset=150.0 + 11.0 * (i % 4), phase=0.5 * i)
        d.add(cw.Clutch(f"c{i}", base=shafts[i], follower=shafts[i + 1], friction=law, gain=1.0, normal_force=force))
    d.add(cw.Torque("drive", shaft=shafts[0], torque=cw.Sine(amplitude=60.0, frequency=1.0, offset=20.0)))
    d.add(cw.ResistingTorque("load", shaft=shafts[-1], torque=15.0, speed=1.0))
    return d


def rows(quick: bool = False) -> Iterator[Row]:
    """Microseconds per step for each size."""
    for n in (2, 4, 8, 16, 32, 64):
        prepared = Prepared(chain(n).assemble(), T_END)
        taken = prepared.seconds(3 if quick else 15)
        count = prepared.statistics()
        steps = count["steps"] + count["rejected"]
        each = 1e6 * taken / steps
        figures = f"{each:.1f} us/step, {steps} steps, {count['events']} events"
        yield Row(
            f"chain of {n} shafts and {n - 1} clutches",
            figures,
            "<= 60 us/step" if n == 64 else "",
            each <= 60 if n == 64 else None,
        )
