"""The solvers by name: each gets scaled unknowns and gives those where it ended."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from clutchwork.calibration.ending import Ending
from clutchwork.calibration.interior import ipopt
from clutchwork.calibration.scaled import Scaled
from clutchwork.calibration.slsqp import slsqp
from clutchwork.calibration.trust import trust_constr

Array = NDArray[np.float64]
Solver: TypeAlias = Callable[[Scaled, Ending, int], Array]

SOLVERS: dict[str, Solver] = {"slsqp": slsqp, "trust-constr": trust_constr, "ipopt": ipopt}
