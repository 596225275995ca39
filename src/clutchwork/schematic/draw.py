"""Draw a model, or a run of it at an instant."""

from __future__ import annotations

from math import inf, isfinite
from numbers import Real
from pathlib import Path
from typing import TYPE_CHECKING, Any

from clutchwork.base import UseError, quote
from clutchwork.base.paths import path_fault
from clutchwork.declare.quantity import QuantityError, in_si
from clutchwork.model.model import Model
from clutchwork.schematic.diagram import diagram
from clutchwork.schematic.moment import Snapshot, instant
from clutchwork.schematic.picture import Schematic, kind_of
from clutchwork.schematic.sheet import sheet

POINTS = 72.0 / 25.4  # in a millimetre
MILLIMETRES = 310.0  # the width from which on a schematic is folded

if TYPE_CHECKING:
    from clutchwork.declare.node import Number
    from clutchwork.results.recorded import Recorded


def drawn(
    model: Model,
    path: str | Path | None = None,
    *,
    run: Recorded | None = None,
    at: Number | None = None,
    values: bool = True,
    power: bool = False,
    width: float = MILLIMETRES,
) -> Schematic:
    """Lay out the schematic of a model, with a run of its state at an instant [s]; UseError names what does not fit."""
    time = _seconds(at)
    problems = [*_problems(model, path, run, time), *_width_problems(width)]
    if problems:
        raise UseError("draw", problems)
    found = diagram(model)
    moment = Snapshot()
    if run is not None:
        moment = instant(run, float(run.time[-1]) if time is None else float(time), power=power)
    made = Schematic(found.name, sheet(found, moment, values=values, width=width * POINTS), moment.time)
    if path is not None:
        made.save(path)
    return made


def _seconds(at: Any) -> Any:
    """A time in s where it has a unit."""
    try:
        return in_si(at, "s")
    except QuantityError as error:
        raise UseError("draw", [f"at is {error}"]) from None


def _width_problems(width: Any) -> Any:
    if not isinstance(width, Real) or isinstance(width, bool) or not 20.0 <= float(width) < inf:
        yield f"width is {quote(width)}: give a number of at least 20 mm"


def _problems(model: Model, path: Any, run: Any, at: Any) -> Any:
    if hasattr(path, "events"):
        yield f"{quote(path)} is not a path; give the run by name: run=..."
    elif path is not None and (fault := path_fault(path, "driveline.svg")):
        yield fault
    elif path is not None and not kind_of(path):
        yield f"{quote(str(path))} does not say the format: end it with .svg, .png or .pdf"
    if run is None:
        if at is not None:
            yield f"at is {quote(at)}, but there is no run to show: give run=d.simulate(...)"
        return
    if not (hasattr(run, "events") and hasattr(run, "wiring")):
        yield f"run is {quote(run)}: give what d.simulate(...) returned"
        return
    if not len(run):
        yield f"the run has no instant to show: {run.message}"
        return
    known, inner = {one.name for one in model.nodes}, tuple(f"{element.name}." for element in model.elements)
    names = [node.name for node in run.wiring.nodes]
    missing = [name for name in names if name not in known and not name.startswith(inner)]
    if missing:
        yield f"the run is of another driveline, which has {quote(missing[0])}: draw that one, or cw.draw(run)"
    if at is None:
        return
    if not isinstance(at, Real) or isinstance(at, bool) or not isfinite(float(at)):
        yield f"at is {quote(at)}: give one time in s"
        return
    # one that got to its end is repeated for any instant
    begin, end = (run.options.t_start, run.t_end) if run.finished else (run.time[0], run.time[-1])
    if not begin <= float(at) <= end:
        yield f"at is {float(at):g} s: the run goes from {begin:g} to {end:g} s"
