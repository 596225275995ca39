"""Every friction law inside the six-speed shift: launch in third gear, then the 3-4 shift."""

from __future__ import annotations

import tomllib
import warnings
from functools import cache
from pathlib import Path
from typing import Any

import pytest

import clutchwork as cw
from reference.friction import sets

EXAMPLE = Path(__file__).resolve().parents[2] / "examples/six_speed"
# overall ratio w1/w8 of the fourth gear, from the teeth
FOURTH = 1.83021

# the law that ends where a contact should lock
STALLS = "naive_sign"


@cache
def shift(kind: str) -> Any:
    """The example with one law in all of its contacts."""
    data = tomllib.loads((EXAMPLE / "model.toml").read_text())
    for element in data["element"]:
        if "friction" in element:
            element["friction"] = {"type": kind, **sets.SHIFT[kind]}
    d = cw.Driveline.from_dict(data, folder=EXAMPLE)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", cw.ModelWarning)
        if kind == STALLS:
            warnings.simplefilter("ignore", cw.StoppedEarly)
        return d.simulate(4.0, rtol=1e-6, atol=1e-8)


def end(kind: str, signal: str) -> float:
    return float(shift(kind)[signal][-1])


@pytest.mark.parametrize("kind", [kind for kind in sets.SHIFT if kind != STALLS])
def test_every_law_does_the_shift(kind: str) -> None:
    run = shift(kind)
    assert run.status == "done"
    assert run.time[-1] == 4.0
    # the fourth gear is in: the clutches stand still, or creep with a little of the slip that smooths the law
    assert end(kind, "w1.speed") / end(kind, "w8.speed") == pytest.approx(FOURTH, rel=1e-4)
    assert abs(end(kind, "F4.slip")) < (5e-3 if kind in ("tanh", "regularised_stribeck") else 1e-6)
    assert abs(run.energy.residual) <= 1e-6 * run.energy.turnover


@pytest.mark.parametrize("kind", [kind for kind in sets.SHIFT if kind != STALLS])
def test_speeds_after_the_shift_are_those_of_the_exact_law(kind: str) -> None:
    """The gearbox accelerates for a second after the shift; how friction fell while it slipped counts little."""
    same_curve = "shape" in sets.SHIFT[kind] and "width" not in sets.SHIFT[kind]
    assert end(kind, "w8.speed") == pytest.approx(end("exponential", "w8.speed"), rel=1e-4 if same_curve else 1e-3)


def test_the_naive_law_ends_with_a_diagnosis() -> None:
    """F4 should hold the launch: there the run stops, at once."""
    run = shift(STALLS)
    assert run.status == "chatter"
    assert run.time[-1] < 1.0
