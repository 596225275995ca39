"""An instance of FMI 3.0."""

from __future__ import annotations

import ctypes as c
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from clutchwork.fmu_import.library import Assignment, FailedCall, NumberAccess, checked, function_of
from clutchwork.fmu_import.messages import Answer

TYPES: dict[str, Any] = {"Float64": c.c_double, "Float32": c.c_float, "Boolean": c.c_bool}
TYPES |= {f"{s}Int{n}": getattr(c, f"c_{s.lower()}int{n}") for s in ("", "U") for n in (8, 16, 32, 64)}
LOG = c.CFUNCTYPE(None, c.c_void_p, c.c_int, c.c_char_p, c.c_char_p)


class Instance3:
    """An instance, as `library.Instance` has it; without event mode and early return."""

    def __init__(self, library: Any, assigned: Assignment) -> None:
        self.library, self.assigned, self.said = library, assigned, ""
        self.values = NumberAccess(library, "fmi3", TYPES, counted=True)
        self.instance: int | None = None
        self._log = LOG(self._heard)

    def begin(self, time: float, inputs: Sequence[float]) -> None:
        """Instantiate and initialise."""
        make = function_of(self.library, "fmi3InstantiateCoSimulation")
        make.restype = c.c_void_p
        # a path that ends in a separator, not a URI
        where = str(Path(self.assigned.folder, "resources")) + "/"
        no = c.c_bool(False)
        self.instance = make(
            self.assigned.name.encode(),
            self.assigned.token.encode(),
            where.encode(),
            *(no, no, no, no),
            None,
            c.c_size_t(0),
            None,
            self._log,
            None,
        )
        if not self.instance:
            raise FailedCall(Answer.NO_INSTANCE, "fmi3InstantiateCoSimulation")
        for reference, kind, value in self.assigned.parameters:
            self.values.set(self.instance, reference, kind, value)
        self._call("fmi3EnterInitializationMode", no, c.c_double(0.0), c.c_double(time), no, c.c_double(0.0))
        self._set(inputs)
        self._call("fmi3ExitInitializationMode")

    def step(self, time: float, size: float, inputs: Sequence[float]) -> None:
        """Set inputs and step."""
        self._set(inputs)
        needed, terminate, early, last = c.c_bool(), c.c_bool(), c.c_bool(), c.c_double()
        places = [c.byref(needed), c.byref(terminate), c.byref(early), c.byref(last)]
        self._call("fmi3DoStep", c.c_double(time), c.c_double(size), c.c_bool(True), *places)
        if terminate.value:
            raise FailedCall(Answer.TERMINATED, "fmi3DoStep")
        if early.value:
            raise FailedCall(Answer.DISCARD, "fmi3DoStep, which came back early")

    def outputs(self) -> list[float]:
        """Values of the outputs."""
        return [self.values.get(self.instance, *one) for one in self.assigned.outputs]

    def end(self) -> None:
        """Terminate and free."""
        self._call("fmi3Terminate")
        function_of(self.library, "fmi3FreeInstance")(c.c_void_p(self.instance))

    def _set(self, inputs: Sequence[float]) -> None:
        for (reference, kind), value in zip(self.assigned.inputs, inputs, strict=True):
            self.values.set(self.instance, reference, kind, value)

    def _call(self, name: str, *given: Any) -> None:
        checked(name, function_of(self.library, name)(c.c_void_p(self.instance), *given))

    def _heard(self, _environment: Any, status: int, _category: Any, text: bytes | None) -> None:
        if text and (status > 1 or not self.said):
            self.said = text.decode("utf-8", "replace")
