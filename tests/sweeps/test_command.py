"""`clutchwork sweep`."""

from __future__ import annotations

import csv
import json

import pytest

import clutchwork as cw
from clutchwork.command.main import main
from support.two_discs import MODEL


@pytest.fixture
def model(tmp_path):
    path = tmp_path / "model.toml"
    path.write_text(MODEL.replace("t_end = 2.0", "t_end = 3.0"))
    return str(path)


def test_a_table_of_all_combinations(model, tmp_path, capsys):
    out = tmp_path / "out" / "sweep.csv"
    line = ["sweep", model, "--vary", "c1.gain=0.5:2:4", "--vary", "load.inertia=0.8,1.6", "--out", str(out)]
    assert main([*line, "--outputs", "load.speed, lock(c1, -1), at(c1.slip, 0.5, 1), peak(c1.torque)"]) == 0
    with out.open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 8
    assert [row["c1.gain [m]"] for row in rows[::2]] == ["0.5", "1.0", "1.5", "2.0"]
    expected = cw.simulate(cw.Driveline.load(model).assemble().changed({"c1.gain": 1.0}))
    assert float(rows[2]["lock(c1, -1) [s]"]) == expected.events[-1].time
    assert "c1.slip at 0.5 s [rad/s]" in rows[0]
    told = capsys.readouterr().out
    assert "8 variants: 8 done" in told
    assert f"wrote {out}" in told


def test_values_with_units(model, tmp_path):
    """A unit stands behind the last value, and counts for all of them."""
    tables = []
    for place, (vary, outputs) in enumerate(
        (
            (["c1.normal_force=100:200:3", "load.inertia=0.8,1.6"], "at(c1.slip, 0.5)"),
            (["c1.normal_force=100:200 N:3", "load.inertia=800,1600 g m2"], "at(c1.slip, 500 ms)"),
        )
    ):
        out = tmp_path / f"{place}.csv"
        line = [part for one in vary for part in ("--vary", one)]
        assert main(["sweep", model, *line, "--outputs", outputs, "--out", str(out)]) == 0
        tables.append(out.read_text())
    assert tables[0] == tables[1]


def test_parquet_and_json(model, tmp_path, capsys):
    pytest.importorskip("pyarrow")
    out = tmp_path / "sweep.parquet"
    assert main(["sweep", model, "--vary", "c1.gain=0.5,1", "--out", str(out), "--json", "--t-end", "2"]) == 0
    data = json.loads(capsys.readouterr().out)
    assert data["variants"] == 2
    assert data["status"] == {"done": 2}
    assert data["files"] == [str(out)]
    # by default the speeds at the end and when contacts lock
    assert set(data["outputs"]) == {"engine.speed", "load.speed", "lock(c1, -1)"}
    assert out.stat().st_size > 0


def test_a_variant_that_stops_early(model, capsys):
    assert main(["sweep", model, "--vary", "c1.gain=0.5,1", "--max-steps", "1"]) == 1
    told = capsys.readouterr()
    assert "2 variants: 2 too_many_steps" in told.out
    assert "variant 0 stopped at" in told.err
    assert "raise max_steps" in told.err


@pytest.mark.parametrize(
    ("arguments", "code", "words"),
    [
        (["--vary", "c1.gain=0.5:2"], 2, "write NAME=FIRST:LAST:COUNT"),
        (["--vary", "c1.gain=1,2 rpm"], 3, "gain = '1.0 rpm': has a unit that does not fit"),
        (["--vary", "c1.gain=1 m,2"], 2, "write one unit, behind the last value"),
        (["--vary", "c1.gain"], 2, "write NAME=FIRST:LAST:COUNT"),
        (["--vary", "c1.gain", "--vary", "load.inertia=1:2"], 2, "sweep: 2 problems"),
        (["--vary", "c1.gian=1,2"], 3, "did you mean 'c1.gain'"),
        (["--vary", "c1.gain=-1,2"], 3, "gain = -1.0 m3: must be > 0 m3"),
        (["--vary", "c1.gain=1,2", "--outputs", "lokc(c1)"], 2, "no output 'lokc'; did you mean 'lock'"),
        (["--vary", "c1.gain=1,2", "--outputs", "lock(c1, x)"], 2, "x must be numbers"),
        (["--vary", "c1.gain=1,2", "--outputs", "laod.speed"], 2, "did you mean 'load.speed'"),
        ([], 2, "--vary is missing: give values of a name, such as --vary c1.gain=4e-4,8e-4"),
        (["--out", "sweep.xlsx"], 2, "must end in .parquet or .csv"),
    ],
)
def test_mistakes(model, capsys, arguments, code, words):
    assert main(["sweep", model, *arguments]) == code
    assert words in capsys.readouterr().err


