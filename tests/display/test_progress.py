"""One bar for runs, sweeps and the command line."""

from __future__ import annotations

import io
import sys
from pathlib import Path

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.command import progress
from clutchwork.command.main import main

from .conftest import two_discs

pytest.importorskip("tqdm")


class Terminal(io.StringIO):
    """A standard error that says it is a terminal."""

    def isatty(self) -> bool:
        return True


def test_a_bar_of_a_run(capsys: pytest.CaptureFixture[str], discs: cw.Trajectory) -> None:
    run = two_discs().simulate(2.5, progress=True)
    assert "2.5 of 2.5 s" in capsys.readouterr().err
    # who watches changes nothing
    assert np.array_equal(run.rows, discs.rows)
    cw.simulate(two_discs().assemble(), 2.5, progress=True)
    assert "100%" in capsys.readouterr().err
    for silent in (False, None):
        two_discs().simulate(2.5, progress=silent)
        assert capsys.readouterr().err == ""


def test_a_bar_counts_from_where_a_run_begins(capsys: pytest.CaptureFixture[str]) -> None:
    two_discs().simulate(5.5, t_start=5.0, progress=True)
    assert "0.5 of 0.5 s" in capsys.readouterr().err
    told: list[tuple[float, float]] = []
    two_discs().simulate(5.5, t_start=5.0, progress=lambda time, end: told.append((time, end)))
    assert told[-1] == (5.5, 5.5)


def test_a_bar_of_a_sweep(capsys: pytest.CaptureFixture[str]) -> None:
    cw.sweep(two_discs(), 0.1, vary={"c1.gain": [1e-4, 2e-4]}, outputs="c1.torque", progress=True)
    assert "2/2" in capsys.readouterr().err


def test_neither_true_nor_a_function() -> None:
    with pytest.raises(cw.UseError, match=r"progress is 3: give True, or a function of \(time, t_end\)"):
        two_discs().simulate(0.1, progress=3)
    with pytest.raises(cw.UseError, match=r"progress is 'yes': give True, or a function of \(done, variants\)"):
        cw.sweep(two_discs(), 0.1, vary={"c1.gain": [1e-4]}, outputs="c1.torque", progress="yes")


def test_the_bar_ends_where_the_run_does(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.warns(cw.StoppedEarly):
        two_discs().simulate(2.5, progress=True, max_steps=3)
    assert "of 2.5 s" in capsys.readouterr().err


def test_the_command_line_has_the_same_bar(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(progress, "PATIENCE", 0.0)
    model = tmp_path / "model.toml"
    d = two_discs()
    d.simulation["t_end"] = 2.5
    d.save(model)
    shown = {}
    for option in ("", "--quiet", "--json"):
        terminal = Terminal()
        monkeypatch.setattr(sys, "stderr", terminal)
        assert main(["run", str(model), *([option] if option else [])]) == 0
        shown[option] = terminal.getvalue()
    assert "of 2.5 s" in shown[""]
    assert shown["--quiet"] == shown["--json"] == ""
    # no bar without a terminal, and none without tqdm
    monkeypatch.setattr(progress, "find_spec", lambda name: None)
    terminal = Terminal()
    monkeypatch.setattr(sys, "stderr", terminal)
    assert main(["run", str(model)]) == 0
    assert terminal.getvalue() == ""
