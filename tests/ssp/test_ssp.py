"""Packages of FMUs fit the schemas of SSP 1.0, and another program runs them. docs/guide/fmu-import.md"""

from __future__ import annotations

from pathlib import Path
from typing import Any
from zipfile import ZipFile

import fmpy
import numpy as np
import pytest
from fmpy.ssp.simulation import simulate_ssp
from fmpy.ssp.ssd import find_components, get_connections, read_ssd, read_ssv

import clutchwork as cw

STEP, END = 0.01, 0.5
COUPLED = [("tcu.piston.pressure", "car.c1.pressure"), ("car.c1.torque", "engine.load.torque_signal")]


def valve() -> cw.Driveline:
    """A pressure that follows a command; the shaft is there because a driveline has one."""
    d = cw.Driveline("tcu")
    d.shaft("idle", inertia=1.0)
    d.add(cw.PressureActuator("piston", command=2e5, lag=0.05))
    return d


def car() -> cw.Driveline:
    """A clutch between two bodies."""
    d = cw.Driveline("car")
    engine, wheels = d.shaft("engine", inertia=0.2, speed=100.0), d.shaft("wheels", inertia=0.8)
    lining = cw.Coulomb(static=0.12, kinetic=0.1)
    d.add(cw.Clutch("c1", base=engine, follower=wheels, friction=lining, gain=1e-3, pressure=0.0))
    return d


def engine() -> cw.Driveline:
    """A body that feels a torque."""
    d = cw.Driveline("engine")
    d.add(cw.Torque("load", shaft=d.shaft("crank", inertia=0.5), torque=0.0))
    return d


@pytest.fixture
def fmus(tmp_path: Path) -> dict[str, Path]:
    """Three FMUs."""
    how: dict[str, Any] = {"picture": False}
    return {
        "tcu": valve().to_fmu(tmp_path / "valve.fmu", **how),
        "car": car().to_fmu(tmp_path / "car 1.fmu", inputs=["c1.pressure"], **how),
        "engine": engine().to_fmu(tmp_path / "engine.fmu", inputs=["load.torque"], **how),
    }


@pytest.fixture
def package(tmp_path: Path, fmus: dict[str, Path]) -> Path:
    """A package of them."""
    values = {"car.c1.gain": 2e-3, "tcu.piston.lag": 0.1}
    return cw.export_ssp(tmp_path / "all.ssp", fmus, COUPLED, parameters=values, t_end=END)


def test_another_program_reads_what_was_meant(package: Path) -> None:
    """FMPy validates against the schemas of the standard."""
    found = read_ssd(package)
    assert (found.version, found.name) == ("1.0", "all")
    assert [(one.name, one.source) for one in find_components(found.system)] == [
        (name, f"resources/{name}.fmu") for name in ("tcu", "car", "engine")
    ]
    ends = [tuple(f"{one.parent.name}.{one.name}" for one in pair) for pair in get_connections(found.system)]
    assert ends == COUPLED
    connectors = {one.name: one for one in found.system.elements[1].connectors}
    assert (connectors["c1.pressure"].kind, connectors["c1.torque"].kind) == ("input", "output")
    assert connectors["c1.gain"].kind == "parameter"
    units = {one.name: one for one in found.units}
    assert (units["Pa"].kg, units["Pa"].m, units["Pa"].s, units["Pa"].factor) == (1, -1, -2, 1.0)
    values = read_ssv(package, "resources/parameters.ssv")
    assert {one.name: (float(one.value), one.unit) for one in values.parameters} == {
        "car.c1.gain": (2e-3, "m3"),
        "tcu.piston.lag": (0.1, "s"),
    }


def test_the_schemas_hold_with_units_of_all_connectors(package: Path) -> None:
    text = ZipFile(package).read("SystemStructure.ssd").decode()
    assert '<ssc:Real unit="rad/s"' in text
    assert "<ssc:Integer" in text
    # which FMPy validates and does not give
    assert '<ssd:DefaultExperiment startTime="0.0" stopTime="0.5"' in text


def test_fmus_inside_are_those_that_were_given(package: Path, fmus: dict[str, Path], tmp_path: Path) -> None:
    with ZipFile(package) as archive:
        for name, path in fmus.items():
            assert archive.read(f"resources/{name}.fmu") == path.read_bytes()
    # the same content gives the same bytes
    values = {"car.c1.gain": 2e-3, "tcu.piston.lag": 0.1}
    again = cw.export_ssp(tmp_path / "again.ssp", fmus, COUPLED, parameters=values, t_end=END, name="all")
    assert again.read_bytes() == package.read_bytes()


