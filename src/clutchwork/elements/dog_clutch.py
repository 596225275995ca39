"""Dog clutch."""

from __future__ import annotations

from collections.abc import Sequence
from math import remainder, tau
from typing import ClassVar

from clutchwork.declare import Found, Node, Role, SignalLike, State, Work, component, flag, option, param, port, signal
from clutchwork.elements.bases.heating import Heating


@component(
    Role.TORQUE,
    states=(
        State("angle", "rad", "angle of follower - base", span=1e-7),
        State("sleeve", "1", "position of the sleeve, 0 out, 1 in"),
    ),
    hooks=("margin", "cross", "turns", "settle", "heat", "freed"),
)
class DogClutch(Heating):
    """Teeth that engage only when tooth faces gap and the slip is below `speed`; then they carry any torque.

    The sleeve follows the command with a time constant and meets the tips at `reach`. With tooth on tooth or at too
    high a slip it is blocked there, until both fit or the command is withdrawn. In mesh the flanks have play over `gap`
    and press with `stiffness depth (1 + damping closing speed)`, never pulling. Use it for shift sleeves, parking locks
    and range clutches. Pointed teeth find their gap from any angle.

    Source of the damping: K. H. Hunt, F. R. E. Crossley 1975, doi:10.1115/1.3423596.
    """

    work: ClassVar[Work] = Work.STORE | Work.LOSS
    jumps: ClassVar[bool] = True

    base: Node = port("side that the slip is measured from")
    follower: Node = port("side whose motion is positive")
    teeth: int = param("1", "number of teeth around", above=0.0, whole=True, example=24)
    gap: float = param("rad", "total backlash of a tooth in its gap", above=0.0, example=0.02)
    stiffness: float = param("N m/rad", "stiffness of the flanks", above=0.0, example=1e5)
    damping: float = param("s/rad", "damping of the flanks over their force", default=1.0, at_least=0.0)
    speed: float = param("rad/s", "slip above which it does not mesh", default=5.0, above=0.0)
    reach: float = param("1", "position of the sleeve at which the tips meet", default=0.5, above=0.0, below=1.0)
    lag: float = param("s", "time constant of the sleeve", default=0.02, above=0.0)
    pointed: bool = flag("pointed teeth, which are guided into their gap", default=False)
    reversed: bool = flag("a negative command closes it", default=False)
    command: SignalLike = signal("1", "commanded position of the sleeve, 0 out, 1 in")
    initial_angle: float = option("rad", "angle at the start, 0 in the middle of a gap", default=0.0)
    engaged: bool = option("1", "in mesh at the start, at any slip", default=False, flag=True)

    def problems(self) -> Found:
        return gap_problems(self.gap, self.teeth)

    def initial_states(self) -> tuple[float, ...]:
        """Angle [rad] and place of the sleeve at the start."""
        # in mesh it is counted from the middle of the gap
        angle = remainder(self.initial_angle, tau / self.teeth) if self.engaged else self.initial_angle
        return (angle, 1.0 if self.engaged else 0.0)

    def stored(self, states: Sequence[float], torque: float) -> float:
        """Energy of the flank that is pressed [J], also while it parts too fast to push; none out of mesh."""
        depth = max(abs(states[0]) - self.gap / 2, 0.0)
        # out of mesh the sleeve is not beyond the tips, but for round-off
        in_mesh = torque != 0.0 or states[1] > self.reach + 1e-9
        return 0.5 * self.stiffness * depth**2 if in_mesh else 0.0


def gap_problems(gap: float, teeth: int) -> Found:
    """A gap that leaves no room for a tooth."""
    pitch = tau / teeth
    if gap < pitch:
        return []
    return [("gap", f"is {gap:g} rad, not below the pitch {pitch:g} rad", "a tooth needs room beside its gap")]
