"""Fixtures and profiles of all tests."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

# `make test`: the same examples on every machine; `--hypothesis-profile=nightly`: 20 000 fresh ones
settings.register_profile(
    "default", derandomize=True, deadline=None, max_examples=25, suppress_health_check=[HealthCheck.too_slow]
)
settings.register_profile("nightly", deadline=None, max_examples=20_000, print_blob=True)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "default"))


def pytest_configure(config: pytest.Config) -> None:
    """Markers of this test tree."""
    config.addinivalue_line("markers", "feature(name): shows a row of the parity table, tools/parity.py")
    config.addinivalue_line(
        "markers", "slow: takes more than ten seconds; part of `make test`, leave out with -m 'not slow'"
    )


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Files that take long come first, or one worker would end alone with them."""
    long = {item.path for item in items if item.get_closest_marker("slow")}
    items.sort(key=lambda item: item.path not in long)


@pytest.fixture(scope="session")
def root() -> Path:
    """The root of the repository."""
    return HERE.parent
