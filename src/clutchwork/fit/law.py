"""Fit the parameters of a friction law to measured slip and torque."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from numbers import Real
from pathlib import Path
from typing import Any

import numpy as np

from clutchwork.base import counted
from clutchwork.base.arrays import Array
from clutchwork.declare.node import Law
from clutchwork.declare.node import Law as LawBase
from clutchwork.declare.schema import inputs
from clutchwork.fit import table
from clutchwork.fit.adjustable import faults
from clutchwork.fit.engine import Solution
from clutchwork.fit.estimates import Parameter
from clutchwork.fit.experiment import advice
from clutchwork.fit.failure import FitError, all_of, described_by_nothing
from clutchwork.fit.intervals import Estimate, estimate
from clutchwork.fit.losses import WIDTH, Penalty
from clutchwork.fit.measurement import Measurement, measurement
from clutchwork.fit.misfit import DESCRIBED, is_worse, patterns
from clutchwork.fit.model import model_of
from clutchwork.fit.ordinates import check_inside
from clutchwork.fit.profile_intervals import widened
from clutchwork.fit.readings import likely, of_coefficients, of_units
from clutchwork.fit.result import FitResult
from clutchwork.fit.search import TORQUE, Residuals
from clutchwork.fit.sliding import Sliding, noisy
from clutchwork.fit.unknown import Bounds
from clutchwork.fit.unknowns import Unknowns

TEMPERATURE = "temperature"
_REMEDY = "give the measured temperature [K], a number or a row"


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
    loss: str = "linear",
    loss_width: float = WIDTH,
) -> FitResult:
    """Bounded least squares of measured friction torque; see docs/guide/fit.md.

    Parameters: law, with the start values, and the values of what is not free; time [s], slip [rad/s], torque [N m],
    rows of the same length; load [N m], the torque per unit of coefficient, a number or a row; temperature [K] for a
    law that depends on it, a number or a row, by default the number that the law holds; free, names of the parameters
    that are searched for, by default all that do not start at zero; bounds, {name: (lower, upper)} within
    those of the declaration; rest, abs(slip) [rad/s] below which a sample counts as at rest, by default 1e-3 of the
    largest, or what the noise of the slip reaches where it turns signs; confidence of the intervals; translation, slip
    in m/s, torque and load in N; loss, "linear" for least squares, "soft_l1", "huber" or "cauchy" for samples that are
    off, in which residuals count less from loss_width deviations of the noise on.

    Samples that do not determine a parameter are not an error: the result reports it. FitError reports wrong input, and
    a fit that is worse than the mean of the samples.
    """
    samples, penalty, _ = all_of(
        partial(measurement, time, slip, torque, load, temperature=temperature, translation=translation),
        partial(Penalty, loss, loss_width),
        partial(_check, law, free, bounds, rest, confidence),
    )
    return _fit(samples, law, free, bounds, rest, confidence, penalty)


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
    loss: str = "linear",
    loss_width: float = WIDTH,
) -> FitResult:
    """As `fit_law`, from columns of a CSV file.

    Parameters: time, slip, torque, load and temperature are the heads of columns, with or without the unit in brackets;
    a column such as `slip [rpm]` is converted. Load and temperature may be numbers in SI.
    """
    columns = {"time": time, "slip": slip, "torque": torque, "load": load}
    samples, penalty, _ = all_of(
        partial(table.read, path, columns if temperature is None else columns | {"temperature": temperature}),
        partial(Penalty, loss, loss_width),
        partial(_check, law, free, bounds, rest, confidence),
    )
    return _fit(samples, law, free, bounds, rest, confidence, penalty)


def _fit(
    samples: Measurement,
    law: Law,
    free: Sequence[str] | None,
    bounds: Bounds | None,
    rest: float | None,
    confidence: float,
    loss: Penalty,
) -> FitResult:
    def searched(samples: Measurement) -> tuple[Residuals, Solution]:
        samples = at_temperature(samples, law)
        check_inside(samples, law)
        model = model_of(samples, law, rest)
        search = Residuals(model, Unknowns(law, free, bounds, translation=samples.translation), loss=loss)
        count, equations = len(search.unknowns.searched), int(np.sum(model.equations))
        if equations <= count:
            fault = f"give {equations} equations for {count} parameters"
            raise FitError("samples", fault, "record more samples that slide, or free fewer parameters")
        return search, search.settle(search.solve())

    search, solution = searched(samples)
    r2 = _share(search, solution)
    found = widened(search, solution, estimate(search, solution.u, confidence))
    doubts = _doubts(search, found)
    worse = is_worse(r2, int(np.sum(search.model.equations)))
    # runs of the core for a few percent would take long
    if worse or (doubts and search.model.exact):
        hints = [*_turned(search), *likely(samples, 1.0 - r2, lambda other: _share(*searched(other)))]
        doubts = [*hints, *doubts] if worse else [*doubts, *hints]
    result = _result(search, solution, found, confidence, r2, doubts)
    if worse:
        raise described_by_nothing(r2, doubts, result)
    return result


def _share(search: Residuals, solution: Solution) -> float:
    """Share of the variation of the torque that a solution describes."""
    counts = search.model.equations
    left, values = search.residuals(solution.u)[counts], search.measured.torque[counts]
    return search.loss.share(left, values, 1.0 if search.within is None else search.within[counts])


def _turned(search: Residuals) -> list[str]:
    """Signs that noise of the slip turned above a threshold of rest that was given."""
    slips = noisy(search.measured) if isinstance(search.model, Sliding) else np.zeros(0)
    if np.all(slips <= search.model.rest):
        return []
    count = counted(len(slips), "samples")
    remedy = f"leave out `rest`, or give {slips[-1]:.3g}"
    return [f"likely noise of the slip reversed the sign of {count} near rest: {remedy}"]


def _doubts(search: Residuals, found: Estimate) -> list[str]:
    """What says that the law does not describe the samples, whatever its parameters."""
    counts = search.model.equations
    slip, torque = search.measured.slip[counts], search.measured.torque[counts]
    size = float(np.sqrt(np.mean(torque**2)))
    lines = patterns({"slip": found.felt[np.argsort(slip, kind="stable")], "time": found.felt}, size)
    described = 1.0 - float(np.mean(found.felt**2)) / size**2
    if described < DESCRIBED:
        lines.append(f"the law describes {100 * max(described, 0.0):.2g} % of the squares of the torque")
    return lines


def _check(law: Law, free: Sequence[str] | None, bounds: Bounds | None, rest: float | None, confidence: float) -> None:
    all_of(partial(_check_law, law, free, bounds), partial(_check_rest, rest), partial(_check_confidence, confidence))


def _check_law(law: Law, free: Sequence[str] | None, bounds: Bounds | None) -> None:
    if not isinstance(law, LawBase):
        raise FitError("law", f"is {law!r}, which is not a friction law", "give one with its start values")
    found = faults(law)
    if found:
        raise FitError("law", f"has start values that do not fit: {found[0]}", "correct them")
    Unknowns(law, free, bounds, translation=False)


def _check_rest(rest: float | None) -> None:
    if rest is not None and not 0.0 <= rest < np.inf:
        raise FitError("rest", f"is {rest:g}", "give a slip >= 0")


def _check_confidence(confidence: float) -> None:
    if not 0.0 < confidence < 1.0:
        raise FitError("confidence", f"is {confidence:g}", "give a share such as 0.95")


def _result(
    search: Residuals, solution: Solution, found: Estimate, confidence: float, r2: float, doubts: Sequence[str]
) -> FitResult:
    unknowns, samples, equations = search.unknowns, search.measured, search.model.equations
    law = unknowns.law_at(solution.u)
    fitted = search.model.torque(law)
    residuals = (fitted - samples.torque)[equations]
    places = [place for place, reason in enumerate(found.reasons) if reason]
    ideas = advice(search, solution.u, found.deviation, places) if places else {}
    parameters = found.parameters(search, solution.u, ideas)
    return FitResult(
        law=law,
        parameters=parameters,
        correlation=found.correlation,
        confidence=confidence,
        rms=float(np.sqrt(np.mean(residuals**2))),
        r2=r2,
        alike=found.alike[TORQUE],
        converged=solution.converged,
        faults=tuple(faults(law)),
        advice=tuple(
            f"{one} {message}; {remedy}" for one, message, remedy in (*law.advice(), *law.slip_advice("rad/s"))
        ),
        doubts=tuple(doubts),
        remarks=tuple(_remarks(search, residuals, parameters)),
        rest=search.model.rest,
        samples=samples,
        fitted=fitted,
        equations=equations,
    )


def _remarks(search: Residuals, residuals: Array, parameters: Sequence[Parameter]) -> list[str]:
    """What to know about samples and search."""
    model, made = search.model, of_units(parameters)
    made += of_coefficients(parameters, translation=search.measured.translation)
    unit, force = ("m/s", "N") if search.measured.translation else ("rad/s", "N m")
    if isinstance(model, Sliding) and len(model.noisy):
        made.append(
            f"the noise of the slip reversed the sign of {counted(len(model.noisy), 'samples')} near rest: up to "
            f"{model.rest:.3g} {unit} they count as at rest; give `rest` for another threshold, or remove an offset"
        )
    if search.within is not None:
        within = float(np.max(search.within))
        off = int(np.sum(np.abs(residuals) > 2.0 * within))
        made.append(
            f"residuals count less from {within:.3g} {force} on (loss {search.loss.kind!r}): "
            f"{counted(off, 'samples')} more than twice as far off"
        )
    return made


def at_temperature(samples: Measurement, law: Law) -> Measurement:
    """Samples with the temperature that the law needs: the measured one, else the number that the law holds."""
    kind = type(law).__name__
    needed = [name for names, _ in inputs(type(law)) for name in names[:1] if law.reads(name)]
    for name in needed:
        if name != TEMPERATURE:
            raise FitError(
                name, f"drives {kind}, and a fit supports no signal other than the temperature", "fit another law"
            )
    if samples.temperature is not None:
        if not needed:
            raise FitError(TEMPERATURE, f"is given, and {kind} does not depend on it", "remove it")
        return samples
    if not needed:
        return samples
    held = getattr(law, TEMPERATURE)
    if held is None:
        raise FitError(TEMPERATURE, f"is missing, and {kind} depends on it", _REMEDY)
    if not isinstance(held, Real):
        raise FitError(TEMPERATURE, f"of the law is {held!r}, and a fit runs no signals", _REMEDY)
    return replace(samples, temperature=np.full(len(samples.time), float(held)))
