"""Mesh of a wheel and a rack, of a screw and its nut."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import ClassVar

from clutchwork.declare import Found, Node, Role, component, exact, numbers, param, port
from clutchwork.elements.bases.meshing import SLIP, Meshing, table_problems


@component(Role.CONTACT, hooks=("bound", "edges", "edge", "fits"), ways=SLIP)
class RackMesh(Meshing):
    """Mesh between a shaft and a mass with losses that follow the transmitted torque; it sticks exactly.

    It is the part of `Leadscrew` and of `RackPinion` that makes their friction; use those, or this one for a rack
    by its radius alone. Speed of the mass = radius times speed of the shaft relative to the support.
    """

    reports: ClassVar[Mapping[str, str]] = {
        "slip": "speed of the shaft over the support, exactly zero while it sticks",
        "torque": "of the friction, along the slip",
    }

    shaft: Node = port("shaft of the wheel or screw", domain="rotation")
    mass: Node = port("mass that it moves", domain="translation")
    support: Node | None = port("member that carries the shaft and takes its reaction", default=None, domain="rotation")
    radius: float = param("m", "travel of the mass per angle of the shaft", above=0.0)
    loss_table: Sequence[Sequence[float]] = numbers(
        "1",
        "rows of speed of the shaft [rad/s], efficiency where the shaft drives, efficiency where the mass drives,"
        " friction [N m] at the shaft of either",
        example=((0.0, 0.95, 0.94, 0.0, 0.0),),
        rows=True,
    )

    def problems(self) -> Found:
        return table_problems("loss_table", self.loss_table)

    def directions(self) -> Mapping[str, Mapping[str, float]]:
        """Speed of the shaft over the support."""
        return {"slip": {"shaft": 1, "support": -1}}

    def rows(self) -> list[dict[str, Fraction]]:
        return [{"shaft": Fraction(1), "mass": -1 / exact(self.radius), "support": Fraction(-1)}]
