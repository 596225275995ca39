"""The environment itself; gymnasium is imported with this module."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import isfinite
from typing import Any, SupportsFloat

import numpy as np
from gymnasium import Env, spaces
from numpy.typing import NDArray

from clutchwork.assembly.system import System
from clutchwork.base import ClutchworkError, UseError, counted, quote
from clutchwork.learn.moment import Moment
from clutchwork.learn.ranges import Ranges
from clutchwork.learn.variation import Draw
from clutchwork.run.trajectory import SimulationError
from clutchwork.stepping.simulator import Simulator

Observation = NDArray[np.float32]
# ends of periods that are closer to the end of the episode are that end, as a share of a period
ROUND_OFF = 1e-6


class DrivelineEnv(Env[Observation, Observation]):
    """A driveline whose inputs an agent sets every period; `environment` makes it.

    `sim` is the Simulator of the present episode: `env.unwrapped.sim.run` is its trajectory so far.
    """

    metadata: dict[str, Any] = {"render_modes": ["rgb_array"]}  # noqa: RUF012

    def __init__(
        self,
        system: System,
        begin: Callable[[System], Simulator],
        actions: Ranges,
        observations: Ranges,
        reward: Callable[[Moment], float],
        ends: Callable[[Moment], bool] | None,
        varies: Mapping[str, Draw],
        times: tuple[float, float],
        render_mode: str | None,
    ) -> None:
        self._system, self._new, self._varies = system, begin, varies
        self._actions, self._observations = actions, observations
        self._reward, self._ends, self._times = reward, ends, times
        self.render_mode = render_mode
        self.metadata = {**self.metadata, "render_fps": max(1, round(1.0 / times[1]))}
        self.action_space = actions.space(spaces)
        self.observation_space = observations.space(spaces)
        self.sim = self._plain = begin(system)
        # names are looked up now: a wrong one is an error before the first episode
        self.sim.set(actions.values(np.zeros(len(actions.names))))
        self._seen()
        self.sim.reset()

    def _seen(self) -> Observation:
        return self._observations.scaled(self.sim[self._observations.names])

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Begin an episode; `options["values"]` are values by name in place of those that vary."""
        super().reset(seed=seed)
        values = {name: draw(self.np_random) for name, draw in self._varies.items()}
        given = dict((options or {}).get("values") or {})
        if self._varies or given:
            self.sim = self._new(self._system.changed(values | given))
        else:
            # that of the model, whatever the episode before was given
            self.sim = self._plain
            self.sim.reset()
        return self._seen(), self._info(values | given)

    def step(self, action: Any) -> tuple[Observation, SupportsFloat, bool, bool, dict[str, Any]]:
        """Set the inputs and go on by one period."""
        t_end, period = self._times
        before, begun, happened = self.sim.readings(), self.sim.time, len(self.sim.events)
        values = self._actions.values(self._accepted(action))
        self.sim.set(values)
        failure = ""
        try:
            # a multiple of the period, as `advance` ends at
            self.sim.advance(min(period, t_end - begun))
        except SimulationError as error:
            failure = str(error)
        now = before if failure else self.sim.readings()
        moment = Moment(self.sim.time, period, values, before, now, tuple(self.sim.events)[happened:], failure)
        over = bool(failure) or (self._ends is not None and bool(self._ends(moment)))
        seen = self._observations.scaled([now[name] for name in self._observations.names])
        return seen, self._rewarded(moment), over, self.sim.time >= t_end - ROUND_OFF * period, self._info({})

    def _accepted(self, action: Any) -> NDArray[np.float64]:
        """An action as numbers; UseError for what is none."""
        try:
            numbers = np.asarray(action, dtype=float).reshape(-1)
        except (TypeError, ValueError):
            numbers = np.empty(0)
        names = self._actions.names
        if numbers.shape != (len(names),) or not np.all(np.isfinite(numbers)):
            wanted = f"give {counted(len(names), 'numbers')} from -1 to 1, for {', '.join(names)}"
            raise UseError("env.step", [f"action is {quote(action)}: {wanted}"])
        return numbers

    def _rewarded(self, moment: Moment) -> float:
        reward = self._reward(moment)
        if reward is None or not isfinite(reward):
            raise ClutchworkError(f"the reward at {moment.time:.9g} s is {quote(reward)}: return a finite number")
        return float(reward)

    def _info(self, values: Mapping[str, Any]) -> dict[str, Any]:
        """The time, and what was drawn for this episode."""
        return {"time": self.sim.time, **({"values": dict(values)} if values else {})}

    def render(self) -> Any:
        """Picture of the episode so far, (height, width, 3) of bytes, in the mode "rgb_array". Needs matplotlib."""
        if self.render_mode is None:
            return None
        from matplotlib.backends.backend_agg import FigureCanvasAgg

        canvas: Any = FigureCanvasAgg(self.sim.run.plot())
        canvas.draw()
        return np.asarray(canvas.buffer_rgba())[..., :3].copy()
