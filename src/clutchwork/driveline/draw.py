"""Draw whatever holds a driveline: itself, its System, a run of it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from clutchwork.base import UseError, quote
from clutchwork.declare.calls import explained
from clutchwork.declare.node import Number
from clutchwork.driveline.driveline import Driveline
from clutchwork.results.recorded import Recorded
from clutchwork.schematic.draw import drawn
from clutchwork.schematic.picture import Schematic


@explained("cw.draw")
def draw(
    thing: Any,
    path: str | Path | None = None,
    *,
    run: Recorded | None = None,
    at: Number | None = None,
    values: bool = True,
    power: bool = False,
    width: float = 310.0,
) -> Schematic:
    """Schematic of a driveline, of a System, or of a run at an instant; notebooks show it. Needs the extra `draw`.

    Use it where a `Driveline` is not at hand; `d.draw(...)` is the same.

    Parameters: thing, a Driveline, a System or a Trajectory, which is its own `run`; path, SVG, PNG or PDF by its
    ending, written when given; run and at [s, or with a unit], a result and the time whose states, speeds and torques
    are shown; values, whether inertias, ratios and the like are shown; power, whether the power [W] of elements is;
    width [mm], from which on a long driveline is folded into rows. UseError for what does not fit.
    """
    if isinstance(thing, Driveline):
        return thing.draw(path, run=run, at=at, values=values, power=power, width=width)
    if isinstance(thing, Recorded):
        run, thing = thing, thing.system
    source = getattr(thing, "source", None)
    if source is None:
        known = "give a Driveline, a System that was made of one, or a Trajectory"
        raise UseError("cw.draw", [f"{quote(thing)} holds no driveline: {known}"])
    return drawn(source, path, run=run, at=at, values=values, power=power, width=width)
