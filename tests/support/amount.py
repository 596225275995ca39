"""How many random cases the property tests run: a few hundred in `make test`, more on request."""

from __future__ import annotations

import os


def amount(default: int = 300) -> int:
    """Number of random cases; the environment variable CLUTCHWORK_CASES overrides it."""
    return int(os.environ.get("CLUTCHWORK_CASES", default))
