"""Generalised Maxwell-slip friction."""

from __future__ import annotations

from typing import ClassVar

from clutchwork.declare import Points, Role, State, component, curve, param
from clutchwork.laws.bases.stribeck import Found, StribeckCurve, element_problems, kinetic_problems

FEWEST, LARGEST = 4, 10


@component(
    Role.LAW,
    states=tuple(State(f"element_{i}", "1", f"coefficient of element {i}", span=1e-5) for i in range(1, LARGEST + 1)),
    hooks=("margin", "cross", "turns", "runs_on", "count"),
)
class GMS(StribeckCurve):
    """Elastic elements in parallel, each of which sticks or slides on its own share of the Stribeck curve.

    An element that sticks has the stiffness `share static/deflection` and the damping `share damping`, and breaks away
    at `share s(slip)`; while it slides its coefficient is drawn to there at the rate `attraction`. The coefficient is
    the sum, plus `viscous slip`. Use it where both count: hysteresis with non-local memory before sliding, and
    frictional lag in sliding. It does not drift.

    Source: F. Al-Bender, V. Lampaert, J. Swevers 2005, doi:10.1109/TAC.2005.858676.
    """

    sticks: ClassVar[bool] = False

    elements: Points = curve(
        "rad",
        "1",
        "elements, 4 to 10: deflection at break-away, share of the coefficient; shares sum to 1",
        units_x=("m",),
        example=((2e-5, 0.1), (5e-5, 0.2), (1e-4, 0.3), (2e-4, 0.4)),
    )
    attraction: float = param("1/s", "rate at which a sliding element nears the curve", default=100.0, above=0.0)
    damping: float = param(
        "s/rad",
        "coefficient per rate of the deflection while all elements stick; without any a held contact rings for long",
        default=0.0,
        at_least=0.0,
        units=("s/m",),
    )

    def own_states(self) -> tuple[State, ...]:
        """One state for each element."""
        return self.states[: len(self.elements)]

    def problems(self) -> Found:
        found = super().problems() + kinetic_problems(self.kinetic)
        found = found or element_problems(self.elements, FEWEST, LARGEST)
        total = sum(share for _, share in self.elements)
        if not found and abs(total - 1.0) > 1e-9:
            found.append(("elements", f"has shares that sum to {total:.10g}, must be 1", "divide each by the sum"))
        return found
