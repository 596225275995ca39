"""The study of a million shifts: it runs with fewer points, goes on, its claims hold, and it draws its picture."""

from __future__ import annotations

import importlib
from pathlib import Path

import pytest

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "million_shifts"


def test_shifts(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("matplotlib").use("agg")
    for module in ("pyarrow", "SALib", "duckdb"):
        pytest.importorskip(module)
    monkeypatch.syspath_prepend(str(EXAMPLE))
    script = importlib.import_module("million_shifts")
    folder = tmp_path / "shifts"
    found = script.study(folder, 128, threads=2)
    assert len(found) == 1024
    monkeypatch.setattr("sys.argv", ["million_shifts.py", str(folder), "--points", "128"])
    script.main()
    said = capsys.readouterr().out
    assert "goes on with 1024 shifts that are there" in said
    assert "F2.pressure.duration" in said
    assert (folder / "million_shifts.png").stat().st_size > 10_000
    # the second best is worse than the best, and some shifts are not good
    good = [share for *_, share in found.query(script.QUERY).fetchall()]
    assert good == sorted(good, reverse=True)
    assert len(good) == 5
