"""Leuven friction: hysteresis with non-local memory."""

from __future__ import annotations

from typing import ClassVar

from clutchwork.declare import Points, Role, State, component, curve, param
from clutchwork.laws.bases.stribeck import Found, StribeckCurve, element_problems, kinetic_problems, passivity_advice

LARGEST = 10


@component(
    Role.LAW,
    states=tuple(State(f"element_{i}", "1", f"coefficient of element {i}", span=1e-5) for i in range(1, LARGEST + 1)),
    hooks=("margin", "cross", "turns", "runs_on", "count"),
)
class Leuven(StribeckCurve):
    """Hysteresis force `h` with non-local memory, the sum of elastic elements that saturate one after the other.

    The deflection follows `dz/dt = slip (1 - sign(slip h) abs(h/s(slip))^order)`; element i has the stiffness
    `share static/deflection` and saturates at `share static`. The coefficient is `h + damping dz/dt + viscous slip`.
    Use it for pre-sliding where loops within loops must close. One law in both regimes: for a lag in sliding as well
    take `GMS`.

    Source: J. Swevers, F. Al-Bender, C. Ganseman, T. Prajogo 2000, doi:10.1109/9.847103, in the Maxwell-slip form of
    V. Lampaert, J. Swevers, F. Al-Bender 2002, doi:10.1109/9.995050.
    """

    sticks: ClassVar[bool] = False

    elements: Points = curve(
        "rad",
        "1",
        "elements, 1 to 10: deflection at break-away, share of the static coefficient; shares sum to 1 or more",
        units_x=("m",),
        example=((2e-5, 0.1), (5e-5, 0.2), (1e-4, 0.3), (2e-4, 0.4)),
    )
    order: float = param(
        "1", "how sharply deflection turns into sliding; low orders creep as LuGre", default=20.0, above=0.0
    )
    damping: float = param("s/rad", "coefficient per rate of the deflection", default=0.0, at_least=0.0, units=("s/m",))

    @property
    def steep(self) -> str:
        """With an order below 1 the rate of the deflection is as steep as you like next to zero."""
        return (
            f"order = {self.order:g} is below 1, so its rate has no derivative at no deflection"
            if self.order < 1
            else ""
        )

    def own_states(self) -> tuple[State, ...]:
        """One state for each element."""
        return self.states[: len(self.elements)]

    def problems(self) -> Found:
        found = super().problems() + kinetic_problems(self.kinetic)
        found = found or element_problems(self.elements, 1, LARGEST)
        total = sum(share for _, share in self.elements)
        if not found and total < 1.0 - 1e-9:
            fault = f"has shares that sum to {total:g}, must be >= 1, or it never slides"
            found.append(("elements", fault, "raise the shares"))
        return found

    def advice(self) -> Found:
        return passivity_advice(self, self.damping, self.order)
