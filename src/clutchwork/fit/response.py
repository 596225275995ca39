"""Fit numbers of a driveline to a measured response."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import field
from math import exp, inf, log, sqrt
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from clutchwork.base.classes import dataclass
from clutchwork.base.errors import near
from clutchwork.base.text import columns
from clutchwork.declare.options import Options
from clutchwork.declare.schema import specs
from clutchwork.fit.failure import FitError, scipy
from clutchwork.fit.information import information
from clutchwork.fit.result import Parameter
from clutchwork.run.simulation import simulate

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.face.driveline import Driveline
    from clutchwork.results.trajectory import Trajectory

Array = NDArray[np.float64]

# relative step of difference quotients, far above the error of the runs
STEP, RTOL, ATOL = 1e-4, 1e-9, 1e-11
# how far the search goes from a start value, as a factor
REACH = 1e3
# an interval wider than this factor either way determines nothing
WIDE = 2.0


@dataclass(frozen=True, eq=False)
class ResponseFit:
    """Fitted numbers of a driveline with their intervals, and how well its run describes the samples."""

    parameters: tuple[Parameter, ...]
    run: Trajectory = field(repr=False)  # with the fitted values, at the instants of the samples
    rms: Mapping[str, float]  # of the residuals, by signal, in its unit
    r2: float  # share of the variation of the samples that the run describes
    confidence: float  # of the intervals
    converged: bool

    @property
    def values(self) -> dict[str, float]:
        """Fitted values by name, as `System.changed` takes them."""
        return {one.name: one.value for one in self.parameters}

    @property
    def determined(self) -> bool:
        """Whether the search ended and the samples determine every parameter."""
        return self.converged and all(one.determined for one in self.parameters)

    @property
    def message(self) -> str:
        """What stands in the way of using the values, one line each; empty when nothing does."""
        lines = [] if self.converged else ["the search did not converge: start closer to it or free fewer parameters"]
        return "\n".join([*lines, *(str(one) for one in self.parameters if not one.determined)])

    def __getitem__(self, name: str) -> Parameter:
        for one in self.parameters:
            if one.name == name:
                return one
        raise KeyError(f"no fitted parameter {name!r}{near(name, list(self.values))}")

    def __str__(self) -> str:
        """A table for reading."""
        head = f"{len(self.run.time)} samples, r2 {self.r2:.6g}"
        lines = [["parameter", "value", f"{100 * self.confidence:g} % from", "to", "unit", "start", ""]]
        for p in self.parameters:
            numbers = [f"{number:.5g}" for number in (p.value, p.lower, p.upper)]
            lines.append([p.name, *numbers, p.unit, f"{p.start:.5g}", "" if p.determined else "not determined"])
        return "\n\n".join(part for part in (head, columns(lines, right=(1, 2, 3, 5)), self.message) if part)


def fit_response(
    driveline: Driveline,
    time: Any,
    measured: Mapping[str, Any],
    free: Sequence[str],
    *,
    bounds: Mapping[str, tuple[float, float]] | None = None,
    confidence: float = 0.95,
) -> ResponseFit:
    """Bounded least squares of measured signals over numbers of a driveline; see docs/guide/fit.md.

    Parameters: driveline, with the start values; time [s], rising; measured, rows of samples in SI by the name of the
    signal, "piston.pressure"; free, names of the numbers that are searched for, above zero, "piston.orifice_area";
    bounds, {name: (lower, upper)}, by default a factor of 1000 either way; confidence of the intervals. The run
    starts at 0 s. Each signal counts by its own size.

    Numbers that the samples do not determine are not an error: the result reports them. FitError reports wrong input.
    """
    search = _Search(driveline, time, measured, free, bounds or {})
    found = scipy("optimize").least_squares(
        search.residuals, search.start, jac=search.jacobian, bounds=search.bounds, x_scale="jac", xtol=1e-10, ftol=1e-12
    )
    run = search.run(found.x)
    left = {name: run[name] - search.measured[name] for name in search.measured}
    variation = sum(float(np.sum(((y - np.mean(y)) / search.sizes[name]) ** 2)) for name, y in search.measured.items())
    squares = float(np.sum(search.residuals(found.x) ** 2))
    return ResponseFit(
        parameters=search.parameters(found.x, squares, confidence),
        run=run,
        rms={name: float(np.sqrt(np.mean(rest**2))) for name, rest in left.items()},
        r2=1.0 - squares / variation if variation > 0.0 else float("nan"),
        confidence=confidence,
        converged=found.status > 0,
    )


class _Search:
    """Residuals of all samples over the logarithms of the free numbers."""

    def __init__(
        self,
        driveline: Driveline,
        time: Any,
        measured: Mapping[str, Any],
        free: Sequence[str],
        bounds: Mapping[str, tuple[float, float]],
    ) -> None:
        self.system: System = driveline.assemble()
        self.time = np.asarray(time, dtype=float)
        self.measured = {name: np.asarray(values, dtype=float) for name, values in measured.items()}
        self.sizes = {name: float(np.sqrt(np.mean(y**2))) or 1.0 for name, y in self.measured.items()}
        self.names = list(free)
        _check(self.time, self.measured, self.names)
        self.units, self.values = zip(*(_number(driveline, name) for name in self.names), strict=True)
        ends = [bounds.get(name, (v / REACH, v * REACH)) for name, v in zip(self.names, self.values, strict=True)]
        for name, value, (low, high) in zip(self.names, self.values, ends, strict=True):
            if not 0.0 < low < value < high < inf:
                fault = f"of {name} are {low:g} to {high:g}, its start value is {value:g}"
                raise FitError("bounds", fault, "give bounds above zero, and start between them")
        self.start = np.log(self.values)
        self.bounds = (np.log([low for low, _ in ends]), np.log([high for _, high in ends]))

    def run(self, u: Array) -> Trajectory:
        """The run with the values of a code."""
        made = self.system.changed(dict(zip(self.names, np.exp(u).tolist(), strict=True)))
        options = Options(rtol=RTOL, atol=ATOL, times=self.time, work=False)
        return simulate(made, float(self.time[-1]), options=options).raise_for_status()

    def residuals(self, u: Array) -> Array:
        """Run minus samples of all signals, over the size of each."""
        run = self.run(u)
        return np.concatenate([(run[name] - y) / self.sizes[name] for name, y in self.measured.items()])

    def jacobian(self, u: Array) -> Array:
        """Derivatives by central differences, one-sided at bounds."""
        found = []
        for place in range(len(u)):
            above, below = u.copy(), u.copy()
            above[place] = min(u[place] + STEP, self.bounds[1][place])
            below[place] = max(u[place] - STEP, self.bounds[0][place])
            found.append((self.residuals(above) - self.residuals(below)) / (above[place] - below[place]))
        return np.array(found).T

    def parameters(self, u: Array, squares: float, confidence: float) -> tuple[Parameter, ...]:
        """Values with their intervals, and what the samples leave open."""
        known = information(self.jacobian(u), 1.0, False)
        freedom = max(len(self.time) * len(self.measured) - len(u), 1)
        covariance = squares / freedom * known.covariance(np.eye(len(u)))
        t = float(scipy("stats").t.ppf(0.5 + 0.5 * confidence, freedom))
        made = []
        for place, name in enumerate(self.names):
            half = min(t * sqrt(float(covariance[place, place])), log(REACH))
            value = exp(float(u[place]))
            why = "no sample depends on it" if known.silent[place] else ""
            if not why and half > log(WIDE):
                why = f"its interval is wider than a factor of {WIDE:g} either way"
            ends = (value * exp(-half), value * exp(half))
            made.append(Parameter(name, self.units[place], value, *ends, float(self.values[place]), why))
        return tuple(made)


def _check(time: Array, measured: Mapping[str, Array], free: Sequence[str]) -> None:
    if time.ndim != 1 or len(time) < 2 or not np.all(np.diff(time) > 0.0):
        raise FitError("time", "does not rise", "give a row of at least two instants [s]")
    for name, values in measured.items():
        if values.shape != time.shape or not np.all(np.isfinite(values)):
            raise FitError(name, f"has {values.size} samples for {len(time)} instants", "give one number for each")
    if not measured or not free:
        raise FitError("free" if measured else "measured", "is empty", "give at least one name")
    if len(time) * len(measured) <= len(free):
        raise FitError("samples", f"are {len(time) * len(measured)} for {len(free)} numbers", "record more of them")


def _number(driveline: Driveline, name: str) -> tuple[str, float]:
    """Unit and start value of a number of the driveline."""
    things: list[Any] = [*driveline.nodes, *driveline.elements, *driveline.thermal_nodes]
    owners = {one.name: one for one in things}
    owner, _, rest = name.rpartition(".")
    thing: Any = owners.get(owner)
    if thing is None:
        owner, _, inner = owner.rpartition(".")
        thing = getattr(owners.get(owner), inner, None)
    value = getattr(thing, rest, None)
    if isinstance(value, bool) or not isinstance(value, int | float) or not value > 0.0:
        fault = f"{name!r} is {value!r}, not a number above zero" if thing is not None else f"has no {name!r}"
        like = near(name.rpartition(".")[0], list(owners)) if thing is None else ""
        raise FitError("free", fault + like, 'name a number of an element, "c1.gain"')
    spec = next((spec for item, spec in specs(type(thing)) if item.name == rest), None)
    return spec.unit if spec else "", float(value)
