"""What an FMU of a driveline has: its System with inputs as numbers, and all variables in order."""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Sequence
from typing import Any

from clutchwork.assembly.system import System
from clutchwork.assembly.wiring import wiring
from clutchwork.base.classes import dataclass
from clutchwork.base.errors import ModelError, ModelWarning, Problem, near
from clutchwork.base.quote import listed
from clutchwork.declare.layout import ROW
from clutchwork.declare.options import Options
from clutchwork.fmu.parameters import parameters
from clutchwork.fmu.variables import FmuVariable, LeftOut, VariableKind
from clutchwork.results.channels import Channels, channels
from clutchwork.results.forms import Mode
from clutchwork.signals.bases.waveform import value as value_at
from clutchwork.stepping.signals import Settable, signals

# sections of a row that no input moves at once, where no speed is prescribed
OF_STATES = (
    "speed",
    "angle",
    "state",
    "element_work",
    "contact_work",
    "prescribed_work",
    "supply_energy",
    "meter_energy",
)
MODE = "mode of the contact: -1 slips backward, 0 locked, 1 slips forward, 2 open"


@dataclass(frozen=True)
class Interface:
    """A System whose inputs are numbers, with the variables of its FMU."""

    system: System
    options: Options
    t_end: float  # s
    variables: tuple[FmuVariable, ...]
    left_out: tuple[LeftOut, ...]

    def of(self, *kinds: VariableKind) -> list[tuple[int, FmuVariable]]:
        """Variables of some kinds with their value references."""
        return [(number, one) for number, one in enumerate(self.variables) if one.kind in kinds]


def interface(
    system: System,
    t_end: float,
    options: Options,
    inputs: Sequence[str],
    outputs: Sequence[str] | None,
    chosen: Sequence[str] | None,
) -> Interface:
    """The interface of an FMU; ModelError names everything that does not fit.

    Parameters: t_end [s] and options of the run; inputs, names of signals; outputs, names of results, None: all;
    chosen, names of parameters, None: all that can be some.
    """
    pinned = _pinned(system)
    known = channels(pinned, options.angles, options.work)
    given = _inputs(pinned, inputs)
    held = {item: value_at(pinned.inputs[one.numbers[0]].signal, options.t_start) for item, one in given.items()}
    ready = pinned.changed(dict(held)) if held else pinned
    made = list(parameters(ready, set(known)))
    wanted = _outputs(known, outputs, [_shown(known, name) for name in given])
    found = [one for one in made if isinstance(one, FmuVariable)]
    _refuse(chosen, [one.name for one in found], [one for one in made if isinstance(one, LeftOut)])
    kept = [one for one in found if chosen is None or one.name in chosen]
    first = [FmuVariable("time", VariableKind.TIME, "s", options.t_start)]
    first += [_input(known, name, one, held[name]) for name, one in given.items()]
    slopes = [_slope(number, one) for number, one in enumerate(first) if one.kind is VariableKind.INPUT]
    results = [_output(pinned, known, name) for name in wanted]
    left = tuple(one for one in made if isinstance(one, LeftOut))
    return Interface(ready, options, t_end, (*first, *slopes, *kept, *results), left)


def _pinned(system: System) -> System:
    """The System with its independent speeds settled, so that other inertias choose no others."""
    if system.source is None:
        raise ModelError([Problem("system", "", "has no names: assemble its driveline, or read a file of System.save")])
    with warnings.catch_warnings():
        # said of the driveline already
        warnings.simplefilter("ignore", ModelWarning)
        return System.of(system.source, system.independent)


