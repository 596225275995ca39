"""Work that a run could never finish, refused before it starts."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from clutchwork.base.errors import OptionError

if TYPE_CHECKING:
    from clutchwork.assembly.records import Input


def refuse_endless(inputs: Sequence[Input], begin: float, t_end: float, max_steps: int) -> None:
    """OptionError for signals that repeat, or are asked for, more often than the run may take steps."""
    found = []
    for item in inputs:
        sampling = item.signal.sampling()
        period = sampling.period if sampling else item.signal.repeats()
        if period > 0.0 and (t_end - begin) / period > max_steps:
            times = f"more than max_steps = {max_steps} times up to {t_end:g} s"
            found.append(f"{item.name} has a period of {period:g} s, {times}; give a longer period or a shorter run")
    if found:
        raise OptionError(found)
