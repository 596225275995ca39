"""What a run is done with: what the call gives, before what the settings of its model say."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from clutchwork.base import OptionError
from clutchwork.declare.options import DEFAULTS, Options, end_time, known
from clutchwork.declare.wording import say

if TYPE_CHECKING:
    from clutchwork.assembly.records import Input

ON_COMMAND_LINE = "give --t-end, or t_end in the [simulation] table of the model file"
IN_PYTHON = "give the end time to the call in s, or set t_end in d.simulation, the [simulation] table of a model file"


def merged(
    settings: Mapping[str, Any], given: Mapping[str, Any], options: Options | None = None
) -> tuple[float, Options]:
    """End time [s] and options of a run.

    Parameters: settings of the model, t_end among them; given, those that overrule them one by one; options, which
    replace all settings but the end time.
    """
    wanted = _wanted(settings, given, options)
    t_end = wanted.pop("t_end", None)
    # unknown names first: one may be a misspelt t_end
    known(wanted)
    if t_end is None:
        raise OptionError([f"t_end is missing: {say(ON_COMMAND_LINE, IN_PYTHON)}"])
    end = end_time(t_end)
    if "t_end" in given and "times" not in given and wanted.get("times") is not None:
        # a run that is made shorter ends before the last instants of the settings
        wanted["times"] = _up_to(end, wanted["times"])
    made = (options or DEFAULTS).changed(wanted)
    if end <= made.t_start:
        raise OptionError([f"t_end is {end:g} s: it must lie after t_start = {made.t_start:g} s, where the run begins"])
    return end, made


def without_end(settings: Mapping[str, Any], given: Mapping[str, Any], options: Options | None = None) -> Options:
    """Options of a run that is stepped, whose end and instants of output are not known."""
    useless = {"t_end": "sim.advance says how far", "times": "ask sim.run.at(times) afterwards"}
    found = [f"{name} cannot be given to a Simulator: {why}" for name, why in useless.items() if name in given]
    if found:
        raise OptionError(found)
    wanted = {name: value for name, value in _wanted(settings, given, options).items() if name not in useless}
    known(wanted)
    return (options or DEFAULTS).changed(wanted).changed({"times": None})


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


def _wanted(settings: Mapping[str, Any], given: Mapping[str, Any], options: Options | None) -> dict[str, Any]:
    """What the call gives, before what the settings of the model say."""
    wanted = {name: settings[name] for name in settings if options is None or name == "t_end"}
    # a grid that is given replaces the other kind of grid
    for grid, other in (("dt", "times"), ("times", "dt")):
        if given.get(grid) is not None:
            wanted.pop(other, None)
    wanted.update(given)
    return wanted


def _up_to(end: float, times: Any) -> list[float]:
    kept = [instant for instant in times if instant <= end]
    if not kept:
        fault = f"times of d.simulation begin at {times[0]:g} s, after t_end = {end:g} s"
        raise OptionError([f"{fault}: give a later t_end, or dt or times to the call"])
    return kept