def _inputs(system: System, names: Sequence[str]) -> dict[str, Settable]:
    """Signals that are set from outside: those that are asked for, and those that only Python can give."""
    settable, problems = signals(system), list[Problem]()
    wanted = list(dict.fromkeys(name.removesuffix("_signal") if name not in settable else name for name in names))
    for name in wanted:
        if name not in settable:
            unknown = f"is not a signal that can be an input{near(name, settable, f'signals are {listed(settable)}')}"
            problems.append(Problem(name, "", unknown))
    for item in system.inputs:
        # a function of Python cannot go with it
        if item.signal.sampling() and item.name not in wanted:
            wanted.append(item.name)
    if problems:
        raise ModelError(problems, system.name)
    return {name: settable[name] for name in wanted}


def _shown(known: Channels, name: str) -> str:
    """What results call a signal: the torque of a load and the signal that sets its size would have the same name."""
    return f"{name}_signal" if f"{name}_signal" in known else name


def _input(known: Channels, name: str, found: Settable, start: float) -> FmuVariable:
    shown, spec = _shown(known, name), found.spec
    return FmuVariable(shown, VariableKind.INPUT, found.unit, start, spec.ends, spec.doc, inputs=found.numbers)


def _slope(number: int, of: FmuVariable) -> FmuVariable:
    unit = f"{of.unit}/s" if of.unit != "1" else "1/s"
    return FmuVariable(
        f"der({of.name})", VariableKind.SLOPE, unit, 0.0, about="its rate over the coming step", of=number
    )


def _outputs(known: Channels, names: Sequence[str] | None, inputs: Sequence[str]) -> list[str]:
    """Names of the outputs: numbers that are not inputs."""
    numbers = [name for name, one in known.items() if not (isinstance(one.evaluate, Mode) and one.evaluate.named)]
    if names is None:
        return [name for name in numbers if name not in inputs]
    problems = [Problem(name, "", known.fault(name)) for name in names if name not in known]
    texts = [name for name in names if name in known and name not in numbers]
    problems += [Problem(name, "", "is a string", remedy=f"take {name.rpartition('.')[0]}.mode") for name in texts]
    problems += [Problem(name, "", "is an input already", remedy="leave it out") for name in names if name in inputs]
    if problems:
        raise ModelError(problems)
    return list(dict.fromkeys(names))


def _output(system: System, known: Channels, name: str) -> FmuVariable:
    found = known[name]
    if isinstance(found.evaluate, Mode):
        return FmuVariable(name, VariableKind.MODE, "1", about=MODE, form=found.evaluate)
    follows = not len(system.prescribed_input) and found.evaluate.reads() <= _of_states(system)
    return FmuVariable(name, VariableKind.SIGNAL, found.unit, form=found.evaluate, follows_states=follows)


def _of_states(system: System) -> set[int]:
    places = wiring(system).columns
    return {place for name, _ in ROW if name in OF_STATES for place in range(places[name].start, places[name].stop)}


def _refuse(chosen: Sequence[str] | None, known: Sequence[str], left_out: Sequence[LeftOut]) -> None:
    """ModelError for parameters that are none."""
    reasons, problems = {one.name: one.why for one in left_out}, list[Problem]()
    for name in chosen or ():
        if name not in known:
            why = f"cannot be a parameter of an FMU: {reasons[name]}" if name in reasons else ""
            problems.append(Problem(name, "", why or f"is not a number of this driveline{near(name, known)}"))
    if problems:
        raise ModelError(problems)


def advice(made: Interface) -> Iterator[Problem]:
    """What a master should know of the inputs of an FMU."""
    speeds = {made.system.inputs[number].name for number in made.system.prescribed_input.tolist()}
    for _, one in made.of(VariableKind.INPUT):
        names = {made.system.inputs[number].name for number in one.inputs}
        if names & speeds:
            message = "prescribes a speed, which jumps from step to step where its value is held"
            remedy = "let the master give its rate too, as input derivative or der(...)"
            yield Problem(one.name, "", message, remedy=remedy)


def plain(names: Any) -> tuple[str, ...]:
    """Names from a string with commas, or from a sequence."""
    if isinstance(names, str):
        return tuple(part.strip() for part in names.split(",") if part.strip())
    return tuple(names)
