"""The library of an FMU by ctypes: what both versions of FMI have in common. Runs in the process of the FMU alone."""

from __future__ import annotations

import ctypes as c
from collections.abc import Sequence
from typing import Any, NamedTuple, Protocol

from clutchwork.fmu_import.messages import Answer

OK, WARNING = 0, 1


class Assignment(NamedTuple):
    """What is to be run: paths, the FMU, and its variables as (reference, type)."""

    folder: str
    library: str
    version: str
    name: str
    token: str
    inputs: list[tuple[int, str]]
    outputs: list[tuple[int, str]]
    parameters: list[tuple[int, str, float]]


class FailedCall(Exception):  # noqa: N818, it is what happened
    """A call that did not answer OK."""

    def __init__(self, answer: Answer, text: str) -> None:
        self.answer, self.text = answer, text
        super().__init__(text)


class Instance(Protocol):
    """An instance of an FMU."""

    # what it said last
    said: str

    def begin(self, time: float, inputs: Sequence[float]) -> None:
        """Instantiate and initialise."""

    def step(self, time: float, size: float, inputs: Sequence[float]) -> None:
        """Set inputs and step."""

    def outputs(self) -> list[float]:
        """Values of the outputs."""

    def end(self) -> None:
        """Terminate and free."""


class NumberAccess:
    """Sets and gets numbers of any type, one call for each variable: inputs of the same type need not be together."""

    def __init__(self, library: Any, prefix: str, types: dict[str, Any], counted: bool) -> None:
        self.library, self.prefix, self.types, self.counted = library, prefix, types, counted

    def set(self, instance: Any, reference: int, kind: str, value: float) -> None:
        """Set one."""
        self._call("Set", instance, reference, kind, (self.types[kind] * 1)(as_type(kind, value)))

    def get(self, instance: Any, reference: int, kind: str) -> float:
        """Get one."""
        place = (self.types[kind] * 1)()
        self._call("Get", instance, reference, kind, place)
        return float(place[0])

    def _call(self, verb: str, instance: Any, reference: int, kind: str, place: Any) -> None:
        name = f"{self.prefix}{verb}{kind}"
        sizes = (c.c_size_t(1),) if self.counted else ()
        function = function_of(self.library, name)
        checked(name, function(c.c_void_p(instance), (c.c_uint * 1)(reference), c.c_size_t(1), place, *sizes))


def as_type(kind: str, value: float) -> Any:
    """A number as a value of a type: rounded where it counts, true above one half."""
    if kind == "Boolean":
        return int(value > 0.5)
    return float(value) if kind in ("Real", "Float64", "Float32") else round(value)


def function_of(library: Any, name: str) -> Any:
    """A function of the library, which answers with a status."""
    try:
        function = getattr(library, name)
    except AttributeError:
        raise FailedCall(Answer.NO_LIBRARY, f"its library has no {name}") from None
    function.restype = c.c_int
    return function


def checked(name: str, status: int) -> None:
    """FailedCall where a function did not do what it was asked for."""
    if status not in (OK, WARNING):
        answer = Answer(status) if status in (2, 3, 4, 5) else Answer.ERROR
        raise FailedCall(answer, name)
