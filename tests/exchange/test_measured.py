"""Files that other programs wrote, in the ways in which they write them, as inputs of a model."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import asammdf
import h5py
import numpy as np
import pandas as pd
import pytest
import scipy.io
import xarray as xr

import clutchwork as cw
from clutchwork.base.errors import FileError
from support import random_drivelines

FAST, SLOW = np.arange(20) * 0.01, np.arange(5) * 0.1
TORQUE = np.arange(20, dtype="u2")
GEARS = {"val_0": 0, "text_0": "N", "val_1": 1, "text_1": "D", "default": b"?"}


def _channel(name: str, values: Any, times: Any, unit: str = "", **more: Any) -> Any:
    return asammdf.Signal(np.asarray(values), times, name=name, unit=unit, **more)


@pytest.fixture(scope="module")
def recorded(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two rasters as INCA and CANape record them: integers with a conversion, words, invalid samples."""
    path = tmp_path_factory.mktemp("mdf") / "measured.mf4"
    invalid = np.isin(np.arange(20), (7, 9))
    fast = [
        _channel("EngTrq", TORQUE, FAST, "Nm", conversion={"a": 0.5, "b": -100.0}),
        _channel("EngSpd\\ETKC:1", TORQUE * 100.0, FAST, "1/min"),
        _channel("Gear", np.arange(20) % 2, FAST, conversion=GEARS),
        _channel("pBrk", TORQUE * 1.0, FAST, "bar", invalidation_bits=invalid),
        _channel("TOil", TORQUE * 1.0, FAST, "°C"),
        _channel("lost", np.where(TORQUE == 3, np.nan, 1.0), FAST, "bar"),
        _channel("odd", TORQUE * 1.0, FAST, "furlong"),
        _channel("share", TORQUE, FAST, "%"),
        _channel("count", TORQUE, FAST, "-"),
    ]
    slow = [
        _channel("EngTrq", SLOW * 10.0, SLOW, "Nm"),
        _channel("state", np.array([b"a", b"b", b"c", b"d", b"e"]), SLOW, encoding="latin-1"),
        _channel("pAmb", SLOW + 1.0, SLOW, "mbar"),
        _channel("pAmbient", SLOW + 1.0, SLOW, "Nm"),
    ]
    with asammdf.MDF(version="4.10") as file:
        file.append(fast, acq_name="10 ms task", common_timebase=True)
        file.append(slow, acq_name="100 ms task", common_timebase=True)
        file.save(path)
    return path


def test_what_a_measurement_holds(recorded: Path) -> None:
    found = cw.read_columns(recorded)
    assert found.names[:3] == ("EngTrq", "EngSpd\\ETKC:1", "Gear")
    listed = {(one.name, one.group): one for one in found}
    assert listed["EngTrq", "100 ms task"].samples == 5
    assert listed["EngSpd\\ETKC:1", "10 ms task"].unit == "rpm"
    assert listed["Gear", "10 ms task"].is_text
    assert listed["state", "100 ms task"].is_text
    assert ["pBrk", "bar", "20", "10", "ms", "task"] in [line.split() for line in str(found).splitlines()]


@pytest.mark.parametrize(
    ("name", "more", "times", "values"),
    [
        ("EngTrq", {"group": "10 ms task"}, FAST, TORQUE * 0.5 - 100.0),
        ("EngTrq", {"group": "100 ms task"}, SLOW, SLOW * 10.0),
        ("EngSpd\\ETKC:1", {}, FAST, TORQUE * 100.0 * np.pi / 30.0),
        ("EngSpd", {}, FAST, TORQUE * 100.0 * np.pi / 30.0),
        ("share", {}, FAST, TORQUE * 0.01),
        ("count", {"scale": 2.0}, FAST, TORQUE * 2.0),
    ],
)
def test_channels_become_si(recorded: Path, name: str, more: dict[str, Any], times: Any, values: Any) -> None:
    found = np.array(cw.Column(str(recorded), name, **more).points)
    np.testing.assert_array_equal(found[:, 0], times)
    # a factor more than in the file: one rounding
    np.testing.assert_allclose(found[:, 1], values, rtol=4e-16)


