"""Files for other programs: what is written is what a program reads, to the last bit, with units, words and events."""

from __future__ import annotations

import csv
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import asammdf
import numpy as np
import pandas as pd
import pyarrow.parquet as pq
import pytest
import scipy.io
import xarray as xr

import clutchwork as cw
from clutchwork import exchange
from clutchwork.exchange.safe_names import matlab
from support import random_drivelines
from support.amount import seeds

ROOT = Path(__file__).resolve().parents[2]
MODELS = sorted(ROOT.glob("examples/*/model.toml"))
FIELDS = ("time", "element", "before", "after", "cause", "slip_acceleration", "torque_before", "torque_after")

Read = dict[str, tuple[np.ndarray, str]]


def _example(path: Path) -> cw.Trajectory:
    return cw.Driveline.load(path).simulate()


def _random(seed: int) -> cw.Trajectory:
    return random_drivelines.describe(seed).driveline().simulate(0.5)


RUNS = [pytest.param(_example, path, id=path.parent.name) for path in MODELS]
# every format reads every run: a tenth of the usual number of cases
RUNS += [pytest.param(_random, seed, id=str(seed)) for seed in range(max(3, len(seeds(30)) // 10))]


def from_csv(path: Path) -> Read:
    with path.open(newline="") as file:
        heads, *lines = list(csv.reader(file))
    made = {}
    for head, column in zip(heads, zip(*lines, strict=True), strict=True):
        name, _, unit = head.partition(" [")
        made[name] = np.array(column), unit.removesuffix("]")
    return {n: (v if n.endswith(".state") else v.astype(float), unit) for n, (v, unit) in made.items()}


def from_parquet(path: Path) -> Read:
    frame, schema = pd.read_parquet(path), pq.read_schema(path)
    assert frame.attrs["units"] == {name: schema.field(name).metadata[b"unit"].decode() for name in frame}
    return {name: (frame[name].to_numpy(), frame.attrs["units"][name]) for name in frame}


def from_mdf(path: Path) -> Read:
    with asammdf.MDF(path) as file:
        made = {}
        for channel in file.groups[0].channels:
            signal = file.get(channel.name, group=0)
            made[channel.name] = signal.samples, signal.unit
            np.testing.assert_array_equal(signal.timestamps, file.get_master(0))
    return {n: (v.astype(str) if v.dtype.kind == "S" else v, unit) for n, (v, unit) in made.items()}


def from_mat(path: Path) -> Read:
    data = scipy.io.loadmat(path, simplify_cells=True)["run"]
    names, units = data["names"], data["units"]
    made = {names[key]: (np.atleast_1d(data[key]), units[key] if len(units[key]) else "") for key in names}
    return {n: (np.char.rstrip(v) if v.dtype.kind == "U" else v, unit) for n, (v, unit) in made.items()}


def from_netcdf(path: Path) -> Read:
    with xr.open_dataset(path, engine="h5netcdf", decode_times=False) as data:
        made = {"time": (data["time"].values, data["time"].attrs["units"])}
        for one in data.data_vars.values():
            if one.dims == ("time",):
                made[one.attrs["long_name"]] = one.values, one.attrs["units"]
        return made


READERS: dict[str, Callable[[Path], Read]] = {
    ".csv": from_csv,
    ".parquet": from_parquet,
    ".mf4": from_mdf,
    ".mat": from_mat,
    ".nc": from_netcdf,
}


def test_every_format_has_its_reader_here() -> None:
    assert set(READERS) == set(exchange.ENDINGS)


@pytest.mark.parametrize(("make", "what"), RUNS)
def test_every_signal_of_every_format_is_read_back_to_the_last_bit(
    make: Callable[[Any], cw.Trajectory], what: Any, tmp_path: Path
) -> None:
    run = make(what)
    for ending, read in READERS.items():
        run.write(tmp_path / f"run{ending}")
        found = read(tmp_path / f"run{ending}")
        assert list(found) == ["time", *run.names], ending
        for name, (values, unit) in found.items():
            expected = run.time if name == "time" else run[name]
            np.testing.assert_array_equal(values, expected, err_msg=f"{ending} {name}")
            assert unit == ("s" if name == "time" else run.units[name]), (ending, name)


@pytest.fixture(scope="module")
def run() -> cw.Trajectory:
    """Three clutches with a handful of events, and instants that appear twice."""
    made = random_drivelines.describe(3).driveline().simulate(random_drivelines.T_END)
    assert len(made.events) > 3
    assert np.any(np.diff(made.time) == 0.0)
    return made


def test_events_are_markers_and_channels_of_an_mdf_file(run: cw.Trajectory, tmp_path: Path) -> None:
    run.to_mdf(tmp_path / "run.mf4")
    with asammdf.MDF(tmp_path / "run.mf4") as file:
        assert [marker.value for marker in file.events] == [event.time for event in run.events]
        names = [f"{e.element}: {e.before} to {e.after}" for e in run.events]
        assert [marker.name for marker in file.events] == names
        for name in FIELDS[1:]:
            found = file.get(name, group=1)
            expected = [getattr(event, name) for event in run.events]
            samples = found.samples.astype(str) if found.samples.dtype.kind == "S" else found.samples
            assert samples.tolist() == expected
            assert found.timestamps.tolist() == run.events.times.tolist()
        told = file.header.description
    assert run.system.name in told
    assert f"t_end: {run.t_end!r} s" in told
    assert json.loads(told.partition("options: ")[2])["rtol"] == run.options.rtol


def test_words_of_an_mdf_file_are_numbers_with_a_table(run: cw.Trajectory, tmp_path: Path) -> None:
    name = next(name for name in run.names if name.endswith(".state"))
    run.to_mdf(tmp_path / "run.mf4", name)
    with asammdf.MDF(tmp_path / "run.mf4") as file:
        raw = file.get(name, raw=True)
        assert raw.samples.dtype.kind == "u"
        words = {raw.conversion[f"val_{k}"]: raw.conversion.referenced_blocks[f"text_{k}"] for k in range(2)}
    assert [words[code].decode() for code in raw.samples[:5]] == run[name][:5].tolist()


def test_events_of_mat_and_netcdf_files(run: cw.Trajectory, tmp_path: Path) -> None:
    run.to_mat(tmp_path / "run.mat")
    run.to_netcdf(tmp_path / "run.nc")
    events = scipy.io.loadmat(tmp_path / "run.mat", simplify_cells=True)["run"]["events"]
    with xr.open_dataset(tmp_path / "run.nc", engine="h5netcdf") as data:
        for name in FIELDS:
            expected = [getattr(event, name) for event in run.events]
            assert data[f"event_{name}"].values.tolist() == expected
            assert events[name].tolist() == expected
        assert data.attrs["model"] == run.system.name
        assert json.loads(data.attrs["options"])["rtol"] == run.options.rtol


def test_a_run_without_events_or_instants_is_written_too(tmp_path: Path) -> None:
    d = cw.Driveline("bare")
    d.add(cw.Torque("t", shaft=d.shaft("a", inertia=1.0), torque=1.0))
    for run in (d.simulate(1.0), d.simulate(1.0).at([0.5])):
        for ending, read in READERS.items():
            run.write(tmp_path / f"run{ending}")
            assert read(tmp_path / f"run{ending}")["a.speed"][0].tolist() == run["a.speed"].tolist()


def test_a_frame_of_events(run: cw.Trajectory) -> None:
    frame = run.events.to_pandas()
    assert frame["time"].tolist() == run.events.times.tolist()
    assert frame["element"].tolist() == [event.element for event in run.events]
    assert frame.attrs["units"]["torque_after"] == "N m"
    assert run.events[:0].to_pandas().columns.tolist() == frame.columns.tolist()


def test_a_frame_of_energies(run: cw.Trajectory) -> None:
    frame, energy = run.energy.to_pandas().set_index(["kind", "name"])["energy"], run.energy
    assert {name: frame["heat", name] for name in energy.heat} == energy.heat
    assert frame["residual", ""] == energy.residual == energy.to_dict()["residual_J"]
    json.dumps(energy.to_dict(), allow_nan=False)


# ------------------------------------------------------------------------------------------------------------- choice


def test_wildcards_mean_the_same_everywhere(run: cw.Trajectory, tmp_path: Path) -> None:
    wanted = ["c?.slip", "*.speed", "*.speed"]
    expected = [n for n in run.names if n.endswith(".slip") and n[0] == "c" and len(n) == 7]
    expected += [n for n in run.names if n.endswith(".speed")]
    assert len(expected) > 3
    assert list(run.to_pandas(wanted)) == list(run.to_xarray(wanted)) == expected
    for ending, read in READERS.items():
        run.write(tmp_path / f"run{ending}", names=wanted)
        assert list(read(tmp_path / f"run{ending}")) == ["time", *expected], ending


def test_all_unknown_names_are_told_of_at_once_and_nothing_is_written(run: cw.Trajectory, tmp_path: Path) -> None:
    contact = run.system.contacts[0].name
    with pytest.raises(cw.UnknownName) as told:
        run.to_mdf(tmp_path / "x.mf4", [f"{contact}.slipp", f"{contact}.slip", "nothing.*"])
    assert f"no signal '{contact}.slipp'; did you mean '{contact}.slip'?" in str(told.value)
    assert "no signal 'nothing.*'" in str(told.value)
    assert not (tmp_path / "x.mf4").exists()
    for wrong in (3, [3], [None, "x"]):
        with pytest.raises(cw.UseError, match="is not the name of a signal"):
            run.to_pandas(wrong)


def test_other_instants_are_computed_not_interpolated(run: cw.Trajectory) -> None:
    end = run.time[-1]
    frame = run.to_pandas(dt=0.013)
    grid = np.append(np.arange(int(end / 0.013) + 1) * 0.013, end)
    np.testing.assert_array_equal(frame.index, grid)
    exact = run.at(grid)
    for name in run.names:
        np.testing.assert_array_equal(frame[name], exact[name])
    # a straight line between the own instants is further away than any rounding
    name = "s0.speed" if "s0.speed" in run else run.names[0]
    assert not np.array_equal(np.interp(grid, run.time, run[name]), frame[name])
    chosen = run.to_xarray(name, times=[1.0, 0.5])
    assert chosen["time"].values.tolist() == [0.5, 1.0]


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"dt": 0.1, "times": [1.0]}, "dt and times are both given"),
        ({"dt": 0.0}, "dt is 0 s"),
        ({"dt": "x"}, "dt is 'x'"),
        ({"dt": 1e-12}, "do not fit into memory"),
        ({"times": [99.0]}, "must lie between 0 and 2 s"),
        ({"times": "soon"}, "must be a sequence of numbers"),
        ({"times": []}, "at least one"),
    ],
)
def test_instants_that_make_no_sense(run: cw.Trajectory, given: dict[str, Any], words: str, tmp_path: Path) -> None:
    with pytest.raises(cw.OptionError, match=words):
        run.to_parquet(tmp_path / "x.parquet", **given)


