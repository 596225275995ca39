"""One variant as a run of its own: what functions of a run are given, and what controllers need."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from typing import Any

from clutchwork.assembly.system import System
from clutchwork.declare.options import Options
from clutchwork.run.failure import FaultWarning, StoppedEarly
from clutchwork.run.simulation import simulate
from clutchwork.run.trajectory import Trajectory


def single(system: System, values: Mapping[str, Any], t_end: float, options: Options) -> Trajectory:
    """The run of one variant; its status says how it ended."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", StoppedEarly)
        warnings.simplefilter("ignore", FaultWarning)
        return simulate(system.changed(values) if values else system, t_end, options=options)
