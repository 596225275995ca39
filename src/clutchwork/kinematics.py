"""Which speeds are independent: exact elimination of the rigid rows, and what is wrong with them in words.

Gears, prescribed speeds and chains of springs through shafts without inertia all give linear rows over the speeds of
the nodes and the prescribed inputs. See docs/theory/reduction.md.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property
from math import inf, isfinite
from numbers import Real
from typing import Any

from clutchwork.checks import label, ports
from clutchwork.errors import Problem, near
from clutchwork.node import Component, Node
from clutchwork.rational import Reduced, Row, eliminate, exact
from clutchwork.schema import Role

ZERO = Fraction(0)
# initial speeds that were rounded when they were written may differ by this share
ROUNDING = Fraction(1, 10**6)


@dataclass(frozen=True)
class Model:
    """Nodes and elements of a driveline, sorted by what they are to the engine."""

    nodes: tuple[Node, ...]
    components: tuple[Component, ...]

    @cached_property
    def inertia(self) -> list[Fraction]:
        """Inertia of each node; 1 where what is given makes no sense, which is reported elsewhere."""
        return [exact(node.inertia) if _sensible(node.inertia, 0.0) else Fraction(1) for node in self.nodes]

    @cached_property
    def speed(self) -> list[Fraction | None]:
        """Given speed of each node at the start."""
        return [exact(node.speed or 0.0) if _sensible(node.speed) else None for node in self.nodes]

    def role(self, role: Role) -> list[Any]:
        """The elements of one role, in order."""
        return [component for component in self.components if component.role is role]  # type: ignore[attr-defined]

    def index(self) -> dict[int, int]:
        """Place of each node by identity; the housing has none."""
        return {id(node): place for place, node in enumerate(self.nodes)}


def _sensible(value: Any, least: float = -inf) -> bool:
    return isinstance(value, Real) and isfinite(float(value)) and float(value) >= least


@dataclass(frozen=True)
class RigidRow:
    """One rigid row: sum of coefficient times speed = 0, over nodes and prescribed inputs."""

    owner: str  # 'element "g1" (gear)'
    coefficients: Row


@dataclass
class Kinematics:
    """All node speeds over the independent and the prescribed ones: w = basis v + basis_prescribed u."""

    basis: list[Row]
    basis_prescribed: list[Row]
    independent: list[int]  # nodes
    massless: list[bool]  # of the independent speeds
    loose: frozenset[int] = frozenset()  # nodes whose initial speed follows from springs in series
    notes: list[str] = field(default_factory=list)

    def rate(self, direction: Mapping[int, Fraction]) -> tuple[Row, Row]:
        """A rate, given over the nodes, over the independent and the prescribed speeds."""
        columns = len(self.independent), len(self.basis_prescribed[0]) if self.basis_prescribed else 0
        rate, prescribed = [ZERO] * columns[0], [ZERO] * columns[1]
        for node, factor in direction.items():
            rate = [a + factor * b if b else a for a, b in zip(rate, self.basis[node], strict=True)]
            prescribed = [
                a + factor * b if b else a for a, b in zip(prescribed, self.basis_prescribed[node], strict=True)
            ]
        return rate, prescribed


def direction(model: Model, component: Component) -> dict[int, Fraction]:
    """Rate of an element over the nodes: follower - base, or shaft - base."""
    places, joined = model.index(), ports(component)
    moving = joined.get("follower") or joined["shaft"]
    made: dict[int, Fraction] = {}
    for node, sign in ((moving, 1), (joined.get("base"), -1)):
        if node is not None and not node.fixed:
            made[places[id(node)]] = made.get(places[id(node)], ZERO) + sign
    return made


def rigid_rows(model: Model) -> Iterator[RigidRow]:
    """Rows of all gears, then of all prescribed speeds."""
    motions, places = model.role(Role.MOTION), model.index()
    width = len(model.nodes) + len(motions)
    for gear in model.role(Role.GEAR):
        joined = ports(gear)
        for coefficients in gear.rows():
            row = [ZERO] * width
            for port, coefficient in coefficients.items():
                if not joined[port].fixed:
                    row[places[id(joined[port])]] += coefficient
            yield RigidRow(label(gear), row)
    for number, motion in enumerate(motions):
        row = [ZERO] * width
        for node, factor in direction(model, motion).items():
            row[node] += factor
        row[len(model.nodes) + number] = Fraction(-1)
        yield RigidRow(label(motion), row)


def kinematics(
    model: Model, wanted: Sequence[str] = (), *, incomplete: frozenset[str] = frozenset()
) -> tuple[Kinematics | None, list[Problem]]:
    """Choose the independent speeds.

    `wanted` names them, else shafts with the most inertia are taken. Shafts in `incomplete` belong to elements whose
    mistakes are reported elsewhere, so nothing is said about their inertia.
    """
    problems, places = _wanted_problems(model, wanted)
    rows = list(rigid_rows(model))
    order = _order(model, places)
    reduced = eliminate([row.coefficients for row in rows], order)
    problems += _contradictions(model, rows, reduced)
    if problems:
        return None, problems
    # springs in series through a shaft without inertia give further rows
    made = _solve(model, reduced)
    series = {speed: _balance(model, made, speed) for speed in _series_speeds(model, made)}
    if series:
        problems += _unbalanced(model, made, series)
        loose = frozenset(n for n, row in enumerate(made.basis) if any(row[speed] for speed in series))
        rows += series.values()
        reduced = eliminate([row.coefficients for row in rows], order)
        made = _solve(model, reduced)
        made.loose = loose
    problems += _choice_problems(model, made, wanted)
    problems += _massless_problems(model, made, incomplete)
    made.notes += _redundant(rows, reduced) + [f"{row.owner}: its springs act in series" for row in series.values()]
    return (None if problems else made), problems


def _wanted_problems(model: Model, wanted: Sequence[str]) -> tuple[list[Problem], list[int]]:
    names = [node.name for node in model.nodes]
    unknown = [name for name in wanted if name not in names]
    problems = [
        Problem("independent", "", "is not a shaft" + near(name, names), repr(name), f"choose from {', '.join(names)}")
        for name in unknown
    ]
    return problems, [names.index(name) for name in wanted if name in names]


def _order(model: Model, wanted: Sequence[int]) -> list[int]:
    """Columns in the order in which they are solved for: what is left are the independent speeds."""
    rest = [place for place in range(len(model.nodes)) if place not in wanted]
    by_inertia = sorted(rest, key=lambda place: (model.inertia[place], -place))
    return [*by_inertia, *reversed(wanted)]


def _solve(model: Model, reduced: Reduced) -> Kinematics:
    """Node speeds over the columns that no row solves for."""
    count = len(model.nodes)
    width = count + len(model.role(Role.MOTION))
    free = [column for column in range(count) if column not in reduced.pivots]
    solved = dict(zip(reduced.pivots, reduced.rows, strict=True))
    basis, prescribed = [], []
    for node in range(count):
        row = solved.get(node)
        unit = [Fraction(int(node == column)) for column in free]
        basis.append([-row[column] for column in free] if row else unit)
        prescribed.append([-row[column] if row else ZERO for column in range(count, width)])
    heavy = [any(basis[n][k] for n in range(count) if model.inertia[n]) for k in range(len(free))]
    return Kinematics(basis, prescribed, free, [not has for has in heavy])


def _contradictions(model: Model, rows: list[RigidRow], reduced: Reduced) -> Iterator[Problem]:
    """Rows that together hold a shaft still, and prescribed speeds that follow from each other."""
    count = len(model.nodes)
    table = [row.coefficients for row in rows]
    still: dict[tuple[int, ...], list[str]] = {}
    for row, pivot in zip(reduced.rows, reduced.pivots, strict=True):
        if not any(value for column, value in enumerate(row) if column != pivot):
            still.setdefault(_smallest(table, row), []).append(model.nodes[pivot].name)
    for guilty, names in still.items():
        shafts = " and ".join(f'"{name}"' for name in names)
        verb = "contradict each other: they hold" if len(guilty) > 1 else "holds"
        owners = " and ".join(dict.fromkeys(rows[i].owner for i in guilty))
        remedy = "remove one of them or correct a ratio" if len(guilty) > 1 else "use the housing in place of the shaft"
        yield Problem(owners, "", f"{verb} shaft {shafts} still for ever", remedy=remedy)
    for origin in reduced.spare:
        total = [
            sum((f * row[k] for f, row in zip(origin, table, strict=True) if f), ZERO) for k in range(len(table[0]))
        ]
        if any(total[count:]):
            guilty = _smallest(table, total)
            owners = " and ".join(dict.fromkeys(rows[i].owner for i in guilty))
            yield Problem(owners, "", "prescribe speeds that follow from each other", remedy="remove one of them")


def _smallest(table: list[Row], target: Row) -> tuple[int, ...]:
    """A smallest set of rows that the target follows from: drop every row that it does not need."""
    keep = list(range(len(table)))
    for row in list(keep):
        fewer = [i for i in keep if i != row]
        if _follows([table[i] for i in fewer], target):
            keep = fewer
    return tuple(keep)


def _follows(table: list[Row], target: Row) -> bool:
    columns = range(len(target))
    return len(eliminate([*table, target], columns).pivots) == len(eliminate(table, columns).pivots)


def _redundant(rows: list[RigidRow], reduced: Reduced) -> list[str]:
    """Sums of rows that came out as zero."""
    sums = ([rows[i].owner for i, factor in enumerate(origin) if factor] for origin in reduced.spare)
    return [f"{' and '.join(owners)}: one of them repeats what the others say" for owners in sums]


def _choice_problems(model: Model, made: Kinematics, wanted: Sequence[str]) -> Iterator[Problem]:
    """A forced choice that is too large, too small, or hides a shaft without inertia."""
    if not wanted:
        return
    names = [node.name for node in model.nodes]
    free = [names[column] for column in made.independent]
    for name in wanted:
        if name not in free:
            others = [n for n, c in zip(free, made.basis[names.index(name)], strict=True) if c]
            message = f"follows from {', '.join(others) or 'the prescribed speeds'}"
            yield Problem("independent", "", message, repr(name), "leave it out")
    missing = [name for name in free if name not in wanted]
    if missing:
        yield Problem("independent", "", f"misses {', '.join(missing)}", remedy=f"{len(free)} speeds are independent")
    heavy = [n for n, inertia in enumerate(model.inertia) if inertia]
    rank = len(eliminate([made.basis[n] for n in heavy], range(len(free))).pivots)
    if rank < len(free) - sum(made.massless):
        yield Problem("independent", "", "mixes shafts with and without inertia", remedy="let the package choose")


# --- shafts without inertia ---


def _acting(model: Model, made: Kinematics, speed: int) -> list[tuple[Any, Row]]:
    """Torque elements and contacts whose rate contains an independent speed, with that rate."""
    rates = [
        (component, made.rate(direction(model, component))[0])
        for component in (*model.role(Role.TORQUE), *model.role(Role.CONTACT))
    ]
    return [(component, rate) for component, rate in rates if rate[speed]]


def _is_spring(component: Any) -> bool:
    return component.kind in ("spring", "spring_damper") and not getattr(component, "damping", 0.0)


def _series_speeds(model: Model, made: Kinematics) -> Iterator[int]:
    """Independent speeds without inertia on which only springs act."""
    for speed, massless in enumerate(made.massless):
        acting = _acting(model, made, speed) if massless else []
        if acting and all(_is_spring(component) for component, _ in acting):
            yield speed


def _balance(model: Model, made: Kinematics, speed: int) -> RigidRow:
    """The springs at a shaft balance at all times: sum of stiffness times rate is zero."""
    row = [ZERO] * (len(model.nodes) + len(model.role(Role.MOTION)))
    for spring, rate in _acting(model, made, speed):
        for node, factor in direction(model, spring).items():
            row[node] += exact(spring.stiffness) * rate[speed] * factor
    return RigidRow(f'shaft "{model.nodes[made.independent[speed]].name}" without inertia', row)


def _unbalanced(model: Model, made: Kinematics, series: Mapping[int, RigidRow]) -> Iterator[Problem]:
    """Springs in series that do not balance at the start."""
    for speed, row in series.items():
        pulls = [exact(c.stiffness * c.initial_twist) * rate[speed] for c, rate in _acting(model, made, speed)]
        if abs(sum(pulls, ZERO)) > ROUNDING * max(map(abs, pulls)):
            message = f"its springs pull it with {float(-sum(pulls, ZERO)):.9g} N m at the start"
            yield Problem(row.owner, "", message, remedy="choose each initial_twist so that they balance")


def _massless_problems(model: Model, made: Kinematics, incomplete: frozenset[str]) -> Iterator[Problem]:
    """Speeds without inertia that no damping determines."""
    light = [speed for speed, massless in enumerate(made.massless) if massless]
    dampers = [made.rate(direction(model, c))[0] for c in model.role(Role.TORQUE) if getattr(c, "damping", 0.0) > 0]
    damped = eliminate([[rate[speed] for speed in light] for rate in dampers], range(len(light))).pivots
    for place, speed in enumerate(light):
        node = model.nodes[made.independent[speed]]
        if any(row[speed] and other.name in incomplete for other, row in zip(model.nodes, made.basis, strict=True)):
            continue
        at = f'{"mass" if node.domain.value == "translation" else "shaft"} "{node.name}"'
        unit = "kg" if node.domain.value == "translation" else "kg m2"
        quantity = "mass" if unit == "kg" else "inertia"
        contacts = [label(c) for c, _ in _acting(model, made, speed) if c.role is Role.CONTACT]
        if contacts:
            message = f"has none and touches {' and '.join(contacts)}, whose torque jumps"
            yield Problem(at, quantity, message, remedy=f"give it {quantity} > 0 {unit}")
        elif place not in damped:
            remedy = (
                f"give it {quantity} > 0 {unit}, or join it to a shaft that has some by a gear or a spring with damping"
            )
            yield Problem(at, quantity, "is missing, and nothing else determines its motion", remedy=remedy)


# --- start ---


def initial_speeds(model: Model, made: Kinematics, prescribed: Sequence[float]) -> tuple[list[Fraction], list[Problem]]:
    """Independent speeds at the start from the given ones; shafts without a given speed start at rest if they can."""
    given = [n for n, speed in enumerate(model.speed) if speed is not None and n not in made.loose]
    rest = [n for n in range(len(model.nodes)) if n not in given]
    count, rows, owners, problems = len(made.independent), list[Row](), list[int](), list[Problem]()
    largest = max((abs(model.speed[n] or ZERO) for n in given), default=ZERO)
    for node in (*given, *rest):
        pushed = sum((f * exact(u) for f, u in zip(made.basis_prescribed[node], prescribed, strict=True)), ZERO)
        wanted = (model.speed[node] or ZERO) if node in given else ZERO
        row = [*made.basis[node], wanted - pushed]
        left = _remainder(rows, row, count)
        if any(left[:count]):
            rows.append(row)
            owners.append(node)
        elif node in given and abs(left[count]) > ROUNDING * max(largest, Fraction(1)):
            problems.append(_speed_problem(model, rows, owners, row, node, left[count]))
    reduced = eliminate(rows, range(count))
    solved = dict(zip(reduced.pivots, (row[count] for row in reduced.rows), strict=True))
    return [solved.get(k, ZERO) for k in range(count)], problems


def _remainder(rows: list[Row], row: Row, count: int) -> Row:
    """What is left of a row after the others have been taken off."""
    reduced = eliminate(rows, range(count))
    for pivot, other in zip(reduced.pivots, reduced.rows, strict=True):
        factor = row[pivot]
        row = [a - factor * b for a, b in zip(row, other, strict=True)] if factor else row
    return row


def _speed_problem(model: Model, rows: list[Row], owners: list[int], row: Row, node: int, excess: Fraction) -> Problem:
    unit = "m/s" if model.nodes[node].domain.value == "translation" else "rad/s"
    guilty = _smallest([other[:-1] for other in rows], row[:-1])
    others = " and ".join(f'"{model.nodes[owners[i]].name}"' for i in guilty) or "the prescribed speeds"
    speed = model.nodes[node].speed or 0.0
    message = f"contradicts the initial speed of {others}, which gives {speed - float(excess):.9g} {unit}"
    remedy = "correct one of them, or leave this one out and it follows from the others"
    return Problem(f'shaft "{model.nodes[node].name}"', "speed", message, f"{speed:g} {unit}", remedy)


def apart(items: Sequence[int], touching: Callable[[int], Sequence[int]]) -> list[int]:
    """Reverse Cuthill-McKee order: neighbours stand close to each other."""
    degree = {item: len(touching(item)) for item in items}
    order: list[int] = []
    left = sorted(items, key=lambda item: degree[item])
    while left:
        queue = [left[0]]
        while queue:
            item = queue.pop(0)
            if item in left:
                left.remove(item)
                order.append(item)
                queue += sorted((other for other in touching(item) if other in left), key=lambda other: degree[other])
    return order[::-1]
