"""What an exported core of single precision does not take, by name."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from clutchwork.assembly.system import System
from clutchwork.base import quote
from clutchwork.declare.layout import REFUSALS
from clutchwork.declare.options import Options

# first number of the waves among those of a segment
WAVE = 4
WHY = dict(REFUSALS.values())


def refuse(system: System, options: Options) -> None:
    """Raise where single precision does not take a model, with the names of all that it does not take."""
    reasons = list(_refused(system, options))
    if reasons:
        raise ValueError(f"precision is 'single': {'; '.join(reasons)}")


def _refused(system: System, options: Options) -> Iterator[str]:
    if options.method != "fixed":
        yield f"method is {quote(options.method)}: only steps of one length have single precision, give method='fixed'"
    arrays = system.arrays
    stops = np.flatnonzero(arrays["contact_place"] >= 0).tolist()
    for contacts, why in ((stops, "single_stops"), (arrays["load_contact"].tolist(), "single_loads")):
        if contacts:
            names = ", ".join(quote(system.contacts[c].name) for c in contacts)
            yield f"{names}: {WHY[why]}"
    if len(arrays["prescribed_input"]):
        names = ", ".join(quote(system.inputs[i]) for i in arrays["prescribed_input"].tolist())
        yield f"signal {names}: {WHY['single_prescribed']}"
    waves = arrays["segment_coef"].reshape(-1, 12)[:, WAVE] != 0.0
    for name, first, count in zip(system.inputs, arrays["input_first"], arrays["input_count"], strict=True):
        if waves[first : first + count].any():
            yield f"signal {quote(name)}: {WHY['single_waves']}"
