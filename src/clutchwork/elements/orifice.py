"""Orifice that oil flows through."""

from __future__ import annotations

from clutchwork.declare import Role, SignalLike, State, component, param, signal
from clutchwork.elements.bases.oil import Opening


@component(
    Role.PROCESS, states=(State("loss", "J", "heat of the oil that went through since the start"),), hooks=("drawn",)
)
class Orifice(Opening):
    """Orifice between two pressures: turbulent, and laminar at small differences.

    With `u` the pressure at the inlet minus that at the outlet the flow is
    `discharge area sqrt(2/density) u/(u^2 + laminar^2)^(1/4)`; `laminar` is the difference at which the Reynolds number
    is `transition`, so the flow is smooth around zero. Use it for bores and leaks, with a large `transition` for
    pipes and filters.

    Source: W. Borutzky, B. Barnard, J. Thoma 2002, doi:10.1016/S1569-190X(02)00092-8.
    """

    inlet: SignalLike = signal("Pa", "pressure before it: a volume, or a number", draws=True, example=1e6)
    outlet: SignalLike = signal("Pa", "pressure behind it: a volume, or a number", default=0.0, draws=True)
    area: float = param("m2", "area of the opening", above=0.0, example=2e-6)

    def initial_states(self) -> tuple[float, ...]:
        """No heat yet."""
        return (0.0,)
