"""Runs of the compiled core without the Python layers: what there is to time."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from benchmarks.timing import cpu
from clutchwork import _core
from clutchwork.declare.layout import STATUS

METHODS = {"auto": 0.0, "rodas5p": 1.0, "dopri5": 2.0}
EMPTY = np.zeros(0)
EVENTS_FULL = [name for name, *_ in STATUS].index("events_full")


class Prepared:
    """A System in a run that is put back to its start before each timing."""

    def __init__(self, system: Any, t_end: float, method: str = "rodas5p", **options: float) -> None:
        self.run = _core.Run(system.to_bytes())
        chosen = {"rtol": 1e-6, "atol": 1e-8, "method": METHODS[method], "angles": 0.0, "work": 0.0, **options}
        for name, value in chosen.items():
            self.run.set_option(name, value)
        self.t_end = t_end
        self.rows = np.zeros((0, len(self.run.row())))
        self.start = self.run.save()

    def reset(self) -> None:
        """Back to the start."""
        self.run.restore(self.start)

    def go(self) -> None:
        """The whole run, no output."""
        while status := self.run.advance(self.t_end, EMPTY, self.rows, 0, False)[0]:
            if status != EVENTS_FULL:
                raise RuntimeError(f"the run ended with status {status}")
            self.run.events()

    def seconds(self, repeats: int) -> float:
        """Median CPU time of one run [s]."""
        return cpu(self.go, repeats, self.reset)

    def measure(self, repeats: int) -> Callable[[], float]:
        """The same as a contestant."""
        return lambda: self.seconds(repeats)

    def statistics(self) -> dict[str, int]:
        """Counts of one run."""
        self.reset()
        self.go()
        return dict(self.run.statistics())


def place(system: Any, name: str) -> int:
    """Where the core finds the number that a parameter is."""
    (found,) = system.parameters[name].reach["params"].tolist()
    return int(found)
