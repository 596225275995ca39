"""Numbers as C writes them."""

from __future__ import annotations

import math


def literal(value: float) -> str:
    """A double, exactly."""
    if math.isnan(value):
        return "NAN"
    return repr(float(value)) if math.isfinite(value) else ("INFINITY" if value > 0 else "-INFINITY")
