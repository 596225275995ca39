"""The figures of the guide are those of the example, from one run."""

from __future__ import annotations

import importlib
from pathlib import Path

import pytest

TOOLS = Path(__file__).resolve().parents[2] / "tools"
# optima in corners move with the last digits of runs: by less than what readers would notice
CLOSE = 0.05


def test_the_figures_of_the_guide_are_those_of_the_example(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(TOOLS))
    tool = importlib.import_module("calibration_table")
    shown, made = (list(tool.numbers(text)) for text in (tool.shown(), tool.table()))
    assert [len(line) for line in shown] == [len(line) for line in made]
    for one, other in zip(shown, made, strict=True):
        remedy = "run .venv/bin/python tools/calibration_table.py"
        assert one == pytest.approx(other, rel=CLOSE), remedy
