"""The same equations compiled by numba: the functions as they stand, over arrays in place of tuples."""

from __future__ import annotations

from functools import cache
from types import FunctionType, SimpleNamespace
from typing import Any

import numpy as np

from benchmarks.peers import equations


@cache
def compiled() -> Any:
    """The functions of the equations; ImportError where numba is not installed."""
    import numba

    space = dict(vars(equations))
    for name, value in vars(equations).items():
        if isinstance(value, tuple) and value and isinstance(value[0], tuple):
            space[name] = np.array(value)
    space["GAINS"], space["KNOTS"] = np.array(equations.GAINS), np.array(equations.KNOTS)
    for function in equations.FUNCTIONS:
        plain = FunctionType(function.__code__, space, function.__name__)
        space[function.__name__] = numba.njit(plain)
    return SimpleNamespace(**space)
