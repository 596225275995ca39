"""Shafts without inertia: springs in series through them, speeds that damping determines, and what is missing."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from clutchwork.base.errors import Problem
from clutchwork.declare.node import Domain
from clutchwork.declare.rational import ZERO, Row, eliminate, exact, plus
from clutchwork.declare.schema import Role
from clutchwork.declare.speech import path_of
from clutchwork.model.structure import Kinematics, Mechanism, RigidRow

if TYPE_CHECKING:
    from collections.abc import Iterator
    from fractions import Fraction

# initial twists that were rounded when they were written may differ by this share
ROUNDING = exact(1e-6)


def _acting(model: Mechanism, made: Kinematics, speed: int) -> list[tuple[Any, Row, Fraction]]:
    """Elements and contacts that an independent speed moves: rate over the nodes, and per that speed."""
    moved = set(made.moved_by(speed))
    rates = ((c, row, made.over(row).get(speed, ZERO)) for c, row in model.acting if moved & row.keys())
    return [(c, row, share) for c, row, share in rates if share and not _is_idle(c)]


def _is_idle(component: Any) -> bool:
    passive = component.passive()
    return passive is not None and not any(passive)


def _is_spring(component: Any) -> bool:
    passive = component.passive()
    return passive is not None and passive.stiffness > 0.0 and not passive.damping


def _damps(component: Any) -> bool:
    passive = component.passive()
    return passive is not None and passive.damping > 0.0


def series_rows(model: Mechanism, made: Kinematics) -> tuple[dict[int, RigidRow], list[Problem]]:
    """Rows for the speeds without inertia on which only springs act: at all times the springs balance."""
    rows, problems = dict[int, RigidRow](), list[Problem]()
    for speed in sorted(made.massless):
        acting = _acting(model, made, speed)
        if acting and all(_is_spring(component) for component, *_ in acting):
            row: Row = {}
            for spring, direction, share in acting:
                row = plus(row, exact(spring.stiffness) * share, direction)
            rows[speed] = RigidRow(f"{model.node_label(speed)} without inertia", row)
            problems += _unbalanced(rows[speed].owner, acting)
    return rows, problems


def _unbalanced(owner: str, acting: list[tuple[Any, Row, Fraction]]) -> Iterator[Problem]:
    """Springs in series that do not balance at the start."""
    pulls = [exact(spring.stiffness) * exact(spring.initial_twist) * share for spring, _, share in acting]
    total = sum(pulls, ZERO)
    if abs(total) > ROUNDING * max(map(abs, pulls)):
        message = f"its springs pull it with {float(-total):.9g} N m at the start"
        yield Problem(owner, "", message, remedy="choose each initial_twist so that they balance")


def problems(model: Mechanism, made: Kinematics, incomplete: frozenset[str]) -> Iterator[Problem]:
    """Speeds without inertia that no damping determines, or on which a contact acts."""
    dampers = [made.over(row) for component, row in model.acting if _damps(component)]
    damped = eliminate(dampers, sorted(made.massless)).solved
    for speed in sorted(made.massless):
        if any(model.nodes[place].name in incomplete for place in made.moved_by(speed)):
            continue
        is_mass = model.nodes[speed].domain is Domain.TRANSLATION
        quantity, more = ("mass", "mass > 0 kg") if is_mass else ("inertia", "inertia > 0 kg m2")
        contacts = [path_of(c) for c, *_ in _acting(model, made, speed) if c.role is Role.CONTACT]
        if contacts:
            message = f"is missing at {' and '.join(contacts)}, whose torque jumps"
            yield Problem(model.node_label(speed), quantity, message, remedy=f"give it {more}")
        elif speed not in damped:
            remedy = f"give it {more}, or connect it by a gear or a damped spring to a shaft that has some"
            message = "is missing, and nothing else determines its motion"
            yield Problem(model.node_label(speed), quantity, message, remedy=remedy)
