"""Dahl's friction with elastic deflection before sliding."""

from __future__ import annotations

from typing import ClassVar

from clutchwork.declare import Law, Role, State, component, param

# nothing damps the ring of its bristles, which would hold the steps at a fraction of its period for long
RING = 1e-3


@component(
    Role.LAW, states=(State("elastic", "1", "elastic coefficient", span=RING),), hooks=("margin", "cross", "turns")
)
class Dahl(Law):
    """Elastic deflection that turns into sliding: `d elastic/dt = stiffness slip abs(1 - x)^exponent sign(1 - x)`.

    With `x = elastic sign(slip)/kinetic`; the coefficient is `elastic`. With an exponent below 1 it is full within a
    finite slip and stays so until the slip turns. Use it for hysteresis that does not depend on
    the rate, such as in rolling bearings. It has no static coefficient, and it drifts under an oscillating load.

    Source: P. R. Dahl 1976, doi:10.2514/3.61511.
    """

    sticks: ClassVar[bool] = False

    kinetic: float = param("1", "coefficient while it slides", above=0.0, example=0.1)
    stiffness: float = param("1/rad", "coefficient per deflection at rest", above=0.0, units=("1/m",), example=1e3)
    exponent: float = param("1", "shape of the hysteresis, 1 in most uses", default=1.0, above=0.0)
