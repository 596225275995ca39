"""Flanges joined to rigid nodes: a union-find in which every flange knows its offset from the root of its node.

Position of a flange = position of its node + offset. The ground is a node of its own, at position 0.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

GROUND = "ground"

# flanges of an element that move as one, with their positions relative to the first
RIGID = {"inertia", "mass", "rod", "brake", "bearing_friction", "mass_with_stop_and_friction", "rolling_resistance"}

# flanges that an element type has
TWO = ("flange_a", "flange_b")
FLANGES = {
    "fixed": ("flange",),
    "torque": ("flange", "support"),
    "torque2": TWO,
    "constant_torque": ("flange", "support"),
    "sign_torque": ("flange", "support"),
    "linear_speed_dependent_torque": ("flange", "support"),
    "quadratic_speed_dependent_torque": ("flange", "support"),
    "eddy_current_torque": ("flange", "support"),
    "speed": ("flange", "support"),
    "constant_speed": ("flange", "support"),
    "accelerate": ("flange", "support"),
    "position": ("flange", "support"),
    "rolling_resistance": ("flange", "support"),
    "brake": (*TWO, "support"),
    "bearing_friction": (*TWO, "support"),
    "ideal_gear": (*TWO, "support"),
    "lossy_gear": (*TWO, "support"),
    "ideal_planetary": ("sun", "ring", "carrier"),
    "ideal_rolling_wheel": ("flangeR", "flangeT", "supportR", "supportT"),
    "ideal_gear_r2t": ("flangeR", "flangeT", "supportR", "supportT"),
    "relative_states": TWO,
}


class Network:
    """Nodes of a case."""

    def __init__(self, elements: Mapping[str, Mapping[str, Any]], connections: Iterable[list[str]]) -> None:
        self._up: dict[str, tuple[str, float]] = {GROUND: (GROUND, 0.0)}
        joined = [tuple(pair) for pair in connections]
        used = {flange for pair in joined for flange in pair}
        for name, element in elements.items():
            for port in FLANGES.get(element["type"], TWO):
                self._up.setdefault(f"{name}.{port}", (f"{name}.{port}", 0.0))
            self._inside(name, element, used)
        for a, b in joined:
            self._join(a, b, 0.0)

    def _inside(self, name: str, element: Mapping[str, Any], used: set[str]) -> None:
        """What an element itself holds together."""
        kind = element["type"]
        if kind == "fixed":
            self._join(GROUND, f"{name}.flange", float(element.get("pos", 0.0)))
        if kind in RIGID and f"{name}.flange_b" in self._up:
            self._join(f"{name}.flange_a", f"{name}.flange_b", float(element.get("L", 0.0)))
        for port in FLANGES.get(kind, TWO):
            if port.startswith("support") and f"{name}.{port}" not in used:
                self._join(GROUND, f"{name}.{port}", 0.0)

    def _root(self, flange: str) -> tuple[str, float]:
        if flange not in self._up:
            raise KeyError(f"no flange {flange!r} in this case")
        up, offset = self._up[flange]
        if up == flange:
            return flange, 0.0
        root, rest = self._root(up)
        return root, offset + rest

    def _join(self, a: str, b: str, distance: float) -> None:
        """position(b) = position(a) + distance."""
        (root_a, off_a), (root_b, off_b) = self._root(a), self._root(b)
        if root_a == root_b:
            if abs(off_a + distance - off_b) > 1e-12:
                raise ValueError(f"{a} and {b} are held together at two different distances")
        elif root_b == GROUND:
            self._up[root_a] = (root_b, off_b - distance - off_a)
        else:
            self._up[root_b] = (root_a, off_a + distance - off_b)

    def node(self, flange: str) -> str:
        """The node of a flange."""
        return self._root(flange)[0]

    def offset(self, flange: str) -> float:
        """Position of the flange less that of its node."""
        return self._root(flange)[1]

    def nodes(self) -> list[str]:
        """All nodes but the ground, in order of first appearance."""
        return [n for n in dict.fromkeys(self.node(f) for f in self._up) if n != GROUND]
