"""Coupled simulators: the error against one model falls with the step, and the page tells what comes out."""

from __future__ import annotations

import importlib
from pathlib import Path
from types import ModuleType

import pytest

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"


@pytest.fixture
def script(monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    """The script as a module; it imports what lies beside another example."""
    pytest.importorskip("matplotlib").use("agg")
    for folder in ("car_launch", "cosimulation"):
        monkeypatch.syspath_prepend(str(EXAMPLES / folder))
    return importlib.import_module("cosimulation")


def test_the_error_falls_with_the_step(script: ModuleType, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    script.main(tmp_path)
    told = capsys.readouterr().out.splitlines()
    page = (EXAMPLES / "cosimulation" / "README.md").read_text(encoding="utf-8")
    table = [line for line in told if "ms" in line or "one model" in line]
    assert len(table) == len(script.STEPS) + 1
    assert all(line in page for line in table)
    assert (tmp_path / "cosimulation.png").stat().st_size > 10_000


def test_the_halves_keep_their_own_energy(script: ModuleType) -> None:
    """What crosses the cut is work of the sources on both sides; the balance of each half closes."""
    front, back = script.halves()
    for _ in range(100):
        torque, speed = back["half_shafts.torque"], front["flange.speed"]
        front["reaction.torque"], back["given.speed"] = -torque, speed
        front.advance(4e-3)
        back.advance(4e-3)
    for sim in (front, back):
        energy = sim.run.energy
        assert abs(energy.residual) < 1e-6 * energy.turnover
    given, taken = back.run.energy.sources["given"], front.run.energy.sources["reaction"]
    # what is held over a step is not the same on both sides, but for the error of the coupling
    assert given == pytest.approx(-taken, rel=0.1)
