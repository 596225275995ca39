"""What tests ask of derivatives by the smallest driveline that shows something."""

from __future__ import annotations

from typing import Any

import numpy as np

import clutchwork as cw
from clutchwork.sweeps.outputs import asked
from support import by_differences, free_numbers
from support.compared_gradients import Tally
from support.compared_gradients import compared as compared_to_both_sides

TIGHT: dict[str, Any] = {"rtol": 1e-10, "atol": 1e-12}


def derivatives(model: cw.Driveline, t_end: float, of: Any, by: str, side: Any = None, **options: Any) -> cw.Gradient:
    """Those of one value by one number."""
    return cw.differentiable(model, t_end, of=of, by=by, side=side, **{**TIGHT, **options}).gradient()


def judged(model: cw.Driveline, t_end: float, of: Any, by: list[str]) -> Tally:
    """What differences of runs say of derivatives of values by numbers."""
    tally, system = Tally(), model.assemble()
    wanted, run = asked(of), model.simulate(t_end, rtol=1e-8)
    chosen = [one for one in free_numbers.free(system) if one.name in by]
    compared_to_both_sides(tally, system, t_end, wanted, by_differences.scales(run, wanted), chosen)
    return tally


def compared(model: cw.Driveline, t_end: float, of: Any, by: list[str], **options: Any) -> None:
    """Derivatives are those of differences at a tight tolerance."""
    function = cw.differentiable(model, t_end, of=of, by=by, **TIGHT, **options)
    scales = by_differences.scales(model.simulate(t_end, rtol=1e-8, **options), function.task.outputs)
    for one in by_differences.compared(function, function.jacobian(function.x0), scales):
        # what the package promises of a derivative at this tolerance
        assert np.all(one.missed < 1e-6), str(one)
