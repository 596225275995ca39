"""How a law predicts the torque of measured samples, by the sort of law."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

from clutchwork.fit.running import Running
from clutchwork.fit.sliding import Sliding, Smooth

if TYPE_CHECKING:
    from clutchwork.declare.node import Law
    from clutchwork.fit.measurement import Measurement

Model: TypeAlias = Sliding | Smooth | Running


def model_of(measured: Measurement, law: Law, rest: float | None) -> Model:
    """The model for a law: set-valued, a function of the slip, or with a memory."""
    if law.sticks:
        return Sliding(measured, law, rest)
    return Running(measured, law, rest) if law.own_states() else Smooth(measured, rest)
