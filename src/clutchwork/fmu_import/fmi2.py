"""An instance of FMI 2.0."""

from __future__ import annotations

import ctypes as c
import platform
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from clutchwork.fmu_import.library import Assignment, FailedCall, NumberAccess, checked, function_of
from clutchwork.fmu_import.messages import Answer

TYPES = {"Real": c.c_double, "Integer": c.c_int, "Boolean": c.c_int}
CO_SIMULATION = 1
TERMINATED = 2  # fmi2Terminated of fmi2StatusKind
# whether the first argument of a message lies where an argument of a function without further ones would
ARGUMENTS_IN_PLACE = not (sys.platform == "darwin" and platform.machine() == "arm64")
LOG = c.CFUNCTYPE(None, c.c_void_p, c.c_char_p, c.c_int, c.c_char_p, c.c_char_p, c.c_void_p)


class Callbacks(c.Structure):
    """fmi2CallbackFunctions."""

    _fields_ = (
        ("log", LOG),
        ("allocate", c.c_void_p),
        ("free", c.c_void_p),
        ("finished", c.c_void_p),
        ("environment", c.c_void_p),
    )


class Instance2:
    """An instance, as `library.Instance` has it."""

    def __init__(self, library: Any, assigned: Assignment) -> None:
        self.library, self.assigned, self.said = library, assigned, ""
        self.values = NumberAccess(library, "fmi2", TYPES, counted=False)
        self.component: int | None = None
        self._callbacks = self._made_callbacks()

    def begin(self, time: float, inputs: Sequence[float]) -> None:
        """Instantiate and initialise."""
        make = function_of(self.library, "fmi2Instantiate")
        make.restype = c.c_void_p
        where = Path(self.assigned.folder, "resources").as_uri().encode()
        name, token = self.assigned.name.encode(), self.assigned.token.encode()
        self.component = make(name, CO_SIMULATION, token, where, c.byref(self._callbacks), 0, 0)
        if not self.component:
            raise FailedCall(Answer.NO_INSTANCE, "fmi2Instantiate")
        for reference, kind, value in self.assigned.parameters:
            self.values.set(self.component, reference, kind, value)
        self._call("fmi2SetupExperiment", 0, c.c_double(0.0), c.c_double(time), 0, c.c_double(0.0))
        self._call("fmi2EnterInitializationMode")
        self._set(inputs)
        self._call("fmi2ExitInitializationMode")

    def step(self, time: float, size: float, inputs: Sequence[float]) -> None:
        """Set inputs and step."""
        self._set(inputs)
        try:
            self._call("fmi2DoStep", c.c_double(time), c.c_double(size), 1)
        except FailedCall as failed:
            if failed.answer is Answer.DISCARD and self._has_terminated():
                raise FailedCall(Answer.TERMINATED, failed.text) from None
            raise

    def outputs(self) -> list[float]:
        """Values of the outputs."""
        return [self.values.get(self.component, *one) for one in self.assigned.outputs]

    def end(self) -> None:
        """Terminate and free."""
        self._call("fmi2Terminate")
        function_of(self.library, "fmi2FreeInstance")(c.c_void_p(self.component))

    def _has_terminated(self) -> bool:
        known = c.c_int(0)
        status = getattr(self.library, "fmi2GetBooleanStatus", None)
        answered = status is not None and status(c.c_void_p(self.component), TERMINATED, c.byref(known)) == 0
        return answered and bool(known.value)

    def _set(self, inputs: Sequence[float]) -> None:
        for (reference, kind), value in zip(self.assigned.inputs, inputs, strict=True):
            self.values.set(self.component, reference, kind, value)

    def _call(self, name: str, *given: Any) -> None:
        checked(name, function_of(self.library, name)(c.c_void_p(self.component), *given))

    def _made_callbacks(self) -> Callbacks:
        # memory of the C library itself, which needs no Python
        standard = c.CDLL("msvcrt") if sys.platform == "win32" else c.CDLL(None)
        memory = [c.cast(function, c.c_void_p) for function in (standard.calloc, standard.free)]
        self._log = LOG(self._heard)
        return Callbacks(self._log, *memory, None, None)

    def _heard(self, _env: Any, _name: Any, status: int, _category: Any, text: bytes | None, first: int | None) -> None:
        words = text or b""
        if words.strip() == b"%s":
            words = c.string_at(first) if first and ARGUMENTS_IN_PLACE else b""
        if words and (status > 1 or not self.said):
            self.said = words.decode("utf-8", "replace")
