"""How a run is computed: tolerances, method, budgets and output.

The fields of `Options` are the table of all options. What checks them, the command line, [simulation] of a model file,
`cw_set_option` of the compiled core, exported C and the page of options follow from it.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import fields
from math import inf
from typing import TYPE_CHECKING, Any, Literal, Unpack, get_args

from clutchwork.base import OptionError, UseError, advised, dataclass, near
from clutchwork.declare.calls import explain, explained_methods
from clutchwork.declare.docs import document
from clutchwork.declare.layout import METHODS
from clutchwork.declare.quantity import has_unit
from clutchwork.declare.schema import Spec
from clutchwork.declare.setting import Setting, setting
from clutchwork.declare.to_si import is_array

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from clutchwork.declare.option_fields import OptionFields

Method = Literal["auto", "rodas5p", "dopri5", "fixed"]
Output = Literal["smooth", "steps"]

# A grid finer than this does not fit into memory together with its signals.
MOST_ROWS = 10_000_000
# no run lasts that long
MOST_COUNTED = 10**15

ONE_GRID = "give the spacing or the instants, not both"


@explained_methods("options")
@dataclass(frozen=True)
class Options:
    """Options of a run; every one may also be given to `simulate` by name, and in [simulation] of a model file.

    Times may have units, "1 ms" or a quantity of pint; plain numbers are in seconds.

    Output: `times` gives exactly these instants, `dt` a uniform grid that ends with t_end. Without
    either, `output` decides: "smooth" gives the solver's steps refined to `points` intervals, with the left
    and the right limit at every event; "steps" gives the bare steps of the solver.

    "auto" chooses the method for each smooth phase: explicit steps of "dopri5" where nothing is stiff, else "rodas5p".
    Absolute tolerances of bristles and springs, and of slow speeds beside fast ones, follow from the motion; `atol` is
    what is left of them at rest.
    """

    rtol: float = setting(
        "1",
        "relative tolerance of speeds and states (double precision carries no more than 1e-14)",
        default=1e-6,
        at_least=1e-14,
        at_most=0.1,
        core=True,
    )
    atol: float = setting(
        "1",
        "absolute tolerance of speeds, and of states in the unit of each; those that are bent by a rate follow from it",
        default=1e-8,
        above=0.0,
        core=True,
    )
    method: Method = setting(
        "",
        "integrator: auto chooses for each smooth phase; rodas5p for any model, dopri5 where nothing is stiff; fixed "
        "has steps of one length with bounded cost",
        default="auto",
        choices=tuple(METHODS),
        core=True,
    )
    step: float = setting("s", "length of the steps of method fixed", default=1e-3, above=0.0, core=True)
    first_step: float | None = setting(
        "s",
        "first step of the solver in each smooth phase (by default the solver chooses it)",
        default=None,
        above=0.0,
        core=True,
    )
    max_step: float | None = setting(
        "s", "longest step of the solver (by default there is no limit)", default=None, above=0.0, core=True, unset=inf
    )
    max_steps: int = setting(
        "1", "number of steps after which a run stops", default=10_000_000, at_least=1, at_most=MOST_COUNTED, core=True
    )
    max_events: int = setting(
        "1", "number of events after which a run stops", default=100_000, at_least=1, at_most=MOST_COUNTED, core=True
    )
    t_start: float = setting("s", "time at which the run begins", default=0.0, at_least=0.0, core=True)
    dt: float | None = setting("s", "spacing of the output", default=None, above=0.0)
    times: Sequence[float] | NDArray[Any] | None = setting(
        "s",
        "instants of the output (one given twice gets both limits at an event)",
        default=None,
        at_least=0.0,
        numbers=True,
    )
    output: Output = setting(
        "",
        "output where neither dt nor times is given: steps of the solver refined to `points` intervals, or bare",
        default="smooth",
        choices=get_args(Output),
    )
    points: int = setting(
        "1", "number of intervals that smooth output has at least", default=1000, at_least=1, at_most=MOST_ROWS
    )
    angles: bool = setting("", "whether the angles of all shafts are integrated", default=True, core=True)
    work: bool = setting(
        "", "whether the work of all elements is integrated, for the energy balance", default=True, core=True
    )

    if TYPE_CHECKING:
        # numbers may be given with units, what is kept is in SI
        def __init__(self, **given: Unpack[OptionFields]) -> None: ...

    def __post_init__(self) -> None:
        """Put values with units into SI; refuse those that make no sense, with what to write instead, all at once."""
        values = vars(self)
        given = [(name, row) for name, row in OPTIONS.items() if values[name] is not row.default]
        for name, row in given:
            values[name] = row.in_si(values[name])
        found = [fault for name, row in given if (fault := _told(name, row, values[name]))]
        if self.dt is not None and self.times is not None:
            found.append(f"dt and times are both given: {ONE_GRID}")
        if found:
            raise OptionError(found)

    def changed(self, changes: Mapping[str, Any]) -> Options:
        """These options with some replaced; an unknown name is a UseError, a TypeError, with a near match."""
        known(changes)
        return Options(**{**vars(self), **changes}) if changes else self

    def core_options(self) -> dict[str, float]:
        """The options that the compiled core knows, as its numbers."""
        return {name: row.number(getattr(self, name)) for name, row in OPTIONS.items() if row.core}


# the fields of Options by name, and those of [simulation] in a model file: these and the end time
OPTIONS: dict[str, Setting] = {item.name: item.metadata["setting"] for item in fields(Options)}
T_END = Setting(Spec("option", "s", "end time of the run", optional=True, above=0.0), None)
SIMULATION = {"t_end": T_END, **OPTIONS}

document(Options)
explain(Options)

# what a run is done with where nothing is said
DEFAULTS = Options()


def known(names: Iterable[str]) -> None:
    """Raises a UseError, a TypeError, for names that are not options, with near matches."""
    words = [*OPTIONS, "t_end", "options", "progress"]
    unknown = [name for name in names if name not in OPTIONS]
    if unknown:
        rests = [*("" for _ in unknown[1:]), f"known options: {', '.join(OPTIONS)}"]
        found = [f"unknown option {x!r}{near(x, words, rest)}" for x, rest in zip(unknown, rests, strict=True)]
        raise UseError("simulate", found)


def end_time(t_end: Any) -> float:
    """The end time of a run [s], checked; it may have a unit."""
    number = T_END.in_si(t_end)
    fault = _told("t_end", T_END, number)
    if fault:
        raise OptionError([fault])
    return float(number)


def instants(times: Any) -> Any:
    """Instants [s] of a call, one or several, of which any may have a unit; OptionError names what is wrong with it."""
    row = OPTIONS["times"]
    given = row.in_si([times] if has_unit(times) and not is_array(times) else times)
    wrong = [item for item in given if has_unit(item)] if isinstance(given, list | tuple) else []
    if wrong or is_array(given):
        fault = row.unit_fault(wrong[0] if wrong else given)
        raise OptionError([f"times hold {fault.value}: it {advised(fault.message, fault.remedy)}"])
    return given


def _told(name: str, row: Setting, value: object) -> str:
    """What is wrong with the value of an option, empty if nothing."""
    fault = row.fault(value)
    return f"{name} is {fault.value}: it {advised(fault.message, fault.remedy)}" if fault else ""
