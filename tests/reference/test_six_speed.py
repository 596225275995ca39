"""The six-speed gearbox against an independent solver: launch in third gear, then the 3-4 shift."""

from __future__ import annotations

import json
from functools import cache
from typing import Any

import numpy as np
import pytest

from support import cases, six_speed

FOLDER = cases.folder("six_speed")


@cache
def data() -> tuple[dict[str, Any], np.ndarray, dict[str, np.ndarray]]:
    case = json.loads((FOLDER / "case.json").read_text())
    return case, *cases.table(FOLDER / "reference.csv")


@cache
def run() -> Any:
    case, times, _ = data()
    d = six_speed.gearbox(case["pressures_Pa"], case["initial_speeds_rad_s"])
    # two orders tighter than the comparison
    return d.simulate(case["t_end_s"], times=times, rtol=1e-9, atol=1e-11)


def test_the_four_events() -> None:
    case = data()[0]
    expected = [(e["t"], clutch, *change) for e in case["events"] for clutch, change in e["changes"].items()]
    ours = [(e.time, e.element, e.before, e.after) for e in run().events if "open" not in (e.before, e.after)]
    assert [e[1:] for e in ours] == [tuple(e[1:]) for e in expected]
    for mine, theirs in zip(ours, expected, strict=True):
        # 1e-6 s: asked for; the reference is good to about 1e-8 s
        assert mine[0] == pytest.approx(theirs[0], abs=1e-6)


COLUMNS = {
    **{f"w{i}": f"w{i}.speed" for i in range(1, 9)},
    **{f"T_{c}": f"{c}.torque" for c in ("F1", "F2", "F4")},
    "M_shaft": "shaft.torque",
}


@pytest.mark.parametrize("column", COLUMNS)
def test_signal(column: str) -> None:
    case, times, columns = data()
    result, reference = run(), columns[column]
    assert np.array_equal(result.time, times)
    error = np.abs(result[COLUMNS[column]] - reference)
    # torques jump at events: rows within 1e-6 s of one may lie on either side
    if column.startswith(("T_", "M_")):
        near = np.min(np.abs(times[:, None] - np.array([e["t"] for e in case["events"]])), axis=1) < 1e-6
        error = np.where(near, 0.0, error)
    # 1e-5 of full scale: asked for. w5 is held by F4 all the time: there the reference is round-off of 100 rad/s
    assert np.max(error) <= 1e-5 * max(np.max(np.abs(reference)), 1e-6)


def test_the_held_member_does_not_move() -> None:
    assert set(run()["F4.state"]) == {"locked"}
    assert np.max(np.abs(run()["F4.slip"])) == 0.0
