"""Which cases `make test` runs: a case's tier follows from its measured CPU time.

The first tier has every case that takes at most QUICK seconds or was never measured, a part of the random and of the
sampled cases, and the cheapest case of each test whose cases all take longer, up to HELD seconds. The last tier has all
the others.
"""

from __future__ import annotations

import json
import os
from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import pytest

TESTS = Path(__file__).resolve().parents[1]
MEASURED = TESTS / "cpu_seconds.json"
TIERS = ("first", "last", "all")
# s of CPU time that every case of the first tier may take
QUICK = 0.5
# s that the cheapest case of a test may take there
HELD = 2.0
# s that a part of the random cases of a test may take there
DRAWN = 3.0
# the first tier draws one of so many random cases, and of seeds and samples that are cases of their own
PART = 4


# all cases that were collected, whatever the tier
COLLECTED: pytest.StashKey[list[Case]] = pytest.StashKey()


@dataclass(frozen=True)
class Case:
    """A case, and what its tier follows from beside its time."""

    name: str
    # what it shares with the cases that are seeds or samples of the same; empty where it has none
    part_of: str = ""
    # it draws random cases inside, by `support.amount` or Hypothesis
    random: bool = False
    # it is in the first tier whatever it takes
    always: bool = False

    @property
    def test(self) -> str:
        """The test without the parameters."""
        return self.name.partition("[")[0]


def measured(path: Path = MEASURED) -> dict[str, float]:
    """CPU seconds of the cases that are not quick; what is not among them is, or was never measured."""
    files: dict[str, dict[str, float]] = json.loads(path.read_text(encoding="utf-8"))
    return {f"{file}::{name}": seconds for file, cases in files.items() for name, seconds in cases.items()}


def first_tier(cases: Sequence[Case], seconds: Mapping[str, float]) -> set[str]:
    """Names of the cases of the first tier; all cases of a test are given."""
    costs = {case.name: seconds.get(case.name, 0.0) / (PART if case.random else 1) for case in cases}
    found = {case.name for case in _few(cases) if case.always or costs[case.name] <= (DRAWN if case.random else QUICK)}
    touched = {case.test for case in cases if case.name in found}
    slow: dict[str, list[str]] = defaultdict(list)
    for case in cases:
        if case.test not in touched:
            slow[case.test].append(case.name)
    cheapest = (min(names, key=costs.__getitem__) for names in slow.values())
    return found | {name for name in cheapest if costs[name] <= HELD}


def _few(cases: Sequence[Case]) -> list[Case]:
    """All cases, but a part alone of those that differ in their seed, or are samples, evenly over them."""
    groups: dict[str, list[Case]] = defaultdict(list)
    for case in cases:
        groups[case.part_of].append(case)
    return [case for group, some in groups.items() for case in (_spread(some) if group else some)]


def _spread(some: list[Case]) -> list[Case]:
    count = few(len(some))
    return [some[k * len(some) // count] for k in range(count)]


def few(count: int) -> int:
    """How many of so many random cases the first tier has; at least two."""
    return min(count, max(2, -(-count // PART)))


def is_first() -> bool:
    """Whether this process runs the first tier alone; conftest.py says so."""
    return os.environ.get("CLUTCHWORK_TIER") == "first"
