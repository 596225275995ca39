"""Smooth output comes from one run of the core, and has the rows that a grid with its instants has."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.run import simulation
from support import random_contacts, random_drivelines, random_large, six_speed


def drivelines() -> dict[str, tuple[cw.Driveline, float]]:
    """Random drivelines with elastic shafts, loops, gears and prescribed speeds, the shift, signals that jump."""
    made = {"shift": (six_speed.gearbox(six_speed.SHIFT), 4.0)}
    for seed in range(4):
        made[f"elastic {seed}"] = random_drivelines.describe(seed).driveline(), random_drivelines.T_END
        made[f"contacts {seed}"] = random_contacts.driveline(seed), random_contacts.T_END
        made[f"large {seed}"] = random_large.driveline(seed), random_large.T_END
    return made


@pytest.fixture
def runs_of_core(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    """How often the core ran: the end time of each run."""
    found, once = list[float](), simulation._once

    def counted(job: simulation.Job, *given: Any) -> Any:
        found.append(job.t_end)
        return once(job, *given)

    monkeypatch.setattr(simulation, "_once", counted)
    return found


# what a share of a step that is rounded misses of the state at its end, of the largest number of a column
ROUND_OFF = 1e-9


@pytest.mark.parametrize("name", drivelines())
@pytest.mark.parametrize("points", [20, 700])
def test_one_run_gives_what_a_grid_gives(name: str, points: int, runs_of_core: list[float]) -> None:
    """Between the steps the rows of a grid bit for bit, at their ends those of the bare steps."""
    model, t_end = drivelines()[name]
    run = model.simulate(t_end, points=points)
    assert len(runs_of_core) == 1
    assert np.diff(run.time).max() <= t_end / points * (1 + 1e-9)
    bare, grid = model.simulate(t_end, output="steps"), model.simulate(t_end, times=run.time)
    ends = np.isin(run.time, bare.time)
    np.testing.assert_array_equal(run.time[ends], bare.time)
    np.testing.assert_array_equal(run.rows[~ends], grid.rows[~ends])
    # left limits; behind a knot the next step knows its start better
    first = np.append(True, np.diff(bare.time) > 0.0)
    first[0] = False
    np.testing.assert_array_equal(run.rows[ends][first], bare.rows[first])
    np.testing.assert_allclose(run.rows, grid.rows, rtol=0.0, atol=ROUND_OFF * (1.0 + np.abs(grid.rows).max()))
    assert run.statistics["steps"] == bare.statistics["steps"] == grid.statistics["steps"]


def test_a_jump_that_nothing_reads_has_both_limits() -> None:
    """A clutch that is open anyway: no torque jumps with its pressure."""
    d = cw.Driveline()
    shaft, jump = (
        d.shaft("s", inertia=1.0, speed=10.0),
        cw.Table([(0.0, 0.0), (0.3, 0.0), (0.3, -1.0), (0.9, -1.0), (0.9, 1.0)]),
    )
    d.add(cw.Brake("b", shaft=shaft, friction=cw.Coulomb(static=0.2, kinetic=0.1), gain=1.0, normal_force=jump))
    run = d.simulate(1.0, points=10)
    np.testing.assert_array_equal(run["b.normal_force"][run.time == 0.3], [0.0, -1.0])
