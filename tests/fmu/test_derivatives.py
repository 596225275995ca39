"""Derivatives that an FMU gives: by states and inputs, forwards and backwards, and those of outputs over time."""

from __future__ import annotations

import warnings
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import clutchwork as cw
from clutchwork.signals.bases.waveform import value
from fmu.conftest import SIX_SPEED
from support.fmus import ERROR, Fmu, Instance
from support.importer import exchanged, simulated
from support.project import ROOT

# signals that drive something in the examples; their values and results of them
SIGNALS = (".torque", ".pressure", ".force")
INTEGRALS = (".work", ".heat", ".energy", ".losses")
Array = NDArray[np.float64]
EXAMPLES = sorted(path.parent.name for path in (ROOT / "examples").glob("*/model.toml"))


def results(fmu: Fmu) -> list[str]:
    """Outputs that are numbers."""
    return [name for name, one in fmu.variables.items() if one.causality == "output" and one.variability != "discrete"]


def derived(run: Instance, unknowns: list[str], known: str) -> Array:
    """Derivatives of results by one number."""
    references = [run.reference(name) for name in unknowns]
    more = () if run.fmu.version == "2.0" else (len(references),)
    return np.array(run.raw.getDirectionalDerivative(references, [run.reference(known)], [1.0], *more))


def rates(run: Instance, names: list[str]) -> Array:
    """First derivatives of outputs over time."""
    read = run.raw.getRealOutputDerivatives if run.fmu.version == "2.0" else run.raw.getOutputDerivatives
    return np.array(read([run.reference(name) for name in names], [1] * len(names)))


@pytest.mark.parametrize("example", EXAMPLES)
def test_by_inputs_they_are_those_of_the_linear_system(tmp_path: Path, example: str) -> None:
    """`linearise` has them by dual numbers and elimination, an FMU by differences of its motion."""
    driveline = cw.Driveline.load(ROOT / "examples" / example / "model.toml")
    system = driveline.assemble()
    signals = [item.name for item in system.inputs if item.name.endswith(SIGNALS) and not item.signal.sampling()]
    path = driveline.to_fmu(tmp_path / "one.fmu", inputs=signals, parameters=(), version="3.0", picture=False)
    fmu = Fmu(path, tmp_path / "unpacked")
    assert 'providesDirectionalDerivatives="true"' in (fmu.folder / "modelDescription.xml").read_text()
    start = {item.name: value(item.signal, 0.0) for item in system.inputs if item.name in signals}
    sim, end = cw.Simulator(system.changed(start)), float(driveline.simulation["t_end"])
    times = np.linspace(0.0, end, 8)
    names = [name for name in results(fmu) if not name.endswith(INTEGRALS)]
    seen = 0
    with fmu.running() as run:
        for begin, after in pairwise(times):
            for item in system.inputs:
                if item.name in signals:
                    sim.set({item.name: value(item.signal, begin)})
                    run.set(item.name, value(item.signal, begin))
            sim.advance_to(after)
            run.step(begin, after - begin)
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                plain = {name.replace("'", ""): name for name in names}
                linear = cw.linearise(sim, inputs=signals, outputs=list(plain))
            found = [plain[name] for name in linear.outputs]
            for column, one in enumerate(linear.inputs):
                called = f"{one}_signal" if f"{one}_signal" in fmu.variables else one
                got, want = derived(run, found, called), linear.D[:, column]
                # round-off of results over a millionth of the input
                largest = np.abs(run.get(found)).max() / max(1.0, abs(run.get([called])[0]))
                off = 1e-8 * np.abs(want).max() + 1e-9 * largest
                np.testing.assert_allclose(got, want, rtol=1e-6, atol=off, err_msg=f"{one} {after}")
                seen += int(np.any(want))
    assert seen > 0 or not signals


