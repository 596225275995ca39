"""An FMU of other people as a part of a driveline: its outputs set inputs of elements."""

from __future__ import annotations

import platform
import sys
from collections.abc import Callable, Mapping, Sequence
from functools import cached_property
from math import isfinite
from numbers import Real
from pathlib import Path
from typing import TYPE_CHECKING, Any

from clutchwork.base import FMUError, UseError, quote
from clutchwork.base.paths import path_of
from clutchwork.declare.calls import explained
from clutchwork.declare.quantity import QuantityError, has_unit, in_si
from clutchwork.fmu_import import archive
from clutchwork.fmu_import.description import INPUT, OUTPUT, PARAMETER, Description, FMUVariable, read
from clutchwork.fmu_import.library import Assignment
from clutchwork.fmu_import.output import Output

if TYPE_CHECKING:
    from clutchwork.declare.node import Number
    from clutchwork.signals.sampled import Sampled

UNTRUSTED = "runs the library of another program with your permissions: give trust=True if you trust its source"
ENDINGS = {"linux": ".so", "win32": ".dll", "darwin": ".dylib"}
TWO = {"linux": "linux", "win32": "win", "darwin": "darwin"}
THREE = {"linux": "linux", "win32": "windows", "darwin": "darwin"}
PROCESSORS = {"amd64": "x86_64", "x86_64": "x86_64", "arm64": "aarch64", "aarch64": "aarch64"}


class FMU:
    """An FMU for co-simulation (FMI 2.0 or 3.0) that runs beside a driveline: `fmu["p"]` is a signal for its elements.

    Use it for a controller or a model from another tool. Every `period` it reads its inputs just before that instant
    and steps by one period; its outputs hold from the next instant on: a delay of one period, as with a control unit.
    At the first instant its outputs are those of its initialisation. Each run starts it afresh in a process of its own,
    which ends in a `SimulationError` with the name of the FMU where it crashes, hangs or reports an error.
    """

    @explained("cw.FMU", path="'controller.fmu'", period="0.01", trust="True")
    def __init__(
        self,
        path: str | Path,
        period: Number,
        *,
        inputs: Mapping[str, str] | None = None,
        parameters: Mapping[str, float] | None = None,
        trust: bool = False,
        time_limit: Number = 60.0,
        name: str = "",
    ) -> None:
        """Read what an FMU says of itself; its library is loaded by runs alone.

        Parameters: period [s] from one step to the next; inputs, names of results by those of its inputs, such as
        {"slip": "c1.slip"}; parameters, numbers by name in the units of the FMU, also start values of inputs that
        nothing drives; trust, must be True, for a run executes the library; time_limit [s] for each of its steps and
        for its start; name in messages, that of the file by default. Values are in the SI units of the driveline, where
        the FMU says its own. UseError for arguments that do not fit, FMUError for any other file.
        """
        self.path = path_of("cw.FMU", path, "controller.fmu").absolute()
        self.name = name or self.path.stem
        problems = list[str]()
        self.period = _seconds("period", period, problems)
        self.time_limit = _seconds("time_limit", time_limit, problems)
        self.inputs = _named("inputs", inputs, str, "names of results, such as {'slip': 'c1.slip'}", problems)
        self.parameters = _named("parameters", parameters, Real, "numbers, such as {'gain': 2.0}", problems)
        if trust is not True:
            problems.append(f"{quote(self.path.name)} {UNTRUSTED}")
        if problems:
            raise UseError("cw.FMU", problems)
        try:
            self._description, self._library = self._read()
            for wanted, names in ((INPUT, self.inputs), (PARAMETER, self.parameters)):
                for one in names:
                    self._description.variable(one, wanted)
        except FMUError as error:
            raise FMUError(f"FMU {quote(self.name)} ({self.path}): {error}") from None

    def _read(self) -> tuple[Description, str]:
        made = read(archive.description_of(self.path))
        return made, library_of(made, archive.names_in(self.path))

    def __getitem__(self, output: str) -> Sampled:
        """An output as a signal that sets an input of an element; FMUError with near names where there is none."""
        # loaded where a signal is made
        from clutchwork.signals.sampled import Sampled

        try:
            self._description.variable(output, OUTPUT)
        except FMUError as error:
            raise FMUError(f"FMU {quote(self.name)}: {error}") from None
        return Sampled(Output(self, output), self.period)

    @property
    def outputs(self) -> tuple[str, ...]:
        """Names of its outputs that are numbers."""
        known = self._description.variables.values()
        return tuple(one.name for one in known if one.causality == OUTPUT and one.type)

    def variable(self, name: str) -> FMUVariable:
        """A variable of it."""
        return self._description.variables[name]

    def assignment(self, outputs: list[str]) -> Assignment:
        """What a run of it is, with some of its outputs; FMUError where the file is not what it was."""
        if self._read() != (self._description, self._library):
            raise FMUError(f"{self.path} has changed: make cw.FMU again")
        made, of = self._description, self._description.variables
        given = [(of[one].reference, of[one].type, value) for one, value in self.parameters.items()]
        read_, wanted = ([(of[one].reference, of[one].type) for one in names] for names in (self.inputs, outputs))
        return Assignment("", self._library, made.version, self.name, made.token, read_, wanted, given)

    @cached_property
    def _key(self) -> tuple[Any, ...]:
        given = (*self.inputs.items(), *self.parameters.items())
        return self.path, self.name, self.period, self.time_limit, given

    def __eq__(self, other: object) -> bool:
        return isinstance(other, FMU) and self._key == other._key

    def __hash__(self) -> int:
        return hash(self._key)

    def __repr__(self) -> str:
        version, count = self._description.version, len(self.outputs)
        return f"<FMU {quote(self.name)}, FMI {version}, every {self.period:g} s, {count} outputs>"


