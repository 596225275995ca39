"""The whole car: what its example claims, faster than the car; the cycle of 20 minutes is driven and in balance."""

from __future__ import annotations

import importlib
from pathlib import Path
from types import ModuleType

import pytest

import clutchwork as cw

FOLDER = Path(__file__).resolve().parents[2] / "examples" / "car"


def example(script: str) -> ModuleType:
    """A script of the example; it imports what lies beside it."""
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(FOLDER))
        return importlib.import_module(script)


@pytest.fixture(scope="module")
def driven() -> tuple[cw.Trajectory, object]:
    """Launch, upshifts and coast-down."""
    return example("whole_car").drive()


def test_it_keeps_what_it_claims(driven) -> None:
    example("whole_car").check(*driven)


def test_its_pictures_are_drawn(driven, tmp_path) -> None:
    example("whole_car").pictures(*driven, tmp_path)
    names = {"drive.png", "shift.png", "sankey_launch.svg", "sankey_shift.svg", "sankey_coast.svg"}
    assert {path.name for path in tmp_path.iterdir()} == names


def test_in_a_coast_the_engine_is_driven(driven) -> None:
    run, box = driven
    begin, end = example("whole_car").phases(box)["coast"]
    losses = run.losses(begin, end)
    assert losses["combustion"].outside < 0.0
    assert losses["car"].stored < 0.0
    assert losses["lock_up"].heat < 1e-3 * losses["lock_up"].taken


def test_a_part_of_the_cycle() -> None:
    """The whole of it is for the program; 130 s have all gears of a town, two stops and two starts."""
    cycle = example("cycle")
    run = cycle.drive(130.0, rtol=1e-6, dt=0.1)
    cycle.check(run)
