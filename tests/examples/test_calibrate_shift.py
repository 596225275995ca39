"""A shift is calibrated with few samples: less jerk, and limits that hold in gearboxes that were not looked at."""

from __future__ import annotations

import importlib
from pathlib import Path

import pytest

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "calibrate_shift"


def test_the_eight_speed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(EXAMPLE))
    script = importlib.import_module("calibrate_shift")
    shift = script.eight_speed()
    nominal = script.calibrated(shift)
    assert nominal.feasible, nominal.message
    # the least jerk is where a clutch only just locks: what is not certified is not solved, and the message says so
    assert nominal.solved or "a neighbour may be better" in nominal.message
    assert nominal.goal[1] < 1.2
    found = script.robust(shift, nominal.system, samples=16)
    assert found.feasible
    # 9.6 m/s3 before, of the nominal gearbox
    assert found.goal[1] < 4.0
    assert not found.verify(100).broken.any()


def test_help_says_what_it_does_without_doing_it(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.syspath_prepend(str(EXAMPLE))
    script = importlib.import_module("calibrate_shift")
    monkeypatch.setattr("sys.argv", ["calibrate_shift.py", "--help"])
    with pytest.raises(SystemExit) as ended:
        script.main()
    assert ended.value.code == 0
    assert "least jerk" in capsys.readouterr().out
