"""Gear with losses."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from clutchwork.declare import Component, Found, Node, Role, component, param, port
from clutchwork.elements.bases.meshing import Lossy
from clutchwork.elements.mesh import Mesh


@component(Role.COMPOSITE)
class LossyGear(Lossy):
    """Gear with an efficiency for either direction of power, and friction; it sticks exactly, by load.

    Use it for spur, helical and bevel gears, chains and hypoid drives where losses count. With T the torque into the
    input, the output has `ratio (T - loss)`; the loss is `(1 - efficiency) T` where the input drives,
    `(1/backward - 1) |T|` where the output does, and anything in between at rest. A loss table gives both and a
    friction torque over the speed of the input, linear between its rows and beyond. The sign of T is an event, and
    so are the rows.

    Source: C. Pelchen, C. Schweiger, M. Otter, Modeling and simulating the efficiency of gearboxes and of planetary
    gearboxes, 2nd Modelica Conference, 2002.
    """

    input: Node = port("shaft whose speed is ratio times that of the output")
    output: Node = port("other shaft")
    support: Node | None = port("member that carries the gear and takes the reaction", default=None)
    ratio: float | None = param("1", "speed of the input over speed of the output", default=None)
    teeth_input: int | None = param("1", "teeth of the input wheel, negative if internal", default=None, whole=True)
    teeth_output: int | None = param("1", "teeth of the output wheel, negative if internal", default=None, whole=True)

    def problems(self) -> Found:
        """What the bounds of single values cannot say, as (quantity, what is wrong, remedy)."""
        wheels = self.teeth_input, self.teeth_output
        if self.ratio is None and None in wheels:
            return [("ratio", "is missing", "give `ratio`, or both `teeth_input` and `teeth_output`")]
        if self.ratio is not None and wheels != (None, None):
            return [("ratio", "is given twice, as a number and by teeth", "give only one of the two")]
        zero = [name for name in ("ratio", "teeth_input", "teeth_output") if getattr(self, name) == 0]
        found = [(name, "is zero", "give a number other than zero; a fixed shaft is the housing") for name in zero]
        return found or self.loss_problems()

    def parts(self) -> Iterable[Component]:
        """The mesh with its friction."""
        ratio = self.ratio if self.ratio is not None else -(self.teeth_output or 0) / (self.teeth_input or 1)
        ends: dict[str, Any] = {"input": self.input, "output": self.output, "support": self.support}
        return (Mesh(self.name, ratio=ratio, **ends, **self.mesh()),)
