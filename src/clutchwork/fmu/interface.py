"""What an FMU of a driveline has: its System with inputs as numbers, and all variables in order."""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np

from clutchwork.assembly.system import System
from clutchwork.assembly.wiring import wiring
from clutchwork.base import ModelError, ModelWarning, Problem, UseError, dataclass
from clutchwork.declare.layout import ROW
from clutchwork.declare.options import Options
from clutchwork.fmu.exchange import ContinuousState, exchange, exchange_faults
from clutchwork.fmu.following import Following, following
from clutchwork.fmu.names import input_faults, is_text, matching, output_faults, parameter_faults, shown
from clutchwork.fmu.parameters import parameters
from clutchwork.fmu.sizes import largest, nominal
from clutchwork.fmu.variables import FmuVariable, LeftOut, NumberThatFollows, VariableKind
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
CO_SIMULATION, MODEL_EXCHANGE = "co-simulation", "model exchange"
KINDS = (CO_SIMULATION, MODEL_EXCHANGE)
FOLLOWS = "the output {} is computed from it too, along no straight line: choose outputs without that one"
MODE = "mode of the contact: -1 slips backward, 0 locked, 1 slips forward, 2 open"


@dataclass(frozen=True)
class Interface:
    """A System whose inputs are numbers, with the variables of its FMU."""

    system: System
    options: Options
    t_end: float  # s
    variables: tuple[FmuVariable, ...]
    left_out: tuple[LeftOut, ...]
    kinds: tuple[str, ...] = (CO_SIMULATION,)
    states: tuple[ContinuousState, ...] = ()
    not_exchanged: tuple[str, ...] = ()  # why it is not for model exchange

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
    kinds: Sequence[str] | None = None,
    version: str = "2.0",
) -> Interface:
    """The interface of an FMU; UseError names everything that does not fit.

    Parameters: t_end [s] and options of the run; inputs, names of signals; outputs, names of results, None: all;
    chosen, names of parameters, None: all that can be some. In each a star stands for any letters. kinds of KINDS,
    None: all that the driveline can be; version of FMI.
    """
    pinned = _pinned(system)
    known, settable = channels(pinned, options.angles, options.work), signals(pinned)
    asked = [_signal_of(settable, name) for name in matching(inputs, settable)]
    held = {name: _start(pinned, settable[name], options) for name in _with_sampled(pinned, asked) if name in settable}
    ready = pinned.changed(dict(held)) if held else pinned
    found = list(parameters(ready, set(known)))
    numbers = {one.name: one for one in found if isinstance(one, FmuVariable)}
    left = tuple(one for one in found if isinstance(one, LeftOut))
    taken = [shown(known, name) for name in held]
    results = [name for name, one in known.items() if not is_text(one)]
    wanted = [name for name in results if name not in taken] if outputs is None else matching(outputs, results)
    kept = list(numbers) if chosen is None else matching(chosen, numbers)
    asked_for = [numbers[name] for name in kept if name in numbers]
    moves = following(ready, options, asked_for, [name for name in wanted if name in results])
    if chosen is not None and outputs is None:
        # parameters that were asked for come before outputs that were not
        while moves.left_out:
            wanted = [name for name in wanted if name not in moves.left_out.values()]
            moves = following(ready, options, asked_for, wanted)
    left += tuple(LeftOut(name, FOLLOWS.format(output)) for name, output in moves.left_out.items())
    numbers = {name: _moving(one, moves, wanted) for name, one in numbers.items() if name not in moves.left_out}
    kept = kept if chosen is not None else [name for name in kept if name in numbers]
    faults = [
        *input_faults(asked, settable, known, numbers),
        *output_faults(wanted, known, taken),
        *parameter_faults(kept, numbers, left, settable),
    ]
    first = [FmuVariable("time", VariableKind.TIME, "s", options.t_start)]
    first += [_input(ready, known, name, settable[name], start) for name, start in held.items()]
    reasons = tuple(exchange_faults(ready, first, version))
    if kinds is not None and MODEL_EXCHANGE in kinds:
        faults += [f"kinds: not for model exchange: {why}" for why in reasons]
    if faults:
        raise UseError("cw.export_fmu", faults)
    slopes = [_slope(number, one) for number, one in enumerate(first) if one.kind is VariableKind.INPUT]
    last = [_output(pinned, known, name) for name in wanted]
    variables = (*first, *slopes, *(numbers[name] for name in kept), *last)
    possible = (CO_SIMULATION,) if reasons else (MODEL_EXCHANGE, CO_SIMULATION)
    taken_kinds = tuple(kind for kind in possible if kinds is None or kind in kinds)
    if MODEL_EXCHANGE not in taken_kinds:
        return Interface(ready, options, t_end, variables, left, taken_kinds, not_exchanged=reasons)
    whole = exchange(ready, known, variables, largest(pinned, options, t_end))
    return Interface(ready, options, t_end, whole.variables, left, taken_kinds, whole.states)


