"""The command line: what it prints, writes and returns."""

from __future__ import annotations

import json
import math
import subprocess
import sys
from pathlib import Path

import pytest

import clutchwork as cw
from clutchwork.command.main import main
from support.two_discs import MODEL

SIX_SPEED = Path(__file__).resolve().parents[2] / "examples" / "six_speed" / "model.toml"


@pytest.fixture
def model(tmp_path: Path) -> Path:
    path = tmp_path / "model.toml"
    path.write_text(MODEL, encoding="utf-8")
    return path


def test_run_prints_events_energy_and_effort(model: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", str(model)]) == 0
    out = capsys.readouterr().out
    assert "1.600000" in out
    assert "locked" in out
    assert "residual" in out
    assert "steps" in out


def test_run_writes_what_is_asked_for(model: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    files = [tmp_path / "a" / name for name in ("out.csv", "events.csv")]
    assert main(["run", str(model), "--csv", str(files[0]), "--events", str(files[1]), "--dt", "0.1", "--quiet"]) == 0
    assert len(files[0].read_text().splitlines()) == 22
    assert files[1].read_text().startswith("time [s],element,before,after")
    assert capsys.readouterr().out == ""


def test_run_writes_a_folder_with_picture(model: Path, tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    assert main(["run", str(model), "--out", str(tmp_path / "out")]) == 0
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == ["events.csv", "picture.png", "trajectory.csv"]
    assert (tmp_path / "out" / "picture.png").read_bytes()[:4] == b"\x89PNG"


def test_units_of_files_and_of_the_picture(model: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("matplotlib")
    asked = ["run", str(model), "--quiet", "--dt", "0.1", "--signals", "*.speed", "--out", str(tmp_path), "--units"]
    assert main([*asked, "*.speed=rpm", "--units", "load.speed=deg/s", "--units", "time=ms"]) == 0
    head, first, *_, last = (tmp_path / "trajectory.csv").read_text().splitlines()
    assert head == "time [ms],engine.speed [rpm],load.speed [deg/s]"
    assert [float(cell) for cell in first.split(",")] == pytest.approx([0.0, 3000 / math.pi, 0.0])
    assert float(last.split(",")[0]) == pytest.approx(2000.0)
    for wrong, words in {
        "*.speed=bar": "does not fit",
        "*.sped=rpm": "no signal",
        "rpm": "write NAME=UNIT",
    }.items():
        assert main([*asked, wrong]) != 0
        assert words in capsys.readouterr().err


def test_a_run_goes_on_from_a_state(model: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    state, files = tmp_path / "one.state", [tmp_path / name for name in ("whole.csv", "rest.csv")]
    run = ["run", str(model), "--quiet"]
    assert main([*run, "--t-end", "1", "--save-state", str(state)]) == 0
    assert main([*run, "--times", "1,1.2,1.7,2", "--csv", str(files[0])]) == 0
    assert main([*run, "--start", str(state), "--times", "1.2,1.7,2", "--csv", str(files[1])]) == 0
    whole, rest = ([line.split(",") for line in file.read_text().splitlines()] for file in files)
    assert len(rest) == 4
    column = whole[0].index("load.speed [rad/s]")
    wanted, found = ([float(row[column]) for row in table] for table in (whole[2:], rest[1:]))
    # the whole run has no step that ends at 1 s
    assert found == pytest.approx(wanted, rel=1e-9)
    assert main([*run, "--start", str(state), "--t-start", "0.5"]) != 0
    assert "t_start cannot be given beside start" in capsys.readouterr().err
    assert main([*run, "--start", str(model)]) != 0
    assert "cannot read a state" in capsys.readouterr().err


def test_json(model: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", str(model), "--json", "--t-end", "1.7", "--rtol", "1e-9", "--method", "dopri5"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["status"] == "done"
    assert told["time_s"] == 1.7
    assert told["events"][0]["element"] == "c1"
    assert told["final"]["load.speed"] == pytest.approx(20.0)
    assert told["energy"]["heat_J"]["c1"] == pytest.approx(800.0)


def test_check_lists_the_gears(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", str(SIX_SPEED)]) == 0
    out = capsys.readouterr().out
    assert "4 independent speeds" in out
    for closed, ratio in {"F2 F4": "2.4886", "F1 F4": "1.8302", "F2 F5": "-5.0309", "F1 F3": "1.0000"}.items():
        assert any(line.split() == [*closed.split(), ratio] for line in out.splitlines())
    assert main(["check", str(SIX_SPEED), "--json", "--ratio", "w8/w1"]) == 0
    gears = {tuple(g["closed"]): g["ratio"] for g in json.loads(capsys.readouterr().out)["gears"]}
    assert gears["F1", "F6"] == pytest.approx(1 / 3.35, abs=1e-12)


def test_the_demonstration(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("matplotlib")
    # an empty folder: the model comes with the package
    monkeypatch.chdir(tmp_path)
    assert main(["demo"]) == 0
    out = capsys.readouterr().out
    assert "2.4886 -> 1.8302 by gears" in out
    written = [Path("out", "demo", name) for name in ("shift.png", "trajectory.csv", "events.csv")]
    assert [line for line in out.splitlines() if line.startswith("wrote")] == [f"wrote {path}" for path in written]
    assert sorted(path.relative_to(tmp_path) for path in tmp_path.rglob("*.*")) == sorted(written)
    events = [line.split(",") for line in written[2].read_text().splitlines()[1:]]
    assert [line[1:4] for line in events] == [
        ["F2", "backward", "locked"],
        ["F2", "locked", "backward"],
        ["F2", "backward", "forward"],
        ["F1", "forward", "locked"],
    ]
    # from an independent solver at rtol 1e-9; ours runs at 1e-6 here
    times = [0.5480809432868581, 2.149267898385477, 2.2428855485606327, 2.7397556553095317]
    assert [float(line[0]) for line in events] == pytest.approx(times, abs=1e-6)


def test_the_demonstration_without_matplotlib(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("clutchwork.command.run.find_spec", lambda name: None)
    assert main(["demo", "--out", str(tmp_path)]) == 0
    assert sorted(path.name for path in tmp_path.iterdir()) == ["events.csv", "trajectory.csv"]
    assert "clutchwork[draw]" in capsys.readouterr().err


def test_the_demonstration_of_a_damaged_installation(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("clutchwork.command.run.DEMO", Path("examples", "none.toml"))
    assert main(["demo"]) == 4
    told = capsys.readouterr().err
    assert "none.toml not found" in told
    assert "install clutchwork again" in told


def test_every_mistake_of_a_model_is_listed(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "wrong.toml"
    path.write_text(MODEL.replace("inertia = 0.8", "inertai = 0.8").replace('"clutch"', '"cluch"'), encoding="utf-8")
    assert main(["run", str(path)]) == 3
    told = capsys.readouterr().err
    assert "did you mean 'inertia'" in told
    assert "did you mean 'clutch'" in told
    assert main(["check", str(path), "--json"]) == 3
    assert len(json.loads(capsys.readouterr().out)["problems"]) >= 2


def test_a_model_that_is_not_there(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", str(tmp_path / "none.toml")]) in (3, 4)
    assert "none.toml" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("extra", "words"),
    [
        (["--rtol", "-1"], "rtol is -1"),
        (["--t-end", "0"], "t_end is 0 s"),
        (["--ratio", "engine/loads"], "did you mean 'load'"),
        (["--ratio", "engine"], "must be two shafts, such as engine/load"),
    ],
)
def test_wrong_options(model: Path, extra: list[str], words: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", str(model), *extra]) == 2
    assert words in capsys.readouterr().err


def test_no_end_time(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "model.toml"
    path.write_text(MODEL.replace("[simulation]\nt_end = 2.0\n", ""), encoding="utf-8")
    assert main(["run", str(path)]) == 2
    assert "--t-end" in capsys.readouterr().err


def test_unknown_commands_and_options_are_refused_by_code_2() -> None:
    for line in (["fly"], ["run"], ["run", "m.toml", "--methd", "x"]):
        with pytest.raises(SystemExit) as stopped:
            main(line)
        assert stopped.value.code == 2


def test_version(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as stopped:
        main(["--version"])
    assert stopped.value.code == 0
    assert capsys.readouterr().out.startswith("clutchwork")


def test_a_reader_that_has_seen_enough_ends_it_quietly(model: Path) -> None:
    command = [sys.executable, "-m", "clutchwork", "run", str(model), "--json"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as run:
        assert run.stdout is not None
        run.stdout.close()
        assert run.stderr is not None
        assert run.stderr.read() == b""
        assert run.wait() == 0


def test_a_run_that_begins_later_says_how_long_it_is(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    """It computed from its start on, not from 0 s."""
    d = cw.Driveline("later")
    d.add(cw.Torque("t", shaft=d.shaft("s", inertia=1.0), torque=1.0))
    d.simulation = {"t_end": 5.0}
    d.save(tmp_path / "model.toml")
    assert main(["run", str(tmp_path / "model.toml"), "--t-start", "2.3 s"]) == 0
    assert "2.7 s computed in" in capsys.readouterr().out
