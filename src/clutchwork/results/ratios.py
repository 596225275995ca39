"""Speed ratios that follow from gears and closed contacts alone; springs count as rigid."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from itertools import combinations
from math import comb
from typing import TYPE_CHECKING

import numpy as np

from clutchwork.assembly.wiring import HOUSING, Wiring, wiring
from clutchwork.base import dataclass
from clutchwork.declare.node import Work
from clutchwork.results.gears import rows_of
from clutchwork.results.locked_intervals import stretches

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from clutchwork.assembly.system import System
    from clutchwork.results.recorded import Recorded

ROUND_OFF = 1e-9
MOST_COMBINATIONS = 5_000


@dataclass(frozen=True)
class Phase:
    """A stretch of a run in which the same contacts are locked."""

    begin: float  # s
    end: float  # s
    closed: tuple[str, ...]
    kinematic: float | None  # ratio of the two shafts by gears and locked contacts; None: free
    measured: float  # ratio of their speeds at the end of the phase


def input_and_output(parts: Wiring) -> tuple[str, str] | None:
    """The shafts of the first and of the last source in a model: drive and load, when they differ."""
    sources = [branch for branch in (*parts.motions, *parts.elements) if Work.SOURCE in branch.component.work]
    moving = [[node for node, factor in b.direction.items() if node != HOUSING and factor > 0.0] for b in sources]
    shafts = [parts.nodes[nodes[0]].name for nodes in moving if nodes]
    return (shafts[0], shafts[-1]) if shafts and shafts[0] != shafts[-1] else None


def follows_from(system: System) -> str:
    """What the ratio of two shafts follows from while contacts are closed, for the head of a table."""
    if system.gears:
        return "by gears"
    springs = any(branch.component.elastic for branch in wiring(system).elements)
    return "with rigid springs" if springs else "by locked contacts"


def head_of(system: System, shafts: tuple[str, str]) -> str:
    """The head of a table of ratios; what they follow from is said where there are no gears."""
    plain = f"{shafts[0]}/{shafts[1]}"
    return plain if system.gears else f"{plain} {follows_from(system)}"


def ratio(system: System, closed: Collection[str], shafts: tuple[str, str]) -> float | None:
    """Speed of the first shaft over that of the second with the named contacts closed.

    None when it is not determined; infinite when the second shaft is held.
    """
    free = free_motions(system, closed)
    names = [node.name for node in system.nodes]
    upper, lower = (free[names.index(name)] for name in shafts)
    size = float(np.max(np.abs(np.concatenate([upper, lower])), initial=0.0))
    if size <= ROUND_OFF:
        return None
    if np.max(np.abs(lower)) <= ROUND_OFF * size:
        return float("inf")
    value = float(upper @ lower / (lower @ lower))
    return value if np.allclose(upper, value * lower, rtol=0.0, atol=ROUND_OFF * size) else None


@dataclass(frozen=True)
class Gears:
    """Smallest sets of closed contacts that fix a finite ratio other than zero, with that ratio."""

    ratios: tuple[tuple[tuple[str, ...], float], ...]
    untried: int | None  # sets of that many contacts or more were not tried; None: all were


def gears(system: System, shafts: tuple[str, str]) -> Gears:
    """Look for the gears of a model, up to sets of as many contacts as can be tried in a moment."""
    names, tried = [contact.name for contact in system.contacts], 0
    if system.gearboxes:
        return Gears(tuple(_by_name(system, shafts, names)), None)
    for size in range(len(names) + 1):
        tried += comb(len(names), size)
        if tried > MOST_COMBINATIONS:
            return Gears(tuple(_gears(system, shafts, names, size)), size)
    return Gears(tuple(_gears(system, shafts, names, len(names) + 1)), None)


def _by_name(system: System, shafts: tuple[str, str], names: list[str]) -> Iterator[tuple[tuple[str, ...], float]]:
    """The gears of the shift tables, each with as few of the other contacts as fix a ratio, one at most."""
    inside = {name for table in system.gearboxes for name in table.elements}
    others = [(), *((name,) for name in names if name not in inside)]
    for row in rows_of(system):
        for some in others:
            value = ratio(system, (*row, *some), shafts)
            if value is not None:
                if np.isfinite(value) and abs(value) > ROUND_OFF:
                    yield (*row, *some), value
                break


def _gears(
    system: System, shafts: tuple[str, str], names: list[str], sizes: int
) -> Iterator[tuple[tuple[str, ...], float]]:
    found: list[tuple[str, ...]] = []
    for size in range(sizes):
        for closed in combinations(names, size):
            value = None if any(set(less) <= set(closed) for less in found) else ratio(system, closed, shafts)
            if value is not None:
                found.append(closed)
                if np.isfinite(value) and abs(value) > ROUND_OFF:
                    yield closed, value


def phases(run: Recorded, shafts: tuple[str, str]) -> list[Phase]:
    """The run cut where a contact locks or breaks away."""
    made = []
    for part in stretches(run):
        if part.end > part.begin:
            upper, lower = (float(part.run[f"{name}.speed"][part.last]) for name in shafts)
            measured = upper / lower if lower else float("inf")
            known = ratio(run.system, part.locked, shafts)
            made.append(Phase(part.begin, part.end, part.locked, known, measured))
    return made


def free_motions(system: System, closed: Collection[str]) -> NDArray[np.float64]:
    """Node speeds of all motions that closed contacts and rigid springs leave, one per column."""
    rigid = [contact.name in closed for contact in system.contacts]
    springs = [branch.component.elastic for branch in wiring(system).elements]
    contacts = np.hstack([system.contact_rate, system.contact_rate_prescribed])[rigid]
    shafts = np.hstack([system.element_rate, system.element_rate_prescribed])[springs]
    basis = np.hstack([system.basis, system.basis_prescribed])
    _, sizes, turned = np.linalg.svd(np.vstack([contacts, shafts]), full_matrices=True)
    rank = int(np.sum(sizes > ROUND_OFF * max(1.0, float(np.max(sizes, initial=0.0)))))
    return np.asarray(basis @ turned[rank:].T)
