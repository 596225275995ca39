"""Environments of Gymnasium around a driveline, one or many."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import TYPE_CHECKING, Any, Unpack

from clutchwork.base import quote
from clutchwork.base.extras import need
from clutchwork.declare.calls import explained
from clutchwork.learn.moment import Moment
from clutchwork.learn.moments import Moments
from clutchwork.learn.task import asked
from clutchwork.run.simulation import Assembles
from clutchwork.stepping.simulator import Simulator
from clutchwork.stepping.simulators import Simulators

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.declare.node import Number
    from clutchwork.declare.option_fields import OptionFields
    from clutchwork.learn.gym import DrivelineEnv
    from clutchwork.learn.vector import DrivelineVectorEnv
    from clutchwork.results.state import State

MODES = 'give "rgb_array" or None'


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
    no_mode = [] if render_mode in (None, "rgb_array") else [f"render_mode is {quote(render_mode)}: {MODES}"]
    times, functions = {"t_end": t_end, "period": period}, {"reward": reward, "ends": ends}
    task = asked("cw.environment", model, times, actions, observations, vary or {}, functions, start, no_mode)
    # needs Gymnasium
    from clutchwork.learn.gym import DrivelineEnv

    def begin(changed: System) -> Simulator:
        return Simulator(changed, start=start, **changes)

    return DrivelineEnv(
        task.system, begin, task.actions, task.observations, reward, ends, task.varies, task.times, render_mode
    )


@explained("cw.vector_environment")
def vector_environment(
    model: Assembles | System,
    count: int,
    t_end: Number,
    *,
    actions: Mapping[str, tuple[Number, Number]],
    observations: Mapping[str, tuple[Number, Number] | None] | Iterable[str],
    reward: Callable[[Moments], Any],
    period: Number = 0.01,
    ends: Callable[[Moments], Any] | None = None,
    vary: Mapping[str, Any] | None = None,
    start: State | None = None,
    autoreset: str = "next step",
    threads: int | None = None,
    **changes: Unpack[OptionFields],
) -> DrivelineVectorEnv:
    """Many environments of Gymnasium side by side, on all cores, as one `VectorEnv`. Needs gymnasium.

    Use it to learn with many episodes at once. Parameters are those of `environment`, with count, how many; reward and
    ends, functions of `Moments`, all steps at once, that return an array of a number, or whether, for each; autoreset,
    what happens where an episode is over: "next step", its next step begins another one; "same step", the same does,
    and `infos["final_obs"]` has what was seen last; "disabled", `reset(options={"reset_mask": ...})` is called;
    threads, by default as many as processors.

    UseError and ModelError name what is wrong with all of them.
    """
    need("gymnasium", "learn", "an environment")
    modes = ("next step", "same step", "disabled")
    no_mode = [] if autoreset in modes else [f"autoreset is {quote(autoreset)}: give one of {', '.join(modes)}"]
    times, functions = {"t_end": t_end, "period": period}, {"reward": reward, "ends": ends}
    task = asked("cw.vector_environment", model, times, actions, observations, vary or {}, functions, start, no_mode)
    # needs Gymnasium
    from gymnasium.vector import AutoresetMode

    # needs it too
    from clutchwork.learn.vector import DrivelineVectorEnv

    sims = Simulators(task.system, count, start=start, threads=threads, **changes)
    mode = AutoresetMode("".join(word.capitalize() for word in autoreset.split()))
    return DrivelineVectorEnv(task, sims, reward, ends, mode)
