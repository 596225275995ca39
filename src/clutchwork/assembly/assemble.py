"""Model -> System: the arrays that the compiled core reads, over the independent speeds."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from clutchwork.assembly.inputs import Wires
from clutchwork.assembly.meters import meter_arrays
from clutchwork.assembly.places import places
from clutchwork.assembly.records import TYPES, Gearing, frozen
from clutchwork.assembly.shared_states import Shared, flow_arrays, heat_arrays
from clutchwork.assembly.sparse import sparse
from clutchwork.base import ModelError
from clutchwork.declare.core import number
from clutchwork.declare.layout import FIELDS
from clutchwork.declare.node import Component, TabledComposite, is_reference
from clutchwork.declare.rational import ONE, Row, plus, product
from clutchwork.declare.schema import Role, inputs
from clutchwork.declare.wording import path_of
from clutchwork.model.findings import Findings, Structure, findings
from clutchwork.model.kinematics import apart, kinematics
from clutchwork.model.loads import load_arrays
from clutchwork.model.model import Model
from clutchwork.model.parts import StopTravel, is_stop, place_of
from clutchwork.model.pools import Pools
from clutchwork.model.start import Started, initial_angles, speed_at_start, start
from clutchwork.model.structure import Kinematics, Mechanism, follows_load
from clutchwork.model.variable_ratios import ordered, transmissions

Array = NDArray[Any]


def assembled(whole: Model, independent: Sequence[str] = (), found: Findings | None = None) -> dict[str, Any]:
    """The fields of the System of a model without mistakes; ModelError reports those of its structure.

    Parameters: found, what the checks of the model have found, where they were made already.
    """
    found = found or findings(whole)
    if found.structure is None:
        raise ModelError(found.problems)
    parts, model = found.structure.parts, found.structure.mechanism
    made, begun, motions = chosen(found.structure, independent)
    shared = Shared(parts.thermal, tuple(model.role(Role.PROCESS)))
    where = places(parts.thermal, shared.processes, [component for component, _ in model.acting])
    pools, wires, columns = Pools(), Wires(where), SpeedColumns(model, made)
    wires.surround(parts.thermal)
    arrays = _inertia(model, made, columns)
    rates = [made.over(row) for _, row in model.acting] if independent else found.structure.rates
    arrays |= _rates(model, rates, columns, Role.TORQUE, "element")
    arrays |= _rates(model, rates, columns, Role.CONTACT, "contact")
    states = list[float]()
    arrays |= _elements(model, pools, wires, states)
    arrays |= load_arrays(model)
    arrays |= _contacts(model, pools, wires, states)
    arrays |= meter_arrays(model)
    # torques that know the rates of others
    arrays |= {"full": [wires.rates or any(_is_coupled(component) for component, _ in model.acting)]}
    arrays |= _transmissions(model, made, columns)
    arrays |= flow_arrays(model, pools, wires)
    arrays |= heat_arrays(model, where)
    arrays |= shared.arrays(pools, wires, states, partial(speed_at_start, model, made, begun.speeds, motions))
    arrays |= {
        "prescribed_input": wires.prescribe(motions),
        "prescribed_sums": [int(one.integrates) for one, _ in motions],
    }
    arrays |= wires.arrays()
    arrays |= {"params": pools.params, "points": pools.points} | _start(model, made, begun)
    return {
        "name": whole.name,
        "arrays": frozen(_shaped(arrays, model, made)),
        "nodes": model.nodes,
        "elements": tuple(model.role(Role.TORQUE)),
        "contacts": tuple(model.role(Role.CONTACT)),
        "motions": tuple(model.role(Role.MOTION)),
        "gears": tuple(_gears(model)),
        "sensors": tuple(model.role(Role.SENSOR)),
        "thermal": parts.thermal,
        "flows": tuple(model.role(Role.FLOW)),
        "processes": shared.processes,
        "inputs": tuple(wires.inputs),
        "links": tuple(wires.links),
        "gearboxes": tuple(
            table for one in whole.elements if isinstance(one, TabledComposite) and (table := one.shift_table())
        ),
        "sums": parts.sums,
        "independent": tuple(model.nodes[n].name for n in made.independent),
        "places": pools.places,
        "notes": (*made.notes, *begun.notes, *_own_notes(whole.elements)),
        "warnings": tuple(map(str, found.advice)),
    }


def _own_notes(elements: Sequence[Component]) -> Iterator[str]:
    """What elements have to say of themselves."""
    return (f"{path_of(one)}: {note}" for one in elements for note in one.notes())


def chosen(found: Structure, wanted: Sequence[str]) -> tuple[Kinematics, Started, list[Any]]:
    """The structure with the independent speeds that are wanted, else in a good order: its start, motions."""
    model = found.mechanism
    if wanted:
        made, problems = kinematics(model, wanted)
        if made is None:
            raise ModelError(problems)
        order = sorted(made.independent, key=lambda node: wanted.index(model.nodes[node].name))
        made = replace(made, independent=order)
        begun, motions, problems = start(model, made)
        if problems:
            raise ModelError(problems)
        return made, begun, motions
    made = replace(found.kinematics, independent=_arranged(found.rates, found.kinematics))
    order = [found.kinematics.independent.index(node) for node in made.independent]
    speeds, answers, notes = found.begun
    return made, Started([speeds[place] for place in order], [answers[place] for place in order], notes), found.motions


def _arranged(rates: Sequence[Row], made: Kinematics) -> list[int]:
    """The independent speeds so that those that act on each other are close."""
    touching: dict[int, set[int]] = {node: set() for node in made.independent}
    for row in (*made.speeds, *rates):
        together = touching.keys() & row.keys()
        for node in together:
            touching[node] |= together - {node}
    return apart(made.independent, lambda node: sorted(touching[node]))


class SpeedColumns:
    """Places of the independent speeds and of the prescribed ones in the arrays."""

    def __init__(self, model: Mechanism, made: Kinematics) -> None:
        first = len(model.nodes)
        self.speeds = {node: place for place, node in enumerate(made.independent)}
        self.prescribed = {first + number: number for number in range(len(model.role(Role.MOTION)))}

    def split(self, name: str, rows: Sequence[Row]) -> dict[str, Any]:
        """The arrays of a matrix over the independent speeds and of that over the prescribed ones."""
        return sparse(name, rows, self.speeds) | {f"{name}_prescribed": _matrix(rows, self.prescribed)}


def _matrix(rows: Sequence[Row], places: Mapping[int, int]) -> Array:
    made = np.zeros((len(rows), len(places)))
    for place, row in enumerate(rows):
        for column, value in row.items():
            if column in places:
                # the quotient of two whole numbers is rounded once
                made[place, places[column]] = value.numerator / value.denominator
    return made


def _inertia(model: Mechanism, made: Kinematics, columns: SpeedColumns) -> dict[str, Any]:
    """Basis and mass matrix."""
    arrays = columns.split("basis", made.speeds) | mass_arrays(model.inertia, made, columns)
    return arrays | {
        "inertia": [float(inertia) for inertia in model.inertia],
        "massless": [node in made.massless for node in made.independent],
        "initial_angle": initial_angles(model),
    }


def mass_arrays(inertia: Sequence[Fraction], made: Kinematics, columns: SpeedColumns) -> dict[str, Any]:
    """The mass matrix, computed as fractions and rounded once."""
    rows: dict[int, Row] = {node: {} for node in made.independent}
    for own, speed in zip(inertia, made.speeds, strict=True):
        for node in speed.keys() & rows.keys() if own else ():
            rows[node] = plus(rows[node], product(own, speed[node]), speed)
    for node in made.followers.values():
        # what follows from a transmission has no inertia; a unit keeps the matrix regular
        rows[node] = {node: ONE}
    return columns.split("mass", list(rows.values()))


def _rates(model: Mechanism, found: Sequence[Row], columns: SpeedColumns, role: Role, prefix: str) -> dict[str, Any]:
    own = [row for row, (component, _) in zip(found, model.acting, strict=True) if component.role is role]
    return columns.split(f"{prefix}_rate", own) | {
        f"{prefix}_kind": [number(type(component)) for component, _ in model.acting if component.role is role]
    }


def _start(model: Mechanism, made: Kinematics, begun: Started) -> dict[str, Any]:
    """Speeds at the start, and how they answer to prescribed speeds and to transmissions, in the order of those."""
    driven, place = len(model.role(Role.MOTION)), {id(tie.component): n for n, tie in enumerate(transmissions(model))}
    ties = [driven + place[id(tie.component)] for tie, _ in ordered(model, made)]
    return {
        "initial_speed": [float(speed) for speed in begun.speeds],
        "initial_by_prescribed": _matrix(begun.answers, {number: number for number in range(driven)}),
        "initial_by_ratio": _matrix(begun.answers, {number: column for column, number in enumerate(ties)}),
    }


def _is_coupled(component: Any) -> bool:
    """Whether it has several ways, follows a load, or own states that others act on, or that make its heat."""
    if len(type(component).ways) > 1 or follows_load(component) or (component.supply and component.heat_path()):
        return True
    given = (getattr(component, name) for names, _ in inputs(type(component)) for name in names)
    return component.role is Role.TORQUE and bool(component.own_states()) and any(map(is_reference, given))


def _first_ways(model: Mechanism, which: Callable[[Any], bool]) -> list[int]:
    """Numbers of the first directions of some torque elements."""
    found, number = list[int](), 0
    for element in model.role(Role.TORQUE):
        found += [number] if which(element) else []
        number += max(1, len(type(element).ways))
    return found


def _elements(model: Mechanism, pools: Pools, wires: Wires, states: list[float]) -> dict[str, Any]:
    params, offsets, refs, ways = list[int](), list[int](), list[int](), list[int]()
    for element in model.role(Role.TORQUE):
        own = range(max(1, len(type(element).ways)))
        ways += own
        params += [pools.add(element, element.name)] * len(own)
        offsets += [len(states)] * len(own)
        refs += [wires.connect(element)] * len(own)
        states += element.initial_states() if element.states else ()
    return {
        "supply_element": _first_ways(model, lambda element: bool(element.supply)),
        "element_way": ways,
        "element_param": params,
        "element_state": offsets,
        "element_input": refs,
    }


def _transmissions(model: Mechanism, made: Kinematics, columns: SpeedColumns) -> dict[str, Any]:
    ties = list(ordered(model, made))
    ways = [component for component, _ in model.acting]
    return {
        "transmission_element": [next(n for n, way in enumerate(ways) if way is tie.component) for tie, _ in ties],
        "transmission_speed": [-1 if node is None else columns.speeds[node] for _, node in ties],
    }


def _contacts(model: Mechanism, pools: Pools, wires: Wires, states: list[float]) -> dict[str, Any]:
    contacts = model.role(Role.CONTACT)
    places = {part.name: place for place, (part, _) in enumerate(model.acting) if isinstance(part, StopTravel)}
    offsets = list[int]()
    for contact in contacts:
        # bristles start without deflection
        offsets.append(len(states))
        states += [0.0] * len(contact.friction.own_states())
    return {
        "contact_param": [pools.add(contact, contact.name) for contact in contacts],
        "contact_input": [wires.connect(contact) for contact in contacts],
        "contact_law": [number(type(contact.friction)) for contact in contacts],
        "contact_law_param": [pools.add(contact.friction, f"{contact.name}.friction") for contact in contacts],
        "contact_law_input": [wires.connect_law(contact) for contact in contacts],
        "contact_state": offsets,
        # the band of a law widens it
        "contact_tolerance": [max(float(contact.tolerance), float(contact.friction.band)) for contact in contacts],
        "contact_initial": [int(contact.locked) for contact in contacts],
        "contact_place": [places[place_of(contact)] if is_stop(contact) else -1 for contact in contacts],
    }


def _gears(model: Mechanism) -> Iterable[Gearing]:
    for gear, joined, row in model.gear_rows:
        yield Gearing(gear, {port: (model.places.of(joined[port]), float(c)) for port, c in row.items()})


def _shaped(arrays: Mapping[str, Any], model: Mechanism, made: Kinematics) -> dict[str, Array]:
    """The arrays with the type and shape that the layout says."""
    sizes = {"nodes": len(model.nodes), "speeds": len(made.independent), "prescribed": len(model.role(Role.MOTION))}
    sizes |= {"elements": len(arrays["element_kind"]), "contacts": len(arrays["contact_kind"])}
    sizes |= {"transmissions": len(arrays["transmission_element"])}
    shaped = {}
    for name, kind, shape, _ in FIELDS:
        given = arrays[name]
        array = np.array(given, dtype=TYPES[kind])
        lengths = tuple(size if isinstance(size, int) else sizes.get(size, len(given)) for size in shape)
        shaped[name] = array if array.shape == lengths else array.reshape(lengths)
    return shaped
