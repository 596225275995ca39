"""Random cases by seed: all of them run, and those that fail are reported together, with figures."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterable
from typing import Any

import numpy as np

import clutchwork as cw

# figures of so many failing seeds are shown; the seeds themselves are all named
SHOWN = 25


def sweep(check: Callable[[int], str], seeds: int | Iterable[int]) -> None:
    """Run `check` for each seed; it returns what is wrong with the case, "" where nothing is."""
    wanted = range(seeds) if isinstance(seeds, int) else list(seeds)
    failed = [(seed, text) for seed in wanted if (text := _checked(check, seed))]
    if not failed:
        return
    lines = [f"  seed {seed}: {text}" for seed, text in failed[:SHOWN]]
    names = ", ".join(str(seed) for seed, _ in failed)
    raise AssertionError("\n".join([f"{len(failed)} of {len(wanted)} seeds fail: {names}", *lines]))


def _checked(check: Callable[[int], str], seed: int) -> str:
    # an error or a warning in one case is a finding of that case, and hides no other
    try:
        return check(seed)
    except (cw.ClutchworkError, ValueError, RuntimeError, IndexError, Warning) as error:
        return f"{type(error).__name__}: {error}"


def simulate(driveline: cw.Driveline, t_end: float, **options: Any) -> Any:
    """Run without the warning of a run that stops early: the caller asks for its status."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", cw.StoppedEarly)
        return driveline.simulate(t_end, **options)


def log_uniform(rng: np.random.Generator, low: float, high: float) -> float:
    """A random number between two bounds, uniform in its logarithm."""
    return float(np.exp(rng.uniform(np.log(low), np.log(high))))


def stopped(run: Any) -> str:
    """How a run ended that did not reach its end; "" where it did."""
    return "" if run.status == "done" else f"{run.status}: {run.message}"
