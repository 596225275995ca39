"""Results in other units: what is asked for by name or pattern, and what is refused."""

from __future__ import annotations

import numpy as np
import pytest

import clutchwork as cw


@pytest.fixture(scope="module")
def run() -> cw.Trajectory:
    d = cw.Driveline("two discs")
    engine, load = d.shaft("engine", inertia=0.2, speed=100.0), d.shaft("load", inertia=0.8)
    plates = d.thermal("plates", capacity=900.0, temperature=350.0)
    law = cw.Coulomb(static=0.12, kinetic=0.1)
    d.add(cw.Clutch("c[1]", base=load, follower=engine, friction=law, gain=5e-4, pressure=2e5, heat=plates))
    return d.simulate(1.0, dt=0.25)


def test_one_signal(run: cw.Trajectory) -> None:
    np.testing.assert_allclose(run.in_units("engine.speed", "rpm"), run["engine.speed"] * 30 / np.pi, rtol=1e-15)
    np.testing.assert_allclose(run.in_units("engine.speed", "1/min"), run["engine.speed"] * 30 / np.pi, rtol=1e-15)
    np.testing.assert_allclose(
        run.in_units("plates.temperature", "degC"), run["plates.temperature"] - 273.15, rtol=1e-15
    )
    np.testing.assert_allclose(
        run.in_units("plates.temperature", "°F"), run["plates.temperature"] * 1.8 - 459.67, rtol=1e-13
    )
    assert run.in_units("engine.speed", "rad/s") is not None
    np.testing.assert_array_equal(run.in_units("engine.speed", "rad/s"), run["engine.speed"])


def test_tables_by_name_and_pattern(run: cw.Trajectory) -> None:
    units = {"*.speed": "rpm", "load.speed": "deg/s", "*temperature": "degC", "c[1].*": "kJ", "time": "ms"}
    frame = run.to_pandas(units=units)
    np.testing.assert_allclose(frame["engine.speed"], run["engine.speed"] * 30 / np.pi, rtol=1e-15)
    np.testing.assert_allclose(frame["load.speed"], np.degrees(run["load.speed"]), rtol=1e-15)
    np.testing.assert_allclose(frame["plates.temperature"], run["plates.temperature"] - 273.15, rtol=1e-15)
    np.testing.assert_allclose(frame["c[1].heat"], run["c[1].heat"] / 1e3, rtol=1e-15)
    # a torque is not work
    np.testing.assert_array_equal(frame["c[1].torque"], run["c[1].torque"])
    np.testing.assert_allclose(frame.index, run.time * 1e3, rtol=1e-15)
    found = frame.attrs["units"]
    assert [found[name] for name in ("engine.speed", "load.speed", "c[1].heat", "c[1].torque")] == [
        "rpm",
        "deg/s",
        "kJ",
        "N m",
    ]
    assert run.to_pandas().equals(run.to_pandas(units={}))
    assert list(run.to_pandas("engine.speed", units={"load.speed": "rpm"}).columns) == ["engine.speed"]


@pytest.mark.parametrize(
    ("units", "words"),
    [
        ({"engine.speed": "bar"}, r"engine.speed is 'bar': it has a unit that does not fit; the signal is in [rad/s];"),
        ({"engine.speed": "bar"}, "give it in rpm, 1/min, U/min, deg/s, rad/s"),
        ({"engine.speed": "rmp"}, "has the unknown unit 'rmp'; did you mean 'rpm'?"),
        ({"*.heat": "Nm"}, "does not fit; the signal is in [J]; give it in J, kJ"),
        ({"c[1].torque": "kJ"}, "does not fit; the signal is in [N m]; give it in Nm"),
        ({"c[1].state": "rpm"}, "is a word and has no unit; leave it out"),
        ({"engine.speed": 3}, "must be a unit"),
        ("engineering", "give units by signal"),
        ({"engine.speed": "bar", "*.torque": "rpm"}, "units: 2 problems"),
    ],
)
def test_what_does_not_fit(run: cw.Trajectory, units: object, words: str) -> None:
    with pytest.raises(cw.UseError) as caught:
        run.to_pandas(units=units)  # type: ignore[arg-type]
    assert words in str(caught.value)


def test_names_that_are_not_there(run: cw.Trajectory) -> None:
    with pytest.raises(cw.UnknownName, match=r"no signal 'engine.sped'; did you mean 'engine.speed'\?"):
        run.to_pandas(units={"engine.sped": "rpm"})
    with pytest.raises(cw.UnknownName, match="no signal"):
        run.in_units("*.speed", "rpm")
    with pytest.raises(cw.UnknownName, match=r"no signal '\*.sped'"):
        run.to_pandas(units={"*.sped": "rpm"})
    with pytest.raises(cw.UseError, match="does not fit"):
        run.in_units("engine.speed", "bar")
