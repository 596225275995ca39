"""What of a friction law can be searched for, and the rules that tie its values to each other."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from clutchwork.declare.node import Law
from clutchwork.declare.schema import Spec, specs
from clutchwork.fit.ordinates import ABOVE, STATIC, ordinates, rivals, tables, with_ordinates
from clutchwork.fit.sliding import coefficients
from clutchwork.laws.bases.tables import Tabulated
from clutchwork.model.fields import CHECKS
from clutchwork.model.numbers import At

_TINY = 1e-9


def faults(law: Law) -> list[str]:
    """Rules of a law that its values break, in words."""
    return [str(problem) for problem in CHECKS["law"](law, Spec("law", "1", ""), At(type(law).__name__, ""))]


def adjustable(cls: type) -> dict[str, Spec]:
    """Parameters that are real numbers, and tables."""
    known = tables(cls)
    return {
        item.name: spec
        for item, spec in specs(cls, "param", "curve", "numbers")
        if item.name in known or (spec.what == "param" and not (spec.flag or spec.whole or spec.choices))
    }


def default_free(law: Law) -> list[str]:
    """All that is not switched off by a zero and that the law lets vary."""
    names = []
    for name, spec in adjustable(type(law)).items():
        value = getattr(law, name)
        if value is not None and (spec.what != "param" or value != 0.0) and not fixed(law, name):
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
    """Whether the law refuses ordinates of a smaller sum, as of shares; coefficients are not shares."""
    less = with_ordinates(law, name, [0.999 * value for value in ordinates(law, name).values()])
    return not isinstance(law, Tabulated) and bool(faults(replace(law, **{name: less})))


def kinetic(law: Law, point: int | None = None) -> float:
    """What the static coefficient must not be below: the largest kinetic one that does not follow from it.

    Parameters: point, place of the static coefficient where there is a table of them.
    """
    if isinstance(law, Tabulated):
        return ABOVE * max(rivals(law, point or 0))
    if law.static is None:
        return 0.0
    given = law.kinetic
    floor = float(given) if isinstance(given, int | float) else 0.0
    if law.sticks:
        found, _ = coefficients(replace(law, **{STATIC: floor or _TINY}), np.zeros(1))
        floor = max(floor, float(found[0])) if found[0] > _TINY else floor
    return floor
