"""Driver who follows a speed over time."""

from __future__ import annotations

from clutchwork.declare import Component, Role, SignalLike, State, component, param, signal


@component(
    Role.PROCESS,
    states=(
        State("throttle", "1", "accelerator pedal, 0 to 1"),
        State("brake", "1", "brake pedal, 0 to 1"),
        State("integral", "1", "integral part of the controller, -1 to 1"),
    ),
    hooks=("margin", "cross"),
)
class Driver(Component):
    """Driver who follows a speed cycle: a controller with proportional and integral part on two pedals.

    With the error `e = cycle - speed`, `gain e + integral` above zero is the accelerator, below zero the brake, each up
    to 1, with the time constant `lag` of the foot. `d integral/dt = integral_gain e` stays within -1 and 1: it is held
    there while the error points outwards, and leaves at once when the error reverses (anti-windup). Give the driver
    itself as a throttle and `(driver, "brake")` as the force of a brake.

    Source: K. J. Åström, T. Hägglund, PID Controllers, 2nd ed., ISA 1995, section 3.5.
    """

    cycle: SignalLike = signal("m/s", "wanted speed", example=10.0)
    speed: SignalLike = signal("m/s", "mass that is driven, or its speed")
    gain: float = param("s/m", "pedal per error", default=0.5, above=0.0)
    integral_gain: float = param("1/m", "growth of the pedal per error", default=0.1, at_least=0.0)
    lag: float = param("s", "time constant of the foot", default=0.1, above=0.0)

    def initial_states(self) -> tuple[float, ...]:
        """Both pedals and the integral at the start: none."""
        return (0.0, 0.0, 0.0)
