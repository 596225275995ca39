"""Triggers of faults of elements with friction plates."""

from __future__ import annotations

from clutchwork.declare import Signal, SignalLike
from clutchwork.elements.bases.geometry import Found
from clutchwork.signals.constant import Constant
from clutchwork.signals.step import Step


def trigger(time: float | None) -> Signal | None:
    """A signal that rises to one at a time."""
    if time is None:
        return None
    return Step(height=1.0, start=time) if time > 0.0 else Constant(1.0)


def fault_problems(fault: str, time: float | None, signal: SignalLike | None) -> Found:
    """A fault without a trigger, or a trigger without a fault."""
    given = [name for name, value in (("fault_time", time), ("fault_signal", signal)) if value is not None]
    if fault != "none" and not given:
        return [("fault", f"is {fault}, but nothing triggers it", "give fault_time, fault_signal, or both")]
    if fault == "none" and given:
        return [(given[0], "triggers no fault", 'give fault "cannot_transmit" or "cannot_unlock"')]
    return []