def differences(run: Any, unknowns: list[str], states: list[str], size: Array) -> Array:
    """Columns of derivatives by continuous states, from both sides, as any importer takes them."""
    time, x = run.time, run.x()
    made = np.empty((len(unknowns), len(states)))
    for k in range(len(states)):
        ends = []
        for side in (1.0, -1.0):
            other = x.copy()
            other[k] += side * size[k]
            run.place(time, other)
            ends.append(np.array(run.get(unknowns)))
        made[:, k] = (ends[0] - ends[1]) / (2.0 * size[k])
    run.place(time, x)
    return made


@pytest.mark.parametrize("example", EXAMPLES)
@pytest.mark.parametrize("version", ["2.0", "3.0"])
def test_by_states_they_are_the_differences_of_an_importer(tmp_path: Path, example: str, version: str) -> None:
    """Rates and outputs of model exchange at instants of a run, and backwards."""
    driveline = cw.Driveline.load(ROOT / "examples" / example / "model.toml")
    path = driveline.to_fmu(tmp_path / "one.fmu", outputs="*.speed,*.torque,*.slip", parameters=(), version=version,
        picture=False)  # fmt: skip
    fmu = Fmu(path, tmp_path / "unpacked")
    derivatives = [one for one in fmu.description.modelVariables if one.derivative is not None]
    states = [one.derivative.name for one in derivatives if one.causality == "local"]
    unknowns = [one.name for one in derivatives if one.causality == "local"] + results(fmu)
    end = float(driveline.simulation["t_end"])
    with exchanged(fmu, tolerance=1e-8) as run:
        for after in np.linspace(0.0, end, 5)[1:]:
            simulated(run, [after], [], rtol=1e-6)
            got = np.array([derived(run, unknowns, name) for name in states]).T
            x = run.x()
            want = differences(run, unknowns, states, 1e-6 * np.maximum(np.abs(x), 1.0))
            # those of an importer lose ten digits of results to round-off, over a change by 1e-6 of a state
            size = np.abs(want).max(axis=1, keepdims=True) + 1e-9 * np.abs(run.get(unknowns))[:, None] / 1e-6
            assert np.max(np.abs(got - want) / np.maximum(size, 1e-4)) < 1e-5, after
            if version == "3.0":
                rows, seed = [run.reference(name) for name in unknowns], np.linspace(-1.0, 1.0, len(unknowns))
                columns = [run.reference(name) for name in states]
                backwards = run.raw.getAdjointDerivative(rows, columns, seed, len(columns))
                np.testing.assert_allclose(backwards, seed @ got, rtol=1e-12, atol=1e-12 * np.abs(got).max())
            run.raw.enterEventMode()


@pytest.mark.parametrize("version", ["2.0", "3.0"])
@pytest.mark.parametrize("example", EXAMPLES)
def test_rates_of_outputs_are_those_between_steps(tmp_path: Path, example: str, version: str) -> None:
    """Of all outputs that are no integrals, where no event is near."""
    driveline = cw.Driveline.load(ROOT / "examples" / example / "model.toml")
    fmu = Fmu(driveline.to_fmu(tmp_path / "one.fmu", parameters=(), version=version, picture=False), tmp_path / "made")
    assert 'maxOutputDerivativeOrder="1"' in (fmu.folder / "modelDescription.xml").read_text()
    end, size = float(driveline.simulation["t_end"]), 2e-5
    names = results(fmu)
    with fmu.running(tolerance=1e-10) as run:
        time = 0.0
        for after in np.linspace(0.0, end, 9)[1:-1]:
            rows = []
            for at in (after - size, after, after + size):
                run.step(time, at - time)
                time = at
                rows.append(np.array(run.get(names)))
                if at == after:
                    got = rates(run, names)
            want = (rows[2] - rows[0]) / (2.0 * size)
            # differences are of second order in a step, and keep nine digits of the largest result of each unit
            units = [fmu.variables[name].unit for name in names]
            largest = [max(abs(y) for y, one in zip(rows[1], units, strict=True) if one == unit) for unit in units]
            far = (np.abs(rows[2] - 2.0 * rows[1] + rows[0]) + 1e-9 * np.array(largest)) / size
            off = np.abs(got - want) - (1e-6 * np.abs(want) + far + 1e-6)
            assert np.max(off) <= 0, (after, names[np.argmax(off)], got[np.argmax(off)], want[np.argmax(off)])


