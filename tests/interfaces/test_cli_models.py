"""`clutchwork new`, and `run` and `check` with --set, --signals and files: good ones, misspelt ones, ones that fail."""

from __future__ import annotations

import csv
import json
import shlex
import tomllib
import warnings
from itertools import pairwise
from pathlib import Path

import pytest

import clutchwork as cw
from clutchwork.command.main import main
from clutchwork.command.new import KINDS, start
from support.two_discs import MODEL


@pytest.fixture
def model(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    """A model file in an empty working folder."""
    monkeypatch.chdir(tmp_path)
    Path("model.toml").write_text(MODEL)
    return "model.toml"


def data(capsys: pytest.CaptureFixture[str], *words: str) -> dict:
    """What a command prints as JSON."""
    assert main([*words, "--json"]) == 0
    made: dict = json.loads(capsys.readouterr().out)
    return made


# --- new ---


@pytest.mark.parametrize("kind", KINDS)
def test_a_new_model_is_right_and_runs(
    kind: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip("matplotlib").use("agg")
    monkeypatch.chdir(tmp_path)
    assert main(["new", "--kind", kind]) == 0
    out = capsys.readouterr().out
    steps = [line.strip() for line in out.splitlines() if line.startswith("  clutchwork")]
    assert len(steps) == 5
    for line in steps:
        assert main(shlex.split(line)[1:]) == 0, line
        assert capsys.readouterr().err == ""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        run = cw.Driveline.load("model.toml").simulate()
    assert run.finished
    assert kind == "torsion" or any(event.after == "locked" for event in run.events)
    # the balance closes to the tolerance of the run, 1e-6, within what 1000 steps add up
    assert abs(run.energy.residual) < 1e-4 * run.energy.turnover


@pytest.mark.parametrize("kind", KINDS)
def test_a_new_model_says_what_its_numbers_are(kind: str) -> None:
    text = start(kind)
    tables = tomllib.loads(text)
    assert tables["name"]
    # every element has words above it or on its lines, and no line is wider than a page shows
    for block in text.split("\n\n"):
        assert "[[element]]" not in block or "#" in block, block
    assert max(map(len, text.splitlines())) <= 120


def test_a_new_model_overwrites_nothing(model: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["new"]) == 4
    assert "model.toml is there already; give another name, or --force" in capsys.readouterr().err
    assert Path(model).read_text() == MODEL
    assert main(["new", "--force"]) == 0
    assert Path(model).read_text() == start("two-discs")
    assert main(["new", "other", "--kind", "torsion"]) == 0
    assert Path("other.toml").read_text() == start("torsion")
    assert main(["new", "a/b c.toml"]) == 0
    assert 'clutchwork check "a/b c.toml"' in capsys.readouterr().out
    assert main(["new", "x.json"]) == 2
    assert main(["new", "model.toml/x.toml"]) == 4


# --- set ---


def test_set_gives_the_run_of_a_changed_system(model: str, capsys: pytest.CaptureFixture[str]) -> None:
    words = ["--set", "c1.gain=1.5", "--set", "load.inertia=2000 kg cm2", "--set", "engine.speed=1200 rpm"]
    words += ["--set", "c1.friction.static=0.12", "--set", "c1.locked=false"]
    told = data(capsys, "run", model, *words)
    system = cw.Driveline.load(model).assemble()
    same = {"c1.gain": 1.5, "load.inertia": 0.2, "engine.speed": 125.66370614359172, "c1.friction.static": 0.12}
    run = cw.simulate(system.changed(same))
    assert told["events"][-1]["time"] == run.events[-1].time
    assert told["final"]["load.speed"] == float(run["load.speed"][-1])


def test_set_takes_all_that_a_file_may_have(model: str, capsys: pytest.CaptureFixture[str]) -> None:
    Path("p.csv").write_text("time [ms],force [kN]\n0,0\n200,0.1\n")
    for value in (
        '{type="table", points=[[0, 0], [0.2, 0.1]], unit="kN"}',
        '{type="column", path="p.csv", column="force"}',
        '{type="ramp", height="0.1 kN", duration="200 ms"}',
    ):
        told = data(capsys, "run", model, "--set", f"c1.normal_force={value}")
        # 1 N m s while the force rises, 16 N m s are needed for 0.16 kg m2 at 100 rad/s
        assert told["events"][-1]["time"] == pytest.approx(0.2 + 15.0 / 10.0, abs=1e-9)
    told = data(capsys, "run", model, "--set", 'c1.friction={type="coulomb", static=0.2, kinetic=0.2}')
    assert told["events"][-1]["time"] == pytest.approx(0.8, abs=1e-9)


def test_names_are_those_of_set(model: str, capsys: pytest.CaptureFixture[str]) -> None:
    names = data(capsys, "check", model, "--names")["names"]
    assert names["c1.gain"] == 1.0
    assert names["c1.friction"] == "coulomb"
    assert names["load.speed"] is None
    known = [f"{name}={json.dumps(value)}" for name, value in names.items() if value not in (None, "coulomb")]
    words = [word for one in known for word in ("--set", one)]
    assert data(capsys, "run", model, *words)["events"] == data(capsys, "run", model)["events"]


def test_all_mistakes_of_set_at_once(model: str, capsys: pytest.CaptureFixture[str]) -> None:
    wrong = {
        "c1.gian=6e-4": "did you mean 'c1.gain'?",
        "c1.normal_force=2 brr": "normal_force = '2 brr': has the unknown unit 'brr'",
        "c1.tolerance=2 N": "tolerance = '2 N': has a unit that does not fit; give it in [rad/s]",
        "load.inertia=-1": "inertia = -1.0 kg m2: must be >= 0 kg m2",
        "c1.base=load": "c1.base: is not a number; build another driveline",
        "c1.friction.kinetic=much": "kinetic = 'much': is not a number",
        "gain": "'gain': is not a name and a value",
        "": "is not a name and a value; write NAME=VALUE",
    }
    words = [word for one in wrong for word in ("--set", one)]
    assert main(["run", model, *words, "--csv", "out.csv"]) == 3
    err = capsys.readouterr().err
    assert [told for told in wrong.values() if told not in err] == []
    assert not Path("out.csv").exists()
    assert main(["run", model, "--set", "c1.gain=1", "--set", "c1.gain=2"]) == 3
    assert "c1.gain: is given twice; give it once" in capsys.readouterr().err


def test_a_unit_must_fit_what_the_gain_multiplies(model: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", model, "--set", "c1.gain=1 m3"]) == 3
    assert "has a unit that does not fit" in capsys.readouterr().err
    assert main(["run", model, "--set", "c1.gain=100 cm"]) == 0


# --- signals and files ---


def test_signals_choose_what_is_written_and_printed(model: str, capsys: pytest.CaptureFixture[str]) -> None:
    words = ["--signals", "*.speed, c1.slip", "--signals", "c1.*", "--csv", "out.csv", "--dt", "0.5"]
    told = data(capsys, "run", model, *words)
    run = cw.Driveline.load(model).simulate(dt=0.5)
    names = ["engine.speed", "load.speed", "c1.slip", *(n for n in run.names if n.startswith("c1.") and n != "c1.slip")]
    assert list(told["signals"]) == names
    assert told["signals"]["load.speed"] == {"unit": "rad/s", "values": run["load.speed"].tolist()}
    assert told["time"]["values"] == run.time.tolist()
    with Path("out.csv").open(newline="") as file:
        heads = next(csv.reader(file))
    assert [head.partition(" [")[0] for head in heads] == ["time", *names]
    assert "signals" not in data(capsys, "run", model)


def test_signals_that_are_not_there(model: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", model, "--signals", "laod.speed,c2.*", "--signals", "c1.slip", "--csv", "out.csv"]) == 2
    err = capsys.readouterr().err
    assert "'laod.speed'; did you mean 'load.speed'?" in err
    assert "'c2.*'" in err
    assert not Path("out.csv").exists()
    # known before the run, which would never end
    assert main(["run", model, "--signals", "nothing", "--t-end", "1e9", "--max-step", "1e-3"]) == 2


def test_check_lists_signals(model: str, capsys: pytest.CaptureFixture[str]) -> None:
    units = cw.Driveline.load(model).simulate().units
    assert data(capsys, "check", model, "--signals")["signals"] == units
    assert main(["check", model, "--signals", "--names"]) == 0
    out = capsys.readouterr().out
    assert all(name in out for name in (*units, "c1.friction.kinetic"))


@pytest.mark.parametrize("option", ["--csv", "--plot", "--events", "--write", "--save"])
def test_files_that_cannot_be_written_are_found_before_the_run(
    model: str, option: str, capsys: pytest.CaptureFixture[str]
) -> None:
    Path("folder.csv").mkdir()
    for path, words in (("model.toml/x.csv", "model.toml is a file, not a folder"), ("folder.csv", "it is a folder")):
        # a run that would never end
        assert main(["run", model, option, path, "--t-end", "1e9", "--max-step", "1e-3"]) == 4
        assert words in capsys.readouterr().err


def test_a_model_that_is_missing_has_a_remedy(model: str, capsys: pytest.CaptureFixture[str]) -> None:
    lines = {
        "modle.toml": "did you mean 'model.toml'?",
        "xyz.toml": "check the path; in its folder: model.toml",
        "none/model.toml": "there is no folder 'none'",
    }
    for path, words in lines.items():
        for command in ("run", "check", "sweep"):
            assert main([command, path]) == 4
            assert words in capsys.readouterr().err
    Path(model).unlink()
    Path("pyproject.toml").write_text("")
    assert main(["run", "car.toml"]) == 4
    assert "or write a model to start from: clutchwork new car.toml" in capsys.readouterr().err


def test_check_of_a_model_with_many_contacts_is_short(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    d = cw.Driveline("many")
    law = cw.Coulomb(static=0.1, kinetic=0.1)
    shafts = [d.shaft(f"s{i}", inertia=1.0) for i in range(9)]
    for i, (a, b) in enumerate(pairwise(shafts)):
        for name in ("x", "y"):
            d.add(cw.Clutch(f"{name}{i}", base=a, follower=b, friction=law, gain=1.0, normal_force=1.0))
    d.add(cw.Torque("in", shaft=shafts[0], torque=1.0))
    d.add(cw.Torque("out", shaft=shafts[-1], torque=-1.0))
    d.save(tmp_path / "many.toml")
    assert main(["check", str(tmp_path / "many.toml")]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "many: no mistakes"
    assert max(map(len, lines)) <= 80
    assert len(lines) < 100


def test_every_number_of_the_event_table_has_its_unit(model: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", model]) == 0
    head = capsys.readouterr().out.splitlines()[0]
    assert head.split("  ")[-3:] == ["slip acc rad/s2", "torque before N m", "torque after N m"]
