"""Many environments of Gymnasium side by side; gymnasium is imported with this module."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from numbers import Integral
from typing import Any

import numpy as np
from gymnasium import spaces
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray

from clutchwork.base import ClutchworkError, UseError, quote
from clutchwork.learn.moments import Moments
from clutchwork.learn.task import Task
from clutchwork.results.events import Events
from clutchwork.stepping.simulators import Simulators

Array = NDArray[Any]
Function = Callable[[Moments], Any]
# ends of periods that are closer to the end of the episode are that end, as a share of a period
ROUND_OFF = 1e-6


class DrivelineVectorEnv(VectorEnv[Array, Array, Array]):
    """Many drivelines whose inputs an agent sets every period; `vector_environment` makes it.

    `sims` are the Simulators of the present episodes.
    """

    def __init__(
        self, task: Task, sims: Simulators, reward: Function, ends: Function | None, autoreset: AutoresetMode
    ) -> None:
        self._task, self.sims, self._reward, self._ends = task, sims, reward, ends
        self.num_envs = len(sims)
        self.metadata = {"render_modes": [], "autoreset_mode": autoreset}
        self.render_mode = None
        self.spec = None
        self.single_action_space = task.actions.space(spaces)
        self.single_observation_space = task.observations.space(spaces)
        self.action_space = batch_space(self.single_action_space, self.num_envs)
        self.observation_space = batch_space(self.single_observation_space, self.num_envs)
        self._generators = [np.random.default_rng() for _ in range(self.num_envs)]
        self._over = np.zeros(self.num_envs, dtype=bool)
        self._last = np.zeros((self.num_envs, len(task.observations.names)), dtype=np.float32)
        # names are looked up now: a wrong one is an error before the first episode
        sims.set(task.actions.values(np.zeros(len(task.actions.names))))
        self._seen()
        sims.reset()

    def _seen(self) -> Array:
        """What all see; where a run cannot go on that is what was seen last."""
        seen = self._task.observations.scaled(self.sims[self._task.observations.names])
        self._last = np.where(self.sims.failed[:, None], self._last, seen)
        return self._last.copy()

    def reset(
        self, *, seed: int | Sequence[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Array, dict[str, Any]]:
        """Begin all episodes, or those of `options["reset_mask"]`: whether, for each.

        Parameters: seed, that of the first, the others follow, or one for each.
        """
        others = sorted(set(options or {}) - {"reset_mask"})
        if others:
            raise UseError("env.reset", [f"options has {quote(one)}: give reset_mask alone" for one in others])
        mask = np.asarray((options or {}).get("reset_mask", np.ones(self.num_envs, dtype=bool)))
        if mask.dtype != bool or mask.shape != (self.num_envs,):
            raise UseError("env.reset", [f"reset_mask is {quote(mask)}: say whether, for each of {self.num_envs}"])
        for number, one in enumerate(self._seeds(seed)):
            if one is not None and mask[number]:
                self._generators[number] = np.random.default_rng(one)
        self._begin(mask)
        return self._seen(), {}

    def _seeds(self, seed: Any) -> list[int | None]:
        """The seed of each."""
        if seed is None or isinstance(seed, Integral):
            return [None if seed is None else int(seed) + number for number in range(self.num_envs)]
        if not isinstance(seed, Sequence | np.ndarray) or len(seed) != self.num_envs:
            raise UseError("env.reset", [f"seed is {quote(seed)}: give one, or {self.num_envs} of them"])
        return [None if one is None else int(one) for one in seed]

    def _begin(self, mask: NDArray[np.bool_]) -> None:
        """New episodes, each with what varies drawn anew."""
        numbers = np.flatnonzero(mask).tolist()
        drawn = {
            name: [draw(self._generators[number]) for number in numbers] for name, draw in self._task.varies.items()
        }
        self.sims.reset(numbers, vary=drawn or None)
        self._over[mask] = False

    def step(self, actions: Array) -> tuple[Array, Array, Array, Array, dict[str, Any]]:
        """Set the inputs of all and go on by one period."""
        task, mode = self._task, self.metadata["autoreset_mode"]
        resting = self._over.copy()
        if resting.any():
            if mode == AutoresetMode.DISABLED:
                remedy = 'call reset(options={"reset_mask": ...}) first'
                raise UseError("env.step", [f"{int(resting.sum())} episodes are over: {remedy}"])
            self._begin(resting)
        moment = self._gone_on(self._accepted(actions), np.flatnonzero(~resting))
        over = moment.failed.copy()
        if self._ends is not None:
            over |= self._of_each("ends", self._ends(moment)).astype(bool)
        terminated = over & ~resting
        truncated = (moment.time >= task.times[0] - ROUND_OFF * task.times[1]) & ~resting
        rewards = np.where(resting, 0.0, self._rewarded(moment))
        seen, infos = self._seen(), dict[str, Any]()
        self._over = terminated | truncated
        if mode == AutoresetMode.SAME_STEP and self._over.any():
            infos = {"final_obs": seen.copy(), "_final_obs": self._over.copy()}
            self._begin(self._over.copy())
            seen = self._seen()
        return seen, rewards, terminated, truncated, infos

    def _gone_on(self, values: dict[str, Array], going: NDArray[np.intp]) -> Moments:
        """One period of those that go on."""
        t_end, period = self._task.times
        before = self.sims.readings()
        for name, numbers in values.items():
            self.sims.set(name, numbers[going], which=going)
        # the last period ends with the episode
        left = t_end - self.sims.time[going]
        steps = np.where(left < period * (1.0 - ROUND_OFF), left, period)
        events = dict[int, Events]()
        for step in np.unique(steps[steps > 0.0]).tolist():
            self.sims.advance(step, which=going[steps == step])
            events |= self.sims.events
        sims = self.sims
        return Moments(sims.time, period, values, before, sims.readings(), events, sims.failed)

    def _accepted(self, actions: Any) -> dict[str, Array]:
        """Actions of all as values by name; UseError for what is none."""
        names = self._task.actions.names
        try:
            numbers = np.asarray(actions, dtype=float)
        except (TypeError, ValueError):
            numbers = np.empty(0)
        if numbers.shape != (self.num_envs, len(names)) or not np.isfinite(numbers).all():
            wanted = f"give an array ({self.num_envs}, {len(names)}) of numbers from -1 to 1, for {', '.join(names)}"
            raise UseError("env.step", [f"actions is {quote(actions)}: {wanted}"])
        ranges = self._task.actions
        share = (np.clip(numbers, -1.0, 1.0) + 1.0) / 2.0
        return dict(zip(names, (ranges.low + share * (ranges.high - ranges.low)).T, strict=True))

    def _rewarded(self, moment: Moments) -> Array:
        rewards = self._of_each("reward", self._reward(moment)).astype(float)
        wrong = ~np.isfinite(rewards) & ~moment.failed
        if wrong.any():
            number = int(np.flatnonzero(wrong)[0])
            raise ClutchworkError(f"the reward of environment {number} is {rewards[number]}: return finite numbers")
        # with NaN as its signals a failed run may have none
        return np.where(np.isfinite(rewards), rewards, 0.0)

    def _of_each(self, name: str, given: Any) -> Array:
        found = np.asarray(given)
        if found.shape not in ((), (self.num_envs,)) or found.dtype == object:
            raise ClutchworkError(f"{name} returned {quote(given)}: return an array of {self.num_envs} numbers")
        return np.broadcast_to(found, (self.num_envs,))
