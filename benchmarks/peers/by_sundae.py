"""CVODE of SUNDIALS through scikit-sundae: the solver is compiled, the right-hand side is called in Python."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from benchmarks.peers import equations
from benchmarks.peers.driver import Phase, Reached, reference

METHODS = ("BDF", "Adams")


def available() -> Any:
    """`solver`; ImportError where scikit-sundae is not installed."""
    import sksundae  # noqa: F401

    return solver


def solver(method: str, made: Any = equations, rtol: float = 1e-6) -> Callable[[Phase], Reached]:
    """What solves one phase."""
    from sksundae.cvode import CVODE

    plain = made is equations

    def solve(phase: Phase) -> Reached:
        modes, k = phase.modes, phase.k

        def slope(t: float, y: Any, into: Any) -> None:
            into[:] = made.slope(t, y.tolist() if plain else y, modes, k)

        def watch(t: float, y: Any, into: Any) -> None:
            numbers = y.tolist() if plain else y
            for place, i in enumerate(phase.guards):
                into[place] = made.guard(i, t, numbers, modes, k)

        watch.terminal, watch.direction = [True] * len(phase.guards), [-1] * len(phase.guards)  # type: ignore[attr-defined]
        options = {"method": method, "rtol": rtol, "atol": 1e-2 * rtol, "max_num_steps": 100_000}
        one = CVODE(slope, eventsfn=watch, num_events=len(phase.guards), **options)
        wanted = np.array([phase.start, phase.stop])
        if phase.dense:
            grid = reference()[0]
            wanted = np.unique(np.concatenate([wanted, grid[(grid > phase.start) & (grid < phase.stop)]]))
        found = one.solve(wanted, phase.y)
        if not found.success:
            raise RuntimeError(f"CVODE {method}: {found.message}")
        t, y, hit = float(found.t[-1]), np.array(found.y[-1]), None
        if found.i_events is not None and len(found.i_events):
            t, y = float(found.t_events[-1]), np.array(found.y_events[-1])
            hit = next(i for i, sign in zip(phase.guards, found.i_events[-1], strict=True) if sign)
        instants, states = np.array(found.t), np.array(found.y)
        at = (lambda times: states[np.searchsorted(instants, times)]) if phase.dense else None
        return Reached(t, y, hit, at)

    return solve
