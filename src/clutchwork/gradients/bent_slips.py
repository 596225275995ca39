"""Slips that bend torques where no event is, or as no polynomial does: of bristles, and of powers."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

from clutchwork.assembly.wiring import HOUSING, wiring

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.declare.node import Law
    from clutchwork.gradients.primal import Primal

Array = NDArray[np.float64]

# of shafts in a slip
Shares: TypeAlias = "Mapping[int, float]"
# of the largest slip: at rest
AT_REST = 1e-6


def of_bristles(system: System) -> tuple[Shares, ...]:
    """Slips of contacts whose laws have states, which bend where the slip turns."""
    return _of(system, lambda law: bool(law.own_states()))


def of_powers(system: System) -> tuple[Shares, ...]:
    """Slips of contacts whose laws have a fractional power of the slip."""
    return _of(system, _has_power)


def _has_power(law: Law) -> bool:
    return getattr(law, "shape", "") == "power" and float(getattr(law, "exponent", 1.0)) % 1.0 != 0.0


def _of(system: System, has: Callable[[Law], bool]) -> tuple[Shares, ...]:
    known = wiring(system)
    laws = ((one.direction, one.component.friction) for one in (*known.contacts, *known.elements))
    slips = (ways for ways, law in laws if law is not None and has(law))
    return tuple({node: share for node, share in ways.items() if node != HOUSING} for ways in slips)


def _slips(primal: Primal, some: tuple[Shares, ...]) -> Iterator[Array]:
    """Slips in the rows of each step."""
    first = primal.columns["speed"].start
    for shares in some:
        speeds = primal.rows[primal.steps.rows[:, :, None], first + np.array([*shares], dtype=np.intp)]
        yield speeds @ np.array([*shares.values()])


def turning(primal: Primal, bristles: tuple[Shares, ...]) -> NDArray[np.bool_]:
    """Steps inside of which a slip with bristles changes its sign: no event ends them there."""
    found = np.zeros(len(primal.steps), dtype=bool)
    for slip in _slips(primal, bristles):
        found |= slip.min(axis=1) * slip.max(axis=1) < 0.0
    return found


def resting(primal: Primal, powers: tuple[Shares, ...]) -> NDArray[np.bool_]:
    """Steps in which a slip whose power is in a torque comes to rest or leaves it."""
    found = np.zeros(len(primal.steps), dtype=bool)
    for slip in _slips(primal, powers):
        sizes = np.abs(slip)
        rest = AT_REST * float(sizes.max(initial=0.0))
        found |= (sizes.min(axis=1) <= rest) & (sizes.max(axis=1) > rest)
    return found
