"""Random gearboxes, right and wrong ones, and their rows by the formulas of Willis, kind by kind."""

from __future__ import annotations

from fractions import Fraction
from itertools import combinations
from typing import Any

import numpy as np

# kind -> ports
PORTS = {
    "single": ("sun", "ring", "carrier"),
    "double": ("sun", "ring", "carrier"),
    "stepped": ("sun", "ring", "carrier"),
    "two_suns": ("sun", "second_sun", "carrier"),
    "two_rings": ("ring", "second_ring", "carrier"),
    "ravigneaux": ("large_sun", "small_sun", "ring", "carrier"),
    "gear": ("first", "second"),
}
HOUSING = "housing"


def random_box(rng: np.random.Generator) -> dict[str, Any]:
    """A gearbox of 1 to 5 sets with random joins and random elements."""
    count = int(rng.integers(1, 6))
    pool = [f"M{n}" for n in range(int(rng.integers(count + 3, 2 * count + 5)))]
    sets = {f"P{n}": _set(rng, pool) for n in range(count)}
    used = sorted({one[port] for one in sets.values() for port in PORTS[one["type"]]} - {HOUSING})
    pairs = [sorted(pair) for pair in combinations([*used, HOUSING], 2)]
    some = rng.permutation(len(pairs))[: int(rng.integers(1, 7))]
    elements = {f"E{n}": _element(rng, pairs[place]) for n, place in enumerate(some)}
    ends = [str(name) for name in rng.permutation(used)[:2]]
    box = {"name": "random", "input": ends[0], "output": ends[-1], "sets": sets, "elements": elements}
    return box | {"gears": _gears(rng, box)}


def _set(rng: np.random.Generator, pool: list[str]) -> dict[str, Any]:
    kind = str(rng.choice(list(PORTS)))
    ports = PORTS[kind]
    chosen = [str(name) for name in rng.permutation(pool)[: len(ports)]]
    # a member that never turns, or two ports on one member
    if rng.random() < 0.08:
        chosen[int(rng.integers(len(ports)))] = HOUSING if rng.random() < 0.7 else chosen[0]
    return {"type": kind, **dict(zip(ports, chosen, strict=True)), **_teeth(rng, kind)}


def _teeth(rng: np.random.Generator, kind: str) -> dict[str, int]:
    sun, planet, other = (int(z) for z in rng.integers(18, 45, 3))
    ring = sun + 2 * planet
    if kind in ("single", "double"):
        return {"teeth_sun": sun, "teeth_ring": ring}
    if kind == "stepped":
        ring = sun + planet + other
        return {"teeth_sun": sun, "teeth_ring": ring, "teeth_planet_sun": planet, "teeth_planet_ring": other}
    if kind == "two_suns":
        second = max(12, sun + planet - other)
        wheels = {"teeth_planet_sun": planet, "teeth_planet_second_sun": other}
        return {"teeth_sun": sun, "teeth_second_sun": second, **wheels}
    if kind == "two_rings":
        wheels = {"teeth_planet_ring": planet, "teeth_planet_second_ring": other}
        return {"teeth_ring": ring, "teeth_second_ring": ring - planet + other, **wheels}
    if kind == "ravigneaux":
        return {"teeth_large_sun": sun, "teeth_small_sun": max(12, sun - 6), "teeth_ring": ring}
    return {"teeth_first": sun, "teeth_second": ring}


def _element(rng: np.random.Generator, pair: list[str]) -> Any:
    if rng.random() < 0.2:
        return {"type": "freewheel", "members": pair}
    return pair


def _gears(rng: np.random.Generator, box: dict[str, Any]) -> dict[str, list[str]]:
    """Rows that give a ratio where there are some, mostly; a random one else."""
    names = list(box["elements"])
    good = [list(some) for size in range(1, 5) for some in combinations(names, size) if is_gear(box, some)]
    if good and rng.random() < 0.9:
        rows = [good[place] for place in rng.permutation(len(good))[:3]]
    else:
        rows = [[str(name) for name in rng.permutation(names)[: int(rng.integers(1, 4))]]]
    return {str(number): row for number, row in enumerate(rows, 1)}


def rows_of(box: dict[str, Any], closed: Any = ()) -> list[dict[str, Fraction]]:
    """Sums of speeds of members that are zero: by gears, and by closed elements."""
    found = [row for one in box["sets"].values() for row in _willis(one)]
    for name in closed:
        element = box["elements"][name]
        first, second = element["members"] if isinstance(element, dict) else element
        found.append({first: Fraction(1), second: Fraction(-1)})
    return [{member: x for member, x in row.items() if member != HOUSING} for row in found]


def _willis(one: dict[str, Any]) -> list[dict[str, Fraction]]:
    """Relative speeds of two wheels against the carrier, by teeth."""

    def row(first: str, second: str, ratio: Fraction) -> dict[str, Fraction]:
        made: dict[str, Fraction] = {}
        carrier = one.get("carrier", HOUSING)
        for member, x in ((one[first], Fraction(1)), (one[second], -ratio), (carrier, ratio - 1)):
            made[member] = made.get(member, Fraction(0)) + x
        return made

    z = {key.removeprefix("teeth_"): Fraction(value) for key, value in one.items() if key.startswith("teeth_")}
    kind = one["type"]
    if kind in ("single", "double"):
        return [row("sun", "ring", (-1 if kind == "single" else 1) * z["ring"] / z["sun"])]
    if kind == "stepped":
        return [row("sun", "ring", -z["ring"] * z["planet_sun"] / (z["sun"] * z["planet_ring"]))]
    if kind == "two_suns":
        return [row("sun", "second_sun", z["second_sun"] * z["planet_sun"] / (z["sun"] * z["planet_second_sun"]))]
    if kind == "two_rings":
        return [row("ring", "second_ring", z["second_ring"] * z["planet_ring"] / (z["ring"] * z["planet_second_ring"]))]
    if kind == "ravigneaux":
        large, small = -z["ring"] / z["large_sun"], z["ring"] / z["small_sun"]
        return [row("large_sun", "ring", large), row("small_sun", "ring", small)]
    return [row("first", "second", -z["second"] / z["first"])]


def freedom(members: list[str], rows: list[dict[str, Fraction]]) -> int:
    """Speeds that rows leave free, by elimination of fractions."""
    pivots: list[tuple[str, dict[str, Fraction]]] = []
    for given in rows:
        row = {member: x for member, x in given.items() if x}
        for member, known in pivots:
            factor = row.get(member, Fraction(0))
            if factor:
                row = {m: row.get(m, Fraction(0)) - factor * known.get(m, Fraction(0)) for m in {*row, *known}}
                row = {m: x for m, x in row.items() if x}
        if row:
            member, lead = next(iter(row.items()))
            pivots.append((member, {m: x / lead for m, x in row.items()}))
    return len(members) - len(pivots)


def is_gear(box: dict[str, Any], closed: Any) -> bool:
    """Whether input and output turn at one ratio: held to one, the other is held, and both can turn."""
    members = members_of(box)
    rows, ends = rows_of(box, closed), (box["input"], box["output"])
    free = freedom(members, rows)
    held = [freedom(members, [*rows, {end: Fraction(1)}]) for end in ends]
    both = freedom(members, [*rows, *({end: Fraction(1)} for end in ends)])
    return ends[0] != ends[1] and held == [free - 1, free - 1] and both == free - 1


def members_of(box: dict[str, Any]) -> list[str]:
    """All that turn."""
    named = {box["input"], box["output"]}
    named |= {one[port] for one in box["sets"].values() for port in PORTS[one["type"]]}
    return sorted(named - {HOUSING})
