"""A study in words: how much of it is there, and the distribution of each output."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from clutchwork.base import html
from clutchwork.base.plural import columns

if TYPE_CHECKING:
    from clutchwork.studies.recorded import RecordedStudy

HEADS = ("output", "unit", "mean", "deviation", "5 %", "median", "95 %", "no value")


def head(study: RecordedStudy) -> str:
    """How many variants there are, and how they ended."""
    ends = ", ".join(f"{count} {name}" for name, count in study.ends.items())
    return f"Study of {study.count} variants, {len(study)} of them there{f': {ends}' if ends else ''}"


def text(study: RecordedStudy) -> str:
    """For the terminal."""
    lines = list(_lines(study))
    table = columns([HEADS, *lines], right=range(2, len(HEADS))) if lines else "nothing is there yet"
    return "\n".join([f"<{head(study)}>", str(study.folder), "", table])


def page(study: RecordedStudy) -> str:
    """For a notebook."""
    table = html.table(HEADS, list(_lines(study)), right=range(2, len(HEADS)))
    return html.page(html.heading(head(study)), html.paragraph(study.folder), table)


def _lines(study: RecordedStudy) -> Iterator[tuple[str, ...]]:
    for name in study.names if len(study) else ():
        values = study[name]
        if values.dtype.kind != "f":
            continue
        known = values[np.isfinite(values)]
        numbers = ["", "", "", "", ""]
        if len(known):
            low, middle, high = np.quantile(known, [0.05, 0.5, 0.95])
            numbers = [f"{number:.6g}" for number in (known.mean(), known.std(), low, middle, high)]
        yield name, study.units.get(name, ""), *numbers, str(len(values) - len(known))
