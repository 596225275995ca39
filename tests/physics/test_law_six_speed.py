"""Every friction law inside the six-speed shift: launch in third gear, then the 3-4 shift."""

from __future__ import annotations

import tomllib
import warnings
from functools import cache
from pathlib import Path
from typing import Any

import pytest

import clutchwork as cw
from support import samples

EXAMPLE = Path(__file__).resolve().parents[2] / "examples/six_speed"
# overall ratio w1/w8 of the fourth gear, from the teeth
FOURTH = 1.83021

# the coefficient of the example without its step at rest: 0.065 + 0.075 exp(-slip/12.56)
CURVE: dict[str, Any] = {"static": 0.14, "kinetic": 0.065, "speed": 12.555180016171073, "shape": "tustin"}
# deflection at break-away 1e-4 rad
BRISTLE = CURVE | {"stiffness": 1400.0, "damping": 0.05}
ELEMENTS = [[2e-5, 0.1], [5e-5, 0.2], [1e-4, 0.3], [2e-4, 0.4]]
FRICTION: dict[str, dict[str, Any]] = {
    "exponential": {"static": 0.16, "slow": 0.14, "fast": 0.065, "speed": CURVE["speed"]},
    "stribeck": CURVE,
    "karnopp": CURVE | {"band": 0.05},
    "regularised_stribeck": CURVE | {"width": 0.05},
    "naive_sign": CURVE,
    "lugre": BRISTLE,
    "elastoplastic": BRISTLE | {"elastic": 3e-5},
    "leuven": CURVE | {"elements": ELEMENTS, "order": 20.0},
    "gms": CURVE | {"elements": ELEMENTS},
    "mykhalevych": {"static": 0.14, "kinetic": 0.065, "elastic": 1e-4, "speed": CURVE["speed"], "viscous": 1.0},
    "coefficient_table": {"static": 0.14, "kinetic": [[0.0, 0.14], [12.0, 0.0938], [40.0, 0.0681], [400.0, 0.065]]},
    # no fall: the mean of the others
    "coulomb": {"static": 0.14, "kinetic": 0.1},
    "tanh": {"kinetic": 0.1, "speed": 0.1},
    "dahl": {"kinetic": 0.1, "stiffness": 1400.0},
}
# the law that ends where a contact should lock
STALLS = "naive_sign"


@cache
def shift(kind: str) -> Any:
    """The example with one law in all of its contacts."""
    data = tomllib.loads((EXAMPLE / "model.toml").read_text())
    for element in data["element"]:
        if "friction" in element:
            element["friction"] = {"type": kind, **FRICTION[kind]}
    d = cw.Driveline.from_dict(data, folder=EXAMPLE)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", cw.ModelWarning)
        if kind == STALLS:
            warnings.simplefilter("ignore", cw.StoppedEarly)
        return d.simulate(4.0, rtol=1e-6, atol=1e-8)


def end(kind: str, signal: str) -> float:
    return float(shift(kind)[signal][-1])


def test_every_law_is_here() -> None:
    assert FRICTION.keys() == samples.over_slip().keys()


@pytest.mark.parametrize("kind", [kind for kind in FRICTION if kind != STALLS])
def test_every_law_does_the_shift(kind: str) -> None:
    run = shift(kind)
    assert run.status == "done"
    assert run.time[-1] == 4.0
    # the fourth gear is in: the clutches stand still, or creep with a little of the slip that smooths the law
    assert end(kind, "w1.speed") / end(kind, "w8.speed") == pytest.approx(FOURTH, rel=1e-4)
    assert abs(end(kind, "F4.slip")) < (5e-3 if kind in ("tanh", "regularised_stribeck") else 1e-6)
    assert abs(run.energy.residual) <= 1e-6 * run.energy.turnover


@pytest.mark.parametrize("kind", [kind for kind in FRICTION if kind != STALLS])
def test_speeds_after_the_shift_are_those_of_the_exact_law(kind: str) -> None:
    """The gearbox accelerates for a second after the shift; how friction fell while it slipped counts little."""
    same_curve = "shape" in FRICTION[kind] and "width" not in FRICTION[kind]
    assert end(kind, "w8.speed") == pytest.approx(end("exponential", "w8.speed"), rel=1e-4 if same_curve else 1e-3)


def test_the_naive_law_ends_with_a_diagnosis() -> None:
    """F4 should hold the launch: there the run stops, at once."""
    run = shift(STALLS)
    assert run.status == "chatter"
    assert run.time[-1] < 1.0
