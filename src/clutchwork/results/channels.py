"""Every signal of a System by name: its unit and how it follows from the output rows of the core.

Nothing is computed before it is asked for. A torque is what its element puts on its follower (or shaft); power is
torque times rate, the work done on the driveline. Heat of a contact, a damper, a converter is minus its work, and holds
what the bristles of a friction law store. States of a friction law stand under the name of the contact: "c1.elastic".
Where a part of an element counts as the element, such as the drag of a clutch, its torque, power, work and heat are
added.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from clutchwork.assembly.shared_states import state_scales
from clutchwork.assembly.wiring import HOUSING, Branch, GearRow, Wiring, wiring
from clutchwork.base import UnknownName, dataclass, near, quote
from clutchwork.base.memoize import memoize
from clutchwork.declare.node import Component, Domain, Work
from clutchwork.declare.ports import directions
from clutchwork.declare.wording import where_signals
from clutchwork.model.variable_ratios import is_transmission
from clutchwork.results import heat_channels, reactions
from clutchwork.results.forms import LOCKED as LOCKED
from clutchwork.results.forms import Affine, Dot, Form, Mode, Power, Powers, RowEntry, Slip, Total

if TYPE_CHECKING:
    from clutchwork.assembly.system import System

Array = NDArray[Any]

SPEED = {Domain.ROTATION: "rad/s", Domain.TRANSLATION: "m/s"}
ANGLE = {Domain.ROTATION: "rad", Domain.TRANSLATION: "m"}
ACCELERATION = {Domain.ROTATION: "rad/s2", Domain.TRANSLATION: "m/s2"}
TORQUE = {Domain.ROTATION: "N m", Domain.TRANSLATION: "N"}
PLACE = {Domain.ROTATION: "angle", Domain.TRANSLATION: "position"}
REACTION = {Domain.ROTATION: "housing.torque", Domain.TRANSLATION: "housing.force"}


@dataclass(frozen=True)
class Channel:
    """One signal: its unit and its evaluation on a matrix of output rows."""

    unit: str
    evaluate: Form


def _unknown(name: object, known: Iterable[str]) -> str:
    return f"no signal {quote(name)}{near(name, known, where_signals())}"


class Units(dict[str, str]):
    """Unit of every signal by name; a misspelt name is answered with near ones."""

    def __missing__(self, name: str) -> str:
        raise UnknownName(_unknown(name, self))


class Channels(Mapping[str, Channel]):
    """All signals of a System by name; a misspelt name is answered with near ones."""

    def __init__(self, wiring: Wiring, *, angles: bool = True, work: bool = True) -> None:
        self._wiring = wiring
        self._left_out = _left_out(angles, work, wiring)
        self._channels: dict[str, Channel] = {}
        # heat of a thermal node is a state, no work integral
        known = {f"{node.name}.heat" for node in wiring.thermal}
        for name, channel in self._all():
            if name in known or not name.endswith(tuple(self._left_out)):
                # the torque of a load and the signal that sets its size would have the same name
                self._channels[f"{name}_signal" if name in self._channels else name] = channel

    def __getitem__(self, name: str) -> Channel:
        try:
            return self._channels[name]
        except KeyError:
            raise UnknownName(self.fault(name)) from None

    def __iter__(self) -> Iterator[str]:
        return iter(self._channels)

    def __len__(self) -> int:
        return len(self._channels)

    def __contains__(self, name: object) -> bool:
        return name in self._channels

    def fault(self, name: str) -> str:
        """Why there is no signal of a name."""
        for ending, option in self._left_out.items():
            if isinstance(name, str) and name.endswith(ending):
                return f"{name} was not computed: run with {option}=True"
        return _unknown(name, self._channels)

    def _all(self) -> Iterator[tuple[str, Channel]]:
        yield from self._nodes()
        for branch in self._wiring.elements:
            if not branch.hidden:
                yield from self._element(branch)
            if not branch.number and branch.name != branch.component.name:
                yield from self._whole(branch)
        for index, branch in enumerate(self._wiring.contacts):
            yield from self._contact(branch, index)
        yield from self._rigid()
        for branch in self._wiring.sensors:
            yield from self._sensor(branch)
        yield from self._thermal()
        yield from self._state_sums()
        start = self._start("input")
        for index, (name, unit) in enumerate(self._wiring.inputs):
            if name not in self._wiring.unused:
                yield name, _column(start + index, unit)

    def _start(self, part: str) -> int:
        return int(self._wiring.columns[part].start)

    def _nodes(self) -> Iterator[tuple[str, Channel]]:
        for index, node in enumerate(self._wiring.nodes):
            domain = node.domain
            yield f"{node.name}.speed", _column(self._start("speed") + index, SPEED[domain])
            yield f"{node.name}.{PLACE[domain]}", _column(self._start("angle") + index, ANGLE[domain])
            yield f"{node.name}.acceleration", _column(self._start("acceleration") + index, ACCELERATION[domain])

    def _element(self, branch: Branch) -> Iterator[tuple[str, Channel]]:
        torque, rate = self._total("torque", branch), self._rate(branch)
        yield f"{branch.name}.torque", Channel(TORQUE[branch.domain], torque)
        yield f"{branch.name}.rate", Channel(SPEED[branch.domain], rate)
        yield f"{branch.name}.power", Channel("W", Power(torque, rate))
        work = self._total("work", branch)
        yield f"{branch.name}.work", Channel("J", work)
        if _loses_all(branch.component) and branch.name == branch.component.name:
            yield f"{branch.name}.heat", Channel("J", Total(work.indices, negative=True))
        if branch.component.supply:
            yield from self._supply(branch)
        yield from self._states(branch)

    def _supply(self, branch: Branch) -> Iterator[tuple[str, Channel]]:
        number = [part.name for part in self._wiring.supplies].index(branch.name)
        name = f"{branch.name}.{branch.component.supply}"
        yield f"{name}_power", _column(self._start("supply_power") + number, "W")
        yield f"{name}_energy", _column(self._start("supply_energy") + number, "J")
        # what it draws and does not give its shaft
        drawn = RowEntry(self._start("supply_power") + number)
        given = Total(self._total("torque", branch).indices, negative=True)
        yield f"{branch.name}.loss", Channel("W", Powers((drawn, Power(given, self._rate(branch)))))

    def _whole(self, first: Branch) -> Iterator[tuple[str, Channel]]:
        """Power and work of an element that acts along several ways: the sums of all."""
        name = first.component.name
        ways = [branch for branch in self._wiring.elements if branch.component is first.component]
        acting = [branch for branch in ways if not branch.hidden]
        powers = tuple(Power(self._total("torque", branch), self._rate(branch)) for branch in acting)
        work = Total(tuple(index for branch in acting for index in self._total("work", branch).indices))
        yield f"{name}.power", Channel("W", Powers(powers))
        yield f"{name}.work", Channel("J", work)
        if _loses_all(first.component):
            yield f"{name}.heat", Channel("J", Total(work.indices, negative=True))
        if is_transmission(first.component):
            yield f"{name}.torque", Channel(TORQUE[first.domain], self._total("torque", first))

    def _states(self, branch: Branch) -> Iterator[tuple[str, Channel]]:
        passive = branch.component.passive()
        for number, (name, unit, index) in enumerate(branch.states):
            column = self._start("state") + index
            yield f"{branch.component.name}.{name}", _column(column, unit)
            if number == 0 and passive is not None and passive.stiffness:
                yield (
                    f"{branch.component.name}.twist",
                    Channel(ANGLE[branch.domain], Affine(column, 1.0 / passive.stiffness)),
                )

    def _contact(self, branch: Branch, index: int) -> Iterator[tuple[str, Channel]]:
        mode = self._start("contact_mode") + index
        torque, work = self._total("torque", branch), self._total("work", branch)
        slip = Slip(self._rate(branch), mode)
        yield f"{branch.name}.torque", Channel(TORQUE[branch.domain], torque)
        yield f"{branch.name}.slip", Channel(SPEED[branch.domain], slip)
        yield f"{branch.name}.power", Channel("W", Power(torque, slip))
        yield f"{branch.name}.work", Channel("J", work)
        yield f"{branch.name}.heat", Channel("J", Total(work.indices, negative=True))
        yield f"{branch.name}.mode", Channel("1", Mode(mode))
        yield f"{branch.name}.state", Channel("", Mode(mode, named=True))
        yield f"{branch.name}.capacity", _column(self._start("contact_capacity") + index, TORQUE[branch.domain])
        yield from self._states(branch)

    def _thermal(self) -> Iterator[tuple[str, Channel]]:
        for name, unit, columns in heat_channels.affine(self._wiring):
            yield name, Channel(unit, Affine(*columns))

    def _state_sums(self) -> Iterator[tuple[str, Channel]]:
        """Signals that are weighted sums of states."""
        known = dict(self._state_columns())
        branches = [branch for branch in (*self._wiring.elements, *self._wiring.contacts) if not branch.number]
        owners = (*(branch.component for branch in branches), *(one.component for one in self._wiring.processes))
        for component in (*owners, *self._wiring.composites):
            for one in component.state_sums():
                terms = [(*known[f"{component.name}.{name}"], weight) for name, weight in one.weights.items()]
                yield f"{component.name}.{one.name}", Channel(one.unit, self._sum(terms, one.offset))

    def _sum(self, terms: list[tuple[int, float, float]], offset: float) -> Form:
        if len(terms) == 1:
            ((column, scale, weight),) = terms
            return Affine(column, scale * weight, offset)
        vector = np.zeros(self._wiring.row_size)
        for column, scale, weight in terms:
            vector[column] += scale * weight
        return Dot.of(vector)

    def _state_columns(self) -> Iterator[tuple[str, tuple[int, float]]]:
        """Column and scale of each state by name."""
        first = self._start("state")
        for branch in (*self._wiring.elements, *self._wiring.contacts):
            yield from ((f"{branch.component.name}.{name}", (first + k, 1.0)) for name, _, k in branch.states)
        for process in self._wiring.processes:
            for (name, _, k), scale in zip(process.states, state_scales(process.component), strict=True):
                yield f"{process.name}.{name}", (first + k, float(scale))

    def _total(self, what: str, branch: Branch) -> Total:
        """Torque or work of a branch and of the parts that count as it."""
        names = (branch.name, *self._wiring.sums.get(branch.name, ()))
        acting = map(self._acting.__getitem__, names)
        return Total(tuple(self._start(f"{sort}_{what}") + index for sort, index in acting))

    @cached_property
    def _acting(self) -> dict[str, tuple[str, int]]:
        """Sort and place of each element and contact by name."""
        sorts = (("element", self._wiring.elements), ("contact", self._wiring.contacts))
        return {part.name: (sort, index) for sort, branches in sorts for index, part in enumerate(branches)}

    def _rigid(self) -> Iterator[tuple[str, Channel]]:
        wiring, made = self._wiring, reactions.multipliers(self._wiring)
        yield from _gear_torques(wiring, made)
        for index, branch in enumerate(wiring.motions):
            torque, rate = Dot.of(made[len(wiring.gears) + index]), self._rate(branch)
            yield f"{branch.name}.torque", Channel(TORQUE[branch.domain], torque)
            yield f"{branch.name}.power", Channel("W", Power(torque, rate))
            yield f"{branch.name}.work", _column(self._start("prescribed_work") + index, "J")
        for domain in Domain:
            if domain is Domain.ROTATION or any(node.domain is domain for node in wiring.nodes):
                yield REACTION[domain], Channel(TORQUE[domain], Dot.of(reactions.on_housing(wiring, made, domain)))

    def _sensor(self, branch: Branch) -> Iterator[tuple[str, Channel]]:
        """Motion of the follower against the base."""
        domain = branch.domain
        yield f"{branch.name}.{PLACE[domain]}", Channel(ANGLE[domain], self._along(branch, "angle"))
        yield f"{branch.name}.speed", Channel(SPEED[domain], self._along(branch, "speed"))
        yield f"{branch.name}.acceleration", Channel(ACCELERATION[domain], self._along(branch, "acceleration"))

    def _rate(self, branch: Branch) -> Dot:
        """Rate of a branch."""
        return self._along(branch, "speed")

    def _along(self, branch: Branch, part: str) -> Dot:
        """Speed, angle or acceleration along the direction of a branch."""
        vector = np.zeros(self._wiring.row_size)
        for node, coefficient in branch.direction.items():
            if node != HOUSING:
                vector[self._start(part) + node] += coefficient
        return Dot.of(vector)


@memoize
def channels(system: System, angles: bool = True, work: bool = True) -> Channels:
    """All signals of a System by name, found once; those that are not integrated are left out."""
    return Channels(wiring(system), angles=angles, work=work)


def _loses_all(component: Component) -> bool:
    """Whether all work that an element takes out of the driveline becomes heat."""
    return component.work is Work.LOSS and not component.supply


def _left_out(angles: bool, work: bool, wiring: Wiring) -> dict[str, str]:
    """Endings of the signals that a run did not integrate, with the option that turns them on."""
    endings = {} if angles else {".angle": "angles", ".position": "angles"}
    if work:
        return endings
    drawn = {f".{branch.component.supply}_energy": "work" for branch in wiring.supplies}
    metered = {f"{line.name}.energy": "work" for line in wiring.lines}
    return endings | {".work": "work", ".heat": "work"} | drawn | metered


def _gear_torques(wiring: Wiring, made: Array) -> Iterator[tuple[str, Channel]]:
    """Torque that a gear puts on the member at each port; several rows of one gear add up, and its friction."""
    totals = _mesh_friction(wiring)
    for index, row in enumerate(wiring.gears):
        if row.is_line:
            yield from _line(wiring, row, made[index])
            place = wiring.columns["meter_energy"].start + wiring.lines.index(row)
            yield f"{row.name}.energy", _column(place, "J")
            continue
        for port, (_, coefficient) in row.ports.items():
            name = f"{row.name}.torque_{port}"
            before = totals[name][0] if name in totals else np.zeros(wiring.row_size)
            totals[name] = (before + coefficient * made[index], row.domains[port])
    for name, (vector, domain) in totals.items():
        yield name, Channel(TORQUE[domain], Dot.of(vector))


def _line(wiring: Wiring, row: GearRow, made: Array) -> Iterator[tuple[str, Channel]]:
    """What goes through a rigid line from its base to its follower: torque on the follower, speed, power."""
    node, factor = row.ports["follower"]
    speed = np.zeros(wiring.row_size)
    if node != HOUSING:
        speed[wiring.columns["speed"].start + node] = 1.0
    torque, rate, domain = Dot.of(factor * made), Dot.of(speed), row.domains["follower"]
    yield f"{row.name}.torque", Channel(TORQUE[domain], torque)
    yield f"{row.name}.speed", Channel(SPEED[domain], rate)
    yield f"{row.name}.power", Channel("W", Power(torque, rate))


def _mesh_friction(wiring: Wiring) -> dict[str, tuple[Array, Domain]]:
    """Torque at each port of the contacts that have gear rows, by their friction alone."""
    totals: dict[str, tuple[Array, Domain]] = {}
    geared = {row.name: row for row in wiring.gears}
    for index, branch in enumerate(wiring.contacts):
        if branch.name in geared:
            (way,) = directions(branch.component)
            for port, domain in geared[branch.name].domains.items():
                vector = np.zeros(wiring.row_size)
                vector[wiring.columns["contact_torque"].start + index] = float(way.coefficients.get(port, 0))
                totals[f"{branch.name}.torque_{port}"] = vector, domain
    return totals


def _column(column: int, unit: str) -> Channel:
    return Channel(unit, RowEntry(column))
