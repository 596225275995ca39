"""Energies of a run: the balance closes, and what is lost is never given back."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from clutchwork.declare.node import Work
from support.any_model.seen import Fault, Seen

# of energies beside the largest one of the run
ENERGY = 1e-4
# the same where torques turn around within steps, of which no quadrature knows: a few of some hundred steps
TURNING = 1e-2
WORKS = ("element_work", "contact_work", "prescribed_work")


def energies(seen: Seen) -> Iterator[Fault]:
    """The balance of energies closes."""
    # torques that turn around from step to step until a run ends have no work
    if seen.chatters and seen.run.status != "done":
        return
    found = seen.run.energy
    kinetic = 0.5 * (seen.inertia * seen.speed**2).sum(axis=1)
    # work goes back and forth: what passes counts, not what is left of it
    works = [float(np.abs(np.diff(seen.part(name), axis=0)).sum()) for name in WORKS]
    size = max(found.turnover, float(kinetic.max(initial=0.0)), *works, 1e-6)
    if abs(found.residual) > max(TURNING if seen.chatters else ENERGY, 100.0 * seen.rtol) * size:
        varying = {seen.kind(seen.wiring.elements[numbers[0]]) for numbers in seen.numbers(Work(0))}
        yield Fault("energy", "+".join(sorted(varying)), f"residual {found.residual:.3g} of {size:.3g} J")


def heats(seen: Seen) -> Iterator[Fault]:
    """What an element loses, its work less what it stores, never falls."""
    states, torque, work = seen.part("state"), seen.part("element_torque"), seen.part("element_work")
    for (number,) in (numbers for numbers in seen.numbers(Work.STORE | Work.LOSS) if len(numbers) == 1):
        branch = seen.wiring.elements[number]
        places = [index for *_, index in branch.states]
        pairs = zip(states[:, places].tolist(), torque[:, number].tolist(), strict=True)
        stored = np.array([branch.component.stored(row, along) for row, along in pairs])
        lost = -work[:, number] - stored
        size = np.abs(np.diff(work[:, number])).sum() + np.abs(stored).max(initial=0.0)
        fall = float((np.maximum.accumulate(lost) - lost).max(initial=0.0))
        if fall > max(ENERGY, 100.0 * seen.rtol) * size + 1e-9:
            yield Fault("heat", seen.kind(branch), f"{branch.name} gives back {fall:.3g} of {size:.3g} J of heat")
