"""Paired timing: every contestant once per round, ratios within the round, medians over the rounds.

CPU time of the thread, not time on the wall: the machine may be shared. A ratio within a round cancels most of what
the machine does to both.
"""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable, Mapping


def cpu(function: Callable[[], object], repeats: int = 1, before: Callable[[], object] | None = None) -> float:
    """Median CPU time of one call [s]; `before` runs untimed ahead of each."""
    taken = []
    for _ in range(repeats):
        if before:
            before()
        start = time.thread_time_ns()
        function()
        taken.append(time.thread_time_ns() - start)
    return 1e-9 * statistics.median(taken)


def wall(function: Callable[[], object], repeats: int = 1) -> float:
    """Median time on the wall of one call [s]."""
    taken = []
    for _ in range(repeats):
        start = time.perf_counter()
        function()
        taken.append(time.perf_counter() - start)
    return statistics.median(taken)


def rounds(contestants: Mapping[str, Callable[[], float]], count: int) -> dict[str, list[float]]:
    """Seconds of each contestant in each round."""
    found: dict[str, list[float]] = {name: [] for name in contestants}
    for _ in range(count):
        for name, measure in contestants.items():
            found[name].append(measure())
    return found


def tenth_of(times: list[float]) -> float:
    """What a tenth of the times lies below: the quiet moments of a machine that is shared."""
    return sorted(times)[len(times) // 10]


def ratio(one: list[float], other: list[float]) -> float:
    """Median over the rounds of one / other."""
    return statistics.median(a / b for a, b in zip(one, other, strict=True))
