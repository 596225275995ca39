"""Measurements from files: columns, units, mistakes."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.base.errors import FileError
from clutchwork.fit import FitError, fit_csv, fit_law
from support import rig_data

LAW = rig_data.true_law(cw.Stribeck)
DATA = rig_data.measured(LAW)
SI = "time [s],slip [rad/s],torque [N m],load [N m]"


def write(folder: Path, head: str, factors: tuple[float, ...] = (1.0, 1.0, 1.0, 1.0)) -> Path:
    path = folder / "measured.csv"
    rows = np.column_stack([DATA.time, DATA.slip, DATA.torque, DATA.load]) * np.array(factors)
    np.savetxt(path, rows, delimiter=",", header=head, comments="", fmt="%.17g")
    return path


@pytest.mark.parametrize(
    ("head", "names"),
    [
        (SI, {"slip": "slip [rad/s]", "torque": "torque [N m]", "load": "load [N m]", "time": "time [s]"}),
        (SI, {"slip": "slip", "torque": "torque", "load": "load"}),
        ("time,w,T,F", {"slip": "w", "torque": "T", "load": "F"}),
        ("time,w,T,F", {"slip": "w [rad/s]", "torque": "T [Nm]", "load": rig_data.LOAD}),
    ],
)
def test_heads_with_and_without_units(head: str, names: dict[str, Any], tmp_path: Path) -> None:
    found = fit_csv(write(tmp_path, head), LAW, **names)
    wanted = fit_law(LAW, **DATA.arguments)
    assert [p.value for p in found.parameters] == [p.value for p in wanted.parameters]


def test_units_are_converted(tmp_path: Path) -> None:
    path = write(tmp_path, "time [ms],n [rpm],T [kNm],F [N m]", (1e3, 30.0 / np.pi, 1e-3, 1.0))
    found = fit_csv(path, LAW, time="time", slip="n", torque="T", load="F")
    wanted = fit_law(LAW, **DATA.arguments)
    for a, b in zip(found.parameters, wanted.parameters, strict=True):
        assert a.value == pytest.approx(b.value, rel=1e-6)
    assert found.samples.time[-1] == pytest.approx(DATA.time[-1])


def test_units_of_translation(tmp_path: Path) -> None:
    found = fit_csv(
        write(tmp_path, "time,v [mm/s],F [N],N [N]", (1.0, 1e3, 1.0, 1.0)), LAW, slip="v", torque="F", load="N"
    )
    assert found["speed"].unit == "m/s"
    assert found["speed"].value == pytest.approx(2.0, rel=0.01)


@pytest.mark.parametrize("head", ["theta [K]", "theta"])
def test_a_column_of_temperature(head: str, tmp_path: Path) -> None:
    law = rig_data.true_law(cw.TemperatureTable)
    data = rig_data.measured(law)
    path = tmp_path / "warm.csv"
    np.savetxt(
        path,
        np.column_stack([*data.arguments.values()]),
        delimiter=",",
        header=f"{SI},{head}",
        comments="",
        fmt="%.17g",
    )
    found = fit_csv(path, law, slip="slip", torque="torque", load="load", temperature="theta", time="time")
    wanted = fit_law(law, **data.arguments)
    for a, b in zip(found.parameters, wanted.parameters, strict=True):
        assert a.value == pytest.approx(b.value, rel=1e-9)
    held = fit_csv(path, law, slip="slip", torque="torque", load="load", temperature=300.0)
    assert set(held.samples.temperature) == {300.0}  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("head", "names", "words"),
    [
        (SI, {"slip": "slipp", "torque": "torque"}, "did you mean 'slip"),
        (SI, {"slip": "slip", "torque": "torque", "time": "t"}, "no column 't'"),
        (SI, {"slip": "slip", "torque": "torque", "temperature": "theta"}, "no column 'theta'"),
        ("time,slip,torque,T [bar]", {"slip": "slip", "torque": "torque", "temperature": "T"}, r"give it in \[K\]"),
        ("time,slip [s],torque,load", {"slip": "slip", "torque": "torque"}, "does not fit"),
        ("time,slip [rads],torque,load", {"slip": "slip", "torque": "torque"}, "unknown unit"),
        ("time,slip [m/s],torque [N m],load", {"slip": "slip", "torque": "torque"}, "mix rotation and translation"),
        ("time;slip;torque;load", {"slip": "slipp", "torque": "torque"}, "did you mean 'slip"),
    ],
)
def test_columns_that_do_not_fit(head: str, names: dict[str, str], words: str, tmp_path: Path) -> None:
    with pytest.raises(FitError, match=words):
        fit_csv(write(tmp_path, head), LAW, **names)  # type: ignore[arg-type]


def test_files_that_cannot_be_read(tmp_path: Path) -> None:
    names = {"slip": "slip", "torque": "torque"}
    with pytest.raises(FileError, match="does not exist"):
        fit_csv(tmp_path / "none.csv", LAW, **names)
    path = write(tmp_path, SI)
    path.write_text(path.read_text().replace("\n0.01", "\nnan", 1))
    with pytest.raises(FileError, match="not a finite number"):
        fit_csv(path, LAW, **names)
    path.write_text("")
    with pytest.raises(FileError, match="empty"):
        fit_csv(path, LAW, **names)
