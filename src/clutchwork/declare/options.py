"""How a run is done: tolerances, method, budgets and what is written down."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from numbers import Real
from typing import TYPE_CHECKING, Any, Literal

from clutchwork.base.errors import OptionError, UseError, near
from clutchwork.base.shown import shown
from clutchwork.declare.calls import explain

if TYPE_CHECKING:
    from numpy.typing import NDArray

Method = Literal["rodas5p", "dopri5", "auto"]
METHODS: dict[str, int] = {"auto": 0, "rodas5p": 1, "dopri5": 2}
OUTPUTS = ("smooth", "steps")

# A grid finer than this does not fit into memory together with its signals.
MOST_ROWS = 10_000_000
# no run lasts that long
MOST_COUNTED = 10**15


@dataclass(frozen=True)
class Options:
    """Options of a run; every one may also be given to `simulate` by name.

    Output: `times` gives exactly these instants, `dt` a uniform grid that ends with t_end. Without
    either, `output` decides: "smooth" gives the solver's steps refined to `points` intervals, with the left
    and the right limit at every event; "steps" gives the bare steps of the solver.

    Use "rodas5p" unless the model has no stiff part; "dopri5" saves time on soft models; "auto" chooses per
    smooth phase.
    """

    rtol: float = 1e-6  # relative tolerance of speeds and states
    atol: float = 1e-8  # absolute tolerance, in the unit of each quantity
    method: Method = "rodas5p"
    first_step: float | None = None  # s; None: chosen by the solver
    max_step: float | None = None  # s; None: no limit
    max_steps: int = 10_000_000  # budget of the whole run
    max_events: int = 100_000  # budget of the whole run
    dt: float | None = None  # s, spacing of the output
    times: Sequence[float] | NDArray[Any] | None = None  # s, instants of the output
    output: str = "smooth"  # when neither dt nor times is given
    points: int = 1000  # intervals that "smooth" output has at least
    angles: bool = True  # integrate the angles of all shafts
    work: bool = True  # integrate the work of all elements, for the energy balance

    def __post_init__(self) -> None:
        """Refuse values that make no sense, with what to write instead, all of them at once."""
        found = [_not_positive(name, getattr(self, name)) for name in ("rtol", "atol")]
        lengths = [(name, getattr(self, name)) for name in ("first_step", "max_step", "dt")]
        found += [_not_positive(name, value, " s") for name, value in lengths if value is not None]
        counts = (("max_steps", MOST_COUNTED), ("max_events", MOST_COUNTED), ("points", MOST_ROWS))
        found += [_not_whole(name, getattr(self, name), most) for name, most in counts]
        found += [_no_flag(name, getattr(self, name)) for name in ("angles", "work")]
        if isinstance(self.rtol, Real) and 0.0 < self.rtol < 1e-14:
            found.append(f"rtol is {float(self.rtol):g}: double precision carries no more than 1e-14")
        found += [_not_one_of("method", self.method, tuple(METHODS)), _not_one_of("output", self.output, OUTPUTS)]
        if self.dt is not None and self.times is not None:
            found.append("dt and times are both given: give the spacing or the instants, not both")
        if any(found):
            raise OptionError([fault for fault in found if fault])

    def changed(self, changes: dict[str, Any]) -> Options:
        """These options with some replaced; an unknown name is a UseError, a TypeError, with a near match."""
        known = [item.name for item in fields(self)]
        words = [*known, "options", "progress"]
        unknown = [name for name in changes if name not in known]
        if unknown:
            rests = [*("" for _ in unknown[1:]), f"known options: {', '.join(known)}"]
            found = [f"unknown option {x!r}{near(x, words, rest)}" for x, rest in zip(unknown, rests, strict=True)]
            raise UseError("simulate", found)
        return replace(self, **changes)

    def core_options(self) -> dict[str, float]:
        """The options that the compiled core knows, as its numbers."""
        return {
            "rtol": self.rtol,
            "atol": self.atol,
            "method": float(METHODS[self.method]),
            "first_step": self.first_step or 0.0,
            "max_step": math.inf if self.max_step is None else self.max_step,
            "max_steps": float(self.max_steps),
            "max_events": float(self.max_events),
            "angles": float(self.angles),
            "work": float(self.work),
        }


explain(Options)


def end_time(t_end: float) -> float:
    """Check the end time of a run [s]."""
    fault = _not_positive("t_end", t_end, " s")
    if fault:
        raise OptionError([fault])
    return float(t_end)


def _not_positive(name: str, value: object, unit: str = "") -> str:
    """What is wrong with a number that must be finite and above zero, empty when nothing is."""
    number = _as_number(value)
    if number is None:
        return f"{name} is {shown(value)}: it must be a number" + (f" in{unit}" if unit else "")
    return (
        ""
        if math.isfinite(number) and number > 0.0
        else f"{name} is {number:g}{unit}: it must be a finite number above 0"
    )


def _not_whole(name: str, value: object, most: int) -> str:
    number = _as_number(value)
    if number is None or math.isnan(number) or (math.isfinite(number) and not number.is_integer()):
        return f"{name} is {shown(value)}: it must be a whole number"
    if number < 1:
        return f"{name} is {shown(value)}: it must be at least 1"
    return f"{name} is {shown(value)}: it must be at most {most}" if number > most else ""


def _no_flag(name: str, value: object) -> str:
    return "" if value is True or value is False else f"{name} is {shown(value)}: it must be True or False"


def _as_number(value: object) -> float | None:
    if isinstance(value, bool) or not isinstance(value, Real):
        return None
    try:
        return float(value)
    except OverflowError:
        return math.inf


def _not_one_of(name: str, value: object, known: Sequence[str]) -> str:
    words = f"it must be one of {', '.join(known)}"
    return "" if value in known else f"{name} is {shown(value)}{near(value, known, words)}"
