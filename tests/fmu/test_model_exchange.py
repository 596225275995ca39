"""Model exchange: other solvers find what `simulate` finds. docs/theory/model-exchange.md"""

from __future__ import annotations

import ctypes
import warnings
from collections.abc import Callable, Sequence
from functools import cache
from pathlib import Path
from typing import Any

import fmpy
import numpy as np
import pytest
from fmpy.validation import validate_fmu
from scipy.signal import lsim, lti

import clutchwork as cw
from clutchwork.results.recorded import Recorded
from clutchwork.signals.bases.waveform import value
from fmu.conftest import INPUTS, SIX_SPEED
from reference.msl.model import translate
from reference.test_msl import FOLDER, load, names
from support import random_drivelines, random_parts
from support.fmus import DISCARD, ERROR, Fmu
from support.importer import exchanged, simulated
from support.project import ROOT

EXAMPLES = sorted(path.parent.name for path in (ROOT / "examples").glob("*/model.toml"))
OUTPUTS = (".speed", ".slip", ".torque")
EVENTFUL = ("rot_CoupledClutches", "rot_LossyGearDemo1", "rot_OneWayClutchDisengaged", "rt_TestFriction", "tra_Brake",
    "tra_ElastoGap", "tra_Vehicle")  # fmt: skip
# a force that rises within a thousandth of a speed shows what is missed of that a thousand times
STEEP = {"tt_TestBraking": 2e-5}
KNOTS = [0.1, 0.3, 1.2, 1.4, 2.0, 2.15, 2.9, 3.1]  # s, of the pressures of the six-speed gearbox


def outputs_of(fmu: Fmu) -> list[str]:
    return [name for name, one in fmu.variables.items() if one.causality == "output" and one.variability != "discrete"]


