"""Model exchange: other solvers find what `simulate` finds. docs/theory/model-exchange.md"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import fmpy
import numpy as np
import pytest
from fmpy.validation import validate_fmu

import clutchwork as cw
from clutchwork.results.recorded import Recorded
from clutchwork.signals.bases.waveform import value
from fmu.conftest import INPUTS, SIX_SPEED
from reference.msl.model import translate
from reference.test_msl import FOLDER, load, names
from support.any_model import agree, model
from support.any_model.model import driveline as drawn
from support.fmus import DISCARD, Fmu
from support.importer import exchanged, simulated
from support.project import ROOT

EXAMPLES = sorted(path.parent.name for path in (ROOT / "examples").glob("*/model.toml"))
OUTPUTS = (".speed", ".slip", ".torque")
# a force that rises within a thousandth of a speed shows what is missed of that a thousand times
STEEP = {"tt_TestBraking": 2e-5}
KNOTS = [0.1, 0.3, 1.2, 1.4, 2.0, 2.15, 2.9, 3.1]  # s, of the pressures of the six-speed gearbox


def outputs_of(fmu: Fmu) -> list[str]:
    return [name for name, one in fmu.variables.items() if one.causality == "output" and one.variability != "discrete"]


def misses(rows: Any, run: Recorded, outputs: Sequence[str]) -> dict[str, float]:
    """What rows at the times of a run miss of it, as shares of the sizes of signals; at jumps nothing is asked.

    A signal counts as no smaller than a thousandth of the largest one of its unit: what is left of it there is round-off.
    """
    jumps = [event.time for event in run.events]
    clear = np.array([all(abs(time - jump) > 1e-6 for jump in jumps) for time in run.time])
    plain = [name.replace("'", "") for name in outputs]
    sizes = {name: float(np.max(np.abs(run[name]))) for name in plain}
    largest: dict[str, float] = {}
    for name, size in sizes.items():
        largest[run.units[name]] = max(largest.get(run.units[name], 1e-9), size)
    return {
        name: float(np.max(np.abs(rows[:, i] - run[name])[clear])) / max(sizes[name], 1e-3 * largest[run.units[name]])
        for i, name in enumerate(plain)
    }


def own(path: Path, folder: Path, run: Recorded, rtol: float) -> dict[str, float]:
    """What a solver of SciPy misses."""
    fmu = Fmu(path, folder)
    outputs = outputs_of(fmu)
    with exchanged(fmu, tolerance=rtol) as instance:
        rows, _ = simulated(instance, run.time, outputs, rtol=rtol)
    return misses(rows, run, outputs)


def cvode(path: Path, folder: Path, run: Recorded, rtol: float) -> dict[str, float]:
    """What CVode of FMPy misses, which has rows of its own at events."""
    outputs = outputs_of(Fmu(path, folder))
    size = float(run.time[1] - run.time[0])
    how = {"start_time": float(run.time[0]), "stop_time": float(run.time[-1]), "output_interval": size}
    made = fmpy.simulate_fmu(
        str(path), fmi_type="ModelExchange", relative_tolerance=rtol, output=outputs, fmi_call_logger=None, **how
    )
    # the nearest row, at an event the last one
    found = np.searchsorted(made["time"], run.time + 1e-9 * size, side="right") - 1
    assert np.max(np.abs(made["time"][found] - run.time)) < 1e-6 * size
    return misses(np.array([made[name][found] for name in outputs]).T, run, outputs)


def exported(driveline: cw.Driveline, to: Path, run: Recorded, version: str) -> Path:
    """An FMU of a driveline whose outputs are its speeds, slips and torques."""
    outputs = [name for name in run.units if name.endswith(OUTPUTS)]
    # numbers that are no parameters need no search for those that can be some
    return driveline.to_fmu(to / "one.fmu", version=version, outputs=outputs, parameters=(), picture=False)


# a step of a signal on an instant of the grid has two values: instants that no signal has a knot at
def grid(begin: float, end: float) -> Any:
    return begin + (end - begin) * np.linspace(0.0, 1.0, 47)


# CVode misses more than its tolerance over a run; its own order is up to five
@pytest.mark.parametrize(("solver", "version", "rtol"), [(own, "2.0", 1e-8), (cvode, "3.0", 1e-10)])
@pytest.mark.parametrize("example", EXAMPLES)
def test_examples(tmp_path: Path, example: str, solver: Callable[..., Any], version: str, rtol: float) -> None:
    driveline = cw.Driveline.load(ROOT / "examples" / example / "model.toml")
    run = driveline.simulate(times=grid(0.0, float(driveline.simulation["t_end"])), rtol=1e-11, atol=1e-13)
    path = exported(driveline, tmp_path, run, version)
    assert validate_fmu(str(path)) == []
    found = solver(path, tmp_path / "unpacked", run, rtol)
    assert max(found.values()) < 1e-6, found


@pytest.mark.parametrize(("solver", "version", "rtol"), [(own, "3.0", 1e-8), (cvode, "2.0", 1e-10)])
@pytest.mark.parametrize("name", names(FOLDER))
def test_cases_of_modelica(tmp_path: Path, name: str, solver: Callable[..., Any], version: str, rtol: float) -> None:
    case = load(FOLDER, name)
    with warnings.catch_warnings():
        # tables of the cases are continued linearly
        warnings.simplefilter("ignore", cw.ModelWarning)
        driveline = translate(case).driveline
        end = float(case["stop_time"])
        run = driveline.simulate(end, times=grid(0.0, end), rtol=1e-11, atol=1e-13)
        path = exported(driveline, tmp_path, run, version)
    found = solver(path, tmp_path / "unpacked", run, rtol)
    assert max(found.values()) < STEEP.get(name, 1e-6), found
