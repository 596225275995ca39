"""CPU time of each case, with that of the processes that it starts: `pytest --measure` writes cpu_seconds.json.

What cases share, a fixture of a module or a session, is divided among them, whichever of them asks for it first; a
fixture that takes more than a case may in the first tier belongs to each of them, which none of them is then.
Seconds are those of a machine that does `work` in UNIT seconds, so that tiers stay where machines are faster.
"""

from __future__ import annotations

import json
import os
from collections import defaultdict
from collections.abc import Iterator
from typing import Any

import pytest

from support import tiers

# s that `work` takes on the machine of the tiers
UNIT = 0.45
# s; cases below are not written down: they are far from the bound of the first tier
WRITTEN = 0.4


def clock() -> float:
    """CPU seconds of this process and of those that it waited for."""
    return sum(os.times()[:4])


def work() -> float:
    """CPU seconds of a fixed piece of work."""
    began, total = clock(), 0
    for number in range(10_000_000):
        total += number % 7
    return clock() - began


class Measure:
    """Collects what cases and the fixtures that they share take."""

    def __init__(self) -> None:
        self.own: dict[str, float] = {}
        self.shared: dict[str, float] = defaultdict(float)
        self.users: dict[str, list[str]] = defaultdict(list)
        self.inside = 0.0
        self.unit = work()

    @pytest.hookimpl(wrapper=True)
    def pytest_fixture_setup(self, fixturedef: pytest.FixtureDef[Any]) -> Iterator[None]:
        """A fixture that cases share."""
        began, before = clock(), self.inside
        result = yield
        if fixturedef.scope != "function":
            # what the fixtures below it took is theirs
            took = clock() - began - (self.inside - before)
            self.shared[_key(fixturedef)] += took
            self.inside += took
        return result

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_protocol(self, item: pytest.Item) -> Iterator[None]:
        """A case."""
        began, before = clock(), self.inside
        result = yield
        self.own[item.nodeid] = clock() - began - (self.inside - before)
        for found in item._fixtureinfo.name2fixturedefs.values():
            self.users[_key(found[-1])].append(item.nodeid)
        return result

    def pytest_sessionfinish(self) -> None:
        """Write the figures of the files that ran; others stay."""
        seconds = dict(self.own)
        for key, took in self.shared.items():
            for name in self.users[key]:
                seconds[name] += took if took * UNIT > tiers.HELD * self.unit else took / len(self.users[key])
        scale = 2.0 * UNIT / (self.unit + work())
        written = tiers.measured() if tiers.MEASURED.exists() else {}
        ran = {name.partition("::")[0] for name in self.own}
        kept = {name: value for name, value in written.items() if name.partition("::")[0] not in ran}
        write(kept | {name: value * scale for name, value in seconds.items()})


def _key(found: pytest.FixtureDef[Any]) -> str:
    """Where a fixture is defined, and its name."""
    return f"{found.baseid}::{found.argname}"


def write(seconds: dict[str, float]) -> None:
    """Write the cases that are not quick, by file and name."""
    files: dict[str, dict[str, float]] = defaultdict(dict)
    for name, value in sorted(seconds.items()):
        if value >= WRITTEN:
            file, _, case = name.partition("::")
            files[file][case] = round(value, 1)
    tiers.MEASURED.write_text(json.dumps(files, indent=0, ensure_ascii=False) + "\n", encoding="utf-8")
