"""Ratios that vary: docs/theory/varying-ratios.md."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from math import isfinite
from typing import Any, TypeAlias

from clutchwork.declare import Found, HeatFlow, Node, Rate, Signal, SupplyPower, ThermalNode
from clutchwork.signals.bases.waveform import value

# coefficients by port
Rates: TypeAlias = Mapping[str, float | Fraction]
# share of the size of a ratio that counts as none
ROUNDING = 1e-12


def at_start(ratio: Any) -> float:
    """Value of an input at the start: of a signal, a number, a process or (process, state)."""
    if isinstance(ratio, Signal):
        return value(ratio, 0.0)
    if isinstance(ratio, int | float):
        return float(ratio)
    process, name = ratio if isinstance(ratio, tuple) else (ratio, "")
    names = [state.name for state in type(process).states]
    return float(process.initial_states()[names.index(name) if name else 0])


def beyond_rounding(ratio: float, size: float) -> float:
    """A ratio that is zero where it is no more than round-off of its size: no speed follows from it."""
    return ratio if abs(ratio) > ROUNDING * size else 0.0


def angle_of(node: Node | None) -> float:
    """Angle of a shaft at the start [rad]."""
    return float(node.angle or 0.0) if node is not None else 0.0


def ratio_problems(ratio: Any) -> Found:
    """A ratio that is not finite, or follows the motion at once, so that its rate of change depends on the torque."""
    if isinstance(ratio, Signal) and not isfinite(at_start(ratio)):
        return [("ratio", f"is {at_start(ratio):g} at the start", "give finite and smaller numbers")]
    if not isinstance(ratio, Node | Rate | HeatFlow | SupplyPower | ThermalNode):
        return []
    remedy = "let it pass a RatioActuator, whose state has a rate of its own"
    return [("ratio", "follows the motion without a lag", remedy)]
