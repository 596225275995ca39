"""The eight-speed car: what its example claims, its pictures, some of its faults."""

from __future__ import annotations

import importlib
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

FOLDER = Path(__file__).resolve().parents[2] / "examples" / "eight_speed"


def example() -> ModuleType:
    """The script of the example; it imports what lies beside it."""
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(FOLDER))
        return importlib.import_module("eight_speed")


@pytest.fixture(scope="module")
def driven() -> tuple[Any, Any, Any]:
    """From rest to eighth gear and back."""
    run, control = example().drive()
    return run, control, example().quality(run, control.box)


def test_it_keeps_what_it_claims(driven: tuple[Any, Any, Any]) -> None:
    example().check(*driven)


def test_its_pictures_are_drawn(driven: tuple[Any, Any, Any], tmp_path: Path) -> None:
    run, control, found = driven
    example().pictures(run, control.box, found, tmp_path)
    assert {path.name for path in tmp_path.iterdir()} == {"drive.png", "jerk.png", "shift_2_3.png", "shifts.png"}


def test_what_faults_do(tmp_path: Path) -> None:
    """Fifth gear: without an element there is no drive, and with one more the car is braked."""
    table = example().faults(("5",))
    verdicts = {(one.fault.element, one.fault.fault): one.verdict for one in table}
    assert verdicts == {
        ("A", "stuck closed"): "decelerates",
        ("B", "missing"): "drive lost",
        ("C", "missing"): "drive lost",
        ("D", "missing"): "drive lost",
        ("E", "stuck closed"): "decelerates",
    }
    # four elements hold fourth gear too, and there the car ends
    assert {one.ends_in for one in table if one.fault.element == "E"} == {"4"}
    table.to_csv(tmp_path / "faults.csv")
    assert len((tmp_path / "faults.csv").read_text().splitlines()) == 1 + len(table)
