"""Records from files of other programs: what is read is what was written, in SI."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.fit import FitError, Record, fit_records
from support import measured_discs as two

RPM = 2.0 * np.pi / 60.0
LATE = 12.5  # s, at which the run begins in the file
TAIL = 50  # samples before it


def columns() -> dict[str, tuple[str, Any]]:
    """What a measurement system writes: units of its own, and some time before the run."""
    found = two.samples(two.discs(), 0.3, 5)
    times = np.concatenate([LATE - 0.02 * np.arange(TAIL, 0, -1), LATE + two.TIMES])
    before = np.zeros(TAIL)
    pressure = np.interp(two.TIMES, [0.0, two.RISE], [0.0, two.PRESSURE])
    return {
        "time": ("s", times),
        "n_eng": ("1/min", np.append(before, found["engine.speed"] / RPM)),
        "n_load": ("rpm", np.append(before, found["load.speed"] / RPM)),
        "p1": ("bar", np.append(before, 1e-5 * pressure)),
    }


def write_csv(path: Path, known: dict[str, tuple[str, Any]]) -> None:
    head = ",".join(f"{name} [{unit}]" for name, (unit, _) in known.items())
    table = np.column_stack([values for _, values in known.values()])
    np.savetxt(path, table, fmt="%.17g", delimiter=",", header=head, comments="")


def write_mdf(path: Path, known: dict[str, tuple[str, Any]]) -> None:
    asammdf = pytest.importorskip("asammdf")
    times = known["time"][1]
    channels = [
        asammdf.Signal(values, times, unit=unit, name=name) for name, (unit, values) in known.items() if name != "time"
    ]
    with asammdf.MDF() as file:
        file.append(channels)
        file.save(path, overwrite=True)


def write_parquet(path: Path, known: dict[str, tuple[str, Any]]) -> None:
    pyarrow = pytest.importorskip("pyarrow")
    parquet = pytest.importorskip("pyarrow.parquet")
    parquet.write_table(pyarrow.table({f"{n} [{unit}]": values for n, (unit, values) in known.items()}), path)


WRITERS = {"csv": write_csv, "mf4": write_mdf, "parquet": write_parquet}
MEASURED = {"engine.speed": "n_eng", "load.speed": "n_load"}
WINDOW = (LATE, LATE + 2.5)


@pytest.mark.parametrize("ending", WRITERS)
def test_a_file_gives_the_numbers_that_it_was_made_with(ending: str, tmp_path: Path) -> None:
    path = tmp_path / f"run 7.{ending}"
    WRITERS[ending](path, columns())
    record = Record.read(path, MEASURED, {"c1.pressure": "p1"}, window=WINDOW)
    assert record.name == "run 7"
    assert np.asarray(record.time) == pytest.approx(two.TIMES, abs=1e-9)
    found = fit_records(two.guess(pressure=1.0), record, list(two.TRUE), confidence=0.999)
    assert found.determined, found.message
    for name, true in two.TRUE.items():
        assert found[name].lower < true < found[name].upper, found[name]
    # to round-off what is fitted without a file
    direct = Record(two.TIMES, two.samples(two.discs(), 0.3, 5))
    same = fit_records(two.guess(), direct, list(two.TRUE))
    assert dict(found.values) == pytest.approx(dict(same.values), rel=1e-5)


def test_a_unit_that_the_file_does_not_say_is_given_with_the_name(tmp_path: Path) -> None:
    known = {name: ("" if name == "n_eng" else unit, values) for name, (unit, values) in columns().items()}
    for ending in ("csv", "mf4"):
        path = tmp_path / f"run.{ending}"
        WRITERS[ending](path, known)
        record = Record.read(path, {"engine.speed": "n_eng [1/min]"}, window=WINDOW)
        assert record.units == {"engine.speed": "1/min"}
        found = fit_records(two.discs(), record, ["load.inertia"])
        assert found.values["load.inertia"] == pytest.approx(0.8, rel=0.01)


def test_channels_of_other_rasters_keep_their_instants(tmp_path: Path) -> None:
    asammdf = pytest.importorskip("asammdf")
    known = two.samples(two.discs(), 0.1, 5)
    with asammdf.MDF() as file:
        for name, step in (("engine.speed", 1), ("load.speed", 5)):
            file.append([asammdf.Signal(known[name][::step], two.TIMES[::step], unit="rad/s", name=name)])
        file.save(tmp_path / "rasters.mf4", overwrite=True)
    record = Record.read(tmp_path / "rasters.mf4", {name: name for name in two.SPEEDS})
    found = fit_records(two.guess(), record, list(two.TRUE))
    assert [len(one.times) for one in found.records[0].traces] == [126, 26]
    assert found.values["load.inertia"] == pytest.approx(0.8, rel=0.01)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"measured": {"engine.speed": "n_egn"}}, r"engine.speed cannot be read: .*did you mean 'n_eng"),
        ({"measured": {}}, "measured is empty"),
        ({"window": (100.0, 101.0)}, "has no sample from 100 to 101 s: times are 11.5 to 15 s; choose another window"),
        ({"window": (2.0, 1.0)}, r"window is \(2.0, 1.0\); give begin and end"),
        ({"measured": {"engine.speed": "n_eng [rad/s]"}}, "engine.speed"),
        ({"path": "nowhere.csv"}, "does not exist"),
        (
            {"time": "t"},
            r"^time cannot be read: .* no column 't'; give time=...; the columns are time \[s\], n_eng",
        ),
    ],
)
def test_a_file_that_cannot_be_used_is_refused(changes: dict[str, Any], words: str, tmp_path: Path) -> None:
    write_csv(tmp_path / "run.csv", columns())
    given: dict[str, Any] = {"path": tmp_path / "run.csv", "measured": MEASURED} | changes
    with pytest.raises(FitError, match=words):
        Record.read(**given)


def test_columns_are_listed_where_neither_time_nor_signal_is_there(tmp_path: Path) -> None:
    write_csv(tmp_path / "run.csv", columns())
    with pytest.raises(FitError) as caught:
        Record.read(tmp_path / "run.csv", {"engine.speed": "n_egn", "load.speed": "n_lod"}, time="times")
    head, *lines = str(caught.value).splitlines()
    assert head == "3 problems"
    known = "the columns are time [s], n_eng [1/min], n_load [rpm], p1 [bar]; did you mean"
    assert all(known in line for line in lines)


def test_columns_without_units_are_noted(tmp_path: Path) -> None:
    known = {name: ("-", values) for name, (_, values) in columns().items()}
    write_csv(tmp_path / "run.csv", {**known, "time": columns()["time"]})
    driven = {"c1.pressure": "p1 [bar]"}
    record = Record.read(tmp_path / "run.csv", MEASURED, driven, window=WINDOW, time="time [s]")
    with pytest.raises(FitError, match="worse than their mean") as caught:
        fit_records(two.discs(), record, ["load.inertia"])
    found = caught.value.result
    told = "run: n_eng, n_load of the file have no unit and were taken as rad/s; give one with the name, such as "
    assert told + "'n_eng [1/min]'" in found.notes
    assert told in str(caught.value)
    said = (
        "likely engine.speed and load.speed are in 1/min and were taken as rad/s: give 'n_eng [1/min]' and 'n_load [1"
    )
    assert said in str(caught.value)
    assert "p1" not in found.notes


def test_units_that_do_not_fit_the_signal_are_refused(tmp_path: Path) -> None:
    write_csv(tmp_path / "run.csv", columns())
    record = Record.read(tmp_path / "run.csv", {"engine.speed": "p1"}, {"c1.pressure": "n_eng"}, window=WINDOW)
    with pytest.raises(FitError) as caught:
        fit_records(two.discs(), record, ["load.inertia"])
    assert [one.quantity for one in caught.value.problems] == ["run: c1.pressure", "run: engine.speed"]
    assert isinstance(caught.value, cw.ClutchworkError)
