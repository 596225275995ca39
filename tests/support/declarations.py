"""Declarations that only tests have; they borrow the equations of others, so that nothing has to be built."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

import clutchwork as cw
from clutchwork.declare.node import Component, Passive, Work
from clutchwork.declare.schema import Role, State, family, option, param, port, signal
from clutchwork.elements.bases.heating import Heating


@family
class EddyBrake(Heating):
    """The eddy-current brake of docs/extend.md, by the equations of the wet drag."""

    kind: ClassVar[str] = "wet_drag"
    role: ClassVar[Role] = Role.TORQUE

    shaft: cw.Node = port("shaft that is braked")
    base: cw.Node | None = port("member that takes the reaction", default=None)
    peak: float = param("N m", "largest torque", above=0.0)
    speed: float = param("rad/s", "speed of the largest torque", above=0.0)
    scale: float | None = signal("1", "factor on the torque", default=None, otherwise=1.0)


@family
class Coil(Component):
    """A spring whose fields and state have names of their own, by the equations of the spring."""

    kind: ClassVar[str] = "spring"
    role: ClassVar[Role] = Role.TORQUE
    states: ClassVar[tuple[State, ...]] = (State("load", "N m", "rate times wind-up"),)
    work: ClassVar[Work] = Work.STORE
    elastic: ClassVar[bool] = True

    base: cw.Node = port("one end")
    follower: cw.Node = port("other end")
    rate: float = param("N m/rad", "torque per angle", above=0.0)
    wound: float = param("rad", "wind-up at the start", default=0.0)

    def initial_states(self) -> tuple[float, ...]:
        """Its torque at the start [N m]."""
        return (self.rate * self.wound,)

    def passive(self) -> Passive:
        """Stiffness alone."""
        return Passive(self.rate, 0.0)


@family
class OiledCoil(Heating):
    """A spring with a damper that has names of its own, by the equations of the spring-damper."""

    kind: ClassVar[str] = "spring_damper"
    role: ClassVar[Role] = Role.TORQUE
    states: ClassVar[tuple[State, ...]] = (State("load", "N m", "rate times wind-up"),)
    work: ClassVar[Work] = Work.STORE | Work.LOSS
    elastic: ClassVar[bool] = True

    base: cw.Node = port("one end")
    follower: cw.Node = port("other end")
    rate: float = param("N m/rad", "torque per angle", above=0.0)
    oil: float = param("N m s/rad", "torque per speed", at_least=0.0)
    wound: float = param("rad", "wind-up at the start", default=0.0)

    def initial_states(self) -> tuple[float, ...]:
        """Torque of the spring at the start [N m]."""
        return (self.rate * self.wound,)

    def passive(self) -> Passive:
        """Both."""
        return Passive(self.rate, self.oil)


@family
class Cam(Component):
    """An elastic element with an energy of its own making, which `passive` does not say, by those of the spring."""

    kind: ClassVar[str] = "spring"
    role: ClassVar[Role] = Role.TORQUE
    states: ClassVar[tuple[State, ...]] = (State("load", "N m", "rate times wind-up"),)
    work: ClassVar[Work] = Work.STORE

    base: cw.Node = port("one end")
    follower: cw.Node = port("other end")
    rate: float = param("N m/rad", "torque per angle", above=0.0)
    wound: float = param("rad", "wind-up at the start", default=0.0)
    unused: float = option("1", "what the assembly might read", default=0.0)

    def initial_states(self) -> tuple[float, ...]:
        """Its torque at the start [N m]."""
        return (self.rate * self.wound,)

    def stored(self, states: Sequence[float], torque: float) -> float:
        """Energy at its torque [J]."""
        return 0.5 * states[0] ** 2 / self.rate
