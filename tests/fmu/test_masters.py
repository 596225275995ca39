"""Masters of other people, compiled from C and C++, run every FMU without a message and with the numbers of FMPy.

docs/guide/masters.md
"""

from __future__ import annotations

import importlib.util
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import clutchwork as cw
from support.fmus import Fmu
from support.masters import STEP, run
from support.project import ROOT

EXAMPLES = sorted(path.parent.name for path in (ROOT / "examples").glob("*/model.toml"))
STEPS = 400
# libcosim reads FMI 2.0 alone
# Ecos asks for the version of FMI 3.0 before it has loaded the library
OF_ITSELF = ['Function "fmi3GetVersion" is not provided by this FMU.', "Loading FMI version 3..."]
PAIRS = [("libcosim", "2.0"), ("ecos", "2.0"), ("ecos", "3.0")]


def here(module: str) -> bool:
    """Whether a master is installed: it has wheels for Linux on x86-64 alone."""
    return importlib.util.find_spec(module) is not None


def reals(fmu: Fmu) -> list[str]:
    """Outputs that are real."""
    kinds = ("Real", "Float64")
    return [name for name, one in fmu.variables.items() if one.causality == "output" and one.type in kinds]


@pytest.mark.skipif(not (here("libcosimpy") and here("ecospy")), reason="needs libcosimpy and ecospy")
@pytest.mark.parametrize(("master", "version"), PAIRS)
@pytest.mark.parametrize("example", EXAMPLES)
def test_every_example_runs_in_compiled_masters(tmp_path: Path, example: str, master: str, version: str) -> None:
    driveline = cw.Driveline.load(ROOT / "examples" / example / "model.toml")
    path = driveline.to_fmu(tmp_path / "one.fmu", version=version, picture=False)
    fmu = Fmu(path, tmp_path / "unpacked")
    names = reals(fmu)
    found, messages = run(master, path, STEPS, names)
    assert messages.split("\n") in ([""], OF_ITSELF)
    with fmu.running() as alone:
        for k in range(STEPS):
            alone.step(k * STEP, STEP)
        want = alone.get(names)
    # a difference of numbers that are as large as the largest has their round-off
    least = 1e-12 * max(map(abs, want))
    for name, value in zip(names, want, strict=True):
        # masters add up their instants in different ways, to the last bits of a time
        assert found[name] == pytest.approx(value, rel=1e-9, abs=least), name


@pytest.mark.skipif(not here("fmu_manipulation_toolbox"), reason="needs fmu_manipulation_toolbox")
def test_two_of_them_become_one(tmp_path: Path) -> None:
    """Cut at the half shafts: the error of the coupling shrinks with its step."""
    front, rear, whole = cw.Driveline("front"), cw.Driveline("rear"), cw.Driveline("whole")

    def clutch(d: cw.Driveline) -> cw.Node:
        engine, axle = d.shaft("engine", inertia=0.2, speed=150.0), d.shaft("axle", inertia=0.1)
        pressure = cw.Table([(0.0, 0.0), (0.5, 2e5)])
        lining = cw.Stribeck(static=0.35, kinetic=0.28, speed=10.0)
        d.add(cw.Clutch("c1", base=engine, follower=axle, friction=lining, gain=4e-3, pressure=pressure))
        return axle

    def shafts(d: cw.Driveline, axle: cw.Node) -> None:
        wheels = d.shaft("wheels", inertia=2.0)
        d.add(cw.SpringDamper("half_shafts", base=axle, follower=wheels, stiffness=400.0, damping=8.0))

    front.add(cw.Torque("reaction", shaft=front.housing, base=clutch(front), torque=0.0))
    flange = rear.shaft("flange")
    rear.add(cw.PrescribedSpeed("flange_speed", shaft=flange, speed=0.0))
    shafts(rear, flange)
    shafts(whole, clutch(whole))
    front.to_fmu(tmp_path / "front.fmu", inputs=["reaction.torque"], outputs=["axle.speed"], picture=False)
    outputs = ["half_shafts.torque", "wheels.speed"]
    with pytest.warns(cw.ModelWarning, match="flange_speed"):
        rear.to_fmu(tmp_path / "rear.fmu", inputs=["flange_speed.speed"], outputs=outputs, picture=False)
    links = """rule;from_fmu;from_port;to_fmu;to_port
FMU;front.fmu;;;
FMU;rear.fmu;;;
LINK;front.fmu;axle.speed;rear.fmu;flange_speed.speed
LINK;rear.fmu;half_shafts.torque;front.fmu;reaction.torque_signal
OUTPUT;rear.fmu;wheels.speed;;wheels.speed
"""
    right = whole.simulate(1.5)
    errors = []
    for step in (1e-3, 5e-4):
        (tmp_path / "car.csv").write_text(links)
        command = [Path(sys.executable).with_name("fmucontainer"), "-container", f"car.csv:{step}"]
        subprocess.run([*command, "-fmu-directory", tmp_path], cwd=tmp_path, check=True, capture_output=True)
        # in a process of its own: FMPy has one logger for all that it loads
        program = Path(sys.executable).with_name("fmpy")
        options = ["--stop-time", "1.5", "--output-interval", "0.01", "--output-file", "car.out"]
        subprocess.run([program, "simulate", "car.fmu", *options], cwd=tmp_path, check=True, capture_output=True)
        time, speed = np.loadtxt(tmp_path / "car.out", delimiter=",", skiprows=1).T
        error = speed - np.interp(time, right.time, right["wheels.speed"])
        errors.append(float(np.abs(error).max()))
    # first order, for both sides hold what they get
    assert errors[1] == pytest.approx(0.5 * errors[0], rel=0.2)
    assert errors[1] < 5e-3 * right["wheels.speed"].max()
