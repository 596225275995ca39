"""Fit the parameters of a friction law to measured slip and torque."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from clutchwork.declare.node import Law as LawBase
from clutchwork.fit import table
from clutchwork.fit.adjustable import faults
from clutchwork.fit.elsewhere import widened
from clutchwork.fit.experiment import advice
from clutchwork.fit.failure import FitError
from clutchwork.fit.intervals import Estimate, estimate
from clutchwork.fit.measurement import Measurement, measurement
from clutchwork.fit.model import model_of
from clutchwork.fit.ordinates import check_inside
from clutchwork.fit.result import FitResult, Parameter
from clutchwork.fit.search import Search, Solution
from clutchwork.fit.temperature import at_temperature
from clutchwork.fit.unknown import Bounds
from clutchwork.fit.unknowns import Unknowns

if TYPE_CHECKING:
    from clutchwork.declare.node import Law


def fit_law(
    law: Law,
    time: Any,
    slip: Any,
    torque: Any,
    load: Any = 1.0,
    *,
    temperature: Any = None,
    free: Sequence[str] | None = None,
    bounds: Bounds | None = None,
    rest: float | None = None,
    confidence: float = 0.95,
    translation: bool = False,
) -> FitResult:
    """Bounded least squares of measured friction torque; see docs/guide/fit.md.

    Parameters: law, with the start values, and the values of what is not free; time [s], slip [rad/s], torque [N m],
    rows of the same length; load [N m], the torque per unit of coefficient, a number or a row; temperature [K] for a
    law that depends on it, a number or a row, by default the number that the law holds; free, names of the parameters
    that are searched for, by default all that do not start at zero; bounds, {name: (lower, upper)} within
    those of the declaration; rest, abs(slip) [rad/s] below which a sample counts as at rest, by default 1e-3 of the
    largest; confidence of the intervals; translation, slip in m/s, torque and load in N.

    Samples that do not determine a parameter are not an error: the result reports it. FitError reports wrong input.
    """
    samples = measurement(time, slip, torque, load, temperature=temperature, translation=translation)
    return _fit(samples, law, free, bounds, rest, confidence)


def fit_csv(
    path: str | Path,
    law: Law,
    *,
    slip: str,
    torque: str,
    time: str = "time",
    load: str | float = 1.0,
    temperature: str | float | None = None,
    free: Sequence[str] | None = None,
    bounds: Bounds | None = None,
    rest: float | None = None,
    confidence: float = 0.95,
) -> FitResult:
    """As `fit_law`, from columns of a CSV file.

    Parameters: time, slip, torque, load and temperature are the heads of columns, with or without the unit in brackets;
    a column such as `slip [rpm]` is converted. Load and temperature may be numbers in SI.
    """
    columns = {"time": time, "slip": slip, "torque": torque, "load": load}
    samples = table.read(path, columns if temperature is None else columns | {"temperature": temperature})
    return _fit(samples, law, free, bounds, rest, confidence)


def _fit(
    samples: Measurement,
    law: Law,
    free: Sequence[str] | None,
    bounds: Bounds | None,
    rest: float | None,
    confidence: float,
) -> FitResult:
    _check(law, rest, confidence)
    samples = at_temperature(samples, law)
    check_inside(samples, law)
    model = model_of(samples, law, rest)
    search = Search(model, Unknowns(law, free, bounds, translation=samples.translation))
    count, equations = len(search.unknowns.searched), int(np.sum(model.equations))
    if equations <= count:
        fault = f"give {equations} equations for {count} parameters"
        raise FitError("samples", fault, "record more samples that slide, or free fewer parameters")
    solution = search.solve()
    found = widened(search, solution, estimate(search, solution.u, confidence))
    return _result(search, solution, found, confidence)


def _check(law: Law, rest: float | None, confidence: float) -> None:
    if not isinstance(law, LawBase):
        raise FitError("law", f"is {law!r}, which is not a friction law", "give one with its start values")
    found = faults(law)
    if found:
        raise FitError("law", f"has start values that do not fit: {found[0]}", "correct them")
    if rest is not None and not 0.0 <= rest < np.inf:
        raise FitError("rest", f"is {rest:g}", "give a slip >= 0")
    if not 0.0 < confidence < 1.0:
        raise FitError("confidence", f"is {confidence:g}", "give a share such as 0.95")


def _result(search: Search, solution: Solution, found: Estimate, confidence: float) -> FitResult:
    unknowns, samples, equations = search.unknowns, search.measured, search.model.equations
    law = unknowns.law_at(solution.u)
    fitted = search.model.torque(law)
    residuals, torque = (fitted - samples.torque)[equations], samples.torque[equations]
    variation = float(np.sum((torque - np.mean(torque)) ** 2))
    places = [place for place, reason in enumerate(found.reasons) if reason]
    ideas = advice(search, solution.u, found.deviation, places) if places else {}
    values = unknowns.values(solution.u)
    parameters = tuple(
        Parameter(
            item.name, item.unit, values[place], *found.limits[place], item.start,
            found.reasons[place], found.directions[place], ideas.get(place, ""),
        )
        for place, item in enumerate(unknowns.items)
    )  # fmt: skip
    spread = np.sqrt(np.diag(found.covariance))
    spread = np.where(spread > 0.0, spread, 1.0)
    return FitResult(
        law=law,
        parameters=parameters,
        correlation=found.covariance / np.outer(spread, spread),
        confidence=confidence,
        rms=float(np.sqrt(np.mean(residuals**2))),
        r2=1.0 - float(np.sum(residuals**2)) / variation if variation > 0.0 else float("nan"),
        alike=found.alike,
        converged=solution.converged,
        faults=tuple(faults(law)),
        advice=tuple(f"{name} {message}; {remedy}" for name, message, remedy in law.advice()),
        rest=search.model.rest,
        samples=samples,
        fitted=fitted,
        equations=equations,
    )
