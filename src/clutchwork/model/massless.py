"""Shafts without inertia: springs in series through them, speeds that damping determines, and what is missing.

See docs/theory/reduction.md, Shafts without inertia.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from fractions import Fraction
from typing import Any, NamedTuple

from clutchwork.base import Problem, quote
from clutchwork.declare.node import Domain
from clutchwork.declare.rational import ONE, ZERO, Row, eliminate, exact, plus
from clutchwork.declare.schema import Role
from clutchwork.declare.wording import path_of
from clutchwork.model.structure import Kinematics, Mechanism, RigidRow

# initial twists that were rounded when they were written may differ by this share
ROUNDING = exact(1e-6)


class Acting(NamedTuple):
    """An element or contact that a motion of shafts without inertia moves."""

    component: Any
    direction: Row  # its rate over the nodes
    share: Fraction  # its rate in that motion


def _acting(model: Mechanism, made: Kinematics, motion: Row) -> list[Acting]:
    """Elements and contacts that a motion moves, given as independent speeds without inertia."""
    moved = {place for speed in motion for place in made.moved_by(speed)}
    found = list[Acting]()
    for component, direction in model.acting:
        if moved & direction.keys() and not _is_idle(component):
            rate = made.over(direction)
            share = sum((factor * rate.get(speed, ZERO) for speed, factor in motion.items()), ZERO)
            found += [Acting(component, direction, share)] if share else []
    return found


def _is_idle(component: Any) -> bool:
    passive = component.passive()
    return passive is not None and not any(passive)


def _is_spring(component: Any) -> bool:
    passive = component.passive()
    return passive is not None and passive.stiffness > 0.0 and not passive.damping


def _damps(component: Any) -> bool:
    passive = component.passive()
    return passive is not None and passive.damping > 0.0


def _needs_inertia(component: Any) -> bool:
    return component.role is Role.CONTACT or component.jumps


def undamped(model: Mechanism, made: Kinematics) -> dict[int, Row]:
    """Motions of the speeds without inertia that move no damper, each by the speed that is 1 in it."""
    if not made.massless:
        return {}
    massless = sorted(made.massless)
    rates = (made.over(direction) for component, direction in model.acting if _damps(component))
    dampers = ({speed: rate[speed] for speed in massless if speed in rate} for rate in rates)
    solved = eliminate(dampers, massless, traced=False).solved
    motions: dict[int, Row] = {}
    for speed in (speed for speed in massless if speed not in solved):
        motions[speed] = {speed: ONE, **{other: -row[speed] for other, row in solved.items() if speed in row}}
    return motions


def series_rows(model: Mechanism, made: Kinematics) -> tuple[dict[int, RigidRow], list[Problem]]:
    """Rows for the motions without inertia and damping on which only springs act: at all times the springs balance."""
    rows, problems = dict[int, RigidRow](), list[Problem]()
    for speed, motion in undamped(model, made).items():
        acting = _acting(model, made, motion)
        if acting and all(_is_spring(spring.component) for spring in acting):
            row: Row = {}
            for spring in acting:
                row = plus(row, exact(spring.component.passive().stiffness) * spring.share, spring.direction)
            names = " and ".join(model.node_label(place) for place in sorted(motion))
            rows[speed] = RigidRow(f"{names} without inertia", row)
            moves = all(model.nodes[place].domain is Domain.TRANSLATION for place in motion)
            problems += _unbalanced(rows[speed].owner, acting, "N" if moves else "N m")
    return rows, problems


def _unbalanced(owner: str, acting: list[Acting], unit: str) -> Iterator[Problem]:
    """Springs in series that do not balance at the start."""
    pulls = [exact(spring.component.initial_states()[0]) * spring.share for spring in acting]
    total = sum(pulls, ZERO)
    if abs(total) > ROUNDING * max(map(abs, pulls)):
        message = f"its springs pull it with {float(-total):.9g} {unit} at the start"
        yield Problem(owner, "", message, remedy="choose the twist of each at the start so that they balance")


def problems(model: Mechanism, made: Kinematics, incomplete: frozenset[str]) -> Iterator[Problem]:
    """Speeds without inertia that nothing determines, or on which something acts whose torque jumps."""
    motions = undamped(model, made)
    for speed in sorted(made.massless):
        if any(model.nodes[place].name in incomplete for place in made.moved_by(speed)):
            continue
        is_mass = model.nodes[speed].domain is Domain.TRANSLATION
        quantity, more = ("mass", "mass > 0 kg") if is_mass else ("inertia", "inertia > 0 kg m2")
        if speed >= len(model.nodes) - model.inner:
            # inside of a composite
            more += f" where {quote(model.nodes[speed].name.partition('.')[0])} is written"
        jumping = _names(_acting(model, made, {speed: ONE}), _needs_inertia)
        if jumping:
            message = f"is missing at {jumping}, whose torque jumps"
            yield Problem(model.node_label(speed), quantity, message, remedy=f"give it {more}")
        elif speed in motions:
            other = _names(_acting(model, made, motions[speed]), lambda component: not _is_spring(component))
            message = "is missing, and nothing else determines its motion"
            message += f": {other} is neither spring nor damper" if other else ""
            remedy = f"give it {more}, or connect it by a gear or a damped spring to a shaft that has some"
            yield Problem(model.node_label(speed), quantity, message, remedy=remedy)


def _names(acting: Iterable[Acting], which: Callable[[Any], bool]) -> str:
    return " and ".join(path_of(item.component) for item in acting if which(item.component))
