"""Fixtures, profiles and tiers of all tests."""

from __future__ import annotations

import os
import sys
from collections import defaultdict
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

from support import tiers  # noqa: E402
from support.measure import Measure  # noqa: E402

# the same examples on every machine; `--hypothesis-profile=nightly`: 20 000 fresh ones
EXAMPLES = 25
settings.register_profile(
    "default", derandomize=True, deadline=None, max_examples=EXAMPLES, suppress_health_check=[HealthCheck.too_slow]
)
settings.register_profile("first", settings.get_profile("default"), max_examples=tiers.few(EXAMPLES))
settings.register_profile("nightly", deadline=None, max_examples=20_000, print_blob=True)
# names of parameters that are seeds of random models
SEEDS = {"seed", "first_seed"}


def pytest_addoption(parser: pytest.Parser) -> None:
    """Tiers, and their figures."""
    group = parser.getgroup("clutchwork")
    words = "cases that are quick and a part of the random ones, all the others, or all (default)"
    group.addoption("--tier", choices=tiers.TIERS, default="all", help=words)
    group.addoption("--measure", action="store_true", help=f"write the CPU seconds of cases into {tiers.MEASURED.name}")


def pytest_configure(config: pytest.Config) -> None:
    """Markers of this test tree, and the tier for what counts random cases."""
    config.addinivalue_line("markers", "feature(name): shows a row of the parity table, tools/parity.py")
    config.addinivalue_line("markers", "random: draws random cases, in the first tier a part of them")
    config.addinivalue_line("markers", "sampled: many costly cases alike, in the first tier a part of them")
    config.addinivalue_line("markers", "always: in the first tier whatever it takes")
    tier = config.getoption("tier")
    os.environ["CLUTCHWORK_TIER"] = tier
    settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "first" if tier == "first" else "default"))
    if config.getoption("measure"):
        config.pluginmanager.register(Measure())


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Leave out what the tier has not; files that take long come first, or one worker would end alone with them."""
    seconds, cases = tiers.measured(), [_case(item) for item in items]
    config.stash[tiers.COLLECTED] = cases
    first = tiers.first_tier(cases, seconds)
    wanted = {
        "first": first,
        "last": {case.name for case in cases if case.random or case.name not in first},
        "all": {case.name for case in cases},
    }[config.getoption("tier")]
    config.hook.pytest_deselected(items=[item for item in items if item.nodeid not in wanted])
    items[:] = [item for item in items if item.nodeid in wanted]
    long: dict[Path, float] = defaultdict(float)
    for item in items:
        long[item.path] += seconds.get(item.nodeid, 0.0)
    items.sort(key=lambda item: -long[item.path])


def _case(item: pytest.Item) -> tiers.Case:
    """What the tier of a case follows from."""
    index: dict[str, int] = item.callspec.indices if hasattr(item, "callspec") else {}
    sampled = bool(item.get_closest_marker("sampled"))
    others = [f"{name} {place}" for name, place in index.items() if name not in SEEDS and not sampled]
    return tiers.Case(
        name=item.nodeid,
        part_of=" ".join([item.nodeid.partition("[")[0], *others]) if sampled or SEEDS & set(index) else "",
        random=bool(item.get_closest_marker("random")) or hasattr(getattr(item, "obj", None), "hypothesis"),
        always=bool(item.get_closest_marker("always")),
    )


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """What failed before these tests, which have the last word."""
    failed = os.environ.get("CLUTCHWORK_FAILED", "").strip()
    if failed:
        terminalreporter.write_line(f"FAILED before these tests: {failed}", red=True)


@pytest.fixture(scope="session")
def root() -> Path:
    """The root of the repository."""
    return HERE.parent
