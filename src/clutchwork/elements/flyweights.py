"""Flyweights on a shaft."""

from __future__ import annotations

from clutchwork.declare import Component, Role, SignalLike, State, component, option, param, signal


@component(Role.PROCESS, states=(State("force", "N", "force outwards; below zero: the springs hold the masses"),))
class Flyweights(Component):
    """Force `mass radius (speed^2 - onset^2)` of masses on a shaft, which follows with a small lag.

    Use it as the `normal_force` of a contact that closes with the speed; `CentrifugalClutch` holds one.
    """

    mass: float = param("kg", "mass of each weight", above=0.0)
    radius: float = param("m", "distance of its centre of mass from the axis", above=0.0)
    onset: float = param("rad/s", "speed at which it leaves its spring", default=0.0, at_least=0.0)
    lag: float = param("s", "time constant of its motion outwards", default=5e-3, above=0.0)
    speed: SignalLike = signal("rad/s", "shaft that rotates it, or a speed")
    initial_force: float = option("N", "force at the start", default=0.0)

    def initial_states(self) -> tuple[float, ...]:
        """Force at the start [N]."""
        return (self.initial_force,)
