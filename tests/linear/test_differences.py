"""Linear systems against central differences of what the core does after a small push, in all states of many runs."""

from __future__ import annotations

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.declare.schema import Role
from clutchwork.linear.instant import instant_of
from support import random_drivelines, random_large, samples, six_speed
from support.amount import amount
from support.perturbed import Standing, differences, mismatch

# differences over a part h = 1e-5 of each size miss h^2 times third derivatives, and round-off over h is 1e-11
CLOSE = 1e-6

# of each random driveline
INSTANTS = np.linspace(0.013, 1.987, 9)


@pytest.mark.parametrize("seed", range(amount(24)))
def test_random_drivelines_in_all_their_states(seed):
    run = random_drivelines.describe(seed).driveline().simulate(random_drivelines.T_END)
    for at in INSTANTS:
        standing = Standing(instant_of(run, at))
        locked = int(np.sum(standing.instant.modes == 0))
        speeds = [state for state in standing.linear.states if state.name.endswith(".speed")]
        assert len(speeds) == len(run.system.nodes) - locked
        assert mismatch(standing) < CLOSE, at
