"""What an environment is made of, read and checked: one for a driveline, one for many side by side."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from functools import partial
from math import inf
from typing import TYPE_CHECKING, Any

from clutchwork.base import UseError, dataclass, quote
from clutchwork.declare import quantity
from clutchwork.declare.to_si import TargetUnit
from clutchwork.learn.ranges import Ranges, ranges
from clutchwork.learn.variation import Draw, refuse_unfit, variation
from clutchwork.model.changes import in_si, named, target
from clutchwork.results.channels import channels
from clutchwork.run.simulation import Assembles, model_of

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.results.state import State


@dataclass(frozen=True)
class Task:
    """The System, what is set and seen, what varies, and the end of an episode and its period [s]."""

    system: System
    actions: Ranges
    observations: Ranges
    varies: Mapping[str, Draw]
    times: tuple[float, float]


def asked(
    call: str,
    model: Assembles | System,
    times: Mapping[str, Any],
    actions: object,
    observations: Mapping[str, Any] | Iterable[str],
    vary: Mapping[str, Any],
    functions: Mapping[str, Callable[..., Any] | None],
    start: State | None,
    wrong: Iterable[str] = (),
) -> Task:
    """What a call asks for; UseError and ModelError name all that is wrong with it at once.

    Parameters: times, "t_end" and "period"; functions, "reward" and "ends"; wrong, what else is.
    """
    system = model_of(call, model, None)
    what, bad_actions = ranges("actions", actions, True, partial(_given, system))
    seen, bad_observations = ranges("observations", observations, False, partial(_signal, system))
    varies, tried, bad_variation = variation(vary, partial(_given, system))
    read = {name: TargetUnit("s").number(value) for name, value in times.items()}
    problems = [*bad_actions, *bad_observations, *bad_variation]
    for name, value in read.items():
        if isinstance(value, bool) or not isinstance(value, int | float) or not 0.0 < value < inf:
            problems.append(f"{name} is {quote(value)}: give a time above 0, in s or with a unit")
    problems += [
        f"{name} is {quote(function)}: give a function of a Moment"
        for name, function in functions.items()
        if not (callable(function) or (name == "ends" and function is None))
    ]
    if start is not None and not problems and read["t_end"] <= start.time:
        end = read["t_end"]
        problems.append(f"t_end is {end:g} s, and start is at {start.time:g} s: give a later end of the episodes")
    if start is not None and vary:
        problems.append("vary needs a new start in every episode: give vary or start")
    problems += wrong
    if problems:
        raise UseError(call, problems)
    refuse_unfit(system, tried)
    return Task(system, what, seen, varies, (float(read["t_end"]), float(read["period"])))


def _given(system: System, name: str, value: Any) -> Any:
    """A value of what is set or varies, in SI."""
    aim = target(named(system.source), name) if system.source is not None else None
    return value if aim is None else in_si(aim, value)


def _signal(system: System, name: str, value: Any) -> Any:
    """A value of a signal of results, in SI."""
    known = channels(system, True, True)
    return quantity.in_si(value, known[name].unit) if name in known else value