def test_a_run_that_stopped_early_is_handed_on_as_far_as_it_came(tmp_path: Path) -> None:
    with pytest.warns(cw.StoppedEarly):
        run = random_drivelines.describe(3).driveline().simulate(2.0, max_steps=60)
    run.write(tmp_path / "run.mf4")
    assert from_mdf(tmp_path / "run.mf4")["time"][0].tolist() == run.time.tolist()
    with asammdf.MDF(tmp_path / "run.mf4") as file:
        assert "too_many_steps" in file.header.description


def test_what_is_no_path(run: cw.Trajectory) -> None:
    for call in (run.to_csv, run.write, run.to_mdf, run.save, cw.read_columns):
        with pytest.raises(cw.UseError, match="3 is not a path"):
            call(3)  # type: ignore[operator]


def test_endings(run: cw.Trajectory, tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"ends in '.parket'; did you mean '.parquet'\?"):
        run.write(tmp_path / "x.parket")
    exchange.write(run, tmp_path / "x.MF4", ["*.speed"], 0.5)
    assert len(from_mdf(tmp_path / "x.MF4")["time"][0]) == 5
    # a format that is asked for by name needs no ending
    run.to_mdf(tmp_path / "measured", "*.speed")
    assert len(from_mdf(tmp_path / "measured")["time"][0]) == len(run)