@pytest.mark.parametrize(
    ("name", "more", "words"),
    [
        ("EngTrq", {}, "has 2 columns 'EngTrq'; choose with group: '10 ms task', '100 ms task'"),
        ("EngTrq", {"group": "10ms task"}, "has no group '10ms task'.*did you mean '10 ms task'"),
        ("EngTorq", {}, "has no column 'EngTorq'; the columns are .*did you mean 'EngTrq'"),
        ("Gear", {}, "has words in column 'Gear', no numbers"),
        ("state", {}, "has words in column 'state', no numbers"),
        ("pBrk", {}, r"(?s)'pBrk' at 0\.07 s is marked as invalid.*'pBrk' at 0\.09 s is marked as invalid"),
        ("lost", {}, r"'lost' at 0\.03 s is not a finite number"),
        ("odd", {}, "unknown unit 'furlong'"),
        ("pAmb", {"time": "EngTrq", "group": "10 ms task"}, "has no column 'pAmb'"),
        ("pAmb", {"time": "clock"}, "has no times 'clock' of column 'pAmb'"),
        ("share", {"scale": 0.01}, "repeats the unit"),
    ],
)
def test_what_is_refused(recorded: Path, name: str, more: dict[str, Any], words: str) -> None:
    with pytest.raises(FileError, match=words):
        _ = cw.Column(str(recorded), name, **more).points


def _driven(column: cw.Column) -> cw.Driveline:
    d = cw.Driveline()
    d.add(cw.Torque("t", shaft=d.shaft("a", inertia=2.0), torque=column))
    return d


def test_the_driven_quantity_decides_which_unit_fits(recorded: Path) -> None:
    (problem,) = _driven(cw.Column(str(recorded), "EngSpd")).check()
    assert "'EngSpd\\\\ETKC:1' has a unit that does not fit; give it in [N m]" in str(problem)
    run = _driven(cw.Column(str(recorded), "EngTrq", group="100 ms task")).simulate(0.4)
    # 10 N m/s over 2 kg m2: speed 2.5 t^2
    assert run["a.speed"][-1] == pytest.approx(2.5 * 0.4**2, rel=1e-9)


def test_in_a_model_file(recorded: Path) -> None:
    signal = '{type = "column", path = "measured.mf4", column = "EngTrq", group = "100 ms task"}'
    element = f'[[element]]\nname = "t"\ntype = "torque"\nshaft = "a"\ntorque = {signal}\n'
    path = recorded.parent / "model.toml"
    path.write_text(f'[[shaft]]\nname = "a"\ninertia = 2\n{element}')
    d = cw.Driveline.load(path)
    assert d.simulate(0.4)["a.speed"][-1] == pytest.approx(0.4, rel=1e-9)
    d.save(recorded.parent / "copy.toml")
    assert 'group = "100 ms task"' in (recorded.parent / "copy.toml").read_text()
    assert cw.Driveline.load(recorded.parent / "copy.toml").simulate(0.4)["a.speed"][-1] == pytest.approx(0.4)
    path.write_text(path.read_text().replace(', group = "100 ms task"', ""))
    with pytest.raises(cw.ModelError, match=r"line 8.*has 2 columns 'EngTrq'; choose with group"):
        cw.Driveline.load(path)


def test_times_that_fall_and_times_that_are_equal(tmp_path: Path) -> None:
    times = np.array([0.0, 1.0, 0.5, 2.0])
    frame = pd.DataFrame({"time": times, "p [bar]": 1.0})
    frame.to_parquet(tmp_path / "x.parquet")
    with pytest.raises(FileError, match=r"time 0\.5 s of sample 2 is before 1 s; sort the samples by time"):
        _ = cw.Column(str(tmp_path / "x.parquet"), "p").points
    frame["time"] = [0.0, 1.0, 1.0, 2.0]
    frame.to_parquet(tmp_path / "x.parquet")
    assert cw.Column(str(tmp_path / "x.parquet"), "p [bar]").points[2] == (1.0, 1e5)


