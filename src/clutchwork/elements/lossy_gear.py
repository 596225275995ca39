"""Gear with losses."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from clutchwork.declare import Component, Found, Role, component
from clutchwork.elements.bases.meshing import Lossy
from clutchwork.elements.bases.teeth import WheelPair
from clutchwork.elements.mesh import Mesh


@component(Role.COMPOSITE)
class LossyGear(WheelPair, Lossy):
    """Gear with an efficiency for each direction of power, and load-dependent friction that sticks exactly.

    Use it for spur, helical and bevel gears, chains and hypoid drives where losses count. With T the torque into the
    input, the output has `ratio (T - loss)`; the loss is `(1 - efficiency) T` where the input drives,
    `(1/backward - 1) |T|` where the output does, and anything in between at rest. A loss table gives both and a
    friction torque over the speed of the input, linear between its rows and beyond, as long as a loss stays a loss.
    The sign of T is an event, and so are the rows.

    Source: C. Pelchen, C. Schweiger, M. Otter, Modeling and simulating the efficiency of gearboxes and of planetary
    gearboxes, 2nd Modelica Conference, 2002.
    """

    def problems(self) -> Found:
        return super().problems() or self.loss_problems()

    def parts(self) -> Iterable[Component]:
        """The mesh with its friction."""
        ends: dict[str, Any] = {"input": self.input, "output": self.output, "support": self.support}
        return (Mesh(self.name, ratio=float(self.exact_ratio()), **ends, **self.mesh()),)
