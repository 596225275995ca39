"""Fit numbers of a driveline to a measured response."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from clutchwork.declare.calls import explained
from clutchwork.fit.losses import WIDTH
from clutchwork.fit.record import Record
from clutchwork.fit.records import fit_records

if TYPE_CHECKING:
    from clutchwork.driveline.driveline import Driveline
    from clutchwork.fit.response_result import ResponseFit


@explained(
    "fit_response",
    time="[0.0, 0.1, 0.2]",
    measured="{'engine.speed': [100.0, 99.0, 98.0]}",
    free="['c1.gain']",
    driveline="d",
)
def fit_response(
    driveline: Driveline,
    time: Any,
    measured: Mapping[str, Any],
    free: Sequence[str],
    *,
    bounds: Mapping[str, tuple[float, float]] | None = None,
    confidence: float = 0.95,
    loss: str = "linear",
    loss_width: float = WIDTH,
) -> ResponseFit:
    """Bounded least squares of measured signals over numbers of a driveline; see docs/guide/fit.md.

    Parameters: driveline, with the start values; time [s], rising; measured, rows of samples in SI by the name of the
    signal, "piston.pressure"; free, names of the numbers that are searched for, "piston.orifice_area", as in
    `cw.differentiable`; bounds, {name: (lower, upper)}, by default those of the declaration, and a factor of 1000
    either way for numbers that stay above zero; confidence of the intervals; loss and loss_width, as of `fit_records`.
    The run starts at 0 s. Each signal counts by its own size.

    Numbers that the samples do not determine are not an error: the result reports them. FitError reports wrong input.
    It is `fit_records` with one record.
    """
    return fit_records(
        driveline, Record(time, measured), free, bounds=bounds, confidence=confidence, loss=loss, loss_width=loss_width
    )
