"""When contacts were locked whose directions depend on each other."""

from __future__ import annotations

from clutchwork.assembly.dependence import dependent_sets
from clutchwork.assembly.sparse import entries
from clutchwork.base import dataclass
from clutchwork.results.locked_intervals import stretches
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
    rates = entries(run.system.arrays, "contact_rate")
    made: dict[tuple[str, ...], list[DependentPhase]] = {}
    found: dict[tuple[str, ...], tuple[tuple[str, ...], ...]] = {}
    for part in stretches(run):
        if part.locked not in found:
            found[part.locked] = dependent_sets(names, rates, part.locked)
        for group in found[part.locked] if part.end > part.begin else ():
            begin, phases = part.begin, made.setdefault(group, [])
            if phases and phases[-1].end == begin:
                begin = phases.pop().begin
            phases.append(DependentPhase(begin, part.end, group))
    return tuple(sorted((phase for phases in made.values() for phase in phases), key=lambda phase: phase.begin))
