"""The loads of contacts that follow the torque of their gear row: docs/theory/load-dependent.md.

A virtual motion that violates one row alone, by one, gives its torque: inertia, elements and contacts work in it and no
other row does. It exists where the row is not a sum of the others, and is found in exact arithmetic.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from clutchwork.base import Problem
from clutchwork.declare.rational import MINUS, ONE, ZERO, Row, eliminate, plus, smallest
from clutchwork.declare.schema import Role
from clutchwork.declare.wording import path_of
from clutchwork.model.structure import Mechanism, RigidRow, follows_load


def load_arrays(model: Mechanism) -> dict[str, Any]:
    """Which contacts follow loads, and the virtual motion of each over nodes, elements and contacts."""
    contacts = model.role(Role.CONTACT)
    places = [place for place, contact in enumerate(contacts) if follows_load(contact)]
    motions = [motion for _, _, motion in _motions(model)] if places else []
    acting = {role: [row for part, row in model.acting if part.role is role] for role in (Role.TORQUE, Role.CONTACT)}
    return {
        "load_contact": places,
        "load_motion": [[float(motion.get(node, ZERO)) for node in range(len(model.nodes))] for motion in motions],
        "load_element_rate": [[_rate(row, motion) for row in acting[Role.TORQUE]] for motion in motions],
        "load_contact_rate": [[_rate(row, motion) for row in acting[Role.CONTACT]] for motion in motions],
    }


def load_problems(model: Mechanism) -> Iterator[Problem]:
    """Contacts whose load is not determined because their gear row depends on others."""
    if any(follows_load(contact) for contact in model.role(Role.CONTACT)):
        for component, others, motion in _motions(model):
            if not motion:
                names = " and ".join(dict.fromkeys(others))
                message = f"closes a loop of rigid parts with {names}: how they share the torque is not determined"
                remedy = "remove one of them, or put a spring or a clutch into the loop"
                yield Problem(path_of(component), "", message, remedy=remedy)


def _motions(model: Mechanism) -> Iterator[tuple[Any, list[str], Mapping[int, Any]]]:
    """Each contact that follows a load, the owners of the rows that its row is a sum of, and its virtual motion."""
    rows = list(model.rigid_rows())
    for contact in model.role(Role.CONTACT):
        if follows_load(contact):
            own = next(place for place, row in enumerate(rows) if row.component is contact)
            others = [row for place, row in enumerate(rows) if place != own]
            motion = _motion(model, rows[own].coefficients, others)
            table = [row.coefficients for row in others]
            owners = [] if motion else [others[place].owner for place in smallest(table, rows[own].coefficients)]
            yield contact, owners, motion


def _motion(model: Mechanism, own: Row, others: list[RigidRow]) -> Row:
    """Speeds of the nodes in a motion that all other rows allow and that violates the own one by one; {}: none."""
    count = len(model.nodes)
    # prescribed speeds stand still
    still = ({column: c for column, c in row.coefficients.items() if column < count} for row in others)
    solved = eliminate(still, range(count), traced=False).solved
    speeds = [plus({node: ONE}, MINUS, solved[node]) if node in solved else {node: ONE} for node in range(count)]
    violated: Row = {}
    for node, coefficient in own.items():
        violated = plus(violated, coefficient, speeds[node]) if node < count else violated
    if not violated:
        return {}
    free = max(violated, key=lambda node: (abs(violated[node]), -node))
    return {node: row[free] / violated[free] for node, row in enumerate(speeds) if free in row}


def _rate(row: Row, motion: Mapping[int, Any]) -> float:
    return float(sum((factor * motion.get(node, ZERO) for node, factor in row.items()), ZERO))
