"""The solvers by name: each gets scaled unknowns and gives those where it ended."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from clutchwork.calibrate.interior import ipopt
from clutchwork.calibrate.scaled import Scaled
from clutchwork.calibrate.slsqp import slsqp
from clutchwork.calibrate.trust import trust_constr

Array = NDArray[np.float64]
Solver: TypeAlias = Callable[[Scaled, float, int], Array]

SOLVERS: dict[str, Solver] = {"slsqp": slsqp, "trust-constr": trust_constr, "ipopt": ipopt}
