"""Checks of friction laws inside a contact, and what they are warned of."""

from __future__ import annotations

from collections.abc import Iterator
from numbers import Real
from typing import Any

from clutchwork.checks import At, label, object_problems
from clutchwork.errors import Problem
from clutchwork.node import Component, Law
from clutchwork.schema import REGISTRY, Role, specs


def law_problems(law: Law, at: At) -> Iterator[Problem]:
    """All mistakes of a friction law."""
    found = list(object_problems(law, at))
    yield from found or (_peak(law, at) if law.sticks else ())


def _peak(law: Any, at: At) -> Iterator[Problem]:
    """A kinetic coefficient above the static one has no motion that follows from it."""
    # a law over the temperature compares its tables itself
    if not isinstance(getattr(law, "static", 0.0), Real):
        return
    kinetic = law.sliding()
    if kinetic is None:
        from clutchwork.pools import coefficients

        kinetic, static = coefficients(law, 0.0)
    else:
        static = law.static
    # equal values may differ by round-off
    if kinetic > static * (1 + 1e-12):
        message = f"is below the kinetic coefficient at vanishing slip, {kinetic:g}"
        yield at.inner("static").problem(message, value=f"{static:g}", remedy=f"raise it to at least {kinetic:g}")


def locked_problems(contact: Any, at: At) -> Iterator[Problem]:
    """A contact that starts locked with a law that never locks; a freewheel locks by itself."""
    law = contact.friction
    if isinstance(law, Law) and not law.sticks and not contact.one_way and contact.locked:
        known: Any = REGISTRY[Role.LAW]
        sticking = ", ".join(kind for kind in known if known[kind].sticks)
        remedy = f"leave it out, or take a law that sticks: {sticking}"
        yield at.inner("locked").problem("cannot hold with a law that never locks", value="True", remedy=remedy)


def component_advice(component: Component) -> Iterator[Problem]:
    """What the friction law of an element allows and is rarely wanted; nothing where the law has mistakes."""
    law, place = getattr(component, "friction", None), At(label(component), "friction")
    if not isinstance(law, Law) or any(object_problems(law, place)):
        return
    units = {item.name: spec.unit for item, spec in specs(type(law))}
    try:
        found = law.advice()
    except ArithmeticError:
        yield place.problem("has values from which no number can be computed", remedy="correct those of unusual size")
        return
    for name, message, remedy in found:
        given = getattr(law, name)
        # a table is shown by what is said of it
        value = f"{given:g} {units[name]}".removesuffix(" 1") if isinstance(given, Real) else ""
        yield place.inner(name).problem(message, value=value, remedy=remedy)
