"""How many variants go into one chunk: enough that what the executor itself costs does not show."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

from clutchwork.executors.executor import Alive, Executor

# a chunk takes so long, and so many times what the executor needs for it
SECONDS = 2.0
SHARE = 200.0
# chunks of each worker, so that none waits long for the last
FAIR = 4
# more would not fit into little memory
MOST = 65536
# what a run takes is measured over so many seconds
MEASURED = 0.2


def chunk_size(executor: Executor, job: Any, count: int, run: Callable[[int], object]) -> int:
    """Variants of a chunk.

    Parameters: count, variants in all; run, a function that runs so many of them.
    """
    fair = max(1, -(-count // (FAIR * executor.workers)))
    if fair == 1:
        return 1
    taken = seconds_of_one(run, fair)
    wanted = max(SECONDS, SHARE * cost(executor, job))
    return max(1, min(fair, MOST, round(wanted / taken)))


def seconds_of_one(run: Callable[[int], object], count: int) -> float:
    """What a run takes on one thread."""
    number = 1
    while True:
        begun = time.perf_counter()
        run(number)
        taken = time.perf_counter() - begun
        if taken > MEASURED or number == count:
            return max(taken, 1e-9) / number
        number = min(count, 2 * number)


def cost(executor: Executor, job: Any) -> float:
    """What the executor needs for a chunk, beside its runs: seconds of one worker."""
    rounds = 2
    for _ in executor.run(_nothing, job, range(rounds * executor.workers)):
        # the first calls start processes and import what they need
        pass
    begun = time.perf_counter()
    for _ in executor.run(_nothing, job, range(rounds * executor.workers)):
        pass
    return (time.perf_counter() - begun) / rounds


def _nothing(job: Any, piece: Any, alive: Alive) -> None:
    """A task without work."""
