"""`clutchwork sweep`: the sweep that is asked for, its report and files."""

from __future__ import annotations

import argparse
import re
import sys
from collections.abc import Iterator
from typing import Any

import numpy as np

from clutchwork.base import UseError, columns, counted, near, shell
from clutchwork.base.shell import DONE, INTERRUPTED, STOPPED
from clutchwork.declare.options import instants
from clutchwork.declare.units import split
from clutchwork.declare.wording import words_of_files
from clutchwork.driveline.driveline import Driveline
from clutchwork.run.flags import given_options
from clutchwork.sweeps import outputs as made
from clutchwork.sweeps.asking import CALLS, FORMS, KNOWN
from clutchwork.sweeps.factors import times
from clutchwork.sweeps.result import Sweep, SweepInterrupted
from clutchwork.sweeps.sweep import sweep

WRITERS = {".parquet": Sweep.to_parquet, ".csv": Sweep.to_csv}


def performed(asked: argparse.Namespace) -> int:
    """Run, report, write; the exit code."""
    if asked.out is not None and asked.out.suffix not in WRITERS:
        raise UseError("sweep", [f"--out {asked.out}: must end in .parquet or .csv"])
    shell.writable([asked.out])
    given = _all_varied(asked.vary)
    vary = dict(given)
    twice = [name for name in vary if [one for one, _ in given].count(name) > 1]
    if twice:
        raise UseError("sweep", [f"--vary {name} appears twice; give all its values at once" for name in twice])
    model = Driveline.load(asked.model)
    if not vary:
        names = "clutchwork check MODEL --names lists the names"
        raise UseError(
            "sweep", [f"--vary is missing: give values of a name, such as --vary c1.gain=4e-4,8e-4; {names}"]
        )
    wanted = _outputs(asked.outputs) if asked.outputs else _by_default(model)
    code = DONE
    with words_of_files():
        try:
            found = sweep(model, vary=vary, outputs=wanted, threads=asked.threads, **given_options(asked))
            code = DONE if found.finished.all() else STOPPED
        except SweepInterrupted as stop:
            found, code = stop.sweep, INTERRUPTED
    _report(found, asked)
    return code


def _report(found: Sweep, asked: argparse.Namespace) -> None:
    if asked.out is not None:
        asked.out.parent.mkdir(parents=True, exist_ok=True)
        WRITERS[asked.out.suffix](found, asked.out)
    files = [str(asked.out)] if asked.out is not None else []
    if asked.json:
        shell.tell_json(_data(found) | {"files": files})
    elif not asked.quiet:
        shell.tell("\n".join([*_text(found), *shell.wrote([asked.out] if asked.out is not None else [])]))
    stopped = [number for number in np.flatnonzero(~found.finished.reshape(-1)).tolist() if found.message(number)]
    for number in stopped[:1]:
        sys.stderr.write(f"clutchwork: variant {number} {found.message(number)}\n")


def _text(found: Sweep) -> list[str]:
    """Counts, and the range of every output."""
    lines = [("output", "min", "max", "unit")]
    lines += [(name, f"{low:.6g}", f"{high:.6g}", found.units[name]) for name, low, high in _ranges(found)]
    ends = ", ".join(f"{count} {end}" for end, count in _ends(found).items())
    return [f"{counted(len(found), 'variants')}: {ends}", columns(lines, right={1, 2}), *found.without_values()]


def _data(found: Sweep) -> dict[str, Any]:
    ranges: dict[str, dict[str, Any]] = {
        name: {"min": low, "max": high, "unit": found.units[name]} for name, low, high in _ranges(found)
    }
    for name in found.names:
        missing = found.without_value(name)
        if name in ranges or missing:
            none = {"min": None, "max": None, "unit": found.units[name]}
            ranges[name] = {**ranges.get(name, none), "without_value": missing}
    return {"variants": len(found), "status": _ends(found), "outputs": ranges}


