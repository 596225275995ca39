"""Wear of a friction lining."""

from __future__ import annotations

from clutchwork.declare import Component, Role, SignalLike, State, component, param, signal


@component(Role.PROCESS, states=(State("depth", "m", "depth of wear"),))
class Wear(Component):
    """Depth of wear that grows with the energy of sliding: `d depth/dt = rate heat/area`.

    Use it with `heat = HeatFlow(contact)` where a contact should wear within a run; `DiskClutch` holds one when it has
    a `wear_rate`. The worn volume is `rate` times the energy, which is Archard's law at a constant coefficient.

    Source: J. F. Archard 1953, doi:10.1063/1.1721448.
    """

    rate: float = param("m3/J", "worn volume per sliding energy", above=0.0)
    area: float = param("m2", "area that wears, of all surfaces", above=0.0)
    initial_depth: float = param("m", "depth at the start", default=0.0, at_least=0.0)
    heat: SignalLike = signal("W", "power of sliding, as `HeatFlow(contact)`")

    def initial_states(self) -> tuple[float, ...]:
        """Depth at the start [m]."""
        return (self.initial_depth,)

    def state_scales(self) -> tuple[float, ...]:
        """The solver follows the energy: depth per joule [m/J]."""
        return (self.rate / self.area,)