def test_another_program_runs_it(package: Path) -> None:
    """FMPy lets all step from old values, which are 0 at first, then passes on what they gave."""
    values = read_ssv(package, "resources/parameters.ssv")
    found = simulate_ssp(str(package), stop_time=END - 0.5 * STEP, step_size=STEP, parameter_set=values)
    parts = {"tcu": valve(), "car": car(), "engine": engine()}
    sims = {
        name: cw.Simulator(one.assemble().changed({"car": {"c1.gain": 2e-3}, "tcu": {"piston.lag": 0.1}}.get(name, {})))
        for name, one in parts.items()
    }
    pressure = torque = 0.0
    for number in range(round(END / STEP)):
        sims["car"].set("c1.pressure", pressure)
        sims["engine"].set("load.torque", torque)
        for sim in sims.values():
            sim.advance_to((number + 1) * STEP)
        pressure, torque = sims["tcu"]["piston.pressure"], sims["car"]["c1.torque"]
        row = found[number]
        # steps of both end at sums of steps, which differ by round-off
        assert row["tcu.piston.pressure"] == pytest.approx(pressure, rel=1e-9)
        assert row["car.c1.torque"] == pytest.approx(torque, rel=1e-9)
        assert row["engine.crank.speed"] == pytest.approx(sims["engine"]["crank.speed"], rel=1e-9)
    assert np.max(np.abs(found["car.c1.torque"])) > 1.0


def test_all_mistakes_are_told_at_once(tmp_path: Path, fmus: dict[str, Path]) -> None:
    with pytest.raises(cw.UseError) as raised:
        cw.export_ssp(
            tmp_path / "wrong.ssp",
            fmus,
            [
                ("tcu.piston.pressure", "car.c1.pressure"),
                ("tcu.piston.pressure", "car.c1.pressure"),
                ("car.c1.slip", "engine.load.torque_signal"),
                ("car.c1.mode", "engine.load.torque_signal"),
                ("tcu.piston.presure", "car.c1.torque"),
                ("bus.x", "car.c1.pressure"),
                "tcu.piston.pressure",  # type: ignore[list-item]
            ],
            parameters={"car.c1.gain": "much", "car.c1.gian": 1.0},  # type: ignore[dict-item]
        )
    told = str(raised.value)
    for words in (
        "car.c1.pressure is driven by tcu.piston.pressure already",
        "car.c1.slip is in rad/s and engine.load.torque_signal in N m, which measure different things",
        "car.c1.mode is Integer and engine.load.torque_signal is Real: connect the same types",
        "tcu: 'piston.presure' is not an output; did you mean 'piston.pressure'?",
        "car: 'c1.torque' is not an input",
        "'bus.x' does not begin with an element and a dot",
        "'tcu.piston.pressure' is not a connection",
        "car.c1.gain is 'much': give a number",
        "car: 'c1.gian' is not a parameter; did you mean 'c1.gain'?",
    ):
        assert words in told
    assert not (tmp_path / "wrong.ssp").exists()
    for wrong, words in (({}, "fmus is empty"), ({"my car": fmus["car"]}, "'my car' is not a name of an element")):
        with pytest.raises(cw.UseError, match=words):
            cw.export_ssp(tmp_path / "wrong.ssp", wrong)
    three = car().to_fmu(tmp_path / "three.fmu", version="3.0", picture=False)
    with pytest.raises(cw.FMUError, match=r"SSP 1.0 knows FMI 2.0, and this is 3.0"):
        cw.export_ssp(tmp_path / "wrong.ssp", {"car": three})


def test_the_command_line_writes_one(tmp_path: Path, fmus: dict[str, Path], capsys: pytest.CaptureFixture[str]) -> None:
    from clutchwork.command.main import main

    path = tmp_path / "line.ssp"
    given = [word for name, one in fmus.items() for word in ("--fmu", f"{name}={one}")]
    ends = [word for pair in COUPLED for word in ("--connect", "=".join(pair))]
    assert main(["ssp", str(path), *given, *ends, "--set", "car.c1.gain=2e-3", "--t-end", "0.5"]) == 0
    assert capsys.readouterr().out == f"wrote {path}\n"
    assert len(get_connections(read_ssd(path).system)) == 2
    assert main(["ssp", str(path), *given, "--connect", "car"]) == 2
    assert "--connect car: write it with an equals sign" in capsys.readouterr().err
    assert fmpy.__version__
