"""Numbers of fits as messages write them."""

from __future__ import annotations


def plain(value: float, digits: int = 2, sign: str = "") -> str:
    """A number that is rounded to some digits and written without a power of ten: 14000, not 1.4e+04.

    Parameters: sign, "+" to show that of positive numbers too.
    """
    return f"{float(f'{value:.{digits}g}'):{sign}.15g}"


def share(value: float) -> str:
    """A share for reading: `82 %`, and from twice on `34 times`."""
    return f"{plain(100.0 * value)} % of" if value < 2.0 else f"{plain(value)} times"
