"""Contacts whose directions depend on each other: locked together, the share of each in their load is a convention."""

from __future__ import annotations

from collections.abc import Collection, Sequence

import numpy as np
from numpy.typing import NDArray

ROUND_OFF = 1e-9
Array = NDArray[np.float64]


def dependent_sets(
    names: Sequence[str], rates: Array, closed: Collection[str] | None = None
) -> tuple[tuple[str, ...], ...]:
    """Sets of contacts, among the closed ones or all, that depend on each other when they are locked together.

    `rates` are the directions of the named contacts over the independent speeds, one per row. Parallel clutches are
    such a set, or three clutches in a ring. Their motion and the load that they carry together are unique; their
    torques are shared in proportion to capacity.
    """
    places = [place for place, name in enumerate(names) if closed is None or name in closed]
    rows = np.asarray(rates)[places]
    sizes = np.linalg.norm(rows, axis=1)
    # what only prescribed speeds move has no load to share
    moving = [i for i, size in enumerate(sizes) if size > 0.0]
    groups = _groups(rows[moving] / sizes[moving, None])
    return tuple(tuple(names[places[moving[i]]] for i in group) for group in groups)


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