def misses(rows: Any, run: Recorded, outputs: Sequence[str]) -> dict[str, float]:
    """What rows at the times of a run miss of it, as shares of the sizes of signals; at jumps nothing is asked.

    A signal counts as no smaller than a thousandth of the largest one of its unit: there it is round-off.
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


# CVode misses more than its tolerance over a run: 1.6e-6 at 1e-8, 3e-7 at 1e-9
@pytest.mark.parametrize(("solver", "version", "rtol"), [(own, "2.0", 1e-8), (cvode, "3.0", 1e-9)])
@pytest.mark.parametrize("example", EXAMPLES)
def test_examples(tmp_path: Path, example: str, solver: Callable[..., Any], version: str, rtol: float) -> None:
    driveline = cw.Driveline.load(ROOT / "examples" / example / "model.toml")
    run = driveline.simulate(times=grid(0.0, float(driveline.simulation["t_end"])), rtol=1e-11, atol=1e-13)
    path = exported(driveline, tmp_path, run, version)
    assert validate_fmu(str(path)) == []
    found = solver(path, tmp_path / "unpacked", run, rtol)
    assert max(found.values()) < 1e-6, found


@pytest.mark.parametrize(
    ("name", "solver", "version", "rtol"),
    [(name, cvode, "2.0", 1e-10) for name in names(FOLDER)] + [(name, own, "3.0", 1e-8) for name in EVENTFUL],
)
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


def chain(seed: int) -> cw.Driveline:
    """Three clutches and elastic shafts."""
    return random_drivelines.describe(seed).driveline()


# of the parts those without impacts and ratios that vary: torque converters, gears with losses, plays, planetary sets
@pytest.mark.parametrize(
    ("made", "end", "seed"),
    [(chain, 2.0, seed) for seed in range(6)] + [(random_parts.driveline, 1.0, seed) for seed in (5, 9, 11, 12, 16)],
)
def test_random_drivelines(tmp_path: Path, made: Callable[[int], cw.Driveline], end: float, seed: int) -> None:
    """A handful of events, those of `simulate`, in a bounded number of steps."""
    driveline = made(seed)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", cw.ModelWarning)
        run = driveline.simulate(end, times=grid(0.0, end), rtol=1e-11, atol=1e-13)
        fmu = Fmu(exported(driveline, tmp_path, run, "3.0"), tmp_path / "unpacked")
    outputs = outputs_of(fmu)
    with exchanged(fmu, tolerance=1e-7) as instance:
        rows, events = simulated(instance, run.time, outputs, rtol=1e-7, most_steps=50_000)
    want = [event.time for event in run.events if event.cause != "passing" and event.time > 0.0]
    # each of them, and where else signals and pieces decide something
    assert all(np.min(np.abs(np.array(events) - time)) < 1e-5 for time in want), (events, want)
    found = misses(rows, run, outputs)
    # thirty times the tolerance, for what steps add up to: 1.1e-6 measured
    assert max(found.values()) < 3e-6, found


def test_sizes_of_states_are_those_of_a_run(tmp_path: Path) -> None:
    """A disc of 1e-3 rad/s on a spring: importers scale tolerances by it, and a speed of 1 rad/s is no size of it."""
    d = cw.Driveline("small")
    disc = d.shaft("disc", inertia=1.0)
    d.add(cw.SpringDamper("spring", base=d.housing, follower=disc, stiffness=100.0, damping=0.1))
    d.add(cw.Torque("push", shaft=disc, torque=cw.Sine(amplitude=0.05, frequency=0.5)))
    fmu = Fmu(d.to_fmu(tmp_path / "one.fmu", t_end=4.0, picture=False), tmp_path / "unpacked")
    run = d.simulate(4.0)
    for name in ("disc.speed", "spring.spring_torque"):
        size, amount = float(fmu.variables[name].nominal), float(np.abs(run[name]).max())
        assert size <= amount * 1.01, name
        assert amount < 10.01 * size, name


@cache
def signals() -> dict[str, Any]:
    return {item.name: item.signal for item in cw.Driveline.load(SIX_SPEED).assemble().inputs}


def of_model(time: float) -> dict[str, float]:
    """What the model says of the inputs."""
    return {name: value(signals()[name], time) for name in INPUTS}


def test_inputs_from_outside(six_speed: Fmu) -> None:
    """Ramps go on between events, and their knots are set in event mode: the events are those of `simulate`."""
    run = cw.Driveline.load(SIX_SPEED).simulate(4.0, times=grid(0.0, 4.0), rtol=1e-11)
    outputs = ["w1.speed", "w8.speed", "F1.slip", "F2.slip", "F2.torque"]
    with exchanged(six_speed, of_model(0.0), tolerance=1e-8, log=True) as instance:
        how = {"rtol": 1e-8, "inputs": of_model, "knots": KNOTS}
        rows, events = simulated(instance, run.time, outputs, **how)
        told = [text.split(" s: ")[1] for _, category, text in instance.messages if category == "events"]
    found = misses(rows, run, outputs)
    assert max(found.values()) < 1e-6, found
    want = [event for event in run.events if event.cause != "passing"]
    # an indicator is missed by 1e-10 of its size before it counts
    assert events == pytest.approx([event.time for event in want], abs=1e-7)
    assert told == [f"{one.element} {one.before} to {one.after} ({one.cause})" for one in want]
    locked = (run.time > events[0] + 1e-6) & (run.time < events[1])
    assert np.all(rows[locked, outputs.index("F2.slip")] == 0.0)


def test_a_state_is_kept_restored_and_read_elsewhere(six_speed: Fmu) -> None:
    """What follows has the same bits."""
    values, times = of_model(0.0), np.linspace(0.0, 0.02, 5)
    outputs = ["w1.speed", "w2.speed", "F2.heat"]
    with exchanged(six_speed, values) as first, exchanged(six_speed, values) as second:
        simulated(first, times, outputs)
        kept = first.state()
        saved = first.saved(kept)
        want = simulated(first, times + 0.02, outputs)[0] if again(first) else None
        first.go_to(kept)
        first.time = 0.02
        assert again(first)
        np.testing.assert_array_equal(simulated(first, times + 0.02, outputs)[0], want)
        second.go_to(second.read(saved))
        second.time = 0.02
        assert again(second)
        np.testing.assert_array_equal(simulated(second, times + 0.02, outputs)[0], want)


def again(instance: Any) -> bool:
    """In event mode, from which `simulated` starts."""
    instance.raw.enterEventMode()
    return True


def pointer(run: Any) -> ctypes.c_void_p:
    """The component of an instance, for calls that FMPy has for the other kind alone."""
    return ctypes.c_void_p(getattr(run.raw.component, "value", run.raw.component))


def test_calls_of_the_other_kind_are_refused(six_speed: Fmu) -> None:
    two = six_speed.version == "2.0"
    step = (ctypes.c_double(0.0), ctypes.c_double(0.1), 1, *([] if two else [None] * 4))
    with exchanged(six_speed) as run:
        assert getattr(run.raw.dll, "fmi2DoStep" if two else "fmi3DoStep")(pointer(run), *step) == ERROR
    call = "fmi2EnterContinuousTimeMode" if two else "fmi3EnterContinuousTimeMode"
    with six_speed.running() as run:
        assert getattr(run.raw.dll, call)(pointer(run)) == ERROR


def test_a_state_that_is_not_a_number_is_discarded(six_speed: Fmu) -> None:
    """A solver then takes a shorter step."""
    with exchanged(six_speed) as instance:
        instance.decide()
        instance.raw.enterContinuousTimeMode()
        x = instance.x()
        instance.place(0.0, x * np.nan)
        with pytest.raises(Exception, match=f"status {DISCARD}"):
            instance.rates()
        instance.place(0.0, x)
        assert np.all(np.isfinite(instance.rates()))


def moved_by_a_speed(*, stops: bool) -> cw.Driveline:
    driveline = cw.Driveline("moved")
    source, load = driveline.shaft("source", inertia=0.2), driveline.shaft("load", inertia=0.8)
    driveline.add(cw.PrescribedSpeed("motion", shaft=source, speed=0.0))
    driveline.add(cw.SpringDamper("spring", base=source, follower=load, stiffness=50.0, damping=0.4))
    if stops:
        driveline.add(cw.EndStop("stop", base=source, follower=load, lower=-1.0, upper=1.0))
    return driveline


def test_what_is_left_out_is_named(tmp_path: Path) -> None:
    driveline = moved_by_a_speed(stops=True)
    how = {"inputs": ["motion.speed"], "picture": False}
    with pytest.raises(cw.UseError) as raised:
        driveline.to_fmu(tmp_path / "one.fmu", kinds="model exchange", **how)
    assert "'stop' has impacts" in str(raised.value)
    assert "'motion.speed' prescribes a speed" in str(raised.value)
    with pytest.raises(cw.UseError, match="kinds is 'exchange'"):
        driveline.to_fmu(tmp_path / "one.fmu", kinds="exchange", **how)
    with pytest.warns(cw.ModelWarning, match="prescribes a speed"):
        path = driveline.to_fmu(tmp_path / "one.fmu", **how)
    fmu = Fmu(path, tmp_path / "unpacked")
    assert fmu.description.modelExchange is None
    assert fmu.description.coSimulation is not None
    assert "'stop' has impacts" in (fmu.folder / "documentation" / "index.html").read_text().replace("&#x27;", "'")


def test_a_prescribed_speed_has_its_rate_beside_it(tmp_path: Path) -> None:
    """A shaft that is turned by 3 sin(20 t) through a spring."""
    driveline = moved_by_a_speed(stops=False)
    with pytest.warns(cw.ModelWarning, match="prescribes a speed"):
        path = driveline.to_fmu(
            tmp_path / "one.fmu", inputs="motion.speed", version="3.0", kinds="model exchange", picture=False
        )
    fmu = Fmu(path, tmp_path / "unpacked")

    def moved(time: float) -> dict[str, float]:
        return {"motion.speed": 3.0 * np.sin(20.0 * time), "der(motion.speed)": 60.0 * np.cos(20.0 * time)}

    times = grid(0.0, 1.0)
    with exchanged(fmu, moved(0.0), tolerance=1e-8) as instance:
        rows, _ = simulated(instance, times, ["load.speed", "motion.torque"], rtol=1e-8, inputs=moved)
    # J w'' + d w' + k w = d u' + k u, from rest
    system = lti([0.4, 50.0], [0.8, 0.4, 50.0])
    fine = np.linspace(0.0, 1.0, 46 * 400 + 1)
    _, want, _ = lsim(system, 3.0 * np.sin(20.0 * fine), fine)
    # lsim takes the input as lines of 54 us
    assert rows[:, 0] == pytest.approx(want[::400], abs=2e-6)
