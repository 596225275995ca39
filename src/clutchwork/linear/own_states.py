"""The states of a System that are not speeds: name, unit and scale of each, and which follow from others."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from clutchwork.assembly.shared_states import state_scales
from clutchwork.base import dataclass
from clutchwork.base.arrays import Array
from clutchwork.results.channels import ANGLE

if TYPE_CHECKING:
    from clutchwork.assembly.wiring import Wiring
    from clutchwork.linear.instant import Instant


# what of a rate is left beside others that it may follow from
ROUND_OFF = 1e-9


@dataclass(frozen=True)
class OwnState:
    """One state of the core: as it is shown, value = offset + scale * state."""

    name: str
    unit: str
    scale: float = 1.0
    offset: float = 0.0
    counts: bool = True  # False: only what an ambient has taken up, which nothing depends on


def own_states(wiring: Wiring) -> list[OwnState]:
    """All of them in the order of the core; springs by their twist, thermal nodes by their temperature."""
    made = dict[int, OwnState]()
    for branch in (*wiring.elements, *wiring.contacts):
        passive = branch.component.passive()
        for number, (name, unit, index) in enumerate(branch.states):
            made[index] = OwnState(f"{branch.component.name}.{name}", unit)
            if number == 0 and passive is not None and passive.stiffness:
                made[index] = OwnState(
                    f"{branch.component.name}.twist", ANGLE[branch.domain], 1.0 / float(passive.stiffness)
                )
    for node in wiring.thermal:
        index, capacity = node.states[0][2], node.component.capacity
        if capacity is None:
            made[index] = OwnState(f"{node.name}.heat", "J", counts=False)
        else:
            start = float(node.component.temperature)
            made[index] = OwnState(f"{node.name}.temperature", "K", 1.0 / float(capacity), start)
    for process in wiring.processes:
        for (name, unit, index), scale in zip(process.states, state_scales(process.component), strict=True):
            made[index] = OwnState(f"{process.name}.{name}", unit, float(scale))
    return [made[index] for index in range(len(made))]


def wound_up(instant: Instant, S_r: Array, S_s: Array, S_i: Array) -> NDArray[np.intp]:
    """States that only count how far something has turned: their rates are multiples of one rate, or nothing."""
    branches = (*instant.wiring.elements, *instant.wiring.contacts)
    found = []
    for branch in branches:
        for _, _, index in branch.states:
            if not (S_s[index].any() or S_i[index].any() or np.count_nonzero(S_r[index]) > 1):
                found.append(index)
    return np.array(found, dtype=int)


@dataclass(frozen=True, eq=False)
class Followers:
    """Quantities that turn with others: those that stay, and all over those."""

    kept: NDArray[np.intp]
    over_kept: Array  # one row for each


def apart(count: int) -> Followers:
    """All of them stay."""
    return Followers(np.arange(count), np.eye(count))


def followers(rates: Array) -> Followers:
    """Keep the first independent ones of rows; a row that is a combination of those before follows them from then on.

    docs/theory/linearisation.md (8)
    """
    kept, basis = list[int](), np.zeros((0, rates.shape[1]))
    for number, row in enumerate(rates):
        size = float(np.linalg.norm(row))
        left = row - basis.T @ (basis @ row)
        # twice, so that the basis stays orthogonal to round-off
        left = left - basis.T @ (basis @ left)
        if size > 0.0 and np.linalg.norm(left) > ROUND_OFF * size:
            kept.append(number)
            basis = np.vstack([basis, left / np.linalg.norm(left)])
    if not kept:
        return Followers(np.zeros(0, dtype=int), np.zeros((len(rates), 0)))
    over, *_ = np.linalg.lstsq(rates[kept].T, rates.T, rcond=None)
    cleaned: Array = np.where(np.abs(over.T) > ROUND_OFF, over.T, 0.0).astype(np.float64)
    cleaned[kept] = np.eye(len(kept))
    return Followers(np.array(kept), cleaned)


def preference(instant: Instant) -> Sequence[int]:
    """Independent speeds in the order in which the model names their shafts: the first ones stay."""
    names = [node.name for node in instant.system.nodes]
    places = [names.index(name) for name in instant.system.independent]
    # those without inertia that follow from transmissions go first
    following = {int(i) for i in instant.system.transmission_speed}
    return sorted(range(len(places)), key=lambda i: (i in following, places[i]))
