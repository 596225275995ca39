"""Derivatives of runs by differences at tight tolerances, with a measure of how far they can be trusted."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

import clutchwork as cw
from clutchwork.base.errors import ModelError
from clutchwork.gradients.differentiable import Differentiable
from clutchwork.gradients.exact import Exact
from clutchwork.gradients.finite_differences import weights

# widths of the differences, of the scale of a number; the best of them counts
WIDTHS = (1e-3, 2e-4, 4e-5)
TIGHT = {"rtol": 1e-12, "atol": 1e-14}


@dataclass(frozen=True)
class Compared:
    """Derivatives of values by one number, by differences and by the core, against what counts as 1."""

    name: str
    missed: np.ndarray  # of each value: how far both are apart, of the scale of the value
    doubt: np.ndarray  # of each value: how far two differences are apart


def compared(function: Differentiable, exact: np.ndarray, scales: np.ndarray) -> list[Compared]:
    """The derivatives at the numbers of the driveline against differences of runs.

    Parameters: exact, derivatives; scales, the size of each value.
    """
    task, x = function.task, function.x0
    tight = Exact(replace(task, options=task.options.changed(TIGHT)))
    found = []
    for number, one in enumerate(task.parameters):
        size = max(abs(x[number]), one.scale if one.places else 0.0) or 1.0
        widths = [min(width * size, one.reach / 8) for width in WIDTHS]
        estimates = [e for width in widths if (e := _slope(tight, x, number, width)) is not None]
        if len(estimates) < 2:
            continue
        apart = np.array([np.abs(a - b) for a, b in pairwise(estimates)]) * size / scales
        best = np.argmin(np.where(np.isnan(apart), np.inf, apart), axis=0)
        chosen = np.choose(best, estimates[1:])
        found.append(Compared(one.name, np.abs(chosen - exact[:, number]) * size / scales, apart.min(axis=0)))
    return found


def _slope(runs: Exact, x: np.ndarray, number: int, width: float) -> np.ndarray | None:
    """A difference of fourth order, to one side at a bound."""
    for places in ((-2, -1, 1, 2), (0, 1, 2, 3, 4), (0, -1, -2, -3, -4)):
        points = np.tile(x, (len(places), 1))
        points[:, number] += width * np.array(places)
        try:
            return weights(places, len(places)) @ runs.values(points) / width
        except ModelError:
            continue
    return None


def scales(run: cw.Trajectory, outputs: dict) -> np.ndarray:
    """The size of each output: of its signal over the run, of a time the run itself."""
    found = []
    for one in outputs.values():
        if hasattr(one, "contact"):
            found.append(run.t_end)
        elif hasattr(one, "shaft"):
            found.append(max(abs(float(one.of(run))), 1e-12))
        else:
            size = _size(run, one.kept_as(run) if hasattr(one, "kept_as") else one.signal)
            found += [size] * len(getattr(one, "times", (0,)))
    return np.array(found)


def _size(run: cw.Trajectory, signal: str) -> float:
    """The size of a signal; of one that is round-off beside others of its unit, a small part of theirs."""
    own = float(np.max(np.abs(run[signal]), initial=0.0))
    alike = [name for name in run.names if run.units[name] == run.units[signal]]
    return max([own, 1e-12, *(1e-9 * float(np.max(np.abs(run[name]), initial=0.0)) for name in alike)])
