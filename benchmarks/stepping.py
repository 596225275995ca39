"""A step from outside: what setting, advancing and reading in Python cost above the core."""

from __future__ import annotations

import statistics
from collections.abc import Iterator
from typing import Any

import numpy as np

import clutchwork as cw
from benchmarks.core import EMPTY, EVENTS_FULL
from benchmarks.report import Row
from benchmarks.timing import cpu, rounds
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
