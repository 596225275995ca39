"""Spool valve of a clutch."""

from __future__ import annotations

from clutchwork.declare import Role, SignalLike, State, component, option, param, signal
from clutchwork.elements.bases.oil import CLEARANCE, Opening
from clutchwork.elements.oil_volume import BAR
from clutchwork.elements.relief_valve import command_at_start, is_known


@component(
    Role.PROCESS,
    states=(
        State("pilot", "Pa", "pilot pressure that moves the spool, the command with its lag"),
        State("loss", "J", "heat of the oil that went through since the start"),
    ),
    hooks=("drawn",),
)
class SpoolValve(Opening):
    """Spool that connects a clutch to supply or exhaust, moved by a pilot pressure against that of the clutch.

    The travel of the spool, from -1 to 1, is `(pilot - spring - feedback clutch)/span`. Beyond `overlap` it opens the
    supply, below `-overlap` the exhaust, each in proportion; in between both are closed except for their clearance.
    With a feedback of 1 it regulates the clutch to the pilot pressure, with 0 it is a directional valve. The spool has
    no mass. A `PressureValve` as its command is a solenoid with a table over its current.

    Source: H. E. Merritt, Hydraulic Control Systems, Wiley 1967, sections 5-1 and 5-6.
    """

    # a port for oil here; of a torque element that draws from a supply the class has a word of this name
    supply: SignalLike = signal(  # type: ignore[misc, assignment]
        "Pa", "pressure that fills the clutch: a volume", draws=True, example=1e6
    )
    clutch: SignalLike = signal("Pa", "pressure of the clutch: a volume", draws=True, example=2e5)
    exhaust: SignalLike = signal("Pa", "pressure that the clutch empties to", default=0.0, draws=True)
    command: SignalLike = signal("Pa", "wanted pilot pressure", example=5e5)
    supply_area: float = param("m2", "area to the supply at full travel", above=0.0, example=1e-5)
    exhaust_area: float = param("m2", "area to the exhaust at full travel the other way", above=0.0, example=1e-5)
    span: float = param("Pa", "pilot pressure that moves it from the middle to an end", default=1e5, above=0.0)
    spring: float = param("Pa", "pilot pressure that balances its spring in the middle", default=0.0)
    feedback: float = param("1", "share of the pressure of the clutch that pushes it back", default=1.0, at_least=0.0)
    overlap: float = param("1", "share of the travel that opens nothing", default=0.05, at_least=0.0, at_most=0.9)
    clearance: float = param("1", "clearance as a share of the travel", default=CLEARANCE, above=0.0)
    lag: float = param("s", "time constant with which the pilot pressure follows its command", default=0.01, above=0.0)
    initial_pilot: float | None = option(
        "Pa", "pilot pressure at the start, that of the command by default", default=None
    )

    def begins_with(self) -> str:
        return "command" if self.initial_pilot is None and is_known(self.command) else ""

    def initial_states(self) -> tuple[float, ...]:
        """Pilot pressure at the start [Pa]; no heat yet."""
        return (self.initial_pilot if self.initial_pilot is not None else command_at_start(self.command), 0.0)

    def state_scales(self) -> tuple[float, ...]:
        """The solver follows pressures in bar."""
        return (BAR, 1.0)
