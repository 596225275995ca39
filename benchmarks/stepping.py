"""A step from outside: what setting, advancing and reading in Python cost above the core."""

from __future__ import annotations

import statistics
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

import clutchwork as cw
from benchmarks.core import EMPTY, EVENTS_FULL
from benchmarks.report import Row
from benchmarks.timing import cpu, rounds, wall
from clutchwork import _core
from support import six_speed

STEP, COUNT = 0.01, 400  # s; the shift of 4 s
NAME, READ = "F1.pressure", "w1.speed"
PRESSURES = np.interp(np.arange(COUNT) * STEP, [2.0, 2.2, 3.0, 3.2], [0.0, 0.25e6, 0.6e6, 2e6]).tolist()


class Core:
    """The same steps, called directly: a signal is set, the core runs, nothing is kept or read."""

    def __init__(self, system: Any) -> None:
        self.run = _core.Run(system.to_bytes())
        self.input = [item.name for item in system.inputs].index(NAME)
        self.run.expect_inputs(True)
        self.rows = np.zeros((0, len(self.run.row())))
        self.start = self.run.save()

    def reset(self) -> None:
        """Back to the start."""
        self.run.restore(self.start)

    def go(self) -> None:
        """All steps."""
        run, rows = self.run, self.rows
        for number, pressure in enumerate(PRESSURES, 1):
            run.set_input(self.input, pressure)
            while run.advance(number * STEP, EMPTY, rows, 0, False)[0] == EVENTS_FULL:
                run.events()


def rows(quick: bool = False) -> Iterator[Row]:
    """The lines of the table."""
    system = six_speed.gearbox(six_speed.SHIFT).assemble()
    core, sim = Core(system), cw.Simulator(system)

    def steps() -> None:
        for pressure in PRESSURES:
            sim.set(NAME, pressure)
            sim.advance(STEP)
            _ = sim[READ]

    state = sim.save()
    repeats = 5 if quick else 25
    contestants = {
        "core": lambda: cpu(core.go, repeats, core.reset),
        "steps": lambda: cpu(steps, repeats, sim.reset),
        "reset": lambda: cpu(sim.reset, 40 * repeats),
        "restore": lambda: cpu(lambda: sim.restore(state), 40 * repeats),
        "save": lambda: cpu(sim.save, 40 * repeats),
    }
    taken = rounds(contestants, 3 if quick else 9)
    above = [1e6 * (a - b) / COUNT for a, b in zip(taken["steps"], taken["core"], strict=True)]
    middle = {name: 1e6 * statistics.median(times) for name, times in taken.items()}
    yield Row("stepping: core alone, a step of 10 ms of the shift", f"{middle['core'] / COUNT:.1f} us")
    found = statistics.median(above)
    yield Row("stepping: set, advance 10 ms, read, above the core", f"{found:.1f} us", "<= 15 us", found <= 15.0)
    figures = ", ".join(f"{middle[name]:.0f} us" for name in ("reset", "save", "restore"))
    yield Row("stepping: reset, save, restore", figures)
    yield from many(quick)


def joint() -> cw.Driveline:
    """A joint drive of a robot: a rotor with a brake that sticks, a gear with losses, a flexible shaft."""
    d = cw.Driveline("joint")
    rotor, flange = d.shaft("rotor", inertia=1.5e-4), d.shaft("flange", inertia=0.02)
    link = d.shaft("link", inertia=0.6)
    d.add(cw.Torque("motor", shaft=rotor, torque=0.0))
    stiction = cw.Stribeck(static=0.03, kinetic=0.02, speed=2.0)
    d.add(cw.Brake("seal", shaft=rotor, friction=stiction, gain=1.0, normal_force=1.0))
    d.add(cw.LossyGear("gear", input=rotor, output=flange, ratio=100.0, efficiency=0.7))
    d.add(cw.SpringDamper("spring", base=flange, follower=link, stiffness=8000.0, damping=8.0))
    return d


# runs side by side: the model, what is set and read, between which ends, and the goal of fixed steps [1/s]
SIDE_BY_SIDE = (
    ("joints", joint, "motor.torque", "rotor.speed", (-0.5, 0.5), 2e6),
    ("six-speed boxes", lambda: six_speed.gearbox(six_speed.SHIFT), NAME, READ, (0.0, 1e6), 4e5),
)
FIXED: dict[str, Any] = {"method": "fixed", "step": 1e-3}


@dataclass(frozen=True)
class Loop:
    """Steps of 1 ms of many runs: a signal is set to values of their own between two ends, all go on, one is read."""

    sims: cw.Simulators
    signal: str
    read: str
    ends: tuple[float, float]
    steps: int
    held: bool = False

    def go(self) -> None:
        """All steps; the values of the first one stay where they are held."""
        scatter = np.random.default_rng(1)
        for step in range(self.steps):
            if step == 0 or not self.held:
                self.sims[self.signal] = scatter.uniform(*self.ends, len(self.sims))
            self.sims.advance(1e-3)
            _ = self.sims[self.read]

    def a_second(self, rounds: int) -> float:
        """Steps a second on the wall, at the best of some rounds."""
        return self.steps * len(self.sims) / min(wall(self.go) for _ in range(rounds))


def missed(model: Any, signal: str, read: str, ends: tuple[float, float], steps: int) -> str:
    """The largest error of what is read behind a loop of fixed steps, and the largest of it."""
    system, found = model().assemble(), []
    for how in (FIXED, {"rtol": 1e-9, "atol": 1e-12}):
        loop = Loop(cw.Simulators(system, 32, threads=2, **how), signal, read, ends, steps)
        loop.go()
        found.append(loop.sims[read])
    return f"off by {np.abs(found[0] - found[1]).max():.1g} of {np.abs(found[1]).max():.0f} rad/s"


def many(quick: bool) -> Iterator[Row]:
    """Steps of 1 ms of many runs side by side, on two threads."""
    count, steps = 1024, 20 if quick else 100
    for what, model, signal, read, ends, goal in SIDE_BY_SIDE:
        for method, held in ((FIXED, False), (FIXED, True), ({}, False), ({}, True)):
            loop = Loop(cw.Simulators(model(), count, threads=2, **method), signal, read, ends, steps, held)
            a_second = loop.a_second(3 if quick else 10)
            words = f"stepping: {count} {what} side by side, 1 ms, {'fixed steps' if method else 'adaptive'}, "
            words += f"{signal.partition('.')[2]} {'held' if held else 'set in each'}"
            figure = f"{1e-3 * a_second:.0f} 000 a second"
            if method and not held:
                figure += f", {missed(model, signal, read, ends, steps)}"
                yield Row(words, figure, f">= {goal:,.0f}".replace(",", " "), a_second >= goal)
            else:
                yield Row(words, figure)
