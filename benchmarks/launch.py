"""The optimal launch: least heat with a bounded jerk and least squared jerk, 16 random ones of each, beside nosnoc."""

from __future__ import annotations

import statistics
import time
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from benchmarks.peers import by_nosnoc
from benchmarks.report import Row
from support.launches import Launch, costs, draws

COUNT = 16
GOALS = {"heat": "least heat", "jerk": "least squared jerk"}
# s for one problem
TARGETS = {15: 0.1, 30: 0.3}
# limits and first-order optimality, in shares of their scales
TIGHT = 1e-6


class Ours(NamedTuple):
    """What one problem took here."""

    solved: bool
    cost: float
    seconds: float  # processor time


def ours(launch: Launch, goal: str, pieces: int) -> Ours:
    """Assembling, checking and searching, from the driveline on."""
    begun = time.process_time()
    found = launch.least_heat(pieces) if goal == "heat" else launch.least_jerk(pieces)
    taken = time.process_time() - begun
    proof = found.certificate
    return Ours(proof.violation <= TIGHT and proof.residual <= TIGHT, found.goal[1], taken)


def rows(quick: bool = False) -> Iterator[Row]:
    """The lines of the table."""
    launches = list(draws(COUNT))
    # imports
    ours(launches[0], "heat", 15)
    for goal, words in GOALS.items():
        for pieces, target in TARGETS.items():
            found = [ours(launch, goal, pieces) for launch in launches]
            yield _own(f"optimal launch, {words}, {pieces} pieces", found, target)
            if pieces == 15 or not quick:
                yield _peer(f"optimal launch, {words}, {pieces} pieces: nosnoc", launches, goal, pieces, found)


def _own(what: str, found: Sequence[Ours], target: float) -> Row:
    solved, slowest = sum(one.solved for one in found), max(one.seconds for one in found)
    median = statistics.median(one.seconds for one in found)
    said = f"{solved} of {len(found)}, {1e3 * median:.0f} ms, at most {1e3 * slowest:.0f} ms"
    return Row(what, said, f"all, <= {target:g} s", solved == len(found) and slowest <= target)


def _peer(what: str, launches: Sequence[Launch], goal: str, pieces: int, own: Sequence[Ours]) -> Row:
    try:
        solve = by_nosnoc.available()
    except ImportError:
        return Row(what, by_nosnoc.MISSING)
    found = [solve(launch, goal, pieces) for launch in launches]
    done = [one for one in found if one.success]
    # its own figure of the heat is that of a collocation of low order
    true = [
        float(costs(launch, one.torques[None])[0]) if goal == "heat" else one.cost
        for launch, one in zip(launches, found, strict=True)
    ]
    ratios = [cost / mine.cost for one, mine, cost in zip(found, own, true, strict=True) if one.success]
    as_good, better = sum(one < 1.001 for one in ratios), sum(one < 1.0 - 1e-6 for one in ratios)
    median = statistics.median(one.seconds for one in found)
    said = f"{len(done)} of {len(found)} end, {as_good} at this cost, {better} below; {median:.1f} s"
    return Row(what, said, "none below", better == 0)
