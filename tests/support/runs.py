"""Short words for what most physics tests ask of a run."""

from __future__ import annotations

from typing import Any

import numpy as np

import clutchwork as cw

# tolerances far below what the tests ask for, so that the event times are those of the model
TIGHT: dict[str, Any] = {"rtol": 1e-12, "atol": 1e-12}

# what issue and specification ask of event times against closed forms [s]
EXACT = 1e-9


def switches(run: Any, *, opening: bool = False) -> list[tuple[float, str, str, str]]:
    """(time, contact, before, after) of every change of mode; opening and closing contacts only on request.

    Changes at exactly one instant have no order: they stand by name.
    """
    found = [
        (e.time, e.element, e.before, e.after)
        for e in run.events.changes()
        if opening or e.after == "locked" or e.before == "locked" or "open" not in (e.before, e.after)
    ]
    return sorted(found, key=lambda change: change[:2])


def assert_switches(run: Any, expected: list[tuple[float, str, str, str]], tolerance: float = EXACT) -> None:
    """The run has these changes of mode and no others, each at its time."""
    found = switches(run)
    assert [s[1:] for s in found] == [s[1:] for s in expected], found
    errors = [abs(a[0] - b[0]) for a, b in zip(found, expected, strict=True)]
    assert max(errors, default=0.0) <= tolerance, list(zip(found, expected, strict=True))


def clutch(name: str, base: cw.Node, follower: cw.Node, *, kinetic: float, static: float | None = None) -> cw.Clutch:
    """Clutch of constant capacity [N m]."""
    law = cw.Coulomb(static=kinetic if static is None else static, kinetic=kinetic)
    return cw.Clutch(name, base=base, follower=follower, friction=law, gain=1.0, normal_force=1.0)


def over(points: list[tuple[float, float]], **law: float) -> dict[str, Any]:
    """Fields of a clutch whose capacity [N m], for a coefficient of 1, follows a table."""
    kinetic = law.get("kinetic", 1.0)
    coulomb = cw.Coulomb(static=law.get("static", kinetic), kinetic=kinetic)
    return {"friction": coulomb, "gain": 1.0, "normal_force": cw.Table(points)}


def at_end(run: Any, signal: str) -> float:
    """The last value of a signal."""
    return float(np.asarray(run[signal])[-1])
