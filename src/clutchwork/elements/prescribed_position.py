"""Prescribed position of a shaft."""

from __future__ import annotations

from clutchwork.declare import Role, Signal, SignalLike, component, option, signal
from clutchwork.elements.bases.motion import MotionError, PrescribedMotion, as_signal
from clutchwork.signals.bases.motions import SignalError, at_start, bessel, derivative


@component(Role.MOTION)
class PrescribedPosition(PrescribedMotion):
    """Source that moves a shaft or a mass exactly along a prescribed position, regardless of the torque.

    Use it for an actuator that follows a stroke, a steered angle, a measured position. Its speed is the exact
    derivative; where that jumps, as at a point of a table, the speed jumps by an impulse. A position that jumps is
    refused. With `cutoff` the position follows the signal through a Bessel filter of second order,
    `acceleration = ((signal - position) w - 1.3617 speed) w/0.618`, w = 2 pi cutoff, solved exactly. At the start
    it is where the signal is; a shaft behind the filter may start elsewhere, by its own angle and speed.

    Source of the filter: W. E. Thomson 1949, doi:10.1049/pi-3.1949.0101.
    """

    position: SignalLike = signal("rad", "prescribed angle or position from the base", units=("m",))
    cutoff: float | None = option(
        "Hz", "corner frequency of the filter, none by default", default=None, above=0.0, example=10.0
    )

    def start_angle(self) -> float:
        """Where the signal starts; a shaft behind the filter may start elsewhere."""
        angle = self._started()
        wanted = at_start(as_signal(self.position))
        return angle if self.cutoff is not None and angle else wanted

    def begins_with_shaft(self) -> bool:
        """Whether its speed begins with that of the shaft, from which a filter goes on."""
        return self.cutoff is not None

    def speed_signal(self, speed: float) -> Signal:
        """Derivative of the position, or of what passes the filter."""
        wanted, angle = as_signal(self.position), self._started()
        try:
            if self.cutoff is not None:
                return bessel(wanted, self.cutoff, self.start_angle(), speed)
            made = derivative(wanted, self._unit("rad"))
        except SignalError as error:
            raise MotionError("position", error.message, "", error.remedy) from None
        # a shaft that says nothing starts where the signal does
        if angle and abs(angle - self.start_angle()) > 1e-6 * abs(angle):
            message = f"starts at {self.start_angle():g} {self._unit('rad')}, {self.shaft.name!r} at {angle:g}"
            raise MotionError("position", message, "", "give both the same start, or none to the shaft")
        return made
