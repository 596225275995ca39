"""The eight-speed car: what its example claims, its pictures, some of its faults."""

from __future__ import annotations

import importlib
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
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


def test_what_its_shifts_were_like_by_formulas_of_their_own(driven: tuple[Any, Any, Any]) -> None:
    """Torque holes with filling and ringing, jerk from speeds: docs/theory/shifts.md (9), docs/theory/jerk.md (1)."""
    run, _, found = driven
    ends = [0.0, *(one.shift.end for one in found)]
    begins = [*(one.shift.begin for one in found[1:]), float(run.time[-1])]
    for one, before, behind in zip(found, ends, begins, strict=False):
        first, last = max(one.shift.begin - 0.4, before), min(one.shift.end + 0.5, behind)
        time = np.linspace(first, last, 4001)
        part = run.at(time)
        torque = part["half_shafts.torque"]
        levels = [
            np.mean(torque[inside]) if np.any(inside) else torque[end]
            for inside, end in ((time < one.shift.begin - 0.2, 0), (time > max(one.shift.end, last - 0.2), -1))
        ]
        sign = 1.0 if levels[0] >= 0.0 else -1.0
        least = np.min(sign * torque[time >= one.shift.begin - 0.2])
        hole = max(0.0, min(sign * levels[0], sign * levels[1]) - least)
        assert one.torque_hole == pytest.approx(hole, rel=0.02, abs=3.0)
        at = time[(time > first + 0.05) & (time < last - 0.05)]
        speeds = [run.at(at + shift)["car.speed"] for shift in (-0.05, 0.0, 0.05)]
        jerk = np.abs(speeds[0] - 2.0 * speeds[1] + speeds[2]) / 0.05**2
        assert one.peak_jerk >= np.max(jerk) * 0.98
        assert one.peak_jerk <= np.max(jerk) * 1.5
    holes = {f"{one.shift.before}-{one.shift.after}": one.torque_hole for one in found}
    # what a driver feels at the half shafts as the clutch that closes takes hold and the shafts ring
    assert all(150.0 < holes[name] < 300.0 for name in ("1-2", "2-3", "3-4", "4-5"))


def test_what_faults_do(tmp_path: Path) -> None:
    """Fifth gear: without an element there is no drive, and with one more the car is braked."""
    table = example().faults(("5",))
    verdicts = {(one.fault.element, one.fault.fault): one.verdict for one in table}
    assert verdicts == {
        ("A", "stuck closed"): "locks the output",
        ("B", "missing"): "drive lost",
        ("C", "missing"): "drive lost",
        ("D", "missing"): "drive lost",
        ("E", "stuck closed"): "decelerates",
    }
    # four elements hold fourth gear too, and there the car ends
    assert {one.ends_in for one in table if one.fault.element == "E"} == {"4"}
    table.to_csv(tmp_path / "faults.csv")
    assert len((tmp_path / "faults.csv").read_text().splitlines()) == 1 + len(table)
