"""Nodes at the ports of an element, and the directions along which it acts."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from functools import cache
from typing import Any

from clutchwork.base import dataclass
from clutchwork.declare.node import HOUSING, Component, Domain, Node, ThermalNode
from clutchwork.declare.rational import MINUS, ONE, exact
from clutchwork.declare.schema import Way, specs


def ports(component: Component) -> dict[str, Node]:
    """Nodes at the ports of an element; an optional port that is not given is the housing."""
    return {name: getattr(component, name) or HOUSING for name in _names(type(component), "port")}


@cache
def _names(cls: Any, what: str) -> tuple[str, ...]:
    """Names of the ports of a class, those on nodes or those on thermal nodes."""
    return tuple(item.name for item, _ in specs(cls, what))


@cache
def _free(cls: Any) -> tuple[str, ...]:
    """Names of the ports that may be on shafts and on masses."""
    return tuple(item.name for item, spec in specs(cls, "port") if not spec.domain)


@dataclass(frozen=True)
class Direction:
    """One direction of an element: its name in results, its coefficients by port, its kind of motion."""

    name: str  # "tc", or "tc.turbine" where the element acts along several ways
    coefficients: Mapping[str, Fraction]
    domain: Domain
    way: Way | None = None
    number: int = 0  # among those of the element


def coefficients(component: Component) -> list[dict[str, Fraction]]:
    """Coefficients by port of each direction of an element: follower - base, shaft - base, or what its ways say."""
    ways = type(component).ways
    if not ways:
        moving, base = _moving(type(component))
        return [{moving: ONE, base: MINUS} if base else {moving: ONE}]
    rows_of = component.directions()
    return [{port: exact(coefficient) for port, coefficient in rows_of[way.name].items()} for way in ways]


def directions(component: Component) -> tuple[Direction, ...]:
    """The directions of an element, one for each of its ways."""
    ways, rows = type(component).ways, coefficients(component)
    if not ways:
        return (Direction(component.name, rows[0], _domain(component)),)
    several = sum(not way.watched for way in ways) > 1
    return tuple(
        Direction(
            f"{component.name}.{way.name}" if several or way.watched else component.name,
            rows[number],
            Domain(way.domain) if way.domain else _domain(component),
            way,
            number,
        )
        for number, way in enumerate(ways)
    )


@cache
def _moving(cls: Any) -> tuple[str, str]:
    """Names of the ports between which the rate is measured; the second is empty if there is none."""
    names = _names(cls, "port")
    return "follower" if "follower" in names else "shaft", "base" if "base" in names else ""


def _domain(component: Component) -> Domain:
    """Kind of motion of the first port that is not the housing, among those that may be on either kind of node."""
    joined = ports(component)
    order = [*reversed(_free(type(component))), *joined]
    return next((joined[name].domain for name in order if not joined[name].fixed), Domain.ROTATION)


def port_domains(component: Component) -> dict[str, Domain]:
    """Kind of motion at every port; the housing takes what is declared, else that of its fellow ports."""
    joined = ports(component)
    own = {item.name: spec.domain for item, spec in specs(type(component), "port")}
    other = _domain(component)
    return {
        name: node.domain if not node.fixed else Domain(own[name]) if own[name] else other
        for name, node in joined.items()
    }


def thermal_ports(component: Component) -> dict[str, ThermalNode]:
    """Thermal nodes at the ports of an element, those that are given."""
    values = {name: getattr(component, name) for name in _names(type(component), "thermal")}
    return {name: node for name, node in values.items() if node is not None}
