"""Mesh of two gear wheels."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import ClassVar

from clutchwork.declare import Found, Node, Role, component, exact, numbers, param, port
from clutchwork.elements.bases.meshing import SLIP, Meshing, table_problems


@component(Role.CONTACT, hooks=("bound", "edges", "edge", "fits"), ways=SLIP)
class Mesh(Meshing):
    """Gear ratio with losses that follow the transmitted torque, with load-dependent friction that sticks exactly.

    It is the part of `LossyGear`, `LossyPlanetary` and `WormGear` that makes their friction; use those, or this one
    in elements of your own.

    Source: C. Pelchen, C. Schweiger, M. Otter, Modeling and simulating the efficiency of gearboxes and of planetary
    gearboxes, 2nd Modelica Conference, 2002.
    """

    reports: ClassVar[Mapping[str, str]] = {
        "slip": "speed of the input over the support, exactly zero while it sticks",
        "torque": "of the friction, along the slip",
    }

    input: Node = port("shaft whose speed is ratio times that of the output")
    output: Node = port("other shaft")
    support: Node | None = port("member that carries the gear and takes the reaction", default=None)
    ratio: float = param("1", "speed of the input over speed of the output, both over the support", example=2.0)
    loss_table: Sequence[Sequence[float]] = numbers(
        "1",
        "rows of speed of the input [rad/s], efficiency where the input drives, efficiency where the output drives,"
        " friction [N m] at the input of either",
        example=((0.0, 0.95, 0.94, 0.0, 0.0),),
        rows=True,
    )

    def problems(self) -> Found:
        if self.ratio == 0:
            return [("ratio", "is zero", "give a number other than zero; a fixed shaft is the housing")]
        return table_problems("loss_table", self.loss_table)

    def directions(self) -> Mapping[str, Mapping[str, float]]:
        """Speed of the input over the support."""
        return {"slip": {"input": 1, "support": -1}}

    def rows(self) -> list[dict[str, Fraction]]:
        ratio = exact(self.ratio)
        return [{"input": Fraction(1), "output": -ratio, "support": ratio - 1}]
