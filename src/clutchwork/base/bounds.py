"""Bounds of numbers in words."""

from __future__ import annotations

from math import inf, nextafter


def in_words(bounds: tuple[float, float]) -> str:
    """Bounds such as "above 0" or "from 0 to 1"; empty where there are none.

    The number beside a bound that is not allowed itself has more digits than that.
    """
    low, high = bounds
    below, above = nextafter(low, -inf), nextafter(high, inf)
    words = []
    if low > -inf:
        words.append(f"above {below:g}" if len(f"{below:g}") < len(f"{low:g}") else f"from {low:g}")
    if high < inf:
        words.append(f"below {above:g}" if len(f"{above:g}") < len(f"{high:g}") else f"to {high:g}")
    return " ".join(words)


def plain(bounds: tuple[float, float]) -> tuple[float, float]:
    """The bounds as people write them: 0 for the least number above it."""
    low, high = bounds
    below, above = nextafter(low, -inf), nextafter(high, inf)
    return below if len(f"{below:g}") < len(f"{low:g}") else low, above if len(f"{above:g}") < len(
        f"{high:g}"
    ) else high
