"""What the contacts in gear meshes have in common, whose friction follows the torque that the mesh transmits."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from itertools import pairwise
from math import atan, cos, pi, tan
from typing import Any, ClassVar

from clutchwork.declare import Found, Law, Way, family, numbers, option, param
from clutchwork.elements.bases.contacts import Sticking
from clutchwork.laws.coulomb import Coulomb

# the one direction of such a contact
SLIP = (Way("slip", "speed along which the friction acts"),)
# speed, efficiency of either direction, friction of either direction
COLUMNS = ("speed", "forward efficiency", "backward efficiency", "forward friction", "backward friction")


@family
class Meshing(Sticking):
    """A gear row with friction: its capacity follows the torque of the row."""

    # slides with the capacity itself
    friction: ClassVar[Law] = Coulomb(static=1.0, kinetic=1.0)  # type: ignore[misc]

    def rows(self) -> list[dict[str, Fraction]]:
        """Coefficients of the speeds whose sum is zero; the torque of the first row is the load."""
        raise NotImplementedError


def table_problems(name: str, rows: Sequence[Sequence[float]]) -> Found:
    """Rows of a loss table that are none, or that make a gear drive."""
    for number, row in enumerate(rows, 1):
        if not hasattr(row, "__len__") or len(row) != len(COLUMNS):
            return [(name, f"has a row {number} of other than five numbers", f"give {', '.join(COLUMNS)}")]
        _, forward, backward, *friction = (float(x) for x in row)
        if not 0.0 < forward <= 1.0:
            return [(name, f"has the forward efficiency {forward:g} in row {number}", "give one above 0, at most 1")]
        if backward > 1.0:
            return [(name, f"has the backward efficiency {backward:g} in row {number}", "give one of at most 1")]
        if min(friction) < 0.0:
            return [(name, f"has a friction torque below zero in row {number}", "give sizes")]
        if backward <= 0.0 and friction[1] > 0.0:
            remedy = "give the friction by a `BearingFriction` beside it"
            return [(name, f"has friction beside the backward efficiency {backward:g} in row {number}", remedy)]
    speeds = [float(row[0]) for row in rows]
    if speeds[0] < 0.0 or any(b <= a for a, b in pairwise(speeds)):
        return [(name, "has speeds that do not rise from 0 or above", "sort its rows by speed")]
    return []


@family
class Lossy(Sticking):
    """A gear whose users give its losses by efficiencies or by a table."""

    efficiency: float | None = param(
        "1", "output over input power where the input drives", default=None, above=0.0, at_most=1.0
    )
    backward_efficiency: float | None = param(
        "1",
        "the same where the output drives, `efficiency` by default; below 0 self-locking",
        default=None,
        at_most=1.0,
    )
    bearing_torque: float = param("N m", "friction at the input, without load too", default=0.0, at_least=0.0)
    loss_table: Sequence[Sequence[float]] | None = numbers(
        "1",
        "rows of speed of the input [rad/s], efficiency where the input drives, efficiency where the output drives,"
        " friction [N m] at the input of either",
        default=None,
        rows=True,
    )
    tolerance: float = option(
        "rad/s", "slip below which it may lock; 0: at exactly zero", default=0.0, at_least=0.0, last=1
    )

    def loss_problems(self) -> Found:
        """Losses that are given twice, or that make a gear drive."""
        plain = self.efficiency is not None or self.backward_efficiency is not None or self.bearing_torque
        if self.loss_table is not None and plain:
            return [("loss_table", "cannot be given together with efficiencies", "give one of the two")]
        return table_problems("loss_table" if self.loss_table else "backward_efficiency", self.loss_rows())

    def heat_problems(self) -> Found:
        """A thermal node without losses to warm it, which is left out then."""
        if self.heat is None or self.is_lossy():
            return []
        return [("heat", "is given without losses", "give an efficiency, or leave out `heat`")]

    def is_lossy(self) -> bool:
        """Whether it loses anything."""
        return any(tuple(row)[1:] != (1.0, 1.0, 0.0, 0.0) for row in self.loss_rows())

    def loss_rows(self) -> Sequence[Sequence[float]]:
        """The loss table."""
        if self.loss_table is not None:
            return self.loss_table
        ahead = 1.0 if self.efficiency is None else self.efficiency
        back = ahead if self.backward_efficiency is None else self.backward_efficiency
        return ((0.0, ahead, back, self.bearing_torque, self.bearing_torque),)

    def mesh(self) -> dict[str, Any]:
        """What the contact in its mesh has of it."""
        return {"loss_table": self.loss_rows(), **self.sticking()}


def screw_efficiencies(lead_angle: float, coefficient: float, normal_angle: float) -> tuple[float, float]:
    """Efficiency where the screw drives and where it is driven, by lead angle, friction and normal angle [rad].

    docs/theory/load-dependent.md (4)
    """
    rho = atan(coefficient / cos(normal_angle))
    return tan(lead_angle) / tan(lead_angle + rho), tan(lead_angle - rho) / tan(lead_angle)


def screw_problems(lead_angle: float, coefficient: float, normal_angle: float) -> Found:
    """Friction that holds a screw both ways."""
    rho = atan(coefficient / cos(normal_angle))
    if lead_angle + rho < pi / 2:
        return []
    fault = f"is {coefficient:g}: the screw cannot drive at the lead angle {lead_angle:.3g} rad"
    return [("friction_coefficient", fault, "give less friction or a smaller lead angle")]
