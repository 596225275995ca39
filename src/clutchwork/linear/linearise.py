"""`cw.linearise`: the linear system of the motion that is left in the present locked set."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from clutchwork.assembly.system import System
from clutchwork.base import UseError
from clutchwork.base.arrays import Array
from clutchwork.declare.calls import explained
from clutchwork.linear.chosen import Excitation, chosen_inputs, chosen_outputs
from clutchwork.linear.equations import equations
from clutchwork.linear.instant import CALL, Instant, instant_of
from clutchwork.linear.motion import Motion
from clutchwork.linear.notes import notes
from clutchwork.linear.own_states import own_states
from clutchwork.linear.quantity import Quantity
from clutchwork.linear.result import Linear
from clutchwork.results.channels import channels
from clutchwork.results.forms import Form
from clutchwork.run.simulation import Assembles
from clutchwork.run.trajectory import Trajectory
from clutchwork.stepping.simulator import Simulator

# what of an output comes from the slope of an input and is round-off
ROUND_OFF = 1e-9


@explained(CALL)
def linearise(
    model: Assembles | System | Trajectory | Simulator,
    *,
    at: Any = None,
    inputs: str | Sequence[str] | None = None,
    outputs: str | Sequence[str] | None = None,
) -> Linear:
    """The linear system of a driveline at its start, of a run at an instant, or of a Simulator where it is.

    Use it for torsional frequencies and mode shapes, for judder, and for the design of controllers. Locked contacts are
    constraints: what they hold is gone from the system. Slipping ones contribute the slopes of their friction laws over
    slip, load and temperature.

    Parameters: model, a Driveline, a System, a run, or a `Simulator`, which is taken where it is with all that was
    set; at, the instant [s], needed with a run, which a model is run up to, or a `State` of a model; inputs and
    outputs, names of signals or wildcards such as `*.speed`. Inputs are all signals that the model is given by
    default, outputs all speeds and the other states. A prescribed speed "motor.speed" may also be given by its
    acceleration, as the input "motor.acceleration".

    UseError names all that is wrong with the call; ModelError all mistakes of the model; SimulationError says why the
    instant was not reached.
    """
    instant = instant_of(model, at)
    motion, system = Motion(instant), instant.system
    problems, left_out = list[str](), list[str]()
    given = chosen_inputs(system, inputs, problems)
    given = _free_inputs(motion, given, inputs is None, problems, left_out)
    names = chosen_outputs(system, outputs, _default_outputs(instant), problems)
    if problems:
        raise UseError(CALL, problems)
    return _made(motion, given, names, left_out)


def _made(motion: Motion, given: list[Excitation], names: list[str], left_out: list[str]) -> Linear:
    """The result, unless an output needs the slope of an input."""
    instant, known = motion.instant, channels(motion.system, True, True)
    found = equations(motion, given, *_wanted(instant, names))
    n, m = len(found.states), len(given)
    lines = np.array([_along(known[name].evaluate, instant.row, found.row) for name in names])
    lines = lines.reshape(len(names), n + 2 * m)
    problems = list(_improper(names, given, lines, n))
    if problems:
        raise UseError(CALL, problems)
    outputs = [Quantity(name, known[name].unit, float(known[name].evaluate(instant.row[None, :])[0])) for name in names]
    values = [float(instant.part("input")[one.signal]) for one in given]
    for place, one in enumerate(given):
        if one.accelerates:
            values[place] = float(motion.prescribed_accelerations[one.motion])
    contacts = [contact.name for contact in motion.system.contacts]
    shafts = instant.wiring.columns["speed"]
    return Linear(
        model=motion.system.name,
        time=instant.time,
        A=found.A,
        B=found.B,
        C=lines[:, :n],
        D=lines[:, n : n + m],
        state_quantities=tuple(Quantity(s.name, s.unit, s.value, s.rate) for s in found.states),
        input_quantities=tuple(Quantity(one.name, one.unit, v) for one, v in zip(given, values, strict=True)),
        output_quantities=tuple(outputs),
        modes_of_contacts=dict(zip(contacts, instant.modes.tolist(), strict=True)),
        notes=(*left_out, *notes(motion)),
        shafts=tuple(node.name for node in motion.system.nodes),
        shaft_speeds=found.row[shafts, :n],
    )


def _free_inputs(
    motion: Motion, given: list[Excitation], default: bool, problems: list[str], left_out: list[str]
) -> list[Excitation]:
    """Inputs without prescribed speeds that locked contacts hold."""
    tied = {int(k) for k in np.flatnonzero(np.abs(motion.free.ties).max(axis=0, initial=0.0) > ROUND_OFF)}
    # a ratio that moves acts by its slope too
    turning = np.abs(motion.local.split(motion.local.ratio)[2][motion.ties.rate != 0.0]).max(axis=0, initial=0.0)
    ratios = {int(k) for k in np.flatnonzero(turning)}
    kept = [one for one in given if one.motion not in tied and one.signal not in ratios]
    for one in given:
        if one.signal in ratios:
            reason = f"{one.name} acts by its slope too: give the ratio by a RatioActuator and take its command"
            left_out.append(f"{reason}; it is left out") if default else problems.append(f"inputs: {reason}")
        if one.motion in tied:
            reason = f"{one.name} cannot change by itself: locked contacts hold that motion"
            left_out.append(f"{reason}; it is left out") if default else problems.append(f"inputs: {reason}")
    return kept


def _along(form: Form, row: Array, change: Array) -> Array:
    """How a signal changes at a row with the numbers of that. docs/theory/linearisation.md (11)."""
    found = form.weights(row[None, :])
    line: Array = found.values[0] @ change[found.columns]
    return line


def _default_outputs(instant: Instant) -> list[str]:
    speeds = [f"{node.name}.speed" for node in instant.system.nodes]
    return [*speeds, *(state.name for state in own_states(instant.wiring) if state.counts)]


def _wanted(instant: Instant, names: Sequence[str]) -> tuple[list[int], list[int]]:
    """Nodes whose angles, and states of ambients, that the outputs follow from."""
    known, columns = channels(instant.system, True, True), instant.wiring.columns
    used = {column for name in names for column in known[name].evaluate.reads()}
    angles = [k for k, column in enumerate(range(columns["angle"].start, columns["angle"].stop)) if column in used]
    states = own_states(instant.wiring)
    heats = [k for k, state in enumerate(states) if not state.counts and columns["state"].start + k in used]
    return angles, heats


def _improper(names: Sequence[str], given: Sequence[Excitation], lines: Array, n: int) -> list[str]:
    """Outputs that need the slope of an input, each with what to do."""
    found, m = [], len(given)
    for name, line in zip(names, lines, strict=True):
        slopes = np.abs(line[n + m :])
        size = float(np.max(np.abs(line), initial=0.0))
        for one, slope in zip(given, slopes, strict=True):
            if slope <= ROUND_OFF * size:
                continue
            if one.motion >= 0:
                other = f"{one.name.removesuffix('.speed')}.acceleration"
                remedy = f"give the input {other!r} in place of {one.name!r}, or leave the output out"
            else:
                remedy = f"leave out the output, or {one.name!r} from the inputs"
            found.append(f"output {name!r} follows the slope of the input {one.name!r}; {remedy}")
    return found


linearize = linearise
