"""What elements with friction plates have in common: temperature of the law, triggers of faults."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from clutchwork.geometry import Found
from clutchwork.signals.constant import Constant
from clutchwork.signals.step import Step

if TYPE_CHECKING:
    from clutchwork.node import Law, Signal, SignalLike, ThermalNode


def wants_temperature(friction: Any) -> bool:
    """Whether a law depends on a temperature that it is not given."""
    return hasattr(friction, "temperature") and friction.temperature is None


def temperature_problems(friction: Law, node: ThermalNode | None) -> Found:
    """A law that depends on the temperature of a contact that has none."""
    if node is not None or not wants_temperature(friction):
        return []
    remedy = "give the contact a thermal_mass or a node at `heat`, or give friction.temperature"
    return [("friction", "depends on the temperature, and there is none", remedy)]


def trigger(time: float | None) -> Signal | None:
    """A signal that rises to one at a time."""
    if time is None:
        return None
    return Step(height=1.0, start=time) if time > 0.0 else Constant(1.0)


def fault_problems(fault: str, time: float | None, signal: SignalLike | None) -> Found:
    """A fault without a trigger, or a trigger without a fault."""
    given = [name for name, value in (("fault_time", time), ("fault_signal", signal)) if value is not None]
    if fault != "none" and not given:
        return [("fault", f"is {fault} and nothing triggers it", "give fault_time, fault_signal, or both")]
    if fault == "none" and given:
        return [(given[0], "triggers no fault", 'give fault "cannot_transmit" or "cannot_unlock"')]
    return []
