"""Whether a torque that is given drives its shaft."""

from __future__ import annotations

from collections.abc import Iterable
from numbers import Real
from typing import Any

from clutchwork.declare import Signal
from clutchwork.signals.bases.extremes import extremes


def drives_by(torques: Iterable[float]) -> bool:
    """Whether torques over time or speed drive a shaft more than they brake it."""
    values = [*torques]
    return max(values) > 0.0 and max(values) >= -min(values)


def signal_drives(torque: Any) -> bool:
    """The same of a torque that is given over time; what is only known in the run is taken for a drive."""
    if isinstance(torque, Signal):
        return drives_by([reached.value for reached in extremes(torque)] or [1.0])
    return not isinstance(torque, Real) or float(torque) > 0.0
