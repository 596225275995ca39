"""Gearboxes that tests change."""

from __future__ import annotations

from copy import deepcopy
from typing import Any

# the first row of a ZF 8HP with its four sets, five elements, eight gears and reverse
EIGHT_SPEED: dict[str, Any] = {
    "name": "eight-speed",
    "input": "in",
    "output": "out",
    "sets": {
        "P1": {"type": "single", "sun": "S12", "ring": "R1", "carrier": "C1R4", "teeth_sun": 48, "teeth_ring": 96},
        "P2": {"type": "single", "sun": "S12", "ring": "R2S3", "carrier": "in", "teeth_sun": 48, "teeth_ring": 96},
        "P3": {"type": "single", "sun": "R2S3", "ring": "R3S4", "carrier": "C3", "teeth_sun": 69, "teeth_ring": 111},
        "P4": {"type": "single", "sun": "R3S4", "ring": "C1R4", "carrier": "out", "teeth_sun": 28, "teeth_ring": 104},
    },
    "elements": {
        "A": ["S12", "housing"],
        "B": ["R1", "housing"],
        "C": ["in", "R3S4"],
        "D": ["C3", "out"],
        "E": ["R2S3", "R3S4"],
    },
    "gears": {
        "1": ["A", "B", "C"],
        "2": ["A", "B", "E"],
        "3": ["B", "C", "E"],
        "4": ["B", "D", "E"],
        "5": ["B", "C", "D"],
        "6": ["C", "D", "E"],
        "7": ["A", "C", "D"],
        "8": ["A", "D", "E"],
        "R": ["A", "B", "D"],
    },
    "published": {"1": 4.714, "8": 0.667, "R": -3.317},
}

# one set with its ring held: the simplest reduction
REDUCTION: dict[str, Any] = {
    "name": "reduction",
    "input": "sun",
    "output": "carrier",
    "sets": {
        "P": {"type": "single", "sun": "sun", "ring": "ring", "carrier": "carrier", "teeth_sun": 30, "teeth_ring": 70}
    },
    "elements": {"B": ["ring", "housing"], "K": ["sun", "carrier"]},
    "gears": {"1": ["B"], "2": ["K"]},
}


def changed(box: dict[str, Any], **paths: Any) -> dict[str, Any]:
    """A copy with other values, by keys joined by two underscores; None takes a key out."""
    made = deepcopy(box)
    for path, value in paths.items():
        *way, last = path.split("__")
        table = made
        for key in way:
            table = table.setdefault(key, {})
        if value is None:
            table.pop(last)
        else:
            table[last] = value
    return made
