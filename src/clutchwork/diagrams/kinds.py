"""Kinds of diagrams of a gearbox."""

from __future__ import annotations

KINDS = {
    "stick": "half section with the lines of all members",
    "axes": "parallel axes: shafts as lines with their wheels, of gearboxes of gear pairs alone",
    "lever": "a lever for each gear set, its members at distances by the teeth",
    "speeds": "speed plan after Kutzbach: members at distances by the teeth, a straight line for each gear",
    "chart": "bars of the speed of every member in every gear",
}
