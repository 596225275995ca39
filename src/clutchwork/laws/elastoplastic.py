"""Elasto-plastic friction: LuGre without drift."""

from __future__ import annotations

from typing import ClassVar

from clutchwork.schema import Role, State, component, param
from clutchwork.stribeck import StribeckCurve


@component(Role.LAW, states=(State("elastic", "1", "elastic coefficient, stiffness times deflection"),))
class ElastoPlastic(StribeckCurve):
    """LuGre bristles that stay purely elastic up to a deflection, so that it does not drift.

    `d elastic/dt = stiffness slip (1 - alpha elastic sign(slip)/s(slip))`, alpha = 0 up to the deflection `elastic`, 1
    from `plastic` on. Use it for holding under vibration. It does not creep at all while the load stays below
    `stiffness elastic`.

    Source: P. Dupont, V. Hayward, B. Armstrong, F. Altpeter 2002, doi:10.1109/TAC.2002.1000274.
    """

    sticks: ClassVar[bool] = False

    stiffness: float = param("1/rad", "coefficient per deflection", above=0.0, units=("1/m",))
    damping: float = param("s/rad", "coefficient per rate of the deflection", at_least=0.0, units=("s/m",))
    elastic: float = param("rad", "deflection up to which nothing slides", above=0.0, units=("m",))
    plastic: float = param(
        "rad",
        "deflection from which all slides; 0: the steady one, s(slip)/stiffness",
        default=0.0,
        at_least=0.0,
        units=("m",),
    )
