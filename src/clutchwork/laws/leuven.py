"""Leuven friction: hysteresis with non-local memory."""

from __future__ import annotations

from typing import ClassVar

from clutchwork.node import Points
from clutchwork.schema import Role, State, component, curve, param
from clutchwork.stribeck import StribeckCurve

LARGEST = 10


@component(
    Role.LAW,
    states=tuple(State(f"element_{i}", "1", f"coefficient of element {i}") for i in range(1, LARGEST + 1)),
)
class Leuven(StribeckCurve):
    """Hysteresis force `h` with non-local memory, the sum of elastic elements that saturate one after the other.

    The deflection follows `dz/dt = slip (1 - sign(slip h) abs(h/s(slip))^order)`; element i has the stiffness
    `share static/deflection` and saturates at `share static`. The coefficient is `h + damping dz/dt + viscous slip`.
    Use it for pre-sliding where loops within loops must close. One law in both regimes: for a lag in sliding as well
    take `GMS`.

    Source: J. Swevers, F. Al-Bender, C. Ganseman, T. Prajogo 2000, doi:10.1109/9.847103, in the Maxwell-slip form of
    V. Lampaert, J. Swevers, F. Al-Bender 2002, doi:10.1109/TAC.2002.1000282.
    """

    sticks: ClassVar[bool] = False

    elements: Points = curve(
        "rad", "1", "up to 10 elements: deflection at break-away, share of the static coefficient", units_x=("m",)
    )
    order: float = param("1", "how sharply deflection turns into sliding", default=1.0, above=0.0)
    damping: float = param("s/rad", "coefficient per rate of the deflection", default=0.0, at_least=0.0, units=("s/m",))

    def own_states(self) -> tuple[State, ...]:
        """One state for each element."""
        return self.states[: len(self.elements)]
