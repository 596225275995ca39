"""Every door of a run, over runs of every sort: of no length, of one instant, stopped, from a time, a state, in steps.

Whatever the run, a door gives numbers of it or an error of this package, and warns of nothing.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import clutchwork as cw

pytest.importorskip("matplotlib")
pytest.importorskip("pandas")


def launch(begin: float = 0.0) -> cw.Driveline:
    """Two discs on a spring that lock, with a lining that gets warm and a piston with a lag."""
    d = cw.Driveline("launch")
    engine, gearbox = d.shaft("engine", inertia=0.2, speed=120.0), d.shaft("gearbox", inertia=0.05)
    load = d.shaft("load", inertia=0.6)
    lining = d.thermal("lining", capacity=800.0, temperature=320.0)
    d.add(cw.Torque("drive", shaft=engine, torque=cw.Sine(amplitude=5.0, frequency=3.0, offset=15.0)))
    piston = d.add(cw.PressureActuator("piston", command=2e5, lag=0.05))
    law = cw.Stribeck(static=0.13, kinetic=0.1, speed=10.0)
    d.add(
        cw.Clutch(
            "c1", base=gearbox, follower=engine, friction=law, gain=3e-3, pressure=(piston, "pressure"), heat=lining
        )
    )
    d.add(cw.SpringDamper("k", base=gearbox, follower=load, stiffness=900.0, damping=1.5))
    if begin:
        d.simulation["t_start"] = begin
    return d


@cache
def state() -> cw.State:
    return launch().simulate(0.3).state()


def stopped(**options: Any) -> cw.Trajectory:
    with pytest.warns(cw.StoppedEarly):
        return launch().simulate(2.0, max_steps=40, **options)


def stepped(start: cw.State | None = None, length: float = 0.2) -> cw.Trajectory:
    sim = cw.Simulator(launch(), start=start)
    if length:
        sim.advance(length)
        sim.set({"piston.command": 1.5e5, "k.damping": 3.0})
        sim.advance(length)
    return sim.run


RUNS: dict[str, Callable[[], cw.Trajectory]] = {
    "plain": lambda: launch().simulate(0.8),
    "one instant": lambda: launch().simulate(0.8, times=[0.4]),
    "both limits of one instant": lambda: launch().simulate(0.8, times=[0.4, 0.4]),
    "the start alone": lambda: launch().simulate(0.8, times=[0.0]),
    "stopped": stopped,
    "from 5 s": lambda: launch(5.0).simulate(5.8),
    "from a state": lambda: launch().simulate(0.8, start=state()),
    "from a state, one instant": lambda: launch().simulate(0.8, start=state(), times=[0.3]),
    "stepped": stepped,
    "stepped from a state": lambda: stepped(state()),
    "not stepped yet": lambda: stepped(None, 0.0),
    "not stepped yet, at a state": lambda: stepped(state(), 0.0),
    "not stepped yet, from 5 s": lambda: cw.Simulator(launch(5.0)).run,
    "without work": lambda: launch().simulate(0.8, work=False, angles=False),
    "of no instant": lambda: stopped(times=[0.7]),
}


@cache
def made(kind: str) -> cw.Trajectory:
    return RUNS[kind]()


UNITS = {"*.speed": "rpm", "*.temperature": "degC"}
TABLES = {"to_csv": "csv", "to_parquet": "parquet", "to_mdf": "mf4", "to_mat": "mat", "to_netcdf": "nc"}
DOORS: dict[str, Callable[[cw.Trajectory, Path], Any]] = {
    "plot": lambda run, path: run.plot(path / "a.png"),
    "plot of names": lambda run, path: run.plot("c1.*", "*.speed", path=path / "a.svg"),
    "plot in units": lambda run, path: run.plot(path / "a.png", units=UNITS),
    "explore": lambda run, _: run.explore("c1.*", "*.speed", units=UNITS),
    "compare": lambda run, path: cw.compare(run, run, "*.speed", labels=["a", "b"], path=path / "a.png", units=UNITS),
    "hints": lambda run, _: str(run.hints),
    "energy": lambda run, _: str(run.energy),
    "dependent": lambda run, _: run.dependent,
    "events": lambda run, _: (str(run.events), run.events.to_pandas()),
    "draw": lambda run, _: launch().draw(run=run, at=run.reached),
    "linearise": lambda run, _: str(cw.linearise(run, at=run.reached)),
    "to_pandas": lambda run, _: run.to_pandas(units=UNITS),
    "to_xarray": lambda run, _: run.to_xarray(units=UNITS),
    "to_pandas on a raster": lambda run, _: run.to_pandas(dt=0.01),
    "state": lambda run, _: run.state(),
    "at": lambda run, _: run.at([run.options.t_start, run.reached] if len(run) else 0.0),
    "notebook": lambda run, _: run._repr_mimebundle_(),
    "words": lambda run, _: repr(run),
    **{
        name: lambda run, path, name=name, ending=ending: getattr(run, name)(path / f"run.{ending}", units=UNITS)  # type: ignore[misc]
        for name, ending in TABLES.items()
    },
    "save": lambda run, path: run.save(path / "run"),
}


@pytest.mark.parametrize("kind", RUNS)
@pytest.mark.parametrize("door", DOORS)
def test_a_door_gives_something_or_says_why_not(door: str, kind: str, tmp_path: Path) -> None:
    run = made(kind)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        if (door, kind) in REFUSED:
            with pytest.raises(cw.ClutchworkError, match=REFUSED[door, kind]):
                DOORS[door](run, tmp_path)
        else:
            DOORS[door](run, tmp_path)


NOTHING = "no instant"
REFUSED: dict[tuple[str, str], str] = {
    ("energy", "without work"): "run with work=True",
    **{(door, "of no instant"): NOTHING for door in ("plot", "plot of names", "plot in units", "explore", "compare")},
    **{(door, "of no instant"): NOTHING for door in ("energy", "draw", "to_pandas on a raster")},
}


@pytest.mark.parametrize("kind", RUNS)
def test_the_doors_agree(kind: str, tmp_path: Path) -> None:
    """Tables, states, linear systems, schematics and files hold the numbers of the run."""
    run = made(kind)
    run.save(tmp_path / "run")
    loaded = cw.load_run(tmp_path / "run")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for one in (run, loaded):
            frame = one.to_pandas()
            assert frame.index.tolist() == run.time.tolist()
            assert all(np.array_equal(frame[name], run[name]) for name in run.names)
            end = one.state()
            assert end.time == run.reached or not len(run)
            if len(run):
                there = one.at([run.reached])
                # the row just before and after an event differ in torques, what moves is the same
                for name in ("engine.speed", "load.speed", "lining.temperature", "k.twist"):
                    assert cw.linearise(one, at=run.reached).state.get(name, there[name][-1]) == pytest.approx(
                        there[name][-1], rel=1e-9, abs=1e-12
                    )
                assert end.values[:3].tolist() == run.state().values[:3].tolist()


def test_an_environment_is_shown_before_its_first_step() -> None:
    pytest.importorskip("gymnasium")
    what = {"actions": {"piston.command": (0.0, 2e5)}, "observations": ["engine.speed"], "reward": lambda moment: 0.0}
    env = cw.environment(launch(), 0.5, render_mode="rgb_array", **what)
    env.reset(seed=1)
    assert env.render().std() > 0.0


@pytest.mark.parametrize("kind", ["one instant", "not stepped yet", "not stepped yet, from 5 s"])
def test_a_single_instant_is_seen(kind: str) -> None:
    run = made(kind)
    figure = run.plot("*.speed")
    axes = figure.axes[0]
    assert axes.get_xlim()[0] < run.time[0] < axes.get_xlim()[1]
    assert {line.get_marker() for line in axes.get_lines() if len(line.get_xdata()) == len(run)} == {"o"}
    assert {trace.mode for trace in run.explore("*.speed").data} == {"lines+markers"}
