"""Gearboxes for tests: all of the catalogue, and small ones with kinds of sets that are rare there."""

from __future__ import annotations

from functools import cache
from typing import Any

import clutchwork as cw

AODE: dict[str, Any] = {
    "name": "four speeds",
    "input": "in",
    "output": "ring",
    "sets": {
        "P1": {
            "type": "ravigneaux",
            "small_sun": "S1",
            "large_sun": "S2",
            "ring": "ring",
            "carrier": "C",
            "teeth_small_sun": 30,
            "teeth_large_sun": 36,
            "teeth_ring": 72,
        }
    },
    "elements": {
        "forward": ["in", "S1"],
        "reverse": ["in", "S2"],
        "low": ["C", "housing"],
        "overdrive": ["S2", "housing"],
        "direct": ["in", "C"],
    },
    "gears": {
        "1": ["forward", "low"],
        "2": ["forward", "overdrive"],
        "3": ["forward", "direct"],
        "4": ["direct", "overdrive"],
        "R": ["reverse", "low"],
    },
}
# stepped planets with two suns, of which one is held, and a pair of gears behind
TWO_SUNS: dict[str, Any] = {
    "name": "two suns",
    "input": "carrier",
    "output": "shaft",
    "sets": {
        "P1": {
            "type": "two_suns",
            "sun": "S1",
            "second_sun": "S2",
            "carrier": "carrier",
            "teeth_sun": 33,
            "teeth_second_sun": 27,
            "teeth_planet_sun": 24,
            "teeth_planet_second_sun": 30,
        },
        "Z": {"type": "gear", "first": "S2", "second": "shaft", "teeth_first": 31, "teeth_second": 47},
    },
    "elements": {"B": ["S1", "housing"], "K": ["carrier", "S2"]},
    "gears": {"1": ["B"], "2": ["K"]},
}
TWO_RINGS: dict[str, Any] = {
    "name": "two rings",
    "input": "carrier",
    "output": "R2",
    "sets": {
        "P1": {
            "type": "two_rings",
            "ring": "R1",
            "second_ring": "R2",
            "carrier": "carrier",
            "teeth_ring": 71,
            "teeth_second_ring": 68,
            "teeth_planet_ring": 20,
            "teeth_planet_second_ring": 19,
        },
    },
    "elements": {"B": ["R1", "housing"], "K": ["carrier", "R1"]},
    "gears": {"1": ["B"], "2": ["K"]},
}
# a stepped and a double set, a freewheel and a dog clutch
MIXED: dict[str, Any] = {
    "name": "mixed",
    "input": "in",
    "output": "out",
    "sets": {
        "P1": {
            "type": "stepped",
            "sun": "in",
            "ring": "R1",
            "carrier": "C1",
            "teeth_sun": 24,
            "teeth_ring": 78,
            "teeth_planet_sun": 30,
            "teeth_planet_ring": 24,
        },
        "P2": {
            "type": "double",
            "sun": "C1",
            "ring": "out",
            "carrier": "C2",
            "teeth_sun": 30,
            "teeth_ring": 74,
        },
    },
    "elements": {
        "F": {"type": "freewheel", "members": ["housing", "R1"]},
        "K": ["in", "R1"],
        "B": ["C2", "housing"],
        "D": {"type": "dog", "members": ["C1", "C2"]},
    },
    "gears": {"1": ["F", "B"], "2": ["K", "B"], "3": ["F", "D"]},
}
SMALL = {data["name"]: data for data in (AODE, TWO_SUNS, TWO_RINGS, MIXED)}


@cache
def boxes() -> dict[str, cw.Gearbox]:
    """All of them by name, but those with synchronisers, whose teeth have play."""
    known = {name: box for name, box in cw.catalogue().items() if "synchroniser" not in {e.kind for e in box.elements}}
    return {**{name: cw.Gearbox.from_dict(data) for name, data in SMALL.items()}, **known}


def in_gear(box: Any, gear: str, **values: Any) -> cw.Driveline:
    """A gearbox in a gear between an engine that turns with 100 rad/s and 100 N m, and a load that balances it."""
    state = box.state(gear)
    d = cw.Driveline(f"{box.name} {gear}")
    engine, wheels = d.shaft("engine", inertia=0.1, speed=100.0), d.shaft("wheels", inertia=2.0)
    d.add(cw.Transmission("gearbox", gearbox=box, input=engine, output=wheels, gear=gear, **values))
    d.add(cw.Torque("drive", shaft=engine, torque=100.0))
    d.add(cw.Torque("load", shaft=wheels, torque=100.0 * state.load))
    return d
