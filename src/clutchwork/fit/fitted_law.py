"""A fitted law beside the samples that it was fitted to."""

from __future__ import annotations

from dataclasses import field

import numpy as np
from numpy.typing import NDArray

from clutchwork.base import dataclass
from clutchwork.declare.node import Law
from clutchwork.fit.estimates import ParameterEstimates
from clutchwork.fit.measurement import Measurement

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False, kw_only=True)
class FittedLaw(ParameterEstimates):
    """A fitted law and how well it describes the samples."""

    law: Law
    rms: float  # N m, of the residuals over the samples that give an equation
    samples: Measurement = field(repr=False)
    fitted: Array = field(repr=False)  # torque of the fitted law at the samples [N m]
    equations: NDArray[np.bool_] = field(repr=False)  # samples that give an equation; the others only a bound

    @property
    def residuals(self) -> Array:
        """Fitted minus measured torque [N m]."""
        return self.fitted - self.samples.torque