def _ends(found: Sweep) -> dict[str, int]:
    names, counts = np.unique(found.status, return_counts=True)
    return dict(zip(names.tolist(), counts.tolist(), strict=True))


def _ranges(found: Sweep) -> Iterator[tuple[str, float, float]]:
    for name in found.names:
        values = found.flat(name)
        known = values[~np.isnan(values)] if values.dtype.kind == "f" else values[:0]
        if len(known):
            yield name, float(known.min()), float(known.max())


def _all_varied(texts: list[str]) -> list[tuple[str, Any]]:
    """All of them; UseError names everything that is wrong at once."""
    made, problems = list[tuple[str, Any]](), list[str]()
    for text in texts:
        try:
            made.append(_varied(text))
        except UseError as error:
            problems += error.problems
    if problems:
        raise UseError("sweep", problems)
    return made


def _varied(text: str) -> tuple[str, Any]:
    """c1.gain=4e-4:8e-4:21, c1.gain=4e-4,8e-4, with units, c1.pressure=1:3 bar:5, factors c*.gain*=0.9,1.1."""
    name, sign, values = text.partition("=")
    name, is_factor = name.removesuffix("*"), name.endswith("*")
    spaced = values.count(":") == 2
    words = values.split(":")[:2] if spaced else values.split(",")
    parts = [split(word) for word in words]
    numbers = [part[0] for part in parts if part is not None]
    units = {part[1] for part in parts if part is not None and part[1]}
    try:
        if spaced:
            first, last = numbers
            numbers = np.linspace(first, last, int(values.split(":")[2])).tolist()
    except (ValueError, TypeError):
        numbers = []
    if not sign or not name or not numbers or None in parts or (":" in values and not spaced):
        remedy = "write NAME=FIRST:LAST:COUNT or NAME=A,B,C, such as c1.gain=4e-4:8e-4:21 or 'c1.pressure=1:3 bar:5'"
        raise UseError("sweep", [f"--vary {text}: {remedy}"])
    if len(units) > 1 or (units and not parts[-1][1]):  # type: ignore[index]
        raise UseError("sweep", [f"--vary {text}: write one unit, behind the last value: 'c1.pressure=1,2,3 bar'"])
    if is_factor and units:
        raise UseError("sweep", [f"--vary {text}: a factor has no unit; write c1.gain*=0.9,1.1"])
    if is_factor:
        return name, times(*numbers)
    return name, [f"{number!r} {unit}" for number in numbers for unit in units] or numbers


def _outputs(text: str) -> list[Any]:
    """Signals and calls, with commas between them."""
    return [_output(part.strip()) for part in re.split(r",(?![^()]*\))", text) if part.strip()]


def _output(text: str) -> Any:
    found = re.fullmatch(r"(\w+)\((.*)\)", text)
    if found is None:
        return text
    call, (name, *rest) = found[1], [part.strip() for part in found[2].split(",")]
    if call not in CALLS:
        raise UseError("sweep", [f"--outputs {text}: no output {call!r}{near(call, CALLS, KNOWN)}"])
    most = {"at": None, "jerk": 1, "lock": 1, "break_away": 1}.get(call, 0)
    if most is not None and len(rest) > most:
        raise UseError("sweep", [f"--outputs {text}: {FORMS[[*CALLS].index(call)]} has no more"])
    try:
        numbers = [_instant(part) if call in ("at", "jerk") else int(part) for part in rest]
    except ValueError:
        raise UseError("sweep", [f"--outputs {text}: {', '.join(rest)} must be numbers"]) from None
    return getattr(made, call)(name, *([numbers] if call == "at" else numbers))


def _instant(text: str) -> float:
    """A time in s, or with a unit."""
    try:
        return float(text)
    except ValueError:
        return float(instants([text])[0])


def _by_default(model: Driveline) -> list[Any]:
    """Speeds at the end, and when each contact locks for the last time."""
    system = model.assemble()
    speeds = [f"{node.name}.speed" for node in system.nodes]
    return [*speeds, *(made.lock(contact.name, -1) for contact in system.contacts)]
