"""Drag of an open wet clutch."""

from __future__ import annotations

from clutchwork.declare import Node, Role, SignalLike, component, param, port, signal
from clutchwork.elements.bases.heating import Heating


@component(Role.TORQUE)
class WetDrag(Heating):
    """Drag `2 peak scale x/(1 + x^2)` against the slip, with x = slip/speed: it rises to a peak and falls beyond it.

    Use it in parallel to the clutch of a wet pack: at low slip the oil film is sheared, beyond the peak air enters and
    the film breaks up. Give `scale` as a signal where the drag changes with the oil flow or the temperature.

    Source of the curve over speed: the review by L. Pointner-Gabriel, K. Voelkel, K. Stahl 2025,
    doi:10.3390/lubricants13010027.
    """

    base: Node = port("side that the slip is measured from")
    follower: Node = port("side whose motion is positive")
    peak: float = param("N m", "largest drag", at_least=0.0, units=("N",))
    speed: float = param("rad/s", "slip of the largest drag", above=0.0, units=("m/s",))
    scale: SignalLike | None = signal("1", "factor on the drag, 1 by default", default=None, otherwise=1.0)
