"""A measured record beside the run that was fitted to it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from typing import TYPE_CHECKING, Any

import numpy as np

from clutchwork.base import dataclass
from clutchwork.base.arrays import Array
from clutchwork.fit.traces import Trace

if TYPE_CHECKING:
    from clutchwork.run.trajectory import Trajectory


@dataclass(frozen=True, eq=False)
class FittedRecord:
    """A record and the run that was fitted to it."""

    label: str
    traces: tuple[Trace, ...] = field(repr=False)  # what was measured
    run: Trajectory = field(repr=False)  # with the fitted values, at the instants of the samples
    values: Mapping[str, Any]  # fitted, also those of this record alone, as `System.changed` takes them

    def residuals(self, one: Trace) -> Array:
        """Run minus samples of a measured signal."""
        places = np.searchsorted(self.run.time, one.times)
        return np.asarray(self.run[one.signal][places] - one.values)
