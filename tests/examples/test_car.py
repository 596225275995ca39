"""The examples with a car: they run, their energy balances, temperatures follow from the heat, hot clutches warn."""

from __future__ import annotations

import importlib
import re
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

import clutchwork as cw

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"


def example(name: str, script: str | None = None) -> ModuleType:
    """The script of an example as a module; examples import what lies beside them."""
    with pytest.MonkeyPatch.context() as patch:
        for folder in ("car_launch", name):
            patch.syspath_prepend(str(EXAMPLES / folder))
        return importlib.import_module(script or name)


def integral(values: np.ndarray, time: np.ndarray) -> float:
    """The rule of trapezia, whose name in NumPy depends on its version."""
    return float(np.sum(0.5 * (values[1:] + values[:-1]) * np.diff(time)))


@pytest.fixture(scope="module")
def launch() -> cw.Trajectory:
    """The launch with engine control."""
    return example("car_launch").launch()


def test_engine_clutch_vehicle_is_as_worked_out_by_hand() -> None:
    model = EXAMPLES / "engine_clutch_vehicle" / "model.toml"
    run = cw.Driveline.load(model).simulate()
    example("engine_clutch_vehicle").check(run)
    page = (model.parent / "README.md").read_text(encoding="utf-8")
    assert f"{run.events[-1].time:.4f} s" in page
    assert f"{run['clutch.heat'][-1]:.0f} J" in page
    assert f"{run['engine.acceleration'][-1]:.1f} rad/s2" in page


def test_the_car_of_the_model_file_starts_without_a_controller() -> None:
    model = cw.Driveline.load(EXAMPLES / "car_launch" / "model.toml")
    assert model.check() == []
    run = model.simulate()
    assert run.finished
    assert run["clutch.state"][-1] == "locked"
    assert run["car.speed"][-1] > 5.0


def test_the_launch_keeps_what_it_claims(launch: cw.Trajectory) -> None:
    example("car_launch").check(launch)


def test_the_capacity_holds_what_it_shall(launch: cw.Trajectory) -> None:
    # the torque of a slipping or locked clutch never exceeds the static capacity; rounding of rtol 1e-8
    assert np.all(np.abs(launch["clutch.torque"]) <= launch["clutch.capacity"] * (1.0 + 1e-9) + 1e-6)


def test_heat_is_slip_power_over_time(launch: cw.Trajectory) -> None:
    # output every 4 ms or finer: the rule of trapezia is good to 1e-4 of it
    assert integral(-launch["clutch.power"], launch.time) == pytest.approx(launch["clutch.heat"][-1], rel=1e-3)


def test_the_temperature_of_the_plates_is_the_balance_of_its_flows(launch: cw.Trajectory) -> None:
    plates = launch["clutch.temperature"]
    to_air = np.interp(launch["engine.speed"], (0.0, 100.0, 400.0), (1.0, 4.0, 12.0))
    lost = 80.0 * (plates - launch["flywheel.temperature"]) + to_air * (plates - launch["air.temperature"])
    shown = launch["conduction.heat_flow"] + launch["plates_to_air.heat_flow"]
    assert shown == pytest.approx(lost, rel=1e-9, abs=1e-9)
    held = launch["clutch.heat"][-1] - integral(lost, launch.time)
    # 1500 J/K; flows change slowly, trapezia are good to 1e-5
    assert 1500.0 * (plates[-1] - plates[0]) == pytest.approx(held, rel=1e-4)


def test_figures_of_the_readme_are_those_of_the_launch(launch: cw.Trajectory) -> None:
    page = (EXAMPLES / "car_launch" / "README.md").read_text(encoding="utf-8")
    brake, lock = (launch.events.of(name).changes()[-1].time for name in ("brake", "clutch"))
    rise = np.ptp(launch["clutch.temperature"])
    for figure in (f"{brake:.2f} s", f"{lock:.2f} s", f"{launch['clutch.heat'][-1] / 1e3:.1f} kJ", f"{rise:.1f} K"):
        assert figure in page


def test_the_engine_keeps_its_idle_speed() -> None:
    car = example("car_launch", "car")
    engine = car.Engine(lambda time, readings: 0.0)
    # pedal down, electric load of 10 N m from 2 s on
    model = car.car({"combustion": {"torque": engine.signal()}}, spring={"travel": 0.12})
    shaft = next(node for node in model.nodes if node.name == "engine")
    model.add(cw.Torque("alternator", shaft=shaft, torque=cw.Step(height=-10.0, start=2.0)))
    run = model.simulate(8.0)
    assert run["engine.speed"].min() > 75.0
    assert run["engine.speed"][-1] == pytest.approx(engine.idle, abs=0.5)


@pytest.fixture(scope="module")
def hill() -> tuple[cw.Trajectory, object, pytest.WarningsRecorder]:
    """Hill starts until the clutch is too hot, and what was warned."""
    starts = example("hill_starts")
    driver = starts.Driver()
    with pytest.warns(starts.ClutchTooHotWarning) as warned:
        run = starts.starts(driver, 80.0)
    return run, driver, warned


def test_hill_starts_warn_with_time_and_value(hill: tuple[cw.Trajectory, object, pytest.WarningsRecorder]) -> None:
    run, driver, warned = hill
    example("hill_starts").check(run, driver)
    assert len(warned) == 1
    words = re.fullmatch(r"clutch at ([\d.]+) K above its limit of 473.00 K, ([\d.]+) s: .*", str(warned[0].message))
    assert words
    value, time = map(float, words.groups())
    # shown with two digits
    assert run.at([time])["clutch.temperature"][-1] == pytest.approx(value, abs=0.006)


def test_the_table_of_the_readme_is_that_of_the_hill_starts(
    hill: tuple[cw.Trajectory, object, pytest.WarningsRecorder],
) -> None:
    page = (EXAMPLES / "hill_starts" / "README.md").read_text(encoding="utf-8")
    shown = re.findall(r"^ +\d+ +([\d.]+) s +([\d.]+) kJ +(\d+) to (\d+) K$", page, re.MULTILINE)
    found = example("hill_starts").table(hill[0])
    assert len(shown) == len(found)
    for words, start in zip(shown, found, strict=True):
        lock, heat, before, after = map(float, words)
        # the last digit that is shown, and the tolerance of the run
        assert start.lock == pytest.approx(lock, abs=2e-3)
        assert start.heat == pytest.approx(1e3 * heat, abs=150.0)
        assert (start.before, start.after) == pytest.approx((before, after), abs=0.7)


def test_the_pictures_are_drawn(
    launch: cw.Trajectory, hill: tuple[cw.Trajectory, object, pytest.WarningsRecorder], tmp_path: Path
) -> None:
    pytest.importorskip("matplotlib")
    example("car_launch").picture(launch, tmp_path / "launch.png")
    example("hill_starts").picture(*hill[:2], tmp_path / "hill.png")
    assert all((tmp_path / name).stat().st_size > 50_000 for name in ("launch.png", "hill.png"))
