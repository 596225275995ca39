"""The temperature at which samples were measured, for laws that depend on it."""

from __future__ import annotations

from dataclasses import replace
from numbers import Real
from typing import TYPE_CHECKING

import numpy as np

from clutchwork.declare.schema import inputs
from clutchwork.fit.failure import FitError

if TYPE_CHECKING:
    from clutchwork.declare.node import Law
    from clutchwork.fit.measurement import Measurement

TEMPERATURE = "temperature"
_REMEDY = "give the measured temperature [K], a number or a row"


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
