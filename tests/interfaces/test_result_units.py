"""Results in other units: what is asked for by name or pattern, and what is refused."""

from __future__ import annotations

from pathlib import Path

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


def test_files_have_what_tables_have(run: cw.Trajectory, tmp_path: Path) -> None:
    """One mechanism: every format holds the numbers and units of the table, to the last bit."""
    pandas, scipy, asammdf = map(pytest.importorskip, ("pandas", "scipy.io", "asammdf"))
    names, units = ["*.speed", "plates.temperature", "c[1].torque"], {"*.speed": "rpm", "*.temperature": "degC"}
    frame = run.to_pandas(names, units=units)
    assert frame.attrs["units"]["engine.speed"] == "rpm"
    for ending in ("csv", "parquet", "mf4", "mat", "nc"):
        run.write(tmp_path / f"run.{ending}", names, units=units)
    csv = pandas.read_csv(tmp_path / "run.csv")
    assert list(csv) == ["time [s]", *(f"{name} [{frame.attrs['units'][name]}]" for name in frame)]
    assert np.array_equal(csv.to_numpy()[:, 1:], frame.to_numpy())
    parquet = pandas.read_parquet(tmp_path / "run.parquet")
    assert np.array_equal(parquet[list(frame)], frame)
    assert parquet.attrs["units"]["plates.temperature"] == "degC"
    mat = scipy.loadmat(tmp_path / "run.mat", squeeze_me=True, struct_as_record=False)["run"]
    assert np.array_equal(mat.engine_speed, frame["engine.speed"])
    assert mat.units.engine_speed == "rpm"
    with asammdf.MDF(tmp_path / "run.mf4") as file:
        signal = file.get("plates.temperature")
        assert (signal.unit, signal.samples.tolist()) == ("degC", frame["plates.temperature"].tolist())
    data = run.to_xarray(names, units={**units, "time": "ms"})
    assert data["engine.speed"].attrs["units"] == "rpm"
    assert data["time"].attrs["units"] == "ms"
    assert data["time"].values.tolist() == run.to_pandas(units={"time": "ms"}).index.tolist()
    with pytest.raises(cw.UseError, match="the time of an MDF file is in s"):
        run.to_mdf(tmp_path / "run.mf4", units={"time": "ms"})
    # what is read again as a signal has its units
    column = cw.Column(tmp_path / "run.csv", "engine.speed")
    assert np.asarray(column.points)[:, 1].tolist() == pytest.approx(run["engine.speed"].tolist(), rel=1e-14)


def test_pictures_have_what_tables_have(run: cw.Trajectory) -> None:
    pytest.importorskip("matplotlib")
    units = {"*.speed": "rpm", "load.speed": "deg/s", "*.temperature": "degC"}
    frame = run.to_pandas(units=units)
    measured = {"engine.speed": ([0.0, 1.0], [100.0, 50.0])}
    figure = run.plot("*.speed", "plates.temperature", units=units, measured=measured)
    lines = {(axes.get_ylabel(), line.get_label()): line for axes in figure.axes for line in axes.get_lines()}
    assert lines["speed, rpm", "engine.speed"].get_ydata().tolist() == frame["engine.speed"].tolist()
    assert lines["speed, deg/s", "load.speed"].get_ydata().tolist() == frame["load.speed"].tolist()
    assert lines["temperature, degC", "plates.temperature"].get_ydata().tolist() == frame["plates.temperature"].tolist()
    samples = lines["speed, rpm", "engine.speed, measured"].get_ydata()
    assert samples.tolist() == pytest.approx([3000.0 / np.pi, 1500.0 / np.pi])
    # a unit that is asked for is not changed to a larger one
    assert run.plot("c[1].pressure", units={"c[1].pressure": "Pa"}).axes[0].get_ylabel() == "pressure, Pa"
    assert run.plot("c[1].pressure").axes[0].get_ylabel() == "pressure, MPa"
    labels = [axes.get_ylabel() for axes in run.plot(units=units).axes]
    assert {"speed, rpm", "speed, deg/s", "state", "temperature, degC"} <= set(labels)
    both = cw.compare({"a": run, "b": run}, "engine.speed", units=units)
    assert [line.get_ydata().tolist() for line in both.axes[0].get_lines()] == 2 * [frame["engine.speed"].tolist()]
    with pytest.raises(cw.UseError, match="a picture shows the time in s"):
        run.plot("engine.speed", units={"time": "ms"})
    for draw in (run.plot, lambda **units: cw.compare(run, "engine.speed", **units)):
        with pytest.raises(cw.UseError, match="has a unit that does not fit"):
            draw(units={"engine.speed": "bar"})


def test_pages_have_what_tables_have(run: cw.Trajectory) -> None:
    pytest.importorskip("plotly")
    page = run.explore("engine.speed", units={"*.speed": "rpm"})
    assert list(page.data[0].y) == run.to_pandas(units={"*.speed": "rpm"})["engine.speed"].tolist()
    assert "rpm" in page.data[0].hovertemplate
