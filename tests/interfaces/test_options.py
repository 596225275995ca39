"""Options of a run: what is refused, and in which words."""

from __future__ import annotations

import numpy as np
import pytest

from clutchwork.base.errors import OptionError, UseError
from clutchwork.declare.options import Options, end_time
from clutchwork.run.grid import output_grid
from clutchwork.run.settings import merged


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"rtol": 0.0}, "rtol is 0: it must be a finite number of at least 1e-14"),
        ({"rtol": 1e-16}, "double precision"),
        ({"atol": 0.0}, "atol is 0: it must be a finite number above 0"),
        ({"atol": float("nan")}, "atol is nan"),
        ({"max_step": -1.0}, "max_step is -1 s"),
        ({"method": "rodas"}, "did you mean 'rodas5p'"),
        ({"output": "step"}, "did you mean 'steps'"),
        ({"max_steps": 0}, "max_steps is 0: it must be at least 1"),
        ({"dt": 0.1, "times": [0.0]}, "not both"),
    ],
)
def test_bad_values(changes: dict[str, object], words: str) -> None:
    with pytest.raises(ValueError, match=words.replace("?", r"\?")):
        Options().changed(changes)


def test_a_misspelt_option_is_answered_with_a_near_one() -> None:
    with pytest.raises(TypeError, match="unknown option 'rtoll'; did you mean 'rtol'"):
        Options().changed({"rtoll": 1e-3})


@pytest.mark.parametrize("t_end", [0.0, -1.0, float("inf"), float("nan")])
def test_bad_end_times(t_end: float) -> None:
    with pytest.raises(ValueError, match=r"t_end is .* s: it must be a finite number above 0"):
        end_time(t_end)


@pytest.mark.parametrize(("dt", "t_end"), [(0.1, 0.3), (1e-3, 4.0), (0.7, 2.1), (0.3, 1.0)])
def test_a_uniform_grid_ends_at_the_end(dt: float, t_end: float) -> None:
    grid = output_grid(Options(dt=dt), t_end)
    assert grid is not None
    assert (grid[0], grid[-1]) == (0.0, t_end)
    assert np.diff(grid)[:-1] == pytest.approx(dt)
    assert np.diff(grid)[-1] > 1e-9 * dt


def test_times_must_lie_in_the_run_and_not_decrease() -> None:
    with pytest.raises(ValueError, match="must lie between 0 and t_end = 1 s"):
        output_grid(Options(times=[0.0, 2.0]), 1.0)
    with pytest.raises(ValueError, match="must not decrease"):
        output_grid(Options(times=[0.5, 0.2]), 1.0)
    assert output_grid(Options(times=[0.2, 0.5, 0.5]), 1.0) == pytest.approx([0.2, 0.5, 0.5])


def test_what_is_wrong_with_settings_of_a_shorter_run_is_said_of_them() -> None:
    with pytest.raises(OptionError, match=r"times of d\.simulation begin at 0\.5 s, after t_end = 0\.25 s"):
        merged({"times": [0.5, 1.0]}, {"t_end": 0.25})


def test_a_misspelt_end_time_is_named() -> None:
    with pytest.raises(UseError, match="did you mean 't_end'"):
        merged({}, {"tend": 3.0})
