"""Torques that keep a gear in balance, with mesh losses or without them. docs/theory/gearboxes.md (4) to (8)."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from math import sqrt
from typing import TYPE_CHECKING, NamedTuple

from clutchwork.base import dataclass
from clutchwork.declare.rational import Echelon, Row, eliminate, exact
from clutchwork.gearbox.gear_set import HOUSING, GearSet

if TYPE_CHECKING:
    from clutchwork.gearbox.definition import Definition

# what the torque of each wheel of a set counts for at its planets
Factors = Mapping[str, tuple[Fraction, ...]]
ONE, ZERO = Fraction(1), Fraction(0)
# beyond as many tries no pattern of driving wheels agrees with itself
MOST_TRIES = 64
# column of the torque of the input, 1, which is no unknown
GIVEN = -1


@dataclass(frozen=True)
class Balance:
    """Torques per torque 1 at the input; what closed elements share in more than one way is None.

    wheels: torque on the member at each port, by set and port; elements: torque on the follower of each closed element;
    load: torque on the output member from outside.
    """

    sets: Mapping[str, Mapping[str, Fraction | None]]
    elements: Mapping[str, Fraction | None]
    load: Fraction | None


class UnknownTorque(NamedTuple):
    """A torque that is looked for: at a wheel of a set, of an element, of a machine, or of the load."""

    owner: str
    port: str


LOAD = UnknownTorque("", "load")


def ideal_balance(box: Definition, closed: tuple[str, ...]) -> Balance:
    """Torques of a gear without losses."""
    return _solve(box, closed, no_losses(box))


def no_losses(box: Definition) -> Factors:
    """Meshes that lose nothing."""
    return {one.name: (ONE,) * len(one.wheels) for one in box.sets}


def lossy_balance(box: Definition, closed: tuple[str, ...], speeds: Mapping[str, Fraction]) -> Balance | None:
    """Torques of a gear whose members turn with given speeds, mesh losses counted; None: it cannot run with them.

    A mesh takes less out of the planets than it puts in, or the other way: which it is follows from the torques
    themselves, so patterns are tried until one agrees with itself.
    """
    factors = no_losses(box)
    for _ in range(MOST_TRIES):
        made = _solve(box, closed, factors)
        found = {one.name: _factors(one, made, speeds) for one in box.sets}
        if found == factors:
            return made
        factors = found
    return None


def _factors(one: GearSet, made: Balance, speeds: Mapping[str, Fraction]) -> tuple[Fraction, ...]:
    """What the torque of each wheel counts for at the planets: equation (7)."""
    # each of two meshes has the same share in the losses from wheel to wheel
    mesh = exact(sqrt(one.efficiency)) if one.efficiency != 1.0 else ONE
    found = []
    for wheel, size in zip(one.shape.wheels, one.speeds_of_planets(), strict=True):
        member = one.members[wheel.port]
        slip = speeds.get(member, ZERO) - speeds.get(one.carrier, ZERO)
        power = (made.sets[one.name][wheel.port] or ZERO) * slip
        found.append(ONE if not power or not size else 1 / mesh if power > 0 else mesh)
    return tuple(found)


def _solve(box: Definition, closed: tuple[str, ...], factors: Factors) -> Balance:
    """Torques per torque 1 at the input."""
    rows = BalanceRows(box, closed, factors)
    rows.act(box.input, ONE)
    rows.act(box.output, LOAD)
    found = rows.solved()
    return Balance(found.sets(box), {name: found.value(UnknownTorque(name, "")) for name in closed}, found.value(LOAD))


class BalanceRows:
    """Balance of each member and of the planets of each set, with what acts from outside: equations (4) to (6)."""

    def __init__(self, box: Definition, closed: tuple[str, ...], factors: Factors) -> None:
        """What sets and closed elements do; outside of them nothing acts yet."""
        self.places: dict[UnknownTorque, int] = {}
        self.members: dict[str, Row] = {member: {} for member in box.members}
        self.rows: list[Row] = []
        for one in box.sets:
            planets: Row = {}
            for wheel, size, factor in zip(one.shape.wheels, one.speeds_of_planets(), factors[one.name], strict=True):
                column = self.column(UnknownTorque(one.name, wheel.port))
                planets[column] = factor / size
                self._add(one.members[wheel.port], column, ONE)
                self._add(one.carrier, column, -ONE)
            self.rows.append(planets)
        for name in closed:
            element, column = box.element(name), self.column(UnknownTorque(name, ""))
            self._add(element.follower, column, ONE)
            self._add(element.base, column, -ONE)

    def column(self, key: UnknownTorque) -> int:
        """The column of an unknown torque."""
        return self.places.setdefault(key, len(self.places))

    def act(self, member: str, torque: UnknownTorque | Fraction) -> None:
        """A torque from outside on a member, known or not."""
        if isinstance(torque, UnknownTorque):
            self._add(member, self.column(torque), ONE)
        else:
            self._add(member, GIVEN, torque)

    def solved(self) -> BalanceSolution:
        """The torques that follow."""
        rows = [*self.rows, *self.members.values()]
        return BalanceSolution(self.places, eliminate(rows, range(len(self.places)), traced=False))

    def _add(self, member: str, column: int, value: Fraction) -> None:
        """Add a torque to the balance of a member; the housing carries what it must."""
        if member == HOUSING:
            return
        row = self.members[member]
        row[column] = row.get(column, ZERO) + value
        if not row[column]:
            del row[column]


class BalanceSolution(NamedTuple):
    """Torques that follow from a balance."""

    places: Mapping[UnknownTorque, int]
    echelon: Echelon

    def value(self, key: UnknownTorque) -> Fraction | None:
        """A torque; None where the balance leaves it open."""
        place = self.places[key]
        row = self.echelon.solved.get(place)
        if row is None or any(column not in (GIVEN, place) for column in row):
            return None
        return -row.get(GIVEN, ZERO)

    def sets(self, box: Definition) -> dict[str, Mapping[str, Fraction | None]]:
        """Torques at the ports of all sets."""
        return {
            one.name: _ports(one, {w.port: self.value(UnknownTorque(one.name, w.port)) for w in one.shape.wheels})
            for one in box.sets
        }


def _ports(one: GearSet, wheels: dict[str, Fraction | None]) -> dict[str, Fraction | None]:
    """Torques at all ports: the carrier has what the wheels leave."""
    if not one.shape.carried:
        return wheels
    known = [value for value in wheels.values() if value is not None]
    return wheels | {"carrier": -sum(known, ZERO) if len(known) == len(wheels) else None}
