"""Colours and lines of schematics: apart for every eye, and in black and white."""

from __future__ import annotations

from typing import NamedTuple


class MarkStyle(NamedTuple):
    """How a mark is drawn."""

    colour: str = "#1A1A1A"
    width: float = 1.0  # pt
    fill: str = ""  # of an area
    dash: str = "solid"


INK = MarkStyle()
THIN = MarkStyle(width=0.6)
SHAFT = MarkStyle(width=1.4)
PLATE = MarkStyle(width=2.2)
BODY = MarkStyle(fill="#DDE3EA", width=1.0)
BLANK = MarkStyle(fill="#FFFFFF", width=1.0)
PAPER = "#FFFFFF"
GREY = "#5A5A5A"
MASS = MarkStyle(colour="#0B5D46", width=1.4)
HEAT = MarkStyle(colour="#B3261E", width=1.0, dash="dash")
WARM = MarkStyle(colour="#B3261E", width=1.0)
SIGNAL = MarkStyle(colour="#6A3D9A", width=0.9, dash="dot")
SIGNAL_BODY = MarkStyle(colour="#6A3D9A", width=0.9)
OIL = MarkStyle(colour="#6A3D9A", width=1.4)
WRONG = MarkStyle(colour="#C2185B", width=1.0, dash="dash")

LOCKED, SLIPPING, OPEN = "locked", "slipping", "open"
STATES = (LOCKED, SLIPPING, OPEN)
# lines of a contact by its state, and the ground behind it
STATE = {
    "": INK,
    LOCKED: MarkStyle(colour="#00497A"),
    SLIPPING: MarkStyle(colour="#C04A00"),
    OPEN: MarkStyle(colour="#8A8A8A"),
}
HALO = {LOCKED: "#CFE6F7", SLIPPING: "#FCE4D0"}

NAME, VALUE, TINY = 7.5, 6.8, 5.2  # sizes of text [pt]
LINE = 8.6  # pt from line to line
