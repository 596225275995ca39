"""Values and derivatives for one line of numbers or for any array of lines."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from clutchwork.base import UseError, counted
from clutchwork.base.arrays import Array
from clutchwork.gradients.differentiable import Differentiable


def values(f: Differentiable, x: Array) -> Array:
    """Values (..., of) at numbers (..., by): many lines on threads."""
    if x.ndim == 1:
        return f(x)
    return f.batch(_flat(x)).reshape(*x.shape[:-1], len(f.of))


def values_and_matrix(f: Differentiable, x: Array) -> tuple[Array, Array]:
    """Values (..., of) and derivatives (..., of, by).

    NaN for a derivative that does not exist; NoGradient for one line that has none at all, NaN for one of many.
    """
    if x.ndim == 1:
        return _at_one(f, x)
    found, matrix = f.batch_jacobian(_flat(x))
    lead = x.shape[:-1]
    return found.reshape(*lead, len(f.of)), matrix.reshape(*lead, len(f.of), len(f.by))


def _at_one(f: Differentiable, x: Array) -> tuple[Array, Array]:
    # the cost of a weighted sum does not grow with the number of numbers
    if len(f.of) == 1:
        found, gradient = f.vjp(x, np.ones(1))
        return found, gradient[None]
    return f.value_and_jacobian(x)


def _flat(x: Array) -> Array:
    return x.reshape(-1, x.shape[-1])


def refuse(call: str, f: Differentiable, shape: Sequence[int], kind: str, remedy: str) -> None:
    """Refuse arrays of another shape, or of numbers that are not doubles.

    Parameters: kind, the numbers of x, such as "float32"; remedy, how the framework makes doubles of them.
    """
    problems = []
    if not shape or shape[-1] != len(f.by):
        by = counted(len(f.by), "numbers")
        problems.append(f"x has shape {tuple(shape)}; give {by} along its last axis: {', '.join(f.by)}")
    if kind != "float64":
        problems.append(f"x is {kind}, too coarse for the derivatives of a run; {remedy}")
    if problems:
        raise UseError(call, problems)


def no_second(call: str) -> UseError:
    """Derivatives of derivatives are asked for."""
    return UseError(call, ["a run has first derivatives only; take a method without Hessians, such as BFGS"])
