"""The gradient of a run that was made."""

from __future__ import annotations

from typing import Any

from clutchwork.gradients.differentiable import made
from clutchwork.results.gradient import Gradient, NoGradient
from clutchwork.run.control import Control
from clutchwork.run.trajectory import Trajectory


def gradient_of(run: Trajectory, of: Any, by: Any, side: Any) -> Gradient:
    """Derivatives of what a run gave by numbers of its driveline."""
    if run.lacks or run.start is not None or not isinstance(run.course, Control):
        remedy = "run it as a whole by simulate, with signals in place of what was set"
        raise NoGradient(
            [f"the run began at a state, or was stepped from outside, which is not differentiated; {remedy}"]
        )
    if not run.finished:
        raise NoGradient([f"the run did not reach its end: {run.message}"])
    plain = run.options.changed({"dt": None, "times": None})
    return made(run.system, of, by, run.t_end, plain, 1, side).gradient()
