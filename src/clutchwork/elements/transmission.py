"""Gearbox with all its members, gear sets and shift elements."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from functools import cached_property
from numbers import Real
from typing import Any, ClassVar

from clutchwork.base import listed, near, quote
from clutchwork.base.frozen import frozen
from clutchwork.declare import (
    HOUSING,
    Component,
    Entry,
    Found,
    Node,
    Part,
    Role,
    ShiftTable,
    TabledComposite,
    component,
    data,
    elements,
    named,
    param,
    port,
    text,
)
from clutchwork.elements.bases.gear_trains import train
from clutchwork.elements.bases.heating import Heating
from clutchwork.elements.bases.shift_elements import DRAG, KINDS, Ends, entry, load, ratios, usual
from clutchwork.elements.gear import Gear
from clutchwork.gearbox.definition import Definition
from clutchwork.gearbox.motion import speeds
from clutchwork.gearbox.read import ReadGearbox, read
from clutchwork.gearbox.reader import plain

EXAMPLE: Any = {
    "name": "two speeds",
    "input": "ring",
    "output": "carrier",
    "sets": {
        "P1": {"type": "single", "sun": "sun", "ring": "ring", "carrier": "carrier", "teeth_sun": 30, "teeth_ring": 72}
    },
    "elements": {"B": ["sun", "housing"], "C": ["ring", "sun"]},
    "gears": {"1": ["B"], "2": ["C"]},
}


@component(Role.COMPOSITE)
class Transmission(TabledComposite, Heating):
    """A whole gearbox, from its teeth and its shift table: each member a shaft, each set a gear, each element a clutch.

    Use it for automatic gearboxes, hubs and power splits. The gearbox is one of the catalogue, "zf-8hp70", a file, or a
    `cw.Gearbox`. With the name "gearbox" its members are the shafts "gearbox.S12", its sets "gearbox.P1", its shift
    elements "gearbox.A": results, events, `sim.set({"gearbox.A.pressure": 2e5})` and `System.changed({"gearbox.A.gain":
    1e-3})` use these names. The members at input and output are joined rigidly to their shafts.

    `shift` gives elements by their fields, as an element of the driveline has them, without ports: `{"A": {"type":
    "disk_clutch", ...}}`. The others are wet friction elements (coefficients 0.13 and 0.11), freewheels or dog
    clutches, by their kind; at 1 MPa each holds 1.5 times the largest torque that it carries in any gear at the input
    torque `torque`. Pressures are 0; with `gear` those of the elements that are closed in it are 1 MPa, and they start
    locked.

    Equations: docs/theory/gearboxes.md. Source: H. W. Müller, Epicyclic Drive Trains, 1982.
    """

    open: ClassVar[bool] = True

    input: Node = port("shaft that is joined to the input member")
    output: Node = port("shaft that is joined to the output member")
    gearbox: Any = data("one of the catalogue by name, a file, its content or an object", example=frozen(EXAMPLE))
    inertia: float = param("kg m2", "inertia of each member that `inertias` does not name", default=0.01, at_least=0.0)
    inertias: Mapping[str, float] | None = named("kg m2", "inertia by member", at_least=0.0)
    torque: float = param(
        "N m", "most torque at the input, for capacities that are not given", default=400.0, above=0.0
    )
    shift: Mapping[str, Mapping[str, Any]] | None = elements("fields of shift elements by name, without ports")
    drag: Mapping[str, Mapping[str, Any]] | None = elements(
        "fields of an element beside each, the drag of its open plates: a wet_drag where no type is given"
    )
    speeds: Mapping[str, float] | None = named("rad/s", "speed at the start by member, others follow")
    efficiency: float | None = param(
        "1", "efficiency of each set, wheel to wheel; none: what the gearbox says", default=None, above=0.0, at_most=1.0
    )
    efficiencies: Mapping[str, float] | None = named("1", "that efficiency by set", above=0.0, at_most=1.0)
    gear: str | None = text("gear at the start, none: all elements are open", default=None)

    def _accept(self) -> None:
        """Values with units are put into SI, those in the tables too."""
        super()._accept()
        for found in self._entries:
            field, name = found.quantity.split(".", 1)
            table = getattr(self, field) or {}
            if found.made is not None and isinstance(table.get(name), Mapping):
                own = {key: getattr(found.made, key, value) for key, value in table[name].items()}
                vars(self)[field] = frozen({**table, name: own | {k: v for k, v in table[name].items() if k == "type"}})

    @cached_property
    def _read(self) -> ReadGearbox:
        return read(self.gearbox)

    @cached_property
    def _box(self) -> Definition | None:
        """Its gearbox; None if that, or a value that its parts need, has mistakes."""
        tables = (self.inertias, self.speeds, self.shift, self.drag, self.efficiencies)
        numbers = (self.torque, self.efficiency or 1.0, self.inertia, *self._numbers())
        sound = all(table is None or isinstance(table, Mapping) for table in tables)
        sound = sound and all(isinstance(number, Real) for number in numbers)
        return self._read.box if sound and isinstance(self.input, Node) and isinstance(self.output, Node) else None

    def _numbers(self) -> Iterator[Any]:
        for table in (self.inertias, self.speeds, self.efficiencies):
            yield from table.values() if isinstance(table, Mapping) else ()
        for node in (self.input, self.output):
            yield 0.0 if not isinstance(node, Node) or node.speed is None else node.speed

    @cached_property
    def _made(self) -> tuple[Part, ...]:
        return tuple(self._parts())

    def problems(self) -> Found:
        box = self._read.box
        if box is None:
            return [("gearbox", message, remedy) for message, remedy in self._read.problems]
        members, sets = box.members, [one.name for one in box.sets]
        names = [element.name for element in box.elements]
        known = {"inertias": ("member", members), "speeds": ("member", members), "efficiencies": ("set", sets)}
        known |= {"shift": ("shift element", names), "drag": ("shift element", names)}
        found = [
            (f"{quantity}.{name}", f"is not a {what} of {quote(box.name)}{near(name, of)}", f"it has {listed(of)}")
            for quantity, (what, of) in known.items()
            for name in getattr(self, quantity) or {}
            if name not in of
        ]
        if self.gear is not None and self.gear not in box.gears:
            message = f"{quote(self.gear)} is not a gear of {quote(box.name)}{near(self.gear, box.gears)}"
            found.append(("gear", message, f"it has {listed(box.gears)}"))
        return found

    def parts(self) -> Iterable[Part]:
        """Members, gear sets and shift elements, and what joins input and output to their shafts."""
        return self._made

    def _parts(self) -> Iterator[Part]:
        box = self._box
        if box is None:
            return
        nodes = self._nodes(box)
        yield from nodes.values()
        yield Gear(f"{self.name}.input_spline", input=self.input, output=nodes[box.input], ratio=1.0)
        yield Gear(f"{self.name}.output_spline", input=self.output, output=nodes[box.output], ratio=1.0)
        nodes[HOUSING.name] = HOUSING
        for one in box.sets:
            efficiency = (self.efficiencies or {}).get(one.name, self.efficiency or one.efficiency)
            yield from train(f"{self.name}.{one.name}", one, nodes, float(efficiency), self._heat())
        yield from (found.made for found in self.entries() if found.made is not None)

    def _nodes(self, box: Definition) -> dict[str, Node]:
        """The shaft of each member, turning in the gear at the start as the speeds of the ports say."""
        turning, given = {**self._speeds(box), **(self.speeds or {})}, self.inertias or {}
        return {
            member: Node(f"{self.name}.{member}", inertia=given.get(member, self.inertia), speed=turning.get(member))
            for member in box.members
        }

    def _speeds(self, box: Definition) -> dict[str, float]:
        """Speeds of the members in the gear at the start, where one port has a speed and the other follows."""
        ports = ((box.input, self.input.speed), (box.output, self.output.speed))
        known = [(member, speed) for member, speed in ports if speed is not None]
        if not self._in_gear(box) or len(known) != 1:
            return {}
        rows, (member, speed) = speeds(box, box.closed_in(str(self.gear))), known[0]
        column = next(iter(rows[member]), None)
        # what turns freely beside is left to the rest of the driveline
        own = {name: row for name, row in rows.items() if not row.keys() - {column}}
        if column is None or len(rows[member]) > 1:
            return {}
        return {name: float(row.get(column, 0) / rows[member][column]) * speed for name, row in own.items()}

    def _in_gear(self, box: Definition) -> bool:
        return isinstance(self.gear, str) and self.gear in box.gears

    def _heat(self) -> dict[str, Any]:
        return {} if self.heat is None else {"heat": self.heat, "heat_share": self.heat_share}

    def entries(self) -> tuple[Entry, ...]:
        """The elements that `shift` and `drag` describe, and those that nobody describes."""
        return self._entries

    @cached_property
    def _entries(self) -> tuple[Entry, ...]:
        return () if self._box is None else tuple(self._all_entries(self._box))

    def _all_entries(self, box: Definition) -> Iterator[Entry]:
        nodes = {**self._nodes(box), HOUSING.name: HOUSING}
        closed = box.closed_in(str(self.gear)) if self._in_gear(box) else box.always_closed
        shift, drag = self.shift or {}, self.drag or {}
        loads = load(box)
        for element in box.elements:
            name, ends = element.name, Ends(nodes[element.base], nodes[element.follower])
            values = usual(element, loads[name] * self.torque) | self._heat()
            place, own = f"shift.{name}", f"{self.name}.{name}"
            yield entry(place, own, shift.get(name), KINDS[element.kind], ends, values, name in closed)
            if name in drag:
                yield entry(f"drag.{name}", f"{own}.drag", drag[name], DRAG, ends, self._heat(), closed=False)

    def grips(self) -> Iterable[tuple[str, Node, Node]]:
        """The shift elements that are closed in the gear at the start."""
        box = self._box
        if box is None or not self._in_gear(box):
            return
        nodes, closed = {**self._nodes(box), HOUSING.name: HOUSING}, box.closed_in(str(self.gear))
        for element in box.elements:
            if element.name in closed:
                yield f"{self.name}.{element.name}", nodes[element.base], nodes[element.follower]

    @classmethod
    def entry_kinds(cls, values: Mapping[str, Any]) -> Mapping[str, str]:
        """Kind of each element that its tables may describe, where they do not say another."""
        box = read(values.get("gearbox")).box
        if box is None:
            return {}
        own = {f"shift.{element.name}": KINDS[element.kind] for element in box.elements}
        return own | {f"drag.{element.name}": DRAG for element in box.elements}

    def held(self) -> Mapping[str, Part]:
        """Members and shift elements, whose values can be changed like those of the driveline."""
        start = len(self.name) + 1
        named: dict[str, Part] = {part.name[start:]: part for part in self._made if isinstance(part, Node)}
        members = {name: named[name] for name in (self._box.members if self._box else ())}
        return members | {e.made.name[start:]: e.made for e in self._entries if e.made is not None}

    def with_held(self, name: str, values: Mapping[str, Any]) -> Component:
        """Itself with other values of a member or a shift element."""
        new = dict[str, Any]()
        if isinstance(self.held()[name], Node):
            for key, value in values.items():
                table = {"inertia": "inertias", "speed": "speeds"}[key]
                new[table] = {**(getattr(self, table) or {}), name: value}
            return replace(self, **new)
        inner = name.removesuffix(".drag")
        table, key = ("drag", inner) if name != inner and inner in (self.drag or {}) else ("shift", name)
        tables: Mapping[str, Mapping[str, Any]] = getattr(self, table) or {}
        new[table] = {**tables, key: {**tables.get(key, {}), **values}}
        return replace(self, **new)

    def content(self, name: str) -> Mapping[str, Any]:  # noqa: ARG002, there is one
        """The gearbox, as a file holds it."""
        box = self._read.box
        return {} if box is None else plain(box)

    def shift_table(self) -> ShiftTable | None:
        """Gears by the elements that are closed in them."""
        box = self._box
        if box is None:
            return None
        own = {element.name: f"{self.name}.{element.name}" for element in box.elements}
        ways = [e.made.name for e in self._entries if e.made is not None and e.made.one_way]
        gears = {gear: tuple(own[name] for name in box.closed_in(gear)) for gear in box.gears}
        ends = (f"{self.name}.{box.input}", f"{self.name}.{box.output}")
        waiting = tuple(own[element.name] for element in box.elements if element.kind == "synchroniser")
        return ShiftTable(self.name, *ends, tuple(own.values()), tuple(ways), frozen(gears), ratios(box), waiting)
