"""LuGre friction: bristles with stiffness and damping."""

from __future__ import annotations

from typing import ClassVar

from clutchwork.declare import Role, State, component, param
from clutchwork.laws.bases.stribeck import Found, StribeckCurve, kinetic_problems, passivity_advice


@component(Role.LAW, states=(State("elastic", "1", "elastic coefficient, stiffness times deflection", span=1e-5),))
class LuGre(StribeckCurve):
    """Bristles that bend: `d elastic/dt = stiffness (slip - abs(slip) elastic/s(slip))`.

    The coefficient is `elastic + damping (d elastic/dt)/stiffness + viscous slip`. Use it for frictional lag, varying
    break-away and stick-slip under control. It drifts under a load that oscillates below break-away; `ElastoPlastic`,
    `Leuven` and `GMS` do not.

    Source: C. Canudas de Wit, H. Olsson, K. J. Åström, P. Lischinsky 1995, doi:10.1109/9.376053.
    """

    sticks: ClassVar[bool] = False

    stiffness: float = param("1/rad", "coefficient per deflection", above=0.0, units=("1/m",), example=1e3)
    damping: float = param(
        "s/rad", "coefficient per rate of the deflection", at_least=0.0, units=("s/m",), example=1e-3
    )

    def problems(self) -> Found:
        return super().problems() + kinetic_problems(self.kinetic)

    def advice(self) -> Found:
        return passivity_advice(self, self.damping)
