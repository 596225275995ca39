"""Transmissions: elements whose two rates a varying ratio ties together. docs/theory/varying-ratios.md."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from clutchwork.base import Problem
from clutchwork.declare.rational import Row, exact, plus
from clutchwork.declare.schema import Role
from clutchwork.declare.wording import path_of
from clutchwork.elements.bases.stop import Stop

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from clutchwork.model.structure import Kinematics, Mechanism


class RatioConstraint(NamedTuple):
    """An element and its two rates over the nodes: first = ratio second."""

    component: Any
    first: Row
    second: Row

    def row(self) -> Row:
        """The rates at the start: first - ratio second."""
        return plus(self.first, -exact(self.component.start_ratio()), self.second)


def is_transmission(component: Any) -> bool:
    """Whether an element has a ratio in place of torques."""
    return "ratio" in type(component).hooks


def transmissions(model: Mechanism) -> list[RatioConstraint]:
    """All transmissions, in order."""
    found = [component for component in model.role(Role.TORQUE) if is_transmission(component)]
    return [RatioConstraint(component, *model.directions(component)) for component in found]


def followers(model: Mechanism, made: Kinematics) -> dict[int, int]:
    """Massless nodes whose speed a variable ratio fixes: number of the ratio -> independent node.

    In an order in which each one needs those before it alone.
    """
    left = {n: _massless(made, tie) for n, tie in enumerate(transmissions(model))}
    found = dict[int, int]()
    while True:
        ready = next((n for n, speeds in left.items() if len(speeds) == 1), None)
        if ready is None:
            return found
        (speed,) = left.pop(ready)
        found[ready] = speed
        for speeds in left.values():
            speeds.discard(speed)


def _massless(made: Kinematics, tie: RatioConstraint) -> set[int]:
    return made.massless & (made.over(tie.first).keys() | made.over(tie.second).keys())


def ordered(model: Mechanism, made: Kinematics) -> Iterator[tuple[RatioConstraint, int | None]]:
    """The transmissions with the independent nodes that follow from them, those first."""
    all_of = transmissions(model)
    yield from ((all_of[n], node) for n, node in made.followers.items())
    yield from ((tie, None) for n, tie in enumerate(all_of) if n not in made.followers)


def problems(model: Mechanism, made: Kinematics) -> Iterator[Problem]:
    """Transmissions that nothing with inertia can follow, and such as join nothing that moves."""
    for n, tie in enumerate(transmissions(model)):
        rates = made.over(tie.first), made.over(tie.second)
        names = [model.node_label(speed) for speed in sorted(_massless(made, tie))]
        if names and n not in made.followers:
            message = f"joins {' and '.join(names)} without inertia"
            remedy = "give one of them inertia, or connect it rigidly to a shaft that has some"
            yield Problem(path_of(tie.component), "", message, remedy=remedy)
        elif not any(column < len(model.nodes) for row in rates for column in row):
            message = "joins nothing that is free to move: prescribed speeds and the housing on both sides"
            yield Problem(path_of(tie.component), "", message, remedy="put a shaft with inertia on one side")


def start_rows(model: Mechanism, made: Kinematics) -> Sequence[tuple[Any, Row]]:
    """Rows over independent speeds and prescribed inputs that hold at the start."""
    return [(tie.component, made.over(tie.row())) for tie in transmissions(model)]


def start_grips(model: Mechanism, made: Kinematics) -> Iterator[tuple[str, Row]]:
    """Slips that are zero at the start unless speeds say otherwise, by name.

    Those of gearboxes in gear, of transmissions that can slip and are locked, and of stops that touch what follows from
    one, such as a cam.
    """
    for name, base, follower in model.grips:
        yield name, made.over(model.slip(base, follower))
    following = set(made.followers.values())
    for contact in model.role(Role.CONTACT) if following else ():
        row = made.over(model.direction(contact))
        touches = contact.locked or (isinstance(contact, Stop) and contact.rests())
        if touches and following & row.keys():
            yield path_of(contact), row
