"""A run cut where its contacts lock or break away."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from clutchwork.results.channels import LOCKED
from clutchwork.results.recorded import Recorded


class Stretch(NamedTuple):
    """A stretch of a run in which the same contacts are locked, which may last no time."""

    begin: float  # s
    end: float  # s
    locked: tuple[str, ...]
    run: Recorded  # with instants just before and after every event
    last: int  # its last instant there


def in_full(run: Recorded) -> Recorded:
    """A run with the times of its events, even where the output has a grid of its own."""
    if len(run) and run.finished and (run.options.dt is not None or run.options.times is not None):
        ends = [run.time[0], run.time[-1]]
        at = np.array([event.time for event in run.events if ends[0] < event.time < ends[1]])
        # just before and just after each event
        return run.at([*ends, *at, *np.nextafter(at, ends[1])])
    return run


def stretches(run: Recorded) -> Iterator[Stretch]:
    """All of them."""
    run = in_full(run)
    names = [branch.name for branch in run.wiring.contacts]
    locked = run.rows[:, run.wiring.columns["contact_mode"]] == LOCKED
    cuts = [0, *(np.flatnonzero(np.any(locked[1:] != locked[:-1], axis=1)) + 1), len(run)]
    begin = float(run.time[0]) if len(run) else 0.0
    for first, stop in pairwise(cuts):
        closed = tuple(name for name, is_locked in zip(names, locked[first], strict=True) if is_locked)
        end = float(run.time[stop - 1])
        yield Stretch(begin, end, closed, run, stop - 1)
        begin = end
