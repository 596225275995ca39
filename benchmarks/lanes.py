"""Variants of the six-speed shift: eight in the lanes of one core against one after another, and the same bits."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

import clutchwork as cw
from benchmarks.core import Prepared
from benchmarks.report import Row
from benchmarks.timing import cpu, ratio, rounds
from clutchwork import _core
from support import six_speed

T_END = 4.0
SIDE = 16


def variants() -> list[Any]:
    """Systems of a grid of pressures of the oncoming clutch and of linings."""
    system = six_speed.gearbox(six_speed.SHIFT).assemble()
    pressure = six_speed.SHIFT["F1"]
    found = []
    for lining in np.linspace(0.9, 1.1, SIDE):
        for rise in np.linspace(0.85, 1.15, SIDE):
            changes: dict[str, Any] = {"F1.pressure": cw.Table([(t, float(rise * p)) for t, p in pressure])}
            for name in six_speed.CLUTCHES:
                changes |= {f"{name}.friction.{k}": float(lining) * six_speed.LAW[k] for k in ("slow", "fast")}
            found.append(system.changed(changes))
    return found


class Many:
    """Prepared runs, advanced one by one or in groups."""

    def __init__(self, systems: list[Any]) -> None:
        self.prepared = [Prepared(system, T_END) for system in systems]

    def reset(self) -> None:
        """All of them back to the start."""
        for one in self.prepared:
            one.reset()

    def alone(self) -> None:
        """One after another."""
        for one in self.prepared:
            one.go()

    def together(self) -> None:
        """Eight at a time."""
        for first in range(0, len(self.prepared), 8):
            _core.advance_group([one.run for one in self.prepared[first : first + 8]], T_END)

    def told(self) -> list[bytes]:
        """The last rows, events and counters."""
        return [
            one.run.row().tobytes() + one.run.events().tobytes() + repr(one.run.statistics()).encode()
            for one in self.prepared
        ]


def rows(quick: bool = False) -> Iterator[Row]:
    """The lines of the table."""
    systems = variants()
    alone, together = Many(systems), Many(systems)
    taken = rounds(
        {
            "alone": lambda: cpu(alone.alone, 1, alone.reset),
            "together": lambda: cpu(together.together, 1, together.reset),
        },
        3 if quick else 15,
    )
    gain = ratio(taken["alone"], taken["together"])
    each = min(taken["together"]) / len(systems)
    yield Row(
        f"lanes: {len(systems)} shifts on one core, a second",
        f"{1 / each:.0f}",
        ">= 15000",
        1 / each >= 15000,
    )
    yield Row("lanes: one by one / in groups of eight", f"{gain:.2f}", ">= 2", gain >= 2)
    same = alone.told() == together.told()
    yield Row("lanes: rows, events, counters as alone", "same bits" if same else "DIFFERENT", "same bits", same)
