"""Derivatives by differences of runs at tight tolerances."""

from __future__ import annotations

from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from clutchwork.base.classes import dataclass
from clutchwork.base.errors import ModelError
from clutchwork.gradients.engine import Found, Task, stacked
from clutchwork.gradients.parameters import changes
from clutchwork.results.gradient import NoGradient
from clutchwork.sweeps.batch import Batch, Wanted, Way
from clutchwork.sweeps.variants import Variants

if TYPE_CHECKING:
    from collections.abc import Sequence

    from clutchwork.assembly.system import System
    from clutchwork.declare.options import Options

Array = NDArray[np.float64]

# of the scale of a number
STEP = 1e-3
TIGHT = {"rtol": 1e-11, "atol": 1e-13}


@dataclass(frozen=True, eq=False)
class Differences:
    """Central differences of fourth order."""

    task: Task

    def values(self, x: Array) -> Array:
        """Values for each line of numbers, NaN where there is none."""
        return self._runs([self._system(line) for line in x], self.task.options)

    def gradient(self, x: Array) -> Found:
        """Values and derivatives at a point."""
        tight, steps = self.task.options.changed(TIGHT), self._steps(x)
        values = self.values(x[None])[0]
        systems, weights = list["System"](), list[Array]()
        for number, step in enumerate(steps):
            made, shares = self._sides(x, number, step)
            systems += made
            rows = np.zeros((len(made), len(steps)))
            rows[:, number] = shares / step
            weights.append(rows)
        found = self._runs(systems, tight)
        matrix = found.T @ np.concatenate(weights)
        none = np.isnan(values + matrix.sum(axis=1)).tolist()
        missing = [name for name, lacks in zip(self._names(), none, strict=True) if lacks]
        if missing:
            remedy = "take an event that happens, or another end time"
            raise NoGradient([f"{name} has no value here, or beside it; {remedy}" for name in missing])
        return Found(values, matrix)

    def gradients(self, x: Array) -> tuple[Array, Array]:
        """The same for each line of numbers; NaN where there is none."""
        found = [self._gradient_or_none(line) for line in x]
        return np.array([one.values for one in found]), np.array([one.matrix for one in found])

    def product(self, x: Array, weights: Array) -> tuple[Array, Array]:
        """Values at a point, and the derivatives of their weighted sum."""
        found = self.gradient(x)
        return found.values, weights @ found.matrix

    def _gradient_or_none(self, x: Array) -> Found:
        try:
            return self.gradient(x)
        except NoGradient:
            values = self.values(x[None])[0]
            return Found(values, np.full((len(values), len(x)), np.nan))

    def _names(self) -> list[str]:
        return [
            name for name, one in self.task.outputs.items() for _ in range(len(getattr(one, "times", None) or (None,)))
        ]

    def _steps(self, x: Array) -> list[float]:
        scaled = zip(self.task.parameters, np.abs(x).tolist(), strict=True)
        return [
            min(STEP * (max(size, one.scale) if one.places else size or 1.0), one.reach / 8) for one, size in scaled
        ]

    def _sides(self, x: Array, number: int, step: float) -> tuple[list[System], Array]:
        """Systems beside a point in one number, and the weights of their values."""
        for sign in (0.0, 1.0, -1.0):
            # -25/12, 4, -3, 4/3, -1/4: the difference of fourth order to one side
            one_sided = [(sign * k, sign * w) for k, w in enumerate((-25 / 12, 4.0, -3.0, 4 / 3, -1 / 4))]
            places = one_sided if sign else [(-2.0, 1 / 12), (-1.0, -8 / 12), (1.0, 8 / 12), (2.0, -1 / 12)]
            try:
                made = [self._system(_moved(x, number, place * step)) for place, _ in places]
            except ModelError as error:
                wrong = error
                continue
            return made, np.array([weight for _, weight in places])
        raise wrong

    def _system(self, x: Array) -> System:
        task = self.task
        return task.system.changed(changes(task.system, task.parameters, x))

    def _runs(self, systems: Sequence[System], options: Options) -> Array:
        task = self.task
        wanted = Wanted.of(task.system, options, task.outputs, task.t_end)
        batch = Batch(_plan(task.system, systems), wanted, Way(task.t_end, options, task.threads))
        block = batch.run(0, len(systems), None)
        if block.raised is not None:
            raise block.raised
        values = {name: block.values.get(name, np.full(len(systems), np.nan)) for name in task.outputs}
        return stacked(values, len(systems))


def _moved(x: Array, number: int, by: float) -> Array:
    made = x.copy()
    made[number] += by
    return made


def _plan(base: System, systems: Sequence[System]) -> Any:
    """Systems without axes, as a batch asks for them."""

    def some(first: int, last: int) -> tuple[Sequence[System], NDArray[np.int64]]:
        return systems[first:last], np.arange(last - first)

    return SimpleNamespace(
        base=base, variants=Variants((), len(systems)), axes=[], bound=[], whole=set(), systems=some, relevant=_none
    )


def _none(_signal: str) -> list[Any]:
    return []
