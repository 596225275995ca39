"""`clutchwork rig`: what it prints, writes and returns."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from clutchwork import rig
from clutchwork.command.main import main

pytest.importorskip("matplotlib")


@pytest.fixture(autouse=True)
def elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_the_command_of_the_drift_test(elsewhere: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["rig", "drift", "--laws", "LuGre,elasto-plastic,mykhalevych", "--out", "here"]) == 0
    out = capsys.readouterr().out
    assert [line.split()[0] for line in out.splitlines()[3:6]] == ["lugre", "elastoplastic", "mykhalevych"]
    assert "wrote here/drift.png" in out
    assert sorted(path.name for path in (elsewhere / "here").iterdir()) == ["drift.csv", "drift.png"]


def test_the_list_names_experiments_laws_and_presets(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["rig", "list"]) == 0
    out = capsys.readouterr().out
    for word in (*rig.EXPERIMENTS, *rig.PRESETS, *rig.PRESETS["first"].laws):
        assert word in out


def test_settings_presets_json_and_signals(elsewhere: Path, capsys: pytest.CaptureFixture[str]) -> None:
    line = ["rig", "lag", "--laws", "gms", "--preset", "first", "--set", "fast=5", "--set", "samples=50"]
    assert main([*line, "--json", "--signals"]) == 0
    (told,) = json.loads(capsys.readouterr().out)["experiments"]
    assert told["experiment"] == "lag"
    assert told["preset"] == "first"
    assert "gap at 5 Hz [N]" in told["table"][0]
    assert told["files"] == [
        "out/rig/lag.png",
        "out/rig/lag.csv",
        "out/rig/lag_gms_slow.csv",
        "out/rig/lag_gms_fast.csv",
    ]
    assert len((elsewhere / "out/rig/lag_gms_fast.csv").read_text().splitlines()) == 52


def test_a_law_that_chatters_is_told_and_no_failure(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["rig", "drift", "--laws", "naive_sign"]) == 0
    assert "chatter at" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("line", "words"),
    [
        (["drfit"], "did you mean 'drift'"),
        (["drift", "--laws", "lugr"], "did you mean 'lugre'"),
        (["drift", "--preset", "fristt"], "did you mean 'first'"),
        (["drift", "--set", "frequenzy=1"], "did you mean 'frequency'"),
        (["drift", "--set", "frequency"], "write it as name=number"),
        (["all", "--set", "frequency=1"], "give its name in place of all"),
        (["drift", "--laws", ","], "no friction law is given"),
    ],
)
def test_mistakes_are_answered(line: list[str], words: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["rig", *line]) == 2
    assert words in capsys.readouterr().err


def test_all_of_them(elsewhere: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["rig", "all", "--laws", "stribeck", "--preset", "second"]) == 0
    written = sorted(path.stem for path in (elsewhere / "out" / "rig").glob("*.png"))
    assert written == sorted(rig.EXPERIMENTS)
    assert capsys.readouterr().out.count("wrote ") == 2 * len(rig.EXPERIMENTS)
