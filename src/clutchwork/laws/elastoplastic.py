"""Elasto-plastic friction: LuGre without drift."""

from __future__ import annotations

from typing import ClassVar

from clutchwork.declare import Role, State, component, param
from clutchwork.laws.bases.stribeck import ROUND_OFF, Found, StribeckCurve, kinetic_problems, passivity_advice


@component(Role.LAW, states=(State("elastic", "1", "elastic coefficient, stiffness times deflection", span=1e-5),))
class ElastoPlastic(StribeckCurve):
    """LuGre bristles that stay purely elastic up to a deflection, so that it does not drift.

    `d elastic/dt = stiffness slip (1 - alpha elastic sign(slip)/s(slip))`, alpha = 0 up to the deflection `elastic`, 1
    from `plastic` on. Use it for holding under vibration. It does not creep at all while the load stays below
    `stiffness elastic`.

    Source: P. Dupont, V. Hayward, B. Armstrong, F. Altpeter 2002, doi:10.1109/TAC.2002.1000274.
    """

    sticks: ClassVar[bool] = False

    stiffness: float = param("1/rad", "coefficient per deflection", above=0.0, units=("1/m",), example=1e3)
    damping: float = param(
        "s/rad", "coefficient per rate of the deflection", at_least=0.0, units=("s/m",), example=1e-3
    )
    elastic: float = param("rad", "deflection up to which nothing slides", above=0.0, units=("m",), example=7e-5)
    plastic: float = param(
        "rad",
        "deflection from which all slides; 0: the steady one, s(slip)/stiffness",
        default=0.0,
        at_least=0.0,
        units=("m",),
    )

    def problems(self) -> Found:
        found = super().problems() + kinetic_problems(self.kinetic)
        return found or self._deflection_problems()

    def _deflection_problems(self) -> Found:
        """Deflections that do not rise from elastic over plastic to the smallest steady one."""
        steady = self.kinetic / self.stiffness
        if self.elastic >= (self.plastic or steady):
            upper = f"plastic = {self.plastic:g}" if self.plastic else f"kinetic/stiffness = {steady:g}"
            return [("elastic", f"is {self.elastic:g}, not below {upper}", "lower it; 0.7 kinetic/stiffness is common")]
        if self.plastic > steady * (1 + ROUND_OFF):
            fault = f"is {self.plastic:g}, above the steady deflection kinetic/stiffness = {steady:g}"
            return [("plastic", fault, "lower it, or remove it")]
        return []

    def advice(self) -> Found:
        return passivity_advice(self, self.damping)
