"""Contacts whose directions depend on each other: locked together, the share of each in their load is a convention."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from clutchwork.channels import LOCKED

if TYPE_CHECKING:
    from clutchwork.system import System
    from clutchwork.trajectory import Trajectory

ROUND_OFF = 1e-9
Array = NDArray[np.float64]


@dataclass(frozen=True)
class DependentPhase:
    """A stretch of a run in which contacts that depend on each other are locked."""

    begin: float  # s
    end: float  # s
    contacts: tuple[str, ...]


def dependent_sets(system: System, closed: Collection[str] | None = None) -> tuple[tuple[str, ...], ...]:
    """Sets of contacts, among the named ones or all, that depend on each other when they are locked together.

    Parallel clutches are such a set, or three clutches in a ring. Their motion and the load that they carry together
    are unique; their torques are shared in proportion to capacity.
    """
    places = [i for i, contact in enumerate(system.contacts) if closed is None or contact.name in closed]
    rows = np.asarray(system.contact_rate)[places]
    sizes = np.linalg.norm(rows, axis=1)
    # what only prescribed speeds move has no load to share
    moving = [i for i, size in enumerate(sizes) if size > 0.0]
    groups = _groups(rows[moving] / sizes[moving, None])
    names = [system.contacts[places[i]].name for i in moving]
    return tuple(tuple(names[i] for i in group) for group in groups)


def dependent_phases(run: Trajectory) -> tuple[DependentPhase, ...]:
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
            found[pattern] = dependent_sets(run.system, closed)
        begin, end = float(run.time[first]), float(run.time[stop - 1])
        for group in found[pattern] if end > begin else ():
            stretches = made.setdefault(group, [])
            if stretches and stretches[-1].end == begin:
                begin = stretches.pop().begin
            stretches.append(DependentPhase(begin, end, group))
    return tuple(sorted((phase for phases in made.values() for phase in phases), key=lambda phase: phase.begin))


def _groups(rows: Array) -> list[list[int]]:
    """Places of rows that depend on each other, in blocks that share no row."""
    carriers: list[int] = []
    label = list(range(len(rows)))
    for place, row in enumerate(rows):
        basis = rows[carriers].T
        share = np.linalg.lstsq(basis, row, rcond=None)[0] if carriers else np.empty(0)
        if np.linalg.norm(row - basis @ share) > ROUND_OFF:
            carriers.append(place)
            continue
        for carrier in (c for c, part in zip(carriers, share, strict=True) if abs(part) > ROUND_OFF):
            old, new = label[carrier], label[place]
            label = [new if item == old else item for item in label]
    blocks = [[i for i, item in enumerate(label) if item == block] for block in dict.fromkeys(label)]
    return [block for block in blocks if len(block) > 1]
