"""An environment of Gymnasium around a driveline."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from functools import partial
from math import inf
from typing import TYPE_CHECKING, Any, Unpack

from clutchwork.base.errors import UseError
from clutchwork.base.extras import need
from clutchwork.base.quote import quote
from clutchwork.declare import quantity
from clutchwork.declare.calls import explained
from clutchwork.declare.to_si import TargetUnit
from clutchwork.learn.moment import Moment
from clutchwork.learn.ranges import ranges
from clutchwork.learn.variation import refuse_unfit, variation
from clutchwork.model.changes import in_si, named, target
from clutchwork.results.channels import channels
from clutchwork.run.simulation import Assembles, model_of
from clutchwork.stepping.simulator import Simulator

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.declare.node import Number
    from clutchwork.declare.option_fields import OptionFields
    from clutchwork.learn.gym import DrivelineEnv
    from clutchwork.results.state import State


@explained("cw.environment")
def environment(
    model: Assembles | System,
    t_end: Number,
    *,
    actions: Mapping[str, tuple[Number, Number]],
    observations: Mapping[str, tuple[Number, Number] | None] | Iterable[str],
    reward: Callable[[Moment], float],
    period: Number = 0.01,
    ends: Callable[[Moment], bool] | None = None,
    vary: Mapping[str, Any] | None = None,
    start: State | None = None,
    render_mode: str | None = None,
    **changes: Unpack[OptionFields],
) -> DrivelineEnv:
    """An environment of Gymnasium in which an agent sets inputs of a driveline every period. Needs gymnasium.

    Use it to learn a controller, or to tune one: any optimiser over episodes.

    Parameters: t_end, end of an episode [s], which then is `truncated`; actions, signals or parameters by name, each
    with (low, high) in its unit, where an action of -1 is low and 1 is high; observations, signals by name with (low,
    high), seen as -1 to 1 and held there beyond it, as by a sensor, or names alone, or None as the range: seen as they
    are; reward, a function of a `Moment`, what the step was like, that returns a finite number; period, time between
    two actions [s]; ends, a function of a `Moment`: whether the episode is over, `terminated`, as it also is when the
    run cannot go on; vary, what differs from one episode to the next, by names of `System.changed`: (low, high), drawn
    evenly, a list to choose from, or a function of a numpy Generator; start, a `State` to begin at, where nothing
    varies; render_mode, "rgb_array" for pictures of the episode so far by `render`; changes, options of a run.

    UseError and ModelError name what is wrong with all of them.
    """
    need("gymnasium", "learn", "an environment")
    system = model_of("cw.environment", model, None)
    what, bad_actions = ranges("actions", actions, True, partial(_given, system))
    seen, bad_observations = ranges("observations", observations, False, partial(_signal, system))
    varies, tried, bad_variation = variation(vary or {}, partial(_given, system))
    times = {name: TargetUnit("s").number(value) for name, value in (("t_end", t_end), ("period", period))}
    wrong = [*bad_actions, *bad_observations, *bad_variation]
    for name, value in times.items():
        if isinstance(value, bool) or not isinstance(value, int | float) or not 0.0 < value < inf:
            wrong.append(f"{name} is {quote(value)}: give a time above 0, in s or with a unit")
    wrong += [
        f"{name} is {quote(function)}: give a function of a Moment"
        for name, function in (("reward", reward), ("ends", ends))
        if not (callable(function) or (name == "ends" and function is None))
    ]
    if start is not None and not wrong and times["t_end"] <= start.time:
        end = times["t_end"]
        wrong.append(f"t_end is {end:g} s, and start is at {start.time:g} s: give a later end of the episodes")
    if start is not None and vary:
        wrong.append("vary needs a new start in every episode: give vary or start")
    if render_mode not in (None, "rgb_array"):
        wrong.append(f'render_mode is {quote(render_mode)}: give "rgb_array" or None')
    if wrong:
        raise UseError("cw.environment", wrong)
    refuse_unfit(system, tried)
    # needs Gymnasium
    from clutchwork.learn.gym import DrivelineEnv

    def begin(changed: System) -> Simulator:
        return Simulator(changed, start=start, **changes)

    return DrivelineEnv(
        system, begin, what, seen, reward, ends, varies, (float(times["t_end"]), float(times["period"])), render_mode
    )


def _given(system: System, name: str, value: Any) -> Any:
    """A value of what is set or varies, in SI."""
    aim = target(named(system.source), name) if system.source is not None else None
    return value if aim is None else in_si(aim, value)


def _signal(system: System, name: str, value: Any) -> Any:
    """A value of a signal of results, in SI."""
    known = channels(system, True, True)
    return quantity.in_si(value, known[name].unit) if name in known else value
