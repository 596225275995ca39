"""Differential with friction between its sides."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import ClassVar

from clutchwork.declare import Node, Role, component, param, port
from clutchwork.elements.bases.meshing import SLIP, Meshing


@component(Role.CONTACT, hooks=("bound",), ways=SLIP)
class LimitedSlip(Meshing):
    """Differential whose sides are coupled by `preload` and a share of the torque of its carrier.

    It is the part of `Differential` that makes its friction; use that one. Slip is left - right, its torque is that
    on the left side.
    """

    reports: ClassVar[Mapping[str, str]] = {
        "slip": "left minus right, exactly zero while it sticks",
        "torque": "of the friction, on the left side",
    }

    carrier: Node = port("carrier of the pinions, the driven side")
    left: Node = port("one side")
    right: Node = port("other side")
    preload: float = param("N m", "capacity without torque", default=0.0, at_least=0.0)
    drive: float = param(
        "1", "capacity per torque where the carrier drives forward", default=0.0, at_least=0.0, below=0.5, example=0.2
    )
    coast: float = param(
        "1", "capacity per torque where it drives backward", default=0.0, at_least=0.0, below=0.5, example=0.1
    )

    def directions(self) -> Mapping[str, Mapping[str, float]]:
        """Speed of the left side over the right one."""
        return {"slip": {"left": 1, "right": -1}}

    def rows(self) -> list[dict[str, Fraction]]:
        return [{"carrier": Fraction(2), "left": Fraction(-1), "right": Fraction(-1)}]
