"""Runs that are stored, written for other programs, drawn and compared on the command line."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import clutchwork as cw
from clutchwork.command.main import main
from clutchwork.command.plot import labels, split
from support.two_discs import MODEL

# names of signals in pictures, and several runs in one


@pytest.fixture
def stored(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A working folder with a model, and two runs of it."""
    pytest.importorskip("matplotlib").use("agg")
    monkeypatch.chdir(tmp_path)
    Path("model.toml").write_text(MODEL)
    assert main(["run", "model.toml", "--quiet", "--save", "a.run"]) == 0
    assert main(["run", "model.toml", "--quiet", "--set", "c1.gain=2", "--save", "runs/b.run"]) == 0
    return tmp_path


def test_a_stored_run_is_the_run(stored: Path) -> None:
    run, same = cw.load_run("a.run"), cw.Driveline.load("model.toml").simulate()
    assert run.events == same.events
    assert run["load.speed"].tolist() == same["load.speed"].tolist()
    assert cw.load_run("runs/b.run").events[-1].time == pytest.approx(0.8)


def test_runs_are_written_by_the_endings_of_the_files(stored: Path) -> None:
    pandas = pytest.importorskip("pandas")
    words = ["--write", "x/out.csv", "--write", "out.parquet", "--signals", "*.speed", "--dt", "0.5"]
    assert main(["run", "model.toml", "--quiet", *words]) == 0
    table = pandas.read_csv("x/out.csv")
    assert list(table) == ["time [s]", "engine.speed [rad/s]", "load.speed [rad/s]"]
    same = cw.Driveline.load("model.toml").simulate(dt=0.5)
    assert table["load.speed [rad/s]"].tolist() == same["load.speed"].tolist()
    assert len(pandas.read_parquet("out.parquet")) == len(same)


def test_pictures(stored: Path, capsys: pytest.CaptureFixture[str]) -> None:
    lines = {
        "a.run": "a.png",
        "runs/b.run c1.torque *.speed --out pictures/b.svg": "pictures/b.svg",
        "a.run runs/b.run c1.torque": "a.png",
        "a.run runs/b.run --out both.png": "both.png",
    }
    for line, path in lines.items():
        Path(path).unlink(missing_ok=True)
        assert main(["plot", *line.split()]) == 0
        assert capsys.readouterr().out == f"wrote {path}\n"
        assert Path(path).read_bytes()[:5] in (b"\x89PNG\r", b"<?xml")
    assert main(["plot", "a.run", "c1.slip", "--json"]) == 0
    assert json.loads(capsys.readouterr().out) == {"runs": ["a.run"], "signals": ["c1.slip"], "files": ["a.png"]}


def test_words_after_a_run_are_files_or_signals(stored: Path) -> None:
    assert split(Path("a.run"), ["runs/b.run", "c1.slip", "none.run"]) == (
        [Path("a.run"), Path("runs/b.run"), Path("none.run")],
        ["c1.slip"],
    )
    assert labels([Path("x/a.run"), Path("b.run")]) == ["a", "b"]
    assert labels([Path("x/a.run"), Path("a.run")]) == ["x/a.run", "a.run"]


@pytest.mark.parametrize(
    ("line", "code", "words"),
    [
        ("plot none.run", 4, "none.run does not exist; check the path"),
        ("plot a.run other.run", 4, "other.run does not exist; check the path"),
        ("plot model.toml", 4, "is a model; run it first: clutchwork run model.toml --save model.run"),
        ("plot a.run --out model.toml/x.png", 4, "model.toml is a file, not a folder"),
        ("run model.toml --write out.xlsx", 2, "no format ends in '.xlsx'; known: .csv, .parquet"),
        ("run model.toml --write out.parqet", 2, "did you mean '.parquet'?"),
    ],
)
def test_mistakes(stored: Path, line: str, code: int, words: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(line.split()) == code
    assert words in capsys.readouterr().err


@pytest.mark.parametrize(
    ("line", "words"),
    [("plot a.run c1.spil", "did you mean 'c1.slip'?"), ("plot a.run --out a.gif", ".png")],
)
def test_mistakes_in_pictures(stored: Path, line: str, words: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(line.split()) == 2
    assert words in capsys.readouterr().err
