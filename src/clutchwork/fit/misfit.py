"""Whether what is left over is noise; docs/guide/fit.md."""

from __future__ import annotations

import numpy as np

from clutchwork.base.arrays import Array
from clutchwork.fit.words import share

# a pattern is one that noise has in one of so many fits: the deviations of a normal distribution beyond which that is
CHANCE, BEYOND = 1e-3, 3.09
# means of so many groups of neighbours are compared, each of at least so many samples; fewer groups say nothing
MOST_GROUPS, SMALLEST_GROUP, FEWEST_GROUPS = 40, 3, 12
# a pattern of less than this share of the samples counts as none
SMALL = 0.02
# share of the samples, by squares, of which less is not described
DESCRIBED = 0.5
# residuals that sum up to so much more than those about the mean, in variances of the noise, are worse than the mean
WORSE = 10.0


def pattern(residuals: Array) -> float:
    """Root mean square of what groups of neighbours have in common with the next one; 0 where it may be chance.

    Noise that is filtered within a group has none.
    """
    count = min(MOST_GROUPS, len(residuals) // SMALLEST_GROUP)
    if count < FEWEST_GROUPS:
        return 0.0
    means = np.array([np.mean(group) for group in np.array_split(residuals, count)])
    common, own = float(np.mean(means[1:] * means[:-1])), float(np.mean(means**2))
    return float(np.sqrt(common)) if common > BEYOND / np.sqrt(count) * own else 0.0


def is_worse(r2: float, count: int) -> bool:
    """Whether samples are described worse than by their mean, more than noise alone would do."""
    return count * r2 < -WORSE


def patterns(rows: dict[str, Array], size: float) -> list[str]:
    """Patterns that residuals have over something, in words.

    Parameters: rows, residuals in the order of it, by its name; size, what they are compared with, in the same unit.
    """
    found = {name: pattern(row) / size for name, row in rows.items() if size > 0.0}
    return [
        f"the residuals are not noise: over the {name} they have a pattern of {share(size)} the samples "
        f"(noise would have it once in {1 / CHANCE:.0f} fits)"
        for name, size in found.items()
        if size > SMALL
    ]
