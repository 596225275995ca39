"""When contacts were locked whose directions depend on each other."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from clutchwork.assembly.dependence import dependent_sets
from clutchwork.results.channels import LOCKED

if TYPE_CHECKING:
    from clutchwork.results.recorded import Recorded


@dataclass(frozen=True)
class DependentPhase:
    """A stretch of a run in which contacts that depend on each other are locked."""

    begin: float  # s
    end: float  # s
    contacts: tuple[str, ...]


def dependent_phases(run: Recorded) -> tuple[DependentPhase, ...]:
    """When contacts of a run were locked that depend on each other."""
    names = [branch.name for branch in run.wiring.contacts]
    locked = run.rows[:, run.wiring.columns["contact_mode"]] == LOCKED
    cuts = [0, *(np.flatnonzero(np.any(locked[1:] != locked[:-1], axis=1)) + 1), len(run)]
    found: dict[tuple[bool, ...], tuple[tuple[str, ...], ...]] = {}
    made: dict[tuple[str, ...], list[DependentPhase]] = {}
    for first, stop in pairwise(cuts):
        pattern = tuple(locked[first].tolist())
        if pattern not in found:
            closed = [name for name, is_locked in zip(names, pattern, strict=True) if is_locked]
            found[pattern] = dependent_sets(names, run.system.contact_rate, closed)
        begin, end = float(run.time[first]), float(run.time[stop - 1])
        for group in found[pattern] if end > begin else ():
            stretches = made.setdefault(group, [])
            if stretches and stretches[-1].end == begin:
                begin = stretches.pop().begin
            stretches.append(DependentPhase(begin, end, group))
    return tuple(sorted((phase for phases in made.values() for phase in phases), key=lambda phase: phase.begin))
