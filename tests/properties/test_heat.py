"""The heat of an element as a signal is what the energy balance has of it."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.assembly.wiring import wiring
from clutchwork.declare.node import Work
from support.any_model import model


@pytest.mark.parametrize("seed", range(600, 660))
def test_heat_over_a_run_is_that_of_the_balance(seed: int) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        driveline = cw.Driveline.from_dict(model.model(seed))
        run = driveline.simulate(0.3)
    if not len(run):
        return
    balance = run.energy.heat
    losing = [one.name for one in driveline.elements if one.work is Work.LOSS and f"{one.name}.heat" in run.names]
    for name in losing:
        if name not in balance or not run.time.size > 1:
            continue
        # drag counts as its clutch in results, and is a line of its own in the balance
        lost = sum(balance[part] for part in (name, *wiring(run.system).sums.get(name, ())))
        heat = run[f"{name}.heat"]
        # impulses of the very start belong to the run
        begin = 0.0 if run.events.at_start() else heat[0]
        scale = 1.0 + float(np.abs(heat).max())
        assert heat[-1] - begin == pytest.approx(lost, abs=1e-9 * scale), name