def test_names_that_matlab_cannot_take() -> None:
    long = "x" * 70
    names = ["a.b", "a_b", "1st.speed", "ü.t", "a b", "time", long, f"{long}y", "_x"]
    made = matlab(names, ["time"])
    assert list(made) == names
    assert len(set(made.values())) == len(names)
    assert all(len(name) <= 63 and name.isidentifier() and name.isascii() and name[0] != "_" for name in made.values())
    assert "time" not in made.values()


def test_names_of_any_kind_survive(tmp_path: Path) -> None:
    d = cw.Driveline('strange, "names"')
    for name in ("in/out", "in_out", "Welle ü", 'a "b", c', "x [1]", "long" * 20, "back\\slash"):
        d.add(cw.Torque(f"t {name}", shaft=d.shaft(name, inertia=1.0), torque=1.0))
    run = d.simulate(0.1)
    for ending, read in READERS.items():
        if ending != ".csv":
            run.write(tmp_path / f"run{ending}")
            assert list(read(tmp_path / f"run{ending}")) == ["time", *run.names], ending


def test_a_file_that_is_too_large_for_mat_says_so(run: cw.Trajectory, tmp_path: Path, monkeypatch: Any) -> None:
    from clutchwork.exchange import mat

    monkeypatch.setattr(mat, "MOST_BYTES", 10_000)
    with pytest.raises(ValueError, match="choose signals with names="):
        run.to_mat(tmp_path / "x.mat")


@pytest.mark.parametrize(
    ("ending", "module"), [(".parquet", "pyarrow"), (".mf4", "asammdf"), (".mat", "scipy.io"), (".nc", "h5py")]
)
def test_a_missing_package_is_named(
    run: cw.Trajectory, ending: str, module: str, tmp_path: Path, monkeypatch: Any
) -> None:
    import sys

    monkeypatch.setitem(sys.modules, module, None)
    with pytest.raises(ImportError, match=r'pip install "clutchwork\[exchange\]"'):
        run.write(tmp_path / f"x{ending}")
