"""The example of the valve body: one shift, its table, and what its controller learns."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import pytest

from support.project import ROOT


@pytest.fixture
def script(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Any:
    pytest.importorskip("matplotlib").use("agg")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", [str(ROOT / "examples" / "valve_body"), *sys.path])
    import valve_body

    return valve_body


def test_it_shifts_and_learns(script: Any, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    script.main([])
    told = capsys.readouterr().out
    assert (tmp_path / "out" / "valve_body" / "shift.png").stat().st_size > 10_000
    direct, through = told.splitlines()[1:3]
    assert direct.split()[1:3] == ["2", "0"]
    # two words name the second one
    assert through.split()[2:4] == ["2", "0"]
    jerks = [float(line.split("peak jerk")[1].split()[0]) for line in told.splitlines() if "kiss point" in line]
    assert len(jerks) == 10
    assert jerks[-1] < 0.5 * jerks[0]
