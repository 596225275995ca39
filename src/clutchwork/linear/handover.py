"""Linear systems for other packages: python-control, scipy, plain data."""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING, Any

from clutchwork.base.extras import need

if TYPE_CHECKING:
    from clutchwork.linear.modes import NaturalMode
    from clutchwork.linear.result import Linear


def to_control(lin: Linear) -> Any:
    """As a `control.StateSpace` with names of states, inputs and outputs."""
    control = need("control", "control", "to_control()")
    named = {what: list(map(plain, getattr(lin, what))) for what in ("states", "inputs", "outputs")}
    return control.ss(lin.A, lin.B, lin.C, lin.D, name=plain(lin.model) or "driveline", **named)


def plain(name: str) -> str:
    """A name as python-control takes it: `engine.speed` becomes `engine_speed`."""
    return re.sub(r"\W", "_", name)


def to_scipy(lin: Linear) -> Any:
    """As a `scipy.signal.StateSpace`."""
    signal = need("scipy.signal", "fit", "to_scipy()")
    return signal.StateSpace(lin.A, lin.B, lin.C, lin.D)


def to_dict(lin: Linear) -> dict[str, Any]:
    """As numbers, texts and lists."""
    return {
        "model": lin.model,
        "time": lin.time,
        "contacts": lin.contacts,
        "states": [_of(q) | {"rate": q.rate} for q in lin.state_quantities],
        "inputs": [_of(q) for q in lin.input_quantities],
        "outputs": [_of(q) for q in lin.output_quantities],
        **{name: getattr(lin, name).tolist() for name in "ABCD"},
        "eigenvalues": [[value.real, value.imag] for value in lin.eigenvalues.tolist()],
        "modes": [_mode(mode) for mode in lin.modes],
        "notes": list(lin.notes),
    }


def _of(quantity: Any) -> dict[str, Any]:
    return {"name": quantity.name, "unit": quantity.unit, "value": quantity.value}


def _mode(mode: NaturalMode) -> dict[str, Any]:
    return {
        "kind": mode.kind,
        "frequency": mode.frequency,
        "natural_frequency": mode.natural_frequency,
        "damping": None if math.isnan(mode.damping) else mode.damping,
        "time_constant": mode.time_constant if math.isfinite(mode.time_constant) else None,
        "shape": {name: [value.real, value.imag] for name, value in mode.shape.items()},
    }
