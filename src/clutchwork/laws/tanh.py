"""Coulomb friction smoothed by a hyperbolic tangent."""

from __future__ import annotations

from typing import ClassVar

from clutchwork.declare import Law, Role, component, param


@component(Role.LAW)
class Tanh(Law):
    """Coefficient `kinetic tanh(2 slip/speed)`, without states.

    Use it only to compare with simulations that were made with it: it creeps under any load and never locks.

    Source: B. Armstrong-Hélouvry, P. Dupont, C. Canudas de Wit 1994, doi:10.1016/0005-1098(94)90209-7.
    """

    sticks: ClassVar[bool] = False

    kinetic: float = param("1", "coefficient at high slip", above=0.0, example=0.1)
    speed: float = param("rad/s", "slip at which 96 % of it are reached", above=0.0, units=("m/s",), example=0.1)
