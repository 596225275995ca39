"""Many runs of one driveline with other numbers, in one call."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Unpack

from clutchwork.assembly.system import System
from clutchwork.base import ModelWarning, caller
from clutchwork.base.progress import followed
from clutchwork.declare.calls import explained
from clutchwork.declare.options import Options
from clutchwork.run.simulation import Assembles
from clutchwork.sweeps.elsewhere import run_on
from clutchwork.sweeps.outputs import Asked
from clutchwork.sweeps.request import ordered, threads_of
from clutchwork.sweeps.result import OutputWarning, Sweep
from clutchwork.sweeps.runs import run_all

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from clutchwork.declare.node import Number
    from clutchwork.declare.option_fields import OptionFields

Told = Callable[[int, int], None]


@explained("sweep")
def sweep(
    model: Assembles | System,
    t_end: Number | None = None,
    *,
    vary: Any,
    outputs: Mapping[str, Asked] | Sequence[Asked] | Asked,
    threads: int | None = None,
    on: Any = None,
    options: Options | None = None,
    progress: bool | Told = False,
    **changes: Unpack[OptionFields],
) -> Sweep:
    """Run a Driveline or a System with many sets of values, and keep the chosen outputs of each run.

    Parameters: t_end [s], or with a unit, options and their fields by name are those of `simulate`; vary, values by
    name (all combinations), a list with the values of each variant, `cw.variants` or a DataFrame; in place of values
    `cw.times(0.9, 1.1)` multiplies the numbers in the model of all names that match a pattern; outputs, what is
    kept; threads, how many run at once, by default as many as there are cores; on, where they run: this process,
    "ray" or "dask" for processes, the address of a cluster for other machines; progress, True for a bar of tqdm, or a
    function of (variants done, variants).

    Names are those of `System.changed`; values may have units, "2 bar", and are kept in SI. An output is the name of a
    signal, for its value at the end, `cw.at`, `cw.maximum`, `cw.minimum`, `cw.peak`, `cw.integral`, `cw.jerk`,
    `cw.lock` or `cw.break_away`, or a function of the Trajectory; a mapping gives them names.

    A variant that stops early has its status, and does not affect the others; the value of a function that raises is
    missing, with an `OutputWarning`, and `problems` of the result lists all of them. Ctrl-C ends the sweep with what is
    done.
    """
    order, count = ordered("sweep", model, t_end, vary, outputs, options, changes), threads_of(threads)
    with (
        followed(progress, len(order), "sweep", "(done, variants)", unit=" runs") as told,
        warnings.catch_warnings(),
    ):
        # a value may be rarely wanted; that of a single run is given there
        warnings.simplefilter("ignore", ModelWarning)
        if on is None:
            made = run_all(order.whole, count, told or _silent)
        else:
            made = run_on(order, on, count, threads, told or _silent)
    if made.problems:
        one, *more = made.problems
        also = f"; {len(more)} more, which .problems lists" if more else ""
        warnings.warn(OutputWarning(f"{one}{also}; the value is missing"), stacklevel=caller())
    return made


def _silent(done: int) -> None:
    """No progress was requested."""
