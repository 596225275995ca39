"""An importer of FMUs for model exchange: a solver of SciPy, events located on its interpolant, in either version."""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any

import numpy as np
from fmpy.fmi2 import FMU2Model
from fmpy.fmi3 import FMU3Model
from numpy.typing import NDArray
from scipy.integrate import Radau
from scipy.optimize import brentq

from support.fmus import Fmu, Instance

Array = NDArray[np.float64]
# where an indicator is looked at inside of a step
LOOKS = np.linspace(0.0, 1.0, 9)[1:]


class Exchanged(Instance):
    """An instance for model exchange, alike for both versions of FMI."""

    kinds = (FMU2Model, FMU3Model)
    interface = "modelExchange"

    def begin(self, values: Mapping[str, float], *, start: float = 0.0, tolerance: float | None = None) -> None:
        """Initialise with values; the event mode in which it is then comes next."""
        super().begin(values, start=start, tolerance=tolerance)
        two = self.fmu.version == "2.0"
        model = self.fmu.description
        self.states = int(model.numberOfContinuousStates if two else self.raw.getNumberOfContinuousStates())
        self.indicators = int(model.numberOfEventIndicators if two else self.raw.getNumberOfEventIndicators())
        self.time = start

    def _numbers(self, call: Callable[[Any, int], Any], count: int) -> Array:
        room = (ctypes.c_double * count)()
        call(room, count)
        return np.array(room)

    def place(self, time: float, x: Array) -> None:
        """Take time and state."""
        self.time = time
        self.raw.setTime(time)
        self.raw.setContinuousStates((ctypes.c_double * len(x))(*x), len(x))

    def x(self) -> Array:
        """The present state."""
        return self._numbers(self.raw.getContinuousStates, self.states)

    def rates(self) -> Array:
        """Its time derivative."""
        two = self.fmu.version == "2.0"
        return self._numbers(self.raw.getDerivatives if two else self.raw.getContinuousStateDerivatives, self.states)

    def margins(self) -> Array:
        """Event indicators."""
        return self._numbers(self.raw.getEventIndicators, self.indicators)

    def decide(self) -> float:
        """Until nothing is due; the next time event [s]."""
        while True:
            found = self.raw.newDiscreteStates() if self.fmu.version == "2.0" else self.raw.updateDiscreteStates()
            if not found[0]:
                return float(found[5]) if found[4] else np.inf


@contextmanager
def exchanged(
    fmu: Fmu, values: Mapping[str, float] | None = None, *, log: bool = False, tolerance: float | None = None
) -> Iterator[Exchanged]:
    """An instance for model exchange that is initialised with values."""
    made = Exchanged(fmu, log=log)
    try:
        made.begin(values or {}, start=float(fmu.description.defaultExperiment.startTime), tolerance=tolerance)
        yield made
    finally:
        made.free()


def simulated(
    run: Exchanged,
    times: Sequence[float] | Array,
    names: Sequence[str],
    *,
    rtol: float = 1e-8,
    solver: Any = Radau,
    inputs: Callable[[float], Mapping[str, float]] = lambda _: {},
    knots: Sequence[float] = (),
    most_steps: int = 1_000_000,
) -> tuple[Array, list[float]]:
    """Rows of variables at times, and the instants of all events.

    Parameters: inputs, what they are at a time, continuous but for `knots`, where they are set in event mode, from the
    right; most_steps, how many steps it may take, counted like events, so that none goes on for ever.
    """
    steps = 0
    rows = np.full((len(times), len(names)), np.nan)
    events, done, time, end = list[float](), 0, run.time, float(times[-1])

    def take(values: Mapping[str, float]) -> None:
        for name, value in values.items():
            run.set(name, value)

    def place(t: float, x: Array) -> None:
        run.place(t, x)
        take(inputs(t))

    def rates(t: float, x: Array) -> Array:
        place(t, x)
        return run.rates()

    def fill(until: float, state: Callable[[float], Array], *, whole: bool) -> None:
        nonlocal done
        while done < len(times) and (times[done] < until or (whole and times[done] <= until)):
            place(float(times[done]), state(float(times[done])))
            rows[done] = run.get(names)
            done += 1

    knot = run.decide()
    sizes = run._numbers(run.raw.getNominalsOfContinuousStates, run.states)
    run.raw.enterContinuousTimeMode()
    while time < end:
        stop = min([end, knot, *(t for t in knots if t > time)])
        x = run.x()
        walk = solver(rates, time, x, stop, rtol=rtol, atol=rtol * np.maximum(sizes, 1e-300))
        hit = np.inf
        while walk.status == "running" and hit == np.inf:
            message = walk.step()
            steps += 1
            assert steps + len(events) < most_steps, (walk.t, len(events))
            assert walk.status != "failed", (walk.t, message)
            state = walk.dense_output()
            hit = _first(place, run, state, walk.t_old, walk.t)
            fill(min(hit, walk.t), state, whole=False)
        at = min(hit, walk.t)
        x = state(at) if hit < np.inf else walk.y
        if at >= end and hit == np.inf:
            fill(end, lambda _, last=x: last, whole=True)  # type: ignore[misc]
        place(at, x)
        run.raw.enterEventMode()
        take(inputs(np.nextafter(at, np.inf)) if at in knots else {})
        if hit < np.inf:
            events.append(at)
        time, knot = at, run.decide()
        run.raw.enterContinuousTimeMode()
    return rows, events


def _first(place: Any, run: Exchanged, state: Any, start: float, end: float) -> float:
    """The first instant at which an indicator is below zero; infinite: none."""

    def least(t: float) -> float:
        place(t, state(t))
        found = run.margins()
        return float(found.min()) if len(found) else 1.0

    before = start
    for share in LOOKS:
        t = start + share * (end - start)
        if least(t) < 0:
            if least(before) < 0:
                return before
            at = brentq(least, before, t, xtol=1e-15 * (1 + abs(t)), rtol=1e-15)
            # behind it, as far as the time can be told apart
            while least(at) >= 0 and at < t:
                at = min(t, at + 1e-15 * (1 + abs(t)) + (at - before) * 1e-12)
            return at
        before = t
    return np.inf
