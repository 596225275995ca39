"""Inputs of all components as the arrays that the compiled core reads."""

from __future__ import annotations

from dataclasses import field
from itertools import accumulate, chain
from typing import TYPE_CHECKING, Any

import numpy as np

from clutchwork.assembly.records import Input, Link
from clutchwork.base import dataclass
from clutchwork.declare.node import Node, Segment, Signal, ThermalNode, is_reference
from clutchwork.declare.ports import ports, thermal_ports
from clutchwork.declare.schema import Role, Spec, inputs, specs
from clutchwork.model.parts import role
from clutchwork.signals.bases import waveform
from clutchwork.signals.constant import Constant

if TYPE_CHECKING:
    from collections.abc import Sequence

    from clutchwork.assembly.places import SharedNumbers
    from clutchwork.declare.node import Component

# what a prescribed motion is in the core
SPEED = Spec("signal", "rad/s", "speed")
# what the temperature of an ambient is, which has no declaration of its own
TEMPERATURE = Spec("signal", "K", "temperature of an ambient", above=0.0)
# what an input may be, in the order of the numbers of its references
SORTS = ("input", "shared", "rate", "heat", "supply", "sum")


@dataclass
class Wires:
    """Signals in the order of their numbers, and what the inputs of components refer to."""

    places: SharedNumbers
    inputs: list[Input] = field(default_factory=list)
    links: list[Link] = field(default_factory=list)
    refs: list[tuple[str, int]] = field(default_factory=list)
    ambients: dict[str, int] = field(default_factory=dict)
    rates: bool = False  # a torque element or a contact reads the speed of a shaft

    def surround(self, thermal: Sequence[ThermalNode]) -> None:
        """Number the temperatures of ambients."""
        for node in thermal:
            if node.capacity is None:
                self.ambients[node.name] = self._add(node, "temperature", "K", node.temperature, TEMPERATURE)

    def connect(self, component: Component) -> int:
        """Number the inputs of a component, those of a flow after the temperatures; the offset of the first one."""
        offset = len(self.refs)
        if role(component) is Role.FLOW:
            self.refs += [self._reference(node) for node in thermal_ports(component).values()]
        elif type(component).gathers:
            self.refs.append(("sum", self.places.processes[component.name]))
        self._connect(component, component, "")
        return offset

    def connect_law(self, contact: Any) -> int:
        """Number the inputs of the friction law of a contact; a temperature not given is that of its thermal node."""
        offset = len(self.refs)
        self._connect(contact.friction, contact, "friction.")
        return offset

    def _connect(self, thing: Any, component: Any, inside: str) -> None:
        for names, spec in inputs(type(thing)):
            name = next((name for name in names if getattr(thing, name) is not None), names[0])
            value = getattr(thing, name)
            if value is None and spec.unit == "K":
                value = _warming(component)
            own, quantity = type(thing).__dataclass_fields__[name].metadata["spec"], f"{inside}{name}"
            unit = _unit(component, own)
            if is_reference(value):
                self.refs.append(self._reference(value))
                self.rates = self.rates or (isinstance(value, Node) and role(component) in (Role.TORQUE, Role.CONTACT))
                self._link(f"{component.name}.{quantity}", unit, *self.refs[-1])
            else:
                plain = spec.otherwise if value is None else value
                number = self._add(component, quantity, unit, plain, own, given=value is not None)
                self.refs.append(("input", number))

    def _reference(self, value: Any) -> tuple[str, int]:
        if isinstance(value, ThermalNode) and value.name in self.ambients:
            return "input", self.ambients[value.name]
        return self.places.of(value)

    def _link(self, name: str, unit: str, sort: str, number: int) -> None:
        if sort in ("input", "shared"):
            self.links.append(Link(name, unit, sort, number))

    def prescribe(self, motions: Sequence[tuple[Component, Signal]]) -> list[int]:
        """Number the prescribed speeds, which no reference leads to."""
        return [self._add(one, "speed", _unit(one, SPEED), signal, _speed(one)) for one, signal in motions]

    def _add(self, owner: Any, quantity: str, unit: str, value: Any, spec: Spec, given: bool = True) -> int:
        name = f"{owner.name}.{quantity}"
        self.inputs.append(Input(name, unit, plain_signal(value), spec, owner, quantity, given))
        return len(self.inputs) - 1

    def arrays(self) -> dict[str, Any]:
        """References and the pieces of all signals, one after another."""
        acting = self.places.ways
        sizes = (len(self.inputs), len(self.places.shared), acting, acting, acting)
        base = dict(zip(SORTS, accumulate(sizes, initial=0), strict=True))
        pieces = [item.signal.segments() for item in self.inputs]
        counts = [len(part) for part in pieces]
        numbers = chain.from_iterable(piece for part in pieces for piece in part)
        flat = np.fromiter(numbers, float).reshape(-1, len(Segment._fields))
        return {
            "input_refs": [base[sort] + number for sort, number in self.refs],
            "input_first": [sum(counts[:k]) for k in range(len(counts))],
            "input_count": counts,
            "input_period": [item.signal.repeats() for item in self.inputs],
            "input_value": [waveform.value(item.signal, 0.0) for item in self.inputs],
            "segment_time": flat[:, 0],
            "segment_coef": flat[:, 1:],
        }


def _warming(component: Component) -> ThermalNode | None:
    """Thermal node of an element, whose temperature its friction law has."""
    path = component.heat_path()
    return path.node if path else None


def plain_signal(value: Any) -> Signal:
    """A signal, or a number as one."""
    return value if isinstance(value, Signal) else Constant(float(value or 0.0))


def _speed(motion: Component) -> Spec:
    """What a prescribed speed may be; that which follows from a position is bounded by nothing."""
    return next((spec for item, spec in specs(type(motion), "signal", "alternative") if item.name == "speed"), SPEED)


def _unit(component: Component, spec: Spec) -> str:
    """Unit of an input; on masses a torque is a force and an angular speed a speed."""
    moving = next((node for node in ports(component).values() if not node.fixed), None)
    translates = moving is not None and moving.domain.value == "translation"
    return {"N m": "N", "rad/s": "m/s"}.get(spec.unit, spec.unit) if translates else spec.unit