def _moving(one: FmuVariable, moves: Following, outputs: Sequence[str]) -> FmuVariable:
    """A parameter with the numbers of outputs that follow it."""
    found = [
        NumberThatFollows(outputs.index(output), at.term, at.side, at.share, *line)
        for (output, at), line in moves.lines.get(one.name, {}).items()
    ]
    return replace(one, forms=tuple(found)) if found else one


def _pinned(system: System) -> System:
    """The System with its independent speeds settled, so that other inertias choose no others."""
    if system.source is None:
        raise ModelError([Problem("system", "", "has no names: assemble its driveline, or read a file of System.save")])
    with warnings.catch_warnings():
        # said of the driveline already
        warnings.simplefilter("ignore", ModelWarning)
        return System.of(system.source, system.independent)


def _start(system: System, signal: Settable, options: Options) -> float:
    """The value of a signal in the model where a run begins."""
    return value_at(system.inputs[signal.numbers[0]].signal, options.t_start)


def _signal_of(settable: Mapping[str, Settable], name: str) -> str:
    """The name of a signal in the model, from that in results."""
    plain = name.removesuffix("_signal")
    return plain if name not in settable and plain in settable else name


def _with_sampled(system: System, names: Sequence[str]) -> list[str]:
    """The inputs that are asked for, and those that only Python can give."""
    settable = signals(system)
    given = {number for name in names if name in settable for number in settable[name].numbers}
    left = [number for number, item in enumerate(system.inputs) if item.signal.sampling() and number not in given]
    owners = [next(name for name, one in reversed(settable.items()) if number in one.numbers) for number in left]
    return list(dict.fromkeys([*names, *owners]))


def _input(system: System, known: Channels, name: str, found: Settable, start: float) -> FmuVariable:
    called, spec, size = shown(known, name), found.spec, nominal(system, found.unit)
    made = FmuVariable(called, VariableKind.INPUT, found.unit, start, spec.ends, spec.doc)
    return replace(made, inputs=found.numbers, nominal=size)


def _slope(number: int, of: FmuVariable) -> FmuVariable:
    unit = f"{of.unit}/s" if of.unit != "1" else "1/s"
    return FmuVariable(
        f"der({of.name})", VariableKind.SLOPE, unit, 0.0, about="its rate over the coming step", of=number
    )


def _output(system: System, known: Channels, name: str) -> FmuVariable:
    found = known[name]
    if isinstance(found.evaluate, Mode):
        return FmuVariable(name, VariableKind.MODE, "1", about=MODE, form=found.evaluate)
    # a speed without inertia follows torques at once
    follows = (
        not len(system.prescribed_input)
        and not np.any(system.massless)
        and found.evaluate.reads() <= _of_states(system)
    )
    return FmuVariable(name, VariableKind.SIGNAL, found.unit, form=found.evaluate, follows_states=follows)


def _of_states(system: System) -> set[int]:
    places = wiring(system).columns
    return {place for name, _ in ROW if name in OF_STATES for place in range(places[name].start, places[name].stop)}


def advice(made: Interface, source: System) -> Iterator[Problem]:
    """What a master should know of the inputs of an FMU; source, the System before its inputs were numbers."""
    sampled = {item.name for item in source.inputs if item.signal.sampling()}
    speeds = {made.system.inputs[number].name for number in made.system.prescribed_input.tolist()}
    for _, one in made.of(VariableKind.INPUT):
        names = {made.system.inputs[number].name for number in one.inputs}
        if names & sampled:
            message = "is computed by a Python function, which an FMU cannot contain: its start value is 0"
            yield Problem(one.name, "", message, remedy="let the master set it from the start")
        if names & speeds:
            message = "prescribes a speed, which jumps from step to step where its value is held"
            remedy = "let the master give its rate too, as input derivative or der(...)"
            yield Problem(one.name, "", message, remedy=remedy)