def test_revolutions_per_minute_in_the_head_of_a_csv_file(tmp_path: Path) -> None:
    """They drive what turns: 1/min is rpm there, as in all other formats, and not once in 60 s."""
    (tmp_path / "x.csv").write_text("time,n [1/min],m [rpm]\n0,300,300\n1,300,300\n")
    column = cw.Column(str(tmp_path / "x.csv"), "n")
    assert column.points == cw.Column(str(tmp_path / "x.csv"), "m").points
    assert column.points[0][1] == pytest.approx(10.0 * np.pi)
    d = cw.Driveline()
    d.add(cw.PrescribedSpeed("n", shaft=d.shaft("a"), speed=column))
    assert d.simulate(1.0)["a.speed"][-1] == pytest.approx(10.0 * np.pi)


def test_mdf_of_version_3(tmp_path: Path) -> None:
    with asammdf.MDF(version="3.30") as file:
        file.append([_channel("EngTrq", TORQUE * 1.0, FAST, "Nm")], comment="task", common_timebase=True)
        file.save(tmp_path / "old.mdf")
    assert cw.Column(str(tmp_path / "old.mdf"), "EngTrq").points[-1] == (FAST[-1], 19.0)


# ---------------------------------------------------------------------------------------------------------------- MAT


def test_vectors_of_a_mat_file(tmp_path: Path) -> None:
    path = str(tmp_path / "x.mat")
    scipy.io.savemat(path, {"t": SLOW, "p": SLOW * 2, "n": 3.0, "M": np.eye(3), "clock": SLOW + 1.0})
    assert cw.read_columns(path).names == ("t", "p", "clock")
    assert cw.Column(path, "p").points[-1] == (0.4, 0.8)
    assert cw.Column(path, "p", time="clock").points[-1] == (1.4, 0.8)


def test_structures_of_a_mat_file(tmp_path: Path) -> None:
    path = str(tmp_path / "x.mat")
    measured = {
        "EngTrq": {"time": SLOW, "value": SLOW * 3, "unit": "kNm"},
        "pBrk": {"time": FAST, "value": FAST, "unit": "bar"},
    }
    # as Simulink writes a structure with time
    logged = {"time": SLOW, "signals": [{"values": SLOW * 4, "label": "slip"}, {"values": SLOW * 5, "label": "p"}]}
    table = {"Time": SLOW, "w": SLOW * 6, "units": {"Time": "ms", "w": "1/min"}}
    scipy.io.savemat(path, {"measured": measured, "logged": logged, "table": table})
    assert cw.Column(path, "EngTrq").points[-1] == pytest.approx((0.4, 1200.0))
    assert cw.Column(path, "measured.pBrk.value").points[-1] == pytest.approx((0.19, 0.19e5))
    assert cw.Column(path, "slip").points[-1] == pytest.approx((0.4, 1.6))
    assert cw.Column(path, "w").points[-1] == pytest.approx((0.0004, 2.4 * np.pi / 30))
    with pytest.raises(FileError, match=r"has 2 columns 'value'; name one of them: measured.EngTrq.value"):
        _ = cw.Column(path, "value").points


def test_a_mat_file_without_times(tmp_path: Path) -> None:
    path = str(tmp_path / "x.mat")
    scipy.io.savemat(path, {"p": SLOW, "clock": SLOW})
    with pytest.raises(
        FileError, match=r"has no times 'time' of column 'p'; name the one with the times: time=.*clock"
    ):
        _ = cw.Column(path, "p").points


def test_mat_of_version_7_3(tmp_path: Path, monkeypatch: Any) -> None:
    path = tmp_path / "x.mat"
    with h5py.File(path, "w", userblock_size=512) as file:
        group = file.create_group("run")
        for name, values in (("time", SLOW), ("p", SLOW * 2)):
            group.create_dataset(name, data=values.reshape(1, -1)).attrs["MATLAB_class"] = np.bytes_("double")
        units = group.create_group("units")
        text = np.array([[ord(letter)] for letter in "bar"], dtype="u2")
        units.create_dataset("p", data=text).attrs["MATLAB_class"] = np.bytes_("char")
    head = b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(124) + b"\x00\x02IM"
    path.write_bytes(head.ljust(512, b"\0") + path.read_bytes()[512:])
    assert cw.Column(str(path), "p").points[-1] == pytest.approx((0.4, 0.8e5))
    import sys

    monkeypatch.setitem(sys.modules, "h5py", None)
    (problem,) = cw.Column(str(path), "p").problems()
    assert 'a MAT file of version 7.3 needs h5py: pip install "clutchwork[exchange]"' in problem[1]


