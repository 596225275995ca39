"""What of a friction law can be searched for, and the rules that tie its values to each other."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from clutchwork.checks import CHECKS, At
from clutchwork.fit.sliding import coefficients
from clutchwork.schema import Spec, specs

if TYPE_CHECKING:
    from clutchwork.node import Law

STATIC = "static"
_TINY = 1e-9


def faults(law: Law) -> list[str]:
    """Rules of a law that its values break, in words."""
    return [str(problem) for problem in CHECKS["law"](law, Spec("law", "1", ""), At(type(law).__name__, ""))]


def adjustable(cls: type) -> dict[str, Spec]:
    """Parameters that are real numbers, and curves."""
    return {
        item.name: spec for item, spec in specs(cls, "param", "curve") if not (spec.flag or spec.whole or spec.choices)
    }


def default_free(law: Law) -> list[str]:
    """All that is not switched off by a zero and that the law lets vary."""
    names = []
    for name, spec in adjustable(type(law)).items():
        value = getattr(law, name)
        if value is not None and (spec.what == "curve" or value != 0.0) and not fixed(law, name):
            names.append(name)
    return names


def fixed(law: Law, name: str) -> str:
    """Why a parameter can be moved to neither side on its own; empty when it can."""
    value = getattr(law, name)
    if not isinstance(value, int | float):
        return ""
    moved = [faults(replace(law, **{name: factor * value + _TINY * (value == 0)})) for factor in (1.001, 0.999)]
    return moved[0][0] if all(moved) else ""


def sum_is_held(law: Law, name: str) -> bool:
    """Whether the law refuses ordinates of a smaller sum."""
    return bool(faults(replace(law, **{name: [(x, 0.999 * y) for x, y in getattr(law, name)]})))


def kinetic(law: Law) -> float:
    """What the static coefficient must not be below: the largest kinetic one that does not follow from it."""
    if not hasattr(law, STATIC):
        return 0.0
    given = getattr(law, "kinetic", 0.0)
    floor = float(given) if isinstance(given, int | float) else 0.0
    if law.sticks:
        found, _ = coefficients(replace(law, **{STATIC: floor or _TINY}), np.zeros(1))
        floor = max(floor, float(found[0])) if found[0] > _TINY else floor
    return floor
