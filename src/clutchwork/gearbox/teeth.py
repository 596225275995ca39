"""Whether the teeth of a set mesh, and whether its planets can be put in beside each other.

docs/theory/gearboxes.md (9) to (11).
"""

from __future__ import annotations

from collections.abc import Iterator
from math import gcd, pi, sin
from typing import TYPE_CHECKING

from clutchwork.base import Problem

if TYPE_CHECKING:
    from clutchwork.gearbox.gear_set import GearSet

# teeth by which the distance of axes may differ from that of gears without profile shift
SHIFT = 3
# the tips of planets stand out by one module each
TIPS = 2
SHORT = "swap the two; where the ring meshes the short planets, write a single and a double set on one ring and carrier"


def teeth_problems(one: GearSet) -> Iterator[Problem]:
    """Mistakes of the teeth of one set."""
    path = f'set "{one.name}"'
    if one.ratios:
        yield from _ratio_problems(one, path)
        return
    found = list(_size_problems(one, path))
    yield from found
    if not found and one.planets is not None:
        yield from _planet_problems(one, path, one.planets)


def _ratio_problems(one: GearSet, path: str) -> Iterator[Problem]:
    if one.kind in ("single", "double") and one.ratios["ratio"] <= 1:
        value = f"{one.ratios['ratio']:g}"
        yield Problem(path, "ratio", "must be above 1: a ring has more teeth than its sun", value, "give ring over sun")
    if one.kind == "ravigneaux" and not 1 < one.ratios["ratio_large"] < one.ratios["ratio_small"]:
        value = f"{one.ratios['ratio_small']:g}"
        fault = f"must be above ratio_large = {one.ratios['ratio_large']:g}, and that above 1"
        yield Problem(path, "ratio_small", fault, value, "give ring over large sun and ring over small sun")


def _size_problems(one: GearSet, path: str) -> Iterator[Problem]:
    """A ring holds what turns in it."""
    teeth = one.teeth
    inside = {
        "single": ("sun", "ring"),
        "double": ("sun", "ring"),
        "stepped": ("planet_ring", "ring"),
        "ravigneaux": ("large_sun", "ring"),
    }
    pairs = [inside[one.kind]] if one.kind in inside else []
    if one.kind == "two_rings":
        pairs = [("planet_ring", "ring"), ("planet_second_ring", "second_ring")]
    if one.kind == "ravigneaux":
        pairs.append(("small_sun", "large_sun"))
    for small, large in pairs:
        if teeth[large] <= teeth[small] and small == "small_sun":
            fault = f"is {teeth[large]}, not above teeth_small_sun = {teeth[small]}: the long planets would meet it"
            yield Problem(path, "teeth_large_sun", fault, remedy=SHORT)
        elif teeth[large] <= teeth[small]:
            fault = f"is {teeth[large]}, not above teeth_{small} = {teeth[small]}: they cannot mesh"
            yield Problem(path, f"teeth_{large}", fault, remedy="correct one of the two")
    if "planet" in teeth and abs(teeth["sun"] + 2 * teeth["planet"] - teeth["ring"]) > SHIFT:
        fault = f"cannot mesh teeth_sun = {teeth['sun']} and teeth_ring = {teeth['ring']}"
        remedy = f"ring = sun + 2 planet, so about {(teeth['ring'] - teeth['sun']) // 2}"
        yield Problem(path, "teeth_planet", fault, f"{teeth['planet']}", remedy)
    if one.kind in ("two_suns", "two_rings") and len(set(one.speeds_of_planets())) == 1:
        fault = "makes both wheels turn alike: the set has no ratio"
        yield Problem(path, one.shape.teeth[0], fault, remedy="correct the teeth")


def _planet_problems(one: GearSet, path: str, count: int) -> Iterator[Problem]:
    """Planets that cannot be put in at equal angles, or that touch each other."""
    for total, words in _assembly(one):
        if one.equally_spaced and total % count:
            fault = f"cannot be assembled at equal angles: {words} = {total} cannot be divided by {count}"
            fitting = [str(n) for n in range(2, 9) if total % n == 0]
            remedy = f"take {' or '.join(fitting)} planets" if fitting else "change the teeth"
            yield Problem(path, "planets", fault, f"{count}", f"{remedy}, or write equally_spaced = false")
    most = _most_planets(one)
    if most is not None and count > most:
        fault = f"touch each other: no more than {most} have room around the sun"
        yield Problem(path, "planets", fault, f"{count}", "take fewer planets or change the teeth")


def _assembly(one: GearSet) -> Iterator[tuple[int, str]]:
    """Numbers that the number of planets must divide: equations (10)."""
    t = one.teeth
    if one.kind == "single":
        yield t["ring"] + t["sun"], "teeth_ring + teeth_sun"
    elif one.kind == "double":
        yield t["ring"] - t["sun"], "teeth_ring - teeth_sun"
    elif one.kind == "ravigneaux":
        yield t["ring"] + t["large_sun"], "teeth_ring + teeth_large_sun"
        yield t["ring"] - t["small_sun"], "teeth_ring - teeth_small_sun"
    elif one.kind == "stepped":
        common = gcd(t["planet_sun"], t["planet_ring"])
        total = (t["ring"] * t["planet_sun"] + t["sun"] * t["planet_ring"]) // common
        yield total, "(teeth_ring teeth_planet_sun + teeth_sun teeth_planet_ring) / their common divisor"
    elif one.kind in ("two_suns", "two_rings"):
        (a, p), (b, q) = ((t[wheel.port], t[wheel.planet]) for wheel in one.shape.wheels)
        words = "the difference of the teeth, each times the planet of the other, / the common divisor of the planets"
        yield abs(a * q - b * p) // gcd(p, q), words


def _most_planets(one: GearSet) -> int | None:
    """How many planets have room beside each other at equal angles: equation (11); None: not known."""
    t = one.teeth
    sun = t.get("large_sun", t.get("sun"))
    planet: float | None = t.get("planet", t.get("planet_sun"))
    if planet is None and sun is not None and one.kind in ("single", "ravigneaux"):
        planet = (t["ring"] - sun) / 2
    if sun is None or planet is None or one.kind == "double":
        return None
    fitting = [n for n in range(1, 100) if n < 3 or (sun + planet) * sin(pi / n) > planet + TIPS]
    return max(fitting)
