"""Speed cycles of stages."""

from __future__ import annotations

from collections.abc import Sequence

from clutchwork.base import UseError
from clutchwork.declare.calls import explained
from clutchwork.signals.table import Table


@explained("cw.drive_cycle", stages="[(10.0, 5.0, 3.0)]")
def drive_cycle(stages: Sequence[tuple[float, float, float]], *, start: float = 0.0) -> Table:
    """A speed over time as a table, for a `Driver`: ramps from rest to each speed in turn, each of which is held.

    Parameters: stages, rows of the speed [m/s], the time to reach it [s] and the time that it is held [s]; start, time
    at which the first one begins [s]. A cycle from a file is a `Column`.
    """
    points, time = [(float(start), 0.0)], float(start)
    for number, stage in enumerate(stages, 1):
        speed, reach, hold = _stage(number, stage)
        if not (reach > 0.0 and hold >= 0.0):
            fault = f"stage {number} takes {reach:g} s to {speed:g} m/s and holds it for {hold:g} s"
            raise UseError("cw.drive_cycle", [f"{fault}: give a time > 0 s to reach it and a time >= 0 s to hold it"])
        time += reach
        points.append((time, float(speed)))
        time += hold
        points += [(time, float(speed))] if hold else []
    return Table(points)


def _stage(number: int, stage: Sequence[float]) -> tuple[float, float, float]:
    try:
        speed, reach, hold = map(float, stage)
    except (TypeError, ValueError):
        remedy = "give three plain numbers: speed [m/s], time to reach it [s], time to hold it [s]"
        raise UseError("cw.drive_cycle", [f"stage {number} is {stage!r}: {remedy}"]) from None
    return speed, reach, hold