# ------------------------------------------------------------------------------------------------- NetCDF and the rest


def test_netcdf_of_xarray(tmp_path: Path) -> None:
    data = xr.Dataset({"p": ("time", SLOW, {"units": "bar"}), "w": ("t", FAST)}, coords={"time": SLOW, "t": FAST})
    data.to_netcdf(tmp_path / "x.nc", engine="h5netcdf")
    data.to_netcdf(tmp_path / "old.nc", engine="scipy")
    for name in ("x.nc", "old.nc"):
        assert cw.Column(str(tmp_path / name), "p").points[-1] == pytest.approx((0.4, 0.4e5))
        assert cw.Column(str(tmp_path / name), "w").points[-1] == (0.19, 0.19)


@pytest.mark.parametrize("ending", [".csv", ".parquet", ".mf4", ".mat", ".nc"])
def test_what_one_run_writes_drives_another(ending: str, tmp_path: Path) -> None:
    run = random_drivelines.describe(3).driveline().simulate(1.0)
    run.write(tmp_path / f"run{ending}")
    found = cw.read_columns(tmp_path / f"run{ending}")
    # one of each kind, such as "c1.torque": a file is opened for each
    for name in {name.rpartition(".")[2]: name for name in run.names if not name.endswith(".state")}.values():
        points = np.array(cw.Column(str(tmp_path / f"run{ending}"), name).points)
        np.testing.assert_array_equal(points[:, 0], run.time)
        np.testing.assert_array_equal(points[:, 1], run[name])
    assert len(found) >= len(run.names)


