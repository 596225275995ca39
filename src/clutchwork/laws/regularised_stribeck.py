"""Stribeck friction smoothed around zero slip."""

from __future__ import annotations

from typing import ClassVar

from clutchwork.declare import Role, component, param
from clutchwork.laws.bases.stribeck import StribeckCurve


@component(Role.LAW)
class RegularisedStribeck(StribeckCurve):
    """Coefficient `s(slip) tanh(slip/width) + viscous slip`, without states.

    Use it only to compare with simulations that were made with it: it creeps under any load and never locks, and the
    smaller its width, the stiffer it is.

    Source: B. Armstrong-Hélouvry, P. Dupont, C. Canudas de Wit 1994, doi:10.1016/0005-1098(94)90209-7.
    """

    sticks: ClassVar[bool] = False

    width: float = param(
        "rad/s", "slip at which 76 % of the coefficient are reached", above=0.0, units=("m/s",), example=0.05
    )
