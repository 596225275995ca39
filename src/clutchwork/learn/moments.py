"""What the reward of many environments is a function of: one step of all of them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from clutchwork.base import dataclass

if TYPE_CHECKING:
    from clutchwork.results.events import Events


@dataclass(frozen=True)
class Moments:
    """One step of many environments, just done: what a `Moment` is for one, with an array of a number for each.

    `now["engine.speed"]` and `before["engine.speed"]` are signals at its end and at its begin; NaN where a run cannot
    go on. `events` are those of this step, by the number of the environment.
    """

    time: NDArray[np.float64]  # s, its end
    period: float  # s
    action: Mapping[str, NDArray[np.float64]]  # what was set, by name
    before: Mapping[str, Any]
    now: Mapping[str, Any]
    events: Mapping[int, Events]
    failed: NDArray[np.bool_]  # whether each cannot go on
