"""Growth with size: a chain of n shafts and n - 1 clutches."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import pairwise
from math import log2
from time import process_time

import clutchwork as cw
from benchmarks.core import EMPTY, Prepared, place
from benchmarks.report import Row
from benchmarks.timing import cpu
from support import many_contacts

T_END = 2.0
# targets for the time of a step; that of 256 is 0.35 of what dense matrices took
MOST_MICROSECONDS = {64: 45, 256: 310}
# slip that 64 equal clutches on one hub lose per second
STAR_SLOPE = 10.0 / many_contacts.INERTIA * (1.0 + 64 / 10.0)


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
    """Time of a step over the size, of a change of mode, of a large model, and of many contacts at once."""
    yield from steps(3 if quick else 15)
    yield from mode_changes(3 if quick else 9)
    yield large()
    yield from at_once(3 if quick else 15)
    yield powers("thermal chain, power of n in a step, 50 to 200", warm, (50, 200), 0.01, 1.3)
    yield powers(
        "contacts on one hub, power of n in a run until all slip, 64 to 256", many_contacts.star, (64, 256), 2.01, 2.0
    )


def steps(repeats: int) -> Iterator[Row]:
    """Microseconds per step for each size, and the power of the size with which they grow at the end."""
    each = {}
    for n in (2, 4, 8, 16, 32, 64, 128, 256):
        prepared = Prepared(chain(n).assemble(), T_END)
        taken = prepared.seconds(repeats)
        count = prepared.statistics()
        taken_steps = count["steps"] + count["rejected"]
        each[n] = 1e6 * taken / taken_steps
        figures = f"{each[n]:.1f} us/step, {taken_steps} steps, {count['events']} events"
        most = MOST_MICROSECONDS.get(n)
        target = "" if most is None else f"<= {most} us/step"
        met = None if most is None else each[n] <= most
        yield Row(f"chain of {n} shafts and {n - 1} clutches", figures, target, met)
    power = log2(each[256] / each[64]) / 2
    yield Row("chain, power of n in a step with its events, 64 to 256", f"{power:.2f}", "<= 1.3", power <= 1.3)


def mode_changes(repeats: int) -> Iterator[Row]:
    """A decision over all contacts and the reduction to its modes, with one evaluation of the motion."""
    taken = {n: change(n, repeats) for n in (128, 256, 512)}
    figures = ", ".join(f"{1e3 * seconds:.2f}" for seconds in taken.values())
    power = log2(taken[512] / taken[128]) / 2
    yield Row(
        "mode change in a chain of 128, 256, 512 shafts", f"{figures} ms, power {power:.2f}", "power <= 2", power <= 2
    )


def change(n: int, repeats: int) -> float:
    """Seconds of one change of mode in a chain that has run for a second: a parameter that is set asks for it."""
    system = chain(n).assemble()
    prepared = Prepared(system, 1.0)
    prepared.reset()
    prepared.go()
    number = place(system, "c0.gain")

    def ask() -> None:
        for _ in range(10):
            prepared.run.set_param(number, 1.0)
            prepared.run.advance(1.0, EMPTY, prepared.rows, 0, False)

    return cpu(ask, repeats) / 10


def large() -> Row:
    """From the first line of a model with 1024 shafts to 0.1 s of its motion."""
    start = process_time()
    prepared = Prepared(chain(1024).assemble(), 0.1)
    before = process_time() - start
    prepared.go()
    taken = process_time() - start
    count = prepared.run.statistics()
    size = prepared.run.memory_size / 1e6
    figures = f"{taken:.1f} s, {before:.1f} s before it, {count['events']} events, {size:.1f} MB"
    return Row("chain of 1024 shafts, 0.1 s of motion", figures, "<= 60 s, <= 10 MB", taken <= 60 and size <= 10)


def warm(n: int) -> cw.Driveline:
    """A chain of n shafts with a thermal mass at every clutch, each cooled by the air."""
    d = cw.Driveline(f"warm chain of {n}")
    shafts = [d.shaft(f"s{i}", inertia=0.2 + 0.1 * (i % 5), speed=100.0 * (1 - i / n)) for i in range(n)]
    air, law = d.ambient("air"), cw.Coulomb(static=0.16, kinetic=0.12)
    for i, (base, follower) in enumerate(pairwise(shafts)):
        plates, force = d.thermal(f"plates{i}", capacity=1000.0 + i % 3), 150.0 + i % 4
        d.add(cw.Clutch(f"c{i}", base=base, follower=follower, friction=law, gain=1.0, normal_force=force, heat=plates))
        d.add(cw.Conduction(f"air{i}", hot=plates, cold=air, conductance=2.0))
    return d


def powers(what: str, model: Callable[[int], cw.Driveline], sizes: tuple[int, int], t_end: float, most: float) -> Row:
    """The power of the size with which the time of a step grows."""
    taken = []
    for n in sizes:
        prepared = Prepared(model(n).assemble(), t_end)
        taken.append(prepared.seconds(3) / prepared.statistics()["steps"])
    power = log2(taken[1] / taken[0]) / log2(sizes[1] / sizes[0])
    return Row(what, f"{power:.2f}", f"<= {most}", power <= most)


def at_once(repeats: int) -> Iterator[Row]:
    """What one instant costs at which 64 contacts lock, or break away, over the same run that ends before."""
    for what, model, instant in (
        ("lock, each beside two others", many_contacts.row(64), many_contacts.LOCK),
        ("lock, all on one hub", many_contacts.star(64), many_contacts.SLIP / STAR_SLOPE),
        ("break away, all on one hub", many_contacts.star(64), 2.0),
    ):
        system = model.assemble()
        ends = [Prepared(system, instant + shift).seconds(repeats) for shift in (-1e-6, 1e-6)]
        yield Row(f"64 contacts {what}", f"{1e3 * (ends[1] - ends[0]):.2f} ms", "<= 10 ms", ends[1] - ends[0] <= 10e-3)