def test_variants_that_never_lock_are_counted(model, capsys):
    line = ["sweep", model, "--vary", "c1.gain=1e-6,1,2", "--outputs", "lock(c1), load.speed"]
    assert main(line) == 0
    told = capsys.readouterr().out
    assert "lock(c1): no value in 1 of 3 variants" in told
    assert "load.speed: no value" not in told
    assert main([*line, "--json"]) == 0
    data = json.loads(capsys.readouterr().out)["outputs"]
    assert (data["lock(c1)"]["without_value"], data["load.speed"]["without_value"]) == (1, 0)
    # those that none has are listed too
    assert main(["sweep", model, "--vary", "c1.gain=1e-6", "--outputs", "lock(c1)"]) == 0
    assert "1 variant: 1 done" in (told := capsys.readouterr().out)
    assert "lock(c1): no value in 1 of 1 variant" in told


def test_a_jerk_with_its_window(model, capsys):
    for window, length in (("0.02", 0.02), ("20 ms", 0.02), ("1", 1.0)):
        asked = ["sweep", model, "--vary", "c1.gain=1", "--outputs", f"jerk(load, {window})", "--json"]
        assert main(asked) == 0
        told = json.loads(capsys.readouterr().out)["outputs"]["jerk(load)"]["max"]
        system = cw.Driveline.load(model).assemble().changed({"c1.gain": 1.0})
        assert told == pytest.approx(cw.jerk("load", length).of(cw.simulate(system)), rel=1e-9)
    for wrong, said in (
        ("jerk(load, 1, 2)", "jerk(SHAFT[, WINDOW]) has no more"),
        ("peak(load.speed, 2)", "peak(SIGNAL) has no more"),
        ("jerk(load, soon)", "soon"),
        ("jerk(load, 0)", "window is 0.0: give a time > 0 s"),
    ):
        assert main(["sweep", model, "--vary", "c1.gain=1", "--outputs", wrong]) == 2
        assert said in capsys.readouterr().err


def test_factors_of_all_names_that_match(model, tmp_path, capsys):
    out = tmp_path / "sweep.csv"
    line = ["--vary", "*.inertia*=0.5:1:2", "--vary", "c1.g*n*=2", "--outputs", "lock(c1), jerk(load)"]
    assert main(["sweep", model, *line, "--out", str(out)]) == 0
    with out.open(newline="") as file:
        rows = list(csv.DictReader(file))
    system = cw.Driveline.load(model).assemble()
    gain, inertias = system.parameters["c1.gain"].value, {n.name: n.inertia for n in system.nodes if not n.fixed}
    for row, factor in zip(rows, (0.5, 1.0), strict=True):
        values = {f"{name}.inertia": factor * inertia for name, inertia in inertias.items()}
        run = cw.simulate(system.changed({"c1.gain": 2.0 * gain, **values}))
        assert float(row["lock(c1) [s]"]) == cw.lock("c1").of(run)
        assert float(row["jerk(load) [rad/s3]"]) == pytest.approx(cw.jerk("load").of(run), rel=1e-9)
        assert float(row["*.inertia [1]"]) == factor
    assert main(["sweep", model, "--vary", "c1.gain*=1,2 m"]) == 2
    assert "a factor has no unit; write c1.gain*=0.9,1.1" in capsys.readouterr().err