def ramped(made: Any, version: str) -> Fmu:
    """A torque on 0.5 kg m2 that a clutch with a lining of 0.1 brakes by 1e-4 m of its pressure."""
    d = cw.Driveline("ramped")
    shaft = d.shaft("shaft", inertia=0.5, speed=100.0)
    d.add(cw.Torque("drive", shaft=shaft, torque=0.0))
    lining = cw.Coulomb(static=0.1, kinetic=0.1)
    d.add(cw.Brake("brake", shaft=shaft, friction=lining, gain=1e-3, pressure=1e4))
    return made(d, inputs=["drive.torque", "brake.pressure"], version=version)


@pytest.mark.parametrize("version", ["2.0", "3.0"])
def test_closed_forms(made: Any, version: str) -> None:
    """0.5 w' = T - 1e-4 p, with ramps of both."""
    fmu = ramped(made, version)
    with fmu.running({"drive.torque": 3.0, "brake.pressure": 1e4}) as run:
        run.rate("drive.torque_signal", 20.0)
        run.rate("brake.pressure", 3e4)
        run.step(0.0, 0.1)
        got = dict(zip(("shaft.speed", "brake.torque", "brake.power"), rates(run, ["shaft.speed", "brake.torque",
            "brake.power"]), strict=True))  # fmt: skip
        # at 0.1 s the torque is 5 N m, the brake takes 1.3 N m
        assert got["shaft.speed"] == pytest.approx((5.0 - 1.3) / 0.5, rel=1e-7)
        assert got["brake.torque"] == pytest.approx(-3.0, rel=1e-7)
        assert derived(run, ["brake.torque", "shaft.acceleration"], "brake.pressure") == pytest.approx([-1e-4, -2e-4])


def test_what_has_no_derivatives_is_refused(made: Any) -> None:
    fmu = ramped(made, "2.0")
    with fmu.running() as run:
        speed, mode, pressure = (run.reference(name) for name in ("shaft.speed", "brake.mode", "brake.pressure"))
        for of, by in (([mode], [pressure]), ([speed], [speed]), ([pressure], [pressure]), ([10**6], [pressure])):
            with pytest.raises(Exception, match=f"status {ERROR}"):
                run.raw.getDirectionalDerivative(of, by, [1.0])
        with pytest.raises(Exception, match=f"status {ERROR}"):
            run.raw.getRealOutputDerivatives([speed], [2])
        # and the run goes on
        run.step(0.0, 0.1)


def test_looking_at_derivatives_changes_no_bit(six_speed: Fmu) -> None:
    names, found = ["w1.speed", "F2.heat", "F4.torque"], []
    for looks in (True, False):
        with six_speed.running({"F2.pressure": 4e5, "F4.pressure": 3e5}) as run:
            for k in range(50):
                if looks:
                    rates(run, names)
                    derived(run, names, "F4.pressure")
                run.step(k * 1e-2, 1e-2)
            found.append(run.get(names))
    assert found[0] == found[1]


def test_steps_of_one_length_have_none(tmp_path: Path) -> None:
    path = cw.Driveline.load(SIX_SPEED).to_fmu(tmp_path / "one.fmu", method="fixed", step=1e-3, picture=False)
    fmu = Fmu(path, tmp_path / "made")
    assert not fmu.description.coSimulation.providesDirectionalDerivative
    assert fmu.description.modelExchange.providesDirectionalDerivative
    with fmu.running() as run, pytest.raises(Exception, match=f"status {ERROR}"):
        rates(run, ["w1.speed"])
