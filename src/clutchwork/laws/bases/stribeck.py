"""The Stribeck curve that many friction laws share, and checks that several of them need."""

from __future__ import annotations

from clutchwork.declare import Law, Points, choice, family, param

SHAPES = ("gaussian", "tustin", "lorentz", "power")
# limits that equal a value may differ from it by round-off
ROUND_OFF = 1e-12

Found = list[tuple[str, str, str]]


@family
class StribeckCurve(Law):
    """Coefficient `s(v) = kinetic + (static - kinetic) shape(v)` over abs(slip), and a viscous part beside it."""

    static: float = param("1", "coefficient at rest, at least the kinetic one", above=0.0, example=0.15)
    kinetic: float = param("1", "coefficient at high slip", at_least=0.0, example=0.1)
    speed: float = param(
        "rad/s", "slip over which it falls, the Stribeck speed", above=0.0, units=("m/s",), example=2.0
    )
    shape: str = choice(
        "of the fall, x = abs(slip)/speed: exp(-x^2), exp(-x), 1/(1 + x^2) or exp(-x^exponent)",
        choices=SHAPES,
        default="gaussian",
    )
    exponent: float = param("1", 'exponent, only with shape "power"', default=2.0, above=0.0)
    viscous: float = param(
        "s/rad",
        "viscous part, the coefficient that it adds per slip",
        default=0.0,
        at_least=0.0,
        units=("s/m",),
        example=1e-3,
    )

    def problems(self) -> Found:
        found = static_problems(self.static, self.kinetic)
        if self.shape != "power" and self.exponent != 2.0:
            fault = f"is {self.exponent:g}, but shape {self.shape!r} has no exponent"
            found.append(("exponent", fault, 'remove it, or give shape "power"'))
        return found


def static_problems(static: float, kinetic: float) -> Found:
    """A static coefficient below the kinetic one."""
    if kinetic <= static * (1 + ROUND_OFF):
        return []
    fault = f"is {static:g}, below the kinetic coefficient {kinetic:g}"
    return [("static", fault, f"raise it to at least {kinetic:g}")]


def kinetic_problems(kinetic: float) -> Found:
    """No kinetic coefficient in a law that divides by it."""
    return [] if kinetic > 0.0 else [("kinetic", "is 0, and this law divides by it", "give a coefficient > 0")]


def element_problems(elements: Points, fewest: int, most: int) -> Found:
    """Too few or too many elastic elements, or one without deflection or share."""
    if not fewest <= len(elements) <= most:
        return [("elements", f"has {len(elements)} points, must have {fewest} to {most}", "one point for each element")]
    for number, (deflection, share) in enumerate(elements, 1):
        if deflection <= 0.0 or share <= 0.0:
            fault = f"point {number} is ({deflection:g}, {share:g})"
            return [("elements", fault, "give deflections > 0 that rise, and shares > 0")]
    return []


def passivity_advice(law: StribeckCurve, damping: float, order: float = 1.0) -> Found:
    """Bristles with so much damping that they can generate energy: docs/theory/friction-laws.md (17, 23).

    Source: N. Barabanov, R. Ortega 2000, doi:10.1109/9.847131.
    """
    excess = (law.static / law.kinetic) ** order - 1.0
    if damping * excess <= law.viscous * (1 + ROUND_OFF):
        return []
    formula = "viscous/(static/kinetic - 1)" if order == 1.0 else "viscous/((static/kinetic)^order - 1)"
    message = f"is too large for passivity: it must be <= {formula} = {law.viscous / excess:g}"
    return [("damping", message, f"lower it, or raise viscous to {damping * excess:g}")]
