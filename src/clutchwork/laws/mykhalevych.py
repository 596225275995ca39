"""Mykhalevych's friction: a wind-up angle that is limited."""

from __future__ import annotations

from math import exp, tanh
from typing import ClassVar

from clutchwork.declare import Law, Role, State, choice, component, flag, param, say
from clutchwork.laws.bases.stribeck import Found, static_problems

# least inner friction over 1 - kinetic/static: largest (1 - exp(-x^2))/x, and that over the slope of tanh at 1
AT_REST, AT_THE_ANGLE = 0.638, 1.52


@component(
    Role.LAW,
    states=(State("wind_up", "1", "wind-up over the elastic angle", span=1e-5),),
    hooks=("margin", "cross", "turns"),
)
class Mykhalevych(Law):
    """Elastic wind-up under a hyperbolic tangent, and a Stribeck fall beside it.

    Coefficient `static tanh(q) - sign(slip) (static - kinetic) (1 - exp(-(slip/speed)^2))` with
    `q = wind_up + viscous slip/speed`; the wind-up follows the slip within a range. Use it for elastic pre-sliding
    without drift with few parameters. It needs enough `viscous` to dissipate; `passive` does so with any: its
    coefficient is `(kinetic + (static - kinetic) exp(-(slip/speed)^2)) tanh(q)`.

    Equations: docs/theory/friction-laws.md.
    """

    sticks: ClassVar[bool] = False

    static: float = param("1", "coefficient at rest, at least the kinetic one", above=0.0, example=0.15)
    kinetic: float = param("1", "coefficient at high slip", at_least=0.0, example=0.1)
    elastic: float = param(
        "rad", "angle over which the contact is elastic, the unit of the wind-up", above=0.0, units=("m",), example=1e-4
    )
    speed: float = param("rad/s", "slip that divides static from kinetic", above=0.0, units=("m/s",), example=2.0)
    viscous: float = param("1", "inner friction, against the slip over `speed`", at_least=0.0, example=1.0)
    reset: str = choice(
        "how the wind-up is limited: within plus and minus `range`; clipped to 1 when the slip passes through zero; set"
        " to 1 whenever it does, as printed, which ratchets",
        choices=("saturate", "clip", "literal"),
        default="saturate",
    )
    range: float = param("1", 'largest wind-up over `elastic`, of reset "saturate"', default=3.0, above=0.0)
    passive: bool = flag(
        "multiply tanh by the Stribeck curve instead, which dissipates in every swing at like speeds", default=False
    )

    def problems(self) -> Found:
        found = static_problems(self.static, self.kinetic)
        if self.reset != "saturate" and self.range != 3.0:
            fault = f"is {self.range:g}, but reset {self.reset!r} has no range"
            found.append(("range", fault, 'remove it, or give reset "saturate"'))
        return found

    def advice(self) -> Found:
        if self.passive:
            return []
        found, fall = list[tuple[str, str, str]](), 1.0 - self.kinetic / self.static
        passive = say("passive = true", "passive=True")
        driving = self._driving() if self.reset == "saturate" else None
        if driving is not None:
            message = f"is too small: fully wound up, the coefficient is below zero from a slip of {driving:g} rad/s on"
            found.append(("range", message, f"raise it, or viscous, or kinetic; or give {passive}"))
        if self.viscous < AT_THE_ANGLE * fall:
            message = (
                "is too small to be dissipative: it must be >= 1.52 (1 - kinetic/static)"
                f" = {AT_THE_ANGLE * fall:g} around the elastic angle, and >= {AT_REST * fall:g} at rest"
            )
            found.append(("viscous", message, f"raise it, or give {passive}"))
        return found

    def _driving(self) -> float | None:
        """The slip [rad/s] at which the coefficient of a contact that is fully wound up turns negative, if it does."""
        # beyond 8 speeds nothing is left of the fall, and what is viscous only grows
        for x in (0.01 * number for number in range(1, 801)):
            wound = self.static * tanh(self.range + self.viscous * x)
            if wound - (self.static - self.kinetic) * (1.0 - exp(-x * x)) < -1e-9 * self.static:
                return x * self.speed
        return None
