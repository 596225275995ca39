"""Linear systems for other packages: python-control, scipy, plain data."""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING, Any

from clutchwork.base.extras import need

if TYPE_CHECKING:
    from clutchwork.linear.modes import NaturalMode
    from clutchwork.linear.quantity import Quantity
    from clutchwork.linear.system import LinearSystem


def to_control(lin: LinearSystem) -> Any:
    """As a `control.StateSpace` with names of states, inputs and outputs."""
    control = need("control", "control", "to_control()")
    parts = {"states": lin.state_quantities, "inputs": lin.input_quantities, "outputs": lin.output_quantities}
    named = {what: [plain(quantity.name) for quantity in part] for what, part in parts.items()}
    return control.ss(*lin.matrices, name=plain(lin.model) or "driveline", **named)


def plain(name: str) -> str:
    """A name as python-control takes it: `engine.speed` becomes `engine_speed`."""
    return re.sub(r"\W", "_", name)


def to_scipy(lin: LinearSystem) -> Any:
    """As a `scipy.signal.StateSpace`."""
    signal = need("scipy.signal", "fit", "to_scipy()")
    return signal.StateSpace(*lin.matrices)


def to_dict(lin: LinearSystem) -> dict[str, Any]:
    """As numbers, texts and lists."""
    return {
        "model": lin.model,
        "time": lin.time,
        "contacts": lin.contacts,
        "states": [_of(q) | {"rate": q.rate} for q in lin.state_quantities],
        "inputs": [_of(q) for q in lin.input_quantities],
        "outputs": [_of(q) for q in lin.output_quantities],
        **{name: matrix.tolist() for name, matrix in zip("ABCD", lin.matrices, strict=True)},
        "eigenvalues": [[value.real, value.imag] for value in lin.eigenvalues.tolist()],
        "modes": [_mode(mode) for mode in lin.modes],
        "notes": list(lin.notes),
    }


def _of(quantity: Quantity) -> dict[str, Any]:
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
