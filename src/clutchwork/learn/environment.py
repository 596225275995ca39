"""An environment of Gymnasium around a driveline."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import TYPE_CHECKING, Any, Unpack

from clutchwork.base.errors import UseError
from clutchwork.base.extras import need
from clutchwork.base.shown import shown
from clutchwork.declare.calls import explained
from clutchwork.learn.moment import Moment
from clutchwork.learn.ranges import ranges
from clutchwork.learn.variation import variation
from clutchwork.run.simulation import Assembles, model_of
from clutchwork.stepping.simulator import Simulator

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.declare.option_fields import OptionFields
    from clutchwork.learn.gym import DrivelineEnv
    from clutchwork.results.state import State


@explained("cw.environment")
def environment(
    model: Assembles | System,
    t_end: float,
    *,
    actions: Mapping[str, tuple[float, float]],
    observations: Mapping[str, tuple[float, float] | None] | Iterable[str],
    reward: Callable[[Moment], float],
    period: float = 0.01,
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
    what, bad_actions = ranges("actions", actions, needed=True)
    seen, bad_observations = ranges("observations", observations, needed=False)
    varies, bad_variation = variation(vary or {})
    wrong = [*bad_actions, *bad_observations, *bad_variation]
    for name, value in (("t_end", t_end), ("period", period)):
        if isinstance(value, bool) or not isinstance(value, int | float) or not 0.0 < value < float("inf"):
            wrong.append(f"{name} is {shown(value)}: give a time above 0 in s")
    for name, function in (("reward", reward), ("ends", ends or reward)):
        if not callable(function):
            wrong.append(f"{name} is {shown(function)}: give a function of a Moment")
    if start is not None and vary:
        wrong.append("vary needs a new start in every episode: give vary or start")
    if render_mode not in (None, "rgb_array"):
        wrong.append(f'render_mode is {shown(render_mode)}: give "rgb_array" or None')
    if wrong:
        raise UseError("cw.environment", wrong)
    from clutchwork.learn.gym import DrivelineEnv

    def begin(changed: System) -> Simulator:
        return Simulator(changed, start=start, **changes)

    return DrivelineEnv(system, begin, what, seen, reward, ends, varies, (float(t_end), float(period)), render_mode)
