"""The table of the first five minutes: its numbers are those of the programs, and ours does what it says."""

from __future__ import annotations

import importlib
from pathlib import Path

import numpy as np
import pytest

from support.project import ROOT

PAGE = ROOT / "docs" / "guide" / "first-minutes.md"


def test_the_table_has_the_lines_of_the_programs(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(ROOT / "tools")
    tool = importlib.import_module("first_minutes")
    page = PAGE.read_text(encoding="utf-8").splitlines()
    assert [row for row in tool.rows() if row not in page] == []
    # every program has every section
    for file in tool.PROGRAMS.values():
        counts = tool.lines(tool.FOLDER / file)
        assert list(counts) == list(tool.SECTIONS)
        assert all(counts.values())


def test_our_program_does_what_the_others_do(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("matplotlib").use("agg")
    monkeypatch.chdir(tmp_path)
    source = (ROOT / "benchmarks" / "first_minutes" / "with_clutchwork.py").read_text(encoding="utf-8")
    names: dict = {}
    exec(compile(source, "with_clutchwork.py", "exec"), names)
    # half of the 0.2 s of the ramp, and 16 N m s over the torque
    gains = np.linspace(4e-4, 8e-4, 20)
    assert names["locks"] == pytest.approx(0.1 + 16.0 / (0.1 * 2e5 * gains), abs=1e-6)
    assert names["run"].events[-1].time == pytest.approx(1.7, abs=1e-6)
    assert names["sim"]["c1.state"] == "locked"
    # PathSim with the same controller locks at 2.1280674609 s
    assert names["sim"].events[-1].time == pytest.approx(2.12806746, abs=1e-6)
    assert (tmp_path / "engagement.png").stat().st_size > 10_000
    assert (tmp_path / "engagement.csv").read_text().startswith("time [s],")
