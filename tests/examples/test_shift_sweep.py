"""The sweep over gear shifts: it runs on a coarser grid, its claims hold, and it draws its picture."""

from __future__ import annotations

import importlib
from pathlib import Path

import pytest

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "shift_sweep"


def test_shifts(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("matplotlib").use("agg")
    monkeypatch.syspath_prepend(str(EXAMPLE))
    script = importlib.import_module("shift_sweep")
    found = script.shifts(5, 4, 3)
    script.check(found)
    script.picture(found, tmp_path / "x.png")
    assert (tmp_path / "x.png").stat().st_size > 10_000
    # a short ramp against a long one with the lining of the model, and hot against cold, as the guide tells it
    peak, heat = found["peak(shaft.torque)"], found["F1.heat"]
    assert 1.15 < peak[0].mean() / peak[-1].mean() < 1.4
    assert abs(heat[:, :, -1].mean() / heat[:, :, 0].mean() - 1.0) < 0.15
