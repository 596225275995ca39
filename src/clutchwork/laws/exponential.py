"""Coefficient that falls exponentially with slip."""

from __future__ import annotations

from clutchwork.declare import Law, Role, component, param


@component(Role.LAW)
class Exponential(Law):
    """Kinetic coefficient `fast + (slow - fast) exp(-abs(slip)/speed)`, static coefficient at rest.

    Use it for paper linings whose coefficient settles with slip.
    """

    static: float = param("1", "coefficient at rest", above=0.0, example=0.15)
    slow: float = param(
        "1", "kinetic coefficient at vanishing slip, at most the static one", at_least=0.0, example=0.14
    )
    fast: float = param("1", "kinetic coefficient at high slip", at_least=0.0, example=0.1)
    speed: float = param(
        "rad/s", "slip over which the difference falls to 1/e", above=0.0, units=("m/s",), example=10.0
    )

    def sliding(self) -> float:
        return self.slow
