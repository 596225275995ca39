"""Gears as levers: their members at places along which speeds are a straight line."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from clutchwork.assembly.wiring import HOUSING, GearRow, Wiring

PORTS = 3
EXACT = 1e-9
Lever = dict[int, float]  # node, or HOUSING, -> place


def levers(wiring: Wiring) -> list[dict[str, Any]]:
    """Levers of all gears with three members whose speeds are a straight line; those of one gear are one."""
    made = dict[str, Lever]()
    for row in wiring.gears:
        places = _places(row)
        if places is None:
            continue
        before = made.get(row.name)
        joined = places if before is None else _joined(before, places)
        if joined is not None:
            made[row.name] = joined
    first = int(wiring.columns["speed"].start)
    return [_plain(name, one, wiring, first) for name, one in made.items()]


def _places(row: GearRow) -> Lever | None:
    """Places of the members of a row whose coefficients add up to nothing: all turn together where two do."""
    nodes = [(node, factor) for node, factor in row.ports.values() if factor]
    if len(nodes) != PORTS or len({node for node, _ in nodes}) != PORTS:
        return None
    (a, _), (b, second), (c, third) = nodes
    size = max(abs(factor) for _, factor in nodes)
    if abs(sum(factor for _, factor in nodes)) > EXACT * size:
        return None
    return {a: 0.0, b: 1.0, c: -second / third}


def _joined(one: Lever, other: Lever) -> Lever | None:
    """One lever of two rows of a gear that share two members."""
    shared = [node for node in one if node in other]
    if len(shared) < 2:
        return None
    a, b = shared[:2]
    scale = (one[b] - one[a]) / (other[b] - other[a])
    return {node: one[a] + scale * (place - other[a]) for node, place in other.items()} | one


def _plain(name: str, lever: Lever, wiring: Wiring, first: int) -> dict[str, Any]:
    low, high = min(lever.values()), max(lever.values())
    ordered: Sequence[tuple[int, float]] = sorted(lever.items(), key=lambda item: item[1])
    points = [
        {
            "name": "housing" if node == HOUSING else wiring.nodes[node].name,
            "column": -1 if node == HOUSING else first + node,
            "place": (place - low) / (high - low),
        }
        for node, place in ordered
    ]
    return {"name": name, "points": points}
