"""How many random cases the property tests run: a few hundred, a part of them in the first tier, more on request."""

from __future__ import annotations

import os

from support import tiers


def amount(default: int = 300) -> int:
    """Number of random cases that a test marked `random` draws; CLUTCHWORK_CASES overrides it."""
    asked = os.environ.get("CLUTCHWORK_CASES")
    return int(asked) if asked else part(default)


def part(count: int) -> int:
    """The same for a number that nobody overrides."""
    return tiers.few(count) if tiers.is_first() else count


def seeds(default: int = 300) -> range:
    """Values of a parameter `seed`, a case each: all of them in any tier, for tiers are made of cases."""
    return range(int(os.environ.get("CLUTCHWORK_CASES", default)))