def _seconds(name: str, given: Any, problems: list[str]) -> float:
    try:
        value = in_si(given, "s") if has_unit(given) else given
    except QuantityError:
        value = None
    number = float(value) if isinstance(value, Real) and not isinstance(value, bool) else 0.0
    if isfinite(number) and number > 0.0:
        return number
    problems.append(f"{name} is {quote(given)}: give a time in s above 0")
    return 1.0


def _named(name: str, given: Any, kind: Any, such: str, problems: list[str]) -> dict[str, Any]:
    """A table by names; what does not fit is a problem."""
    values = {} if given is None else given
    if not isinstance(values, Mapping):
        problems.append(f"{name} is {quote(given)}: give a table of {such}")
        return {}
    convert: Callable[[Any], Any] = float if kind is Real else str
    made = {}
    for key, value in values.items():
        if not isinstance(key, str) or not isinstance(value, kind) or (kind is Real and not isfinite(value)):
            problems.append(f"{name}: {quote(key)} is {quote(value)}: give {such}")
        else:
            made[key] = convert(value)
    return made


def library_of(made: Description, names: Sequence[str]) -> str:
    """The entry with the library for this machine; FMUError names the platforms that there are."""
    known = places(made.version, made.identifier)
    found = next((name for name in known if name in names), None)
    if found is None:
        there = sorted({name.split("/")[1] for name in names if name.startswith("binaries/") and name.count("/") > 1})
        has = f"it has those of {', '.join(there)}" if there else "it has no library at all"
        raise FMUError(f"it has no library {known[0]} for this machine; {has}")
    return found


def places(version: str, identifier: str) -> list[str]:
    """Entries that may be the library for this machine, the one of the standard first."""
    ending = ENDINGS.get(sys.platform, ".so")
    return [f"binaries/{folder}/{identifier}{ending}" for folder in _folders(version)]


def _folders(version: str) -> list[str]:
    """Folders for this machine, the likely one first."""
    processor = PROCESSORS.get(platform.machine().lower(), platform.machine().lower())
    system = sys.platform
    three = f"{processor}-{THREE.get(system, system)}"
    if version == "3.0":
        return [three]
    # FMI 2.0 names the processors of its time alone
    return [f"{TWO.get(system, system)}64", three] if processor == "x86_64" else [three, f"{TWO.get(system, system)}64"]
