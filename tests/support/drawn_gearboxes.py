"""Gearboxes for tests: those of the catalogue, one of each kind of set, random ones."""

from __future__ import annotations

from typing import Any

from hypothesis import strategies as st

import clutchwork as cw
from clutchwork.diagrams.draw import with_machines

from .gearboxes import EIGHT_SPEED, changed

EIGHT = changed(EIGHT_SPEED, sets__P4__teeth_sun=23, sets__P4__teeth_ring=85, published=None)
LEPELLETIER = {
    "name": "six-speed", "input": "in", "output": "out",
    "sets": {
        "P1": {"type": "single", "sun": "housing", "ring": "in", "carrier": "C1", "teeth_sun": 37, "teeth_ring": 71},
        "RV": {"type": "ravigneaux", "large_sun": "SL", "small_sun": "SS", "ring": "out", "carrier": "CR",
               "teeth_large_sun": 38, "teeth_small_sun": 31, "teeth_ring": 85},
    },
    "elements": {
        "A": ["C1", "SS"], "B": ["C1", "SL"], "C": ["SL", "housing"], "D": ["CR", "housing"], "E": ["in", "CR"],
        "F": {"type": "freewheel", "members": ["housing", "CR"]},
    },
    "gears": {
        "1": ["A", "D"], "2": ["A", "C"], "3": ["A", "B"], "4": ["A", "E"], "5": ["B", "E"], "6": ["C", "E"],
        "R": ["B", "D"],
    },
}  # fmt: skip
# every kind of set and of element once
KINDS = {
    "name": "every-kind", "input": "in", "output": "out",
    "sets": {
        "D": {"type": "double", "sun": "SD", "ring": "a", "carrier": "in", "teeth_sun": 38, "teeth_ring": 82},
        "T": {"type": "stepped", "sun": "ST", "ring": "a", "carrier": "b", "teeth_sun": 30, "teeth_ring": 66,
              "teeth_planet_sun": 19, "teeth_planet_ring": 14},
        "U": {"type": "two_suns", "sun": "SU", "second_sun": "c", "carrier": "b", "teeth_sun": 21,
              "teeth_second_sun": 27, "teeth_planet_sun": 33, "teeth_planet_second_sun": 27},
        "V": {"type": "two_rings", "ring": "housing", "second_ring": "d", "carrier": "c", "teeth_ring": 60,
              "teeth_second_ring": 66, "teeth_planet_ring": 20, "teeth_planet_second_ring": 21},
        "G": {"type": "gear", "first": "d", "second": "out", "teeth_first": 31, "teeth_second": 47},
    },
    "elements": {
        "B1": ["SD", "housing"], "B2": ["ST", "housing"], "K": ["SU", "b"], "L": {"type": "dog", "members": ["a", "b"]},
        "F": {"type": "freewheel", "members": ["SD", "in"]}, "H": {"type": "dog", "members": ["SU", "housing"]},
    },
    "gears": {"1": ["B1", "B2", "H"], "2": ["B1", "L", "H"]},
}  # fmt: skip

OWN = {one["name"]: cw.Gearbox.from_dict(one) for one in (EIGHT, LEPELLETIER, KINDS)}
BOXES = {**OWN, **{name: with_machines(box) for name, box in cw.catalogue().items()}}

KINDS_OF_SETS = ("single", "single", "double", "stepped", "two_suns", "ravigneaux")
PORTS = {
    "single": ("sun", "ring", "carrier"), "double": ("sun", "ring", "carrier"), "stepped": ("sun", "ring", "carrier"),
    "two_suns": ("sun", "second_sun", "carrier"), "ravigneaux": ("large_sun", "small_sun", "ring", "carrier"),
}  # fmt: skip
TEETH = {"sun": 31, "second_sun": 27, "ring": 89, "large_sun": 38, "small_sun": 31, "planet_sun": 22, "planet_ring": 17}


@st.composite
def definitions(draw: st.DrawFn) -> Any:
    """Gearboxes with one to four sets joined at random, whether or not they have a gear."""
    from clutchwork.gearbox.definition import Definition, ShiftElement
    from clutchwork.gearbox.gear_set import KINDS as SHAPES
    from clutchwork.gearbox.gear_set import GearSet

    names = ["in", "out", *"abcdefg"][: draw(st.integers(3, 9))]
    sets = []
    for number in range(draw(st.integers(1, 4))):
        kind = draw(st.sampled_from(KINDS_OF_SETS))
        ports = PORTS[kind]
        members = draw(
            st.lists(st.sampled_from([*names, "housing"]), min_size=len(ports), max_size=len(ports), unique=True)
        )
        teeth = {name.removeprefix("teeth_"): TEETH.get(name.removeprefix("teeth_"), 20) for name in SHAPES[kind].teeth}
        sets.append(GearSet(f"P{number + 1}", kind, dict(zip(ports, members, strict=True)), teeth, {}))
    known = list(dict.fromkeys(["in", "out", *(m for one in sets for m in one.members.values() if m != "housing")]))
    elements = []
    for number in range(draw(st.integers(1, 5))):
        first, second = draw(st.lists(st.sampled_from([*known, "housing"]), min_size=2, max_size=2, unique=True))
        first, second = (second, first) if first == "housing" else (first, second)
        elements.append(ShiftElement(f"E{number}", "brake" if second == "housing" else "clutch", first, second))
    return Definition("random", tuple(sets), "in", "out", tuple(elements), {})
