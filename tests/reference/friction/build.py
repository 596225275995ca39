"""The independent counterpart of a law, found by the name of its kind."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from reference.friction.bristle import Dahl, ElastoPlastic, LuGre
from reference.friction.curve import Curve
from reference.friction.law import Law
from reference.friction.maxwell import GMS, Leuven
from reference.friction.smooth import NaiveSign, RegularisedStribeck, Tanh
from reference.friction.wound import Mykhalevych


def _curve(law: Any) -> Curve:
    return Curve(law.static, law.kinetic, law.speed, law.shape, law.exponent, law.viscous)


def _elements(law: Any) -> tuple[tuple[float, float], ...]:
    return tuple((float(x), float(y)) for x, y in law.elements)


# what a compliant law needs to be complete, see tests/registry/test_complete_laws.py
COUNTERPARTS: dict[str, Callable[[Any], Law]] = {
    "tanh": lambda law: Tanh(law.kinetic, law.speed),
    "regularised_stribeck": lambda law: RegularisedStribeck(_curve(law), law.width),
    "naive_sign": lambda law: NaiveSign(_curve(law)),
    "dahl": lambda law: Dahl(law.kinetic, law.stiffness, law.exponent),
    "lugre": lambda law: LuGre(_curve(law), law.stiffness, law.damping),
    "dynamic_formula": lambda law: LuGre(
        Curve(law.static, law.kinetic, law.speed, "gaussian", 2.0, law.viscous), law.stiffness, law.damping
    ),
    "elastoplastic": lambda law: ElastoPlastic(_curve(law), law.stiffness, law.damping, law.elastic, law.plastic),
    "leuven": lambda law: Leuven(_curve(law), _elements(law), law.order, law.damping),
    "gms": lambda law: GMS(_curve(law), _elements(law), law.attraction, law.damping),
    "mykhalevych": lambda law: Mykhalevych(
        law.static, law.kinetic, law.elastic, law.speed, law.viscous, law.reset, law.range, bool(law.passive)
    ),
}


def counterpart(law: Any) -> Law:
    """The independent law with the same parameters; KeyError for a kind that has none."""
    return COUNTERPARTS[type(law).kind](law)
