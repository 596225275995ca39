"""Torque with which an element that opens works against the one that closes. docs/theory/shifts.md (9)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from clutchwork.base.arrays import Array
from clutchwork.results.recorded import Recorded
from clutchwork.shifts.detect import Shift

# of the largest torque: a freewheel that lets go has some on either side
ROUND_OFF = 1e-9


class Opposing(NamedTuple):
    """Instants of a shift [s], and torque against the direction that an element had before it [N m]."""

    time: Array
    torque: Array


def opposing(run: Recorded, shift: Shift, contact: str, time: Array, torque: Array) -> Opposing:
    """What an opening contact does from begin to end of a shift.

    Parameters: contact, its path; time and torque of it at equal steps around the shift. Rows and events of the run
    add the instants between these, at which torques jump.
    """
    held = time < shift.begin
    usual = float(np.sign(np.mean(torque[held]))) if np.any(held) else 1.0
    # a dog clutch has none
    events = [event for event in run.events if event.element == contact]
    at = [event.time for event in events]
    jumps = [[event.torque_before for event in events], [event.torque_after for event in events]]
    times = np.concatenate([time, run.time, at, at])
    torques = np.concatenate([torque, run[f"{contact}.torque"], *jumps])
    inside = (times >= shift.begin) & (times <= shift.end)
    against = -usual * torques[inside]
    noise = ROUND_OFF * float(np.max(np.abs(torques), initial=0.0))
    return Opposing(times[inside], np.where(np.abs(against) > noise, against, 0.0))
