"""Random drivelines whose gradients are compared to differences of runs: what is asked of each, and what is found."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

import clutchwork as cw
from clutchwork.declare.schema import Role
from clutchwork.model.parts import is_stop
from clutchwork.sweeps.outputs import Output, asked

from . import (
    by_differences,
    free_numbers,
    random_contacts,
    random_drivelines,
    random_laws,
    random_parts,
    random_stops,
    samples,
)

LAWS = samples.declared(Role.LAW)
Case = tuple[cw.Driveline | cw.System, float]
# runs with derivatives; differences are those of runs at 1e-12
TOLERANCES: dict[str, Any] = {"rtol": 1e-12, "atol": 1e-14}
# of the scale of a value, for a number that changes by all of its own scale
ALLOWED = 1e-6
# differences that are further apart say nothing: another event comes between, or a kink is near
DOUBTFUL = 1e-7


def with_law(seed: int) -> Case:
    """Three shafts, a clutch with a random law, a spring, a torque with a ripple and a load."""
    rng, cls = np.random.default_rng(seed), LAWS[seed % len(LAWS)]
    d = cw.Driveline(cls.kind)
    a, b, c = d.shaft("a", inertia=0.5, speed=50.0), d.shaft("b", inertia=0.8), d.shaft("c", inertia=1.0)
    law, press = random_laws.random_law(cls, rng), float(rng.uniform(200.0, 600.0))
    force = cw.Table([(0.0, 50.0), (0.3, press), (0.8, 100.0)])
    d.add(cw.Clutch("c1", base=a, follower=b, friction=law, gain=1.0, normal_force=force))
    d.add(cw.SpringDamper("k", base=b, follower=c, stiffness=800.0, damping=1.0))
    d.add(cw.Torque("t", shaft=a, torque=cw.Sine(amplitude=30.0, frequency=3.0, offset=40.0)))
    d.add(cw.ResistingTorque("r", shaft=c, torque=20.0, speed=1.0))
    return d, 1.0


def of_element(cls: type) -> Case:
    """A driveline with one element, whose shafts turn where nothing speaks against it."""
    system = samples.driveline(cls).assemble()
    for number, node in enumerate(system.nodes):
        place = "position" if node.domain is cw.Domain.TRANSLATION else "angle"
        for name, value in ((f"{node.name}.speed", 12.0 + 7.0 * number), (f"{node.name}.{place}", 0.1 + 0.02 * number)):
            try:
                system = system.changed({name: value})
            except cw.ModelError:
                # it follows from other shafts
                continue
    return system, 0.4


KINDS: dict[str, Callable[[int], Case]] = {
    "clutches": lambda seed: (random_drivelines.describe(seed).driveline(), random_drivelines.T_END),
    "parts": lambda seed: (random_parts.driveline(seed), random_parts.T_END),
    "stops": lambda seed: (random_stops.driveline(seed), random_stops.T_END),
    "contacts": lambda seed: (random_contacts.driveline(seed), random_contacts.T_END),
    "laws": with_law,
}


@dataclass
class Report:
    """How many derivatives were compared, which were not, and which are wrong."""

    compared: int = 0
    doubtful: int = 0
    refused: list[str] = field(default_factory=list)
    noted: list[str] = field(default_factory=list)
    wrong: list[str] = field(default_factory=list)


def outputs(run: cw.Trajectory, rng: np.random.Generator) -> dict[str, Output]:
    """Speeds, heats, peaks, events that happen, and a squared jerk."""
    speeds = [name for name in run.names if name.endswith(".speed")]
    found: list[Any] = [str(name) for name in rng.permutation(speeds)[:2]]
    begin = run.options.t_start
    found.append(cw.at(str(rng.choice(speeds)), begin + float(rng.uniform(0.1, 0.9)) * (run.t_end - begin)))
    stops = [contact.name for contact in run.system.contacts if is_stop(contact)]
    for contact in map(str, rng.permutation([contact.name for contact in run.system.contacts])[:2]):
        # the end of infinitely many bounces comes when they are small enough, one bounce earlier or later
        events = (cw.lock(contact), cw.break_away(contact)) if contact not in stops else ()
        found += [one for one in events if not np.isnan(one.of(run))]
        found += [f"{contact}.heat"] if f"{contact}.heat" in run else []
        found.append(cw.peak(f"{contact}.torque"))
    found.append(cw.squared_jerk(str(rng.choice([node.name for node in run.system.nodes if not node.fixed]))))
    return asked(found)


def checked(case: Case, seed: int, count: int) -> Report:
    """Derivatives of a driveline by some of its numbers against differences of runs."""
    rng, (model, t_end), made = np.random.default_rng(seed), case, Report()
    system = model if isinstance(model, cw.System) else model.assemble()
    run = cw.simulate(system, t_end, rtol=1e-8, atol=1e-10)
    if not run.finished:
        made.refused.append(f"the run: {run.status}")
        return made
    wanted = outputs(run, rng)
    scales = by_differences.scales(run, wanted)
    for one in free_numbers.some(system, rng, count):
        try:
            function = cw.differentiable(system, t_end, of=wanted, by=one.name, **TOLERANCES)
            found = function.gradient()
        except cw.NoGradient as none:
            made.refused += none.problems
            continue
        made.noted += found.notes
        made.refused += found.problems
        for line in by_differences.compared(function, found.matrix, scales):
            _noted(made, function.of, line)
    return made


def _noted(made: Report, names: tuple[str, ...], line: by_differences.Compared) -> None:
    for name, missed, doubt in zip(names, line.missed, line.doubt, strict=True):
        if np.isnan(missed):
            # it is among those that are refused
            continue
        if not doubt < DOUBTFUL:
            made.doubtful += 1
            continue
        made.compared += 1
        if not missed < max(ALLOWED, 100 * doubt):
            # what is told to have few digits has few
            told = made.refused if made.noted else made.wrong
            told.append(f"d {name} / d {line.name}: {missed:.1e} off, differences {doubt:.1e} apart")
