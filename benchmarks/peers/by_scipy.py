"""SciPy: solve_ivp with terminal events, its right-hand sides interpreted or compiled."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

from benchmarks.peers import equations
from benchmarks.peers.driver import Phase, Reached

METHODS = ("LSODA", "Radau", "RK45")


def solver(method: str, made: Any, rtol: float = 1e-6) -> Callable[[Phase], Reached]:
    """What solves one phase; `made` has the functions, those of `equations` or of `compiled`."""
    # plain numbers are quicker than those of numpy where Python computes with them
    plain = made is equations

    def solve(phase: Phase) -> Reached:
        modes, k = phase.modes, phase.k

        def slope(t: float, y: Any) -> Any:
            return made.slope(t, y.tolist() if plain else y, modes, k)

        def watch(i: int) -> Any:
            def guard(t: float, y: Any) -> Any:
                return made.guard(i, t, y.tolist() if plain else y, modes, k)

            guard.terminal, guard.direction = True, -1  # type: ignore[attr-defined]
            return guard

        events = [watch(i) for i in phase.guards]
        span, options = (phase.start, phase.stop), {"rtol": rtol, "atol": 1e-2 * rtol, "dense_output": phase.dense}
        found = solve_ivp(slope, span, phase.y, method, events=events, **options)
        if found.status < 0:
            raise RuntimeError(f"SciPy {method}: {found.message}")
        hit = next((i for i, times in zip(phase.guards, found.t_events, strict=True) if len(times)), None)
        at = (lambda times: found.sol(times).T) if phase.dense else None
        return Reached(float(found.t[-1]), np.array(found.y[:, -1]), hit, at)

    return solve
