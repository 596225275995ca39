"""Signals of all components as the arrays that the compiled core reads."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from clutchwork import waveform
from clutchwork.checks import ports
from clutchwork.node import Signal
from clutchwork.schema import inputs
from clutchwork.signals.constant import Constant
from clutchwork.system import Input

if TYPE_CHECKING:
    from collections.abc import Sequence

    from clutchwork.node import Component


@dataclass
class Wires:
    """Signals in the order of their numbers, and the references to them."""

    inputs: list[Input] = field(default_factory=list)
    refs: list[int] = field(default_factory=list)

    def connect(self, component: Component) -> int:
        """Number the inputs of a component; the offset of its first reference."""
        offset = len(self.refs)
        for names, spec in inputs(type(component)):
            name = next((name for name in names if getattr(component, name) is not None), names[0])
            value = getattr(component, name)
            plain = spec.otherwise if value is None else value
            signal = value if isinstance(value, Signal) else Constant(float(plain or 0.0))
            self.refs.append(self._add(component, name, signal))
        return offset

    def prescribe(self, motions: Sequence[tuple[Component, Signal]]) -> list[int]:
        """Number the prescribed speeds, which no reference leads to."""
        return [self._add(motion, "speed", signal) for motion, signal in motions]

    def _add(self, component: Component, name: str, signal: Signal) -> int:
        self.inputs.append(Input(f"{component.name}.{name}", _unit(component, name), signal))
        return len(self.inputs) - 1

    def arrays(self) -> dict[str, Any]:
        """Pieces of all signals, one after another."""
        pieces = [item.signal.segments() for item in self.inputs]
        counts = [len(part) for part in pieces]
        flat = [piece for part in pieces for piece in part]
        return {
            "input_refs": self.refs,
            "input_first": [sum(counts[:k]) for k in range(len(counts))],
            "input_count": counts,
            "input_period": [item.signal.repeats() for item in self.inputs],
            "input_value": [waveform.value(item.signal, 0.0) for item in self.inputs],
            "segment_time": [piece.start for piece in flat],
            "segment_coef": [piece[1:] for piece in flat],
        }


def _unit(component: Component, name: str) -> str:
    """Unit of an input; on masses a torque is a force and an angular speed a speed."""
    spec = type(component).__dataclass_fields__[name].metadata["spec"]
    moving = next((node for node in ports(component).values() if not node.fixed), None)
    translates = moving is not None and moving.domain.value == "translation"
    return {"N m": "N", "rad/s": "m/s"}.get(spec.unit, spec.unit) if translates else str(spec.unit)