@pytest.mark.parametrize("ending", [".parquet", ".mf4", ".mat", ".nc"])
def test_damaged_files(ending: str, tmp_path: Path) -> None:
    path = tmp_path / f"x{ending}"
    random_drivelines.describe(3).driveline().simulate(0.1).write(path)
    data = path.read_bytes()
    for cut in (0, 5, 100, len(data) // 2):
        path.write_bytes(data[:cut])
        for column in (lambda: cw.Column(str(path), "p").points, lambda: cw.read_columns(path)):
            with pytest.raises(FileError):
                column()
    path.write_bytes(b"secret,words\n1,2\n")
    with pytest.raises(FileError, match="damaged, or has another format") as told:
        _ = cw.Column(str(path), "p").points
    assert "secret" not in str(told.value)


def test_the_first_bytes_count_not_the_ending(recorded: Path, tmp_path: Path) -> None:
    (tmp_path / "x.dat").write_bytes(recorded.read_bytes())
    assert len(cw.Column(str(tmp_path / "x.dat"), "EngSpd").points) == 20
    (tmp_path / "y.dat").write_text("time,p\n0,1\n")
    assert cw.Column(str(tmp_path / "y.dat"), "p").points == ((0.0, 1.0),)
    with pytest.raises(FileError, match="has no groups"):
        _ = cw.Column(str(tmp_path / "y.dat"), "p", group="a").points


@pytest.mark.parametrize("path", ["none.mf4", ".", "/dev/zero", "a\0b"])
def test_no_file(path: str, tmp_path: Path, monkeypatch: Any) -> None:
    monkeypatch.chdir(tmp_path)
    for read in (lambda: cw.Column(path, "p").points, lambda: cw.read_columns(path)):
        with pytest.raises(FileError):
            read()


def test_a_missing_package_is_a_problem_of_the_model(recorded: Path, monkeypatch: Any) -> None:
    import sys

    monkeypatch.setitem(sys.modules, "asammdf", None)
    (problem,) = cw.Column(str(recorded), "EngSpd").problems()
    assert 'an MDF file needs asammdf: pip install "clutchwork[exchange]"' in problem[1]


# ------------------------------------------------------------------------------------------------- semicolons, and fits

GERMAN = "time;p [bar];note\n0;1,5;x\n0,5;2,25E+01;y\n1;-3;\n"


def _read(folder: Path, text: str, column: str = "p") -> Any:
    (folder / "x.csv").write_bytes(text.encode())
    return cw.Column(str(folder / "x.csv"), column).points


@pytest.mark.parametrize("start", ["", "\ufeff"])
@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_semicolons_and_decimal_commas(tmp_path: Path, start: str, end: str) -> None:
    expected = ((0.0, 1.5e5), (0.5, 22.5e5), (1.0, -3e5))
    assert _read(tmp_path, start + GERMAN.replace("\n", end)) == expected
    points = GERMAN.replace(",", ".")
    assert _read(tmp_path, points) == expected
    found = cw.read_columns(tmp_path / "x.csv")
    assert [(one.name, one.unit, one.samples) for one in found][1] == ("p", "bar", 3)


def test_points_of_thousands_are_no_decimal_points(tmp_path: Path) -> None:
    with pytest.raises(FileError, match=r"line 3 of .* the cell in column 'p' is not a finite number"):
        _read(tmp_path, "time;p\n0;1,5\n1;1.234\n")
    # in a column that is not asked for they are nobody's business
    assert _read(tmp_path, "time;p;date\n0;1,5;01.02.2026\n") == ((0.0, 1.5),)


@pytest.mark.parametrize("ending", [".csv", ".parquet", ".mf4", ".mat"])
def test_fits_take_the_same_files(ending: str, tmp_path: Path) -> None:
    from clutchwork.fit import fit_csv, fit_law

    time = np.linspace(0.0, 1.0, 200)
    slip = 50.0 * np.sin(7.0 * time) + 60.0
    torque = 10.0 * (0.1 + 0.05 * np.exp(-slip / 20.0))
    columns = {"time": ("s", time), "slip": ("1/min", slip * 30.0 / np.pi), "torque": ("Nm", torque)}
    path = tmp_path / f"x{ending}"
    if ending == ".mf4":
        with asammdf.MDF(version="4.10") as file:
            group = [_channel(n, v, time, unit) for n, (unit, v) in columns.items() if n != "time"]
            file.append(group, common_timebase=True)
            file.save(path)
    elif ending == ".mat":
        units = {name: unit for name, (unit, _) in columns.items()}
        scipy.io.savemat(path, {"m": {n: v for n, (_, v) in columns.items()} | {"units": units}})
    else:
        frame = pd.DataFrame({f"{n} [{unit.replace('1/min', 'rpm')}]": v for n, (unit, v) in columns.items()})
        (frame.to_csv if ending == ".csv" else frame.to_parquet)(path, index=False)
    law = cw.Exponential(static=0.2, slow=0.18, fast=0.08, speed=15.0)
    found = fit_csv(path, law, slip="slip", torque="torque", load=10.0)
    wanted = fit_law(law, time=time, slip=slip, torque=torque, load=10.0)
    for a, b in zip(found.parameters, wanted.parameters, strict=True):
        # text and the factor of rpm round in the last digits
        assert a.value == pytest.approx(b.value, rel=1e-6)
    with pytest.raises(ValueError, match="did you mean 'torque"):
        fit_csv(path, law, slip="slip", torque="torqe", load=10.0)


def test_a_fit_over_two_rasters_is_refused(recorded: Path) -> None:
    from clutchwork.fit import fit_csv

    law = cw.Coulomb(static=0.2, kinetic=0.1)
    with pytest.raises(ValueError, match="load has other times than the torque"):
        fit_csv(recorded, law, slip="EngSpd", torque="count", load="pAmbient")


def _points(path: Path) -> Any:
    """Points of a column, None where its unit is refused."""
    try:
        return cw.Column(str(path), "x").points
    except FileError:
        return None


@pytest.mark.parametrize("unit", ["Nm", "bar", "rpm", "%", "kNm", "degC", "deg", "m/s"])
def test_units_mean_what_they_mean_in_the_head_of_a_csv_file(unit: str, tmp_path: Path) -> None:
    values = np.array([0.1, 20.0, -3.0])
    frame = pd.DataFrame({"time [s]": [0.0, 1.0, 2.0], f"x [{unit}]": values})
    frame.to_csv(tmp_path / "x.csv", index=False)
    with asammdf.MDF(version="4.10") as file:
        file.append([_channel("x", values, np.arange(3.0), unit)], common_timebase=True)
        file.save(tmp_path / "x.mf4")
    assert _points(tmp_path / "x.mf4") == _points(tmp_path / "x.csv")
