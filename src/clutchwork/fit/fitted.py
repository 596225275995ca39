"""A fitted law beside the samples, as pictures show it."""

from __future__ import annotations

from dataclasses import field

import numpy as np
from numpy.typing import NDArray

from clutchwork.base.classes import dataclass
from clutchwork.declare.node import Law
from clutchwork.fit.measurement import Measurement

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Fitted:
    """A law, the samples that it was fitted to, and what is left over."""

    law: Law
    rms: float  # N m, of the residuals over the samples that give an equation
    samples: Measurement = field(repr=False)
    fitted: Array = field(repr=False)  # torque of the fitted law at the samples [N m]
    equations: NDArray[np.bool_] = field(repr=False)  # samples that give an equation; the others only a bound

    @property
    def residuals(self) -> Array:
        """Fitted minus measured torque [N m]."""
        return self.fitted - self.samples.torque
