"""The jerk that a person feels, as shifts, calibrations and pages measure it: docs/theory/jerk.md."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

# over which accelerations are averaged, by default [s]
WINDOW = 0.05


def felt_jerk(speed: NDArray[Any], window: float, per_window: int) -> NDArray[np.float64]:
    """Change of the mean acceleration from one window before an instant to one behind it, over the window.

    Parameters: speed, or derivatives of it in lines, at equal steps; window [s], of so many steps. The first value is
    that of one window behind the first speed, the last one of one window before the last.
    """
    found: NDArray[np.float64] = (
        speed[2 * per_window :] - 2.0 * speed[per_window:-per_window] + speed[: -2 * per_window]
    )
    return found / window**2
