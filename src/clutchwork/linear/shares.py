"""How the torques of locked contacts follow a load that changes: docs/theory/linearisation.md (9)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from clutchwork.base import dataclass
from clutchwork.base.arrays import Array

ROUND_OFF = 1e-9


@dataclass(frozen=True, eq=False)
class Holding:
    """Locked contacts at an instant."""

    B: Array  # their directions over the speeds, one per row
    torque: Array  # N m
    bound: Array  # N m, largest torque of each forward, then backward; may be infinite
    bound_change: Array  # its derivative


def torque_change(held: Holding, load_change: Array) -> Array:
    """Derivatives of the torques of locked contacts from those of the load B' torque that they carry together."""
    changes = np.zeros((len(held.B), load_change.shape[1]))
    rows = np.flatnonzero(np.max(np.abs(held.B), axis=1, initial=0.0) > 0.0)
    if not rows.size:
        return changes
    B = held.B[rows]
    weight, given = np.ones(len(rows)), np.zeros((len(rows), load_change.shape[1]))
    for members in _sets(B):
        weight[members], given[members] = _shares(held, rows[members])
    # in the scale of the directions, so that the rank is found whatever their units
    stiffness = B.T @ (weight[:, None] * B)
    deflection = np.linalg.pinv(stiffness, rcond=1e-12, hermitian=True) @ (load_change - B.T @ given)
    changes[rows] = weight[:, None] * (B @ deflection) + given
    return changes


def dependent(B: Array) -> NDArray[np.bool_]:
    """Which rows are combinations of others, so that their torques are not unique."""
    if not len(B):
        return np.zeros(0, dtype=bool)
    scaled = B / np.linalg.norm(B, axis=1, keepdims=True)
    left, sizes, _ = np.linalg.svd(scaled, full_matrices=True)
    rank = int(np.sum(sizes > ROUND_OFF * max(sizes[0], 1.0)))
    found: NDArray[np.bool_] = np.linalg.norm(left[:, rank:], axis=1) > ROUND_OFF
    return found


def _sets(B: Array) -> list[NDArray[np.intp]]:
    """Rows that depend on each other, set by set."""
    rows = np.flatnonzero(dependent(B))
    if not rows.size:
        return []
    scaled = B[rows] / np.linalg.norm(B[rows], axis=1, keepdims=True)
    left, sizes, _ = np.linalg.svd(scaled, full_matrices=True)
    rank = int(np.sum(sizes > ROUND_OFF * sizes[0]))
    joined = np.abs(left[:, rank:] @ left[:, rank:].T) > ROUND_OFF
    found, seen = [], set[int]()
    for first in range(len(rows)):
        if first in seen:
            continue
        members, grown = {first}, True
        while grown:
            more = {int(k) for k in np.flatnonzero(joined[sorted(members)].any(axis=0))}
            grown = not more <= members
            members |= more
        seen |= members
        found.append(rows[sorted(members)])
    return found


def _shares(held: Holding, members: NDArray[np.intp]) -> tuple[Array, Array]:
    """Stiffness of each contact of a set in its share of the load, and what its torque gains with its bound."""
    bounds, changes, torque = held.bound[:, members], held.bound_change[:, members], held.torque[members]
    way, every = np.where(torque > 0.0, 0, 1), np.arange(len(members))
    bound, change = bounds[way, every], changes[way, every]
    finite = np.isfinite(bound)
    # one without a bound counts with the mean of what all others carry together in both ways
    known = np.isfinite(bounds)
    free, free_change = 0.5 * bounds[known].sum(), 0.5 * changes[known].sum(axis=0)
    if free == 0.0:
        free, free_change = 1.0, np.zeros_like(free_change)
    bound, change = np.where(finite, bound, free), np.where(finite[:, None], change, free_change)
    size = np.where(bound > 0.0, bound, 1.0)
    at_bound = finite & (np.abs(torque) >= (1.0 - 1e-12) * bound)
    stiffness = np.where(at_bound, 0.0, bound)
    # freewheels that hold nothing have no share that could change
    stiffness = stiffness / stiffness.max() if stiffness.any() else np.ones(len(members))
    return stiffness, (torque / size)[:, None] * change
