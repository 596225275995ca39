"""Driveline -> System: the arrays that the compiled core reads, over the independent speeds."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any

import numpy as np
from numpy.typing import NDArray

from clutchwork import waveform
from clutchwork.checks import label, ports
from clutchwork.errors import ModelError, Problem
from clutchwork.kinematics import apart, kinematics
from clutchwork.layout import FIELDS
from clutchwork.node import Component, Node, Segment, Signal
from clutchwork.pools import Pools
from clutchwork.rational import Row, plus
from clutchwork.schema import Role, inputs, kinds
from clutchwork.signals.constant import Constant
from clutchwork.start import initial_speeds
from clutchwork.structure import Kinematics, Model
from clutchwork.system import TYPES, Gearing, Input, System, frozen

Array = NDArray[Any]


@dataclass(frozen=True)
class Filtered(Signal):
    """A signal that has passed a low pass."""

    pieces: tuple[Segment, ...]

    def segments(self) -> tuple[Segment, ...]:
        """Exact pieces of the response."""
        return self.pieces


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
            self.refs.append(len(self.inputs))
            self.inputs.append(Input(f"{component.name}.{name}", _unit(component, name), signal))
        return offset


def _unit(component: Component, name: str) -> str:
    """Unit of an input; on masses a torque is a force and an angular speed a speed."""
    spec = type(component).__dataclass_fields__[name].metadata["spec"]
    moving = next((node for node in ports(component).values() if not node.fixed), None)
    translates = moving is not None and moving.domain.value == "translation"
    return {"N m": "N", "rad/s": "m/s"}.get(spec.unit, spec.unit) if translates else str(spec.unit)


def structure_problems(
    nodes: Sequence[Node], components: Sequence[Component], incomplete: Iterable[str] = ()
) -> list[Problem]:
    """What is wrong with the structure of a driveline whose single elements are right."""
    model = Model(tuple(nodes), tuple(components))
    if not nodes:
        return [Problem("driveline", "", "has no shaft", remedy='add one: d.shaft("engine", inertia=0.2)')]
    made, problems = kinematics(model, incomplete=frozenset(incomplete))
    if made is not None:
        _, problems = _start(model, made)
    return problems


def assemble(
    name: str,
    nodes: Sequence[Node],
    components: Sequence[Component],
    independent: Sequence[str] = (),
    source: Mapping[str, Any] | None = None,
) -> System:
    """The System of a driveline without mistakes; ModelError tells those of its structure."""
    model = Model(tuple(nodes), tuple(components))
    made, problems = kinematics(model, independent)
    if made is None:
        raise ModelError(problems)
    _arrange(model, made, independent)
    (speeds, motions), problems = _start(model, made)
    if problems:
        raise ModelError(problems)
    pools, wires, columns = Pools(), Wires(), Columns(model, made)
    arrays = _inertia(model, made, columns)
    arrays |= _rates(model, made, columns, Role.TORQUE, "element")
    arrays |= _rates(model, made, columns, Role.CONTACT, "contact")
    arrays |= _elements(model, pools, wires)
    arrays |= _contacts(model, pools, wires)
    arrays |= _motions(motions, wires)
    arrays |= _signals(wires)
    arrays |= {"params": pools.params, "points": pools.points, "initial_speed": [float(speed) for speed in speeds]}
    return System(
        name=name,
        arrays=frozen(_shaped(arrays, model, made)),
        nodes=model.nodes,
        elements=tuple(model.role(Role.TORQUE)),
        contacts=tuple(model.role(Role.CONTACT)),
        motions=tuple(model.role(Role.MOTION)),
        gears=tuple(_gears(model)),
        inputs=tuple(wires.inputs),
        independent=tuple(model.nodes[n].name for n in made.independent),
        parameters=pools.places,
        notes=tuple(made.notes),
        model=source or {},
    )


def _start(
    model: Model, made: Kinematics
) -> tuple[tuple[list[Fraction], list[tuple[Component, Signal]]], list[Problem]]:
    """Independent speeds at the start, and the prescribed speeds with what drives them."""
    motions, problems = list[tuple[Component, Signal]](), list[Problem]()
    for motion in model.role(Role.MOTION):
        signal = motion.speed if isinstance(motion.speed, Signal) else Constant(float(motion.speed))
        if motion.cutoff is not None:
            try:
                signal = Filtered(waveform.low_pass(signal, motion.cutoff))
            except ValueError as error:
                remedy = "leave cutoff out, or give the speed as a table"
                problems.append(Problem(label(motion), "cutoff", str(error), f"{motion.cutoff:g} Hz", remedy))
        motions.append((motion, signal))
    speeds, wrong = initial_speeds(model, made, [waveform.value(signal, 0.0) for _, signal in motions])
    return (speeds, motions), problems + wrong


def _arrange(model: Model, made: Kinematics, wanted: Sequence[str]) -> None:
    """Order the independent speeds: as wanted, else so that those that act on each other are close."""
    if wanted:
        made.independent.sort(key=lambda node: wanted.index(model.nodes[node].name))
        return
    touching: dict[int, set[int]] = {node: set() for node in made.independent}
    for row in (*made.speeds, *(made.over(row) for _, row in model.acting)):
        together = touching.keys() & row.keys()
        for node in together:
            touching[node] |= together - {node}
    made.independent[:] = apart(made.independent, lambda node: sorted(touching[node]))


class Columns:
    """Places of the independent speeds and of the prescribed ones in the arrays."""

    def __init__(self, model: Model, made: Kinematics) -> None:
        first = len(model.nodes)
        self.speeds = {node: place for place, node in enumerate(made.independent)}
        self.prescribed = {first + number: number for number in range(len(model.role(Role.MOTION)))}

    def split(self, rows: Sequence[Row]) -> tuple[Array, Array]:
        """Rows over the independent speeds and over the prescribed ones."""
        return _matrix(rows, self.speeds), _matrix(rows, self.prescribed)


def _matrix(rows: Sequence[Row], places: Mapping[int, int]) -> Array:
    made = np.zeros((len(rows), len(places)))
    for number, row in enumerate(rows):
        for column, value in row.items():
            if column in places:
                made[number, places[column]] = float(value)
    return made


def _inertia(model: Model, made: Kinematics, columns: Columns) -> dict[str, Any]:
    """Basis and mass matrix, computed as fractions and rounded once."""
    basis, basis_prescribed = columns.split(made.speeds)
    rows: dict[int, Row] = {node: {} for node in made.independent}
    for inertia, speed in zip(model.inertia, made.speeds, strict=True):
        for node in speed.keys() & rows.keys() if inertia else ():
            rows[node] = plus(rows[node], inertia * speed[node], speed)
    mass, mass_prescribed = columns.split(list(rows.values()))
    return {
        "basis": basis,
        "basis_prescribed": basis_prescribed,
        "inertia": [float(inertia) for inertia in model.inertia],
        "mass": mass,
        "mass_prescribed": mass_prescribed,
        "massless": [node in made.massless for node in made.independent],
        "initial_angle": [node.angle for node in model.nodes],
    }


def _rates(model: Model, made: Kinematics, columns: Columns, role: Role, prefix: str) -> dict[str, Any]:
    rates, prescribed = columns.split([made.over(row) for c, row in model.acting if c.role is role])
    return {
        f"{prefix}_rate": rates,
        f"{prefix}_rate_prescribed": prescribed,
        f"{prefix}_kind": [kinds(role).index(component.kind) for component in model.role(role)],
    }


def _elements(model: Model, pools: Pools, wires: Wires) -> dict[str, Any]:
    params, offsets, refs, states = list[int](), list[int](), list[int](), list[float]()
    for element in model.role(Role.TORQUE):
        params.append(pools.add(element, element.name))
        offsets.append(len(states))
        refs.append(wires.connect(element))
        states += element.initial_states() if element.states else ()
    return {
        "element_param": params,
        "element_state": offsets,
        "element_input": refs,
        "initial_state": states,
    }


def _contacts(model: Model, pools: Pools, wires: Wires) -> dict[str, Any]:
    contacts = model.role(Role.CONTACT)
    laws = kinds(Role.LAW)
    return {
        "contact_param": [pools.add(contact, contact.name) for contact in contacts],
        "contact_input": [wires.connect(contact) for contact in contacts],
        "contact_law": [laws.index(contact.friction.kind) for contact in contacts],
        "contact_law_param": [pools.add(contact.friction, f"{contact.name}.friction") for contact in contacts],
        "contact_state": [0] * len(contacts),
        "contact_tolerance": [float(contact.tolerance) for contact in contacts],
        "contact_initial": [int(contact.locked) for contact in contacts],
    }


def _motions(motions: Sequence[tuple[Component, Signal]], wires: Wires) -> dict[str, Any]:
    first = len(wires.inputs)
    for motion, signal in motions:
        wires.inputs.append(Input(f"{motion.name}.speed", _unit(motion, "speed"), signal))
    return {"prescribed_input": list(range(first, len(wires.inputs)))}


def _signals(wires: Wires) -> dict[str, Any]:
    """Pieces of all signals, one after another."""
    pieces = [item.signal.segments() for item in wires.inputs]
    counts = [len(part) for part in pieces]
    flat = [piece for part in pieces for piece in part]
    return {
        "input_refs": wires.refs,
        "input_first": [sum(counts[:k]) for k in range(len(counts))],
        "input_count": counts,
        "input_period": [item.signal.repeats() for item in wires.inputs],
        "input_value": [waveform.value(item.signal, 0.0) for item in wires.inputs],
        "segment_time": [piece.start for piece in flat],
        "segment_coef": [piece[1:] for piece in flat],
    }


def _gears(model: Model) -> Iterable[Gearing]:
    for gear in model.role(Role.GEAR):
        joined = ports(gear)
        for row in gear.rows():
            yield Gearing(gear, {port: (model.index.get(id(joined[port]), -1), float(c)) for port, c in row.items()})


def _shaped(arrays: Mapping[str, Any], model: Model, made: Kinematics) -> dict[str, Array]:
    """The arrays with the type and shape that the layout says."""
    sizes = {"nodes": len(model.nodes), "speeds": len(made.independent), "prescribed": len(model.role(Role.MOTION))}
    shaped = {}
    for name, kind, shape, _ in FIELDS:
        lengths = [size if isinstance(size, int) else sizes.get(size, len(arrays[name])) for size in shape]
        shaped[name] = np.array(arrays[name], dtype=TYPES[kind]).reshape(lengths)
    return shaped
