"""FMUs as a master runs them, by the bare calls of FMPy, which nobody here wrote."""

from __future__ import annotations

import ctypes
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import fmpy
from fmpy.fmi2 import FMU2Slave, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE
from fmpy.fmi3 import FMU3Slave
from fmpy.logging import addLoggerProxy

OK, WARNING, DISCARD, ERROR = range(4)


class Fmu:
    """An unpacked FMU, of which any number of instances are made."""

    def __init__(self, path: Path, folder: Path) -> None:
        self.folder = Path(fmpy.extract(path, unzipdir=folder))
        self.description = fmpy.read_model_description(path)
        self.version = self.description.fmiVersion
        self.variables = {one.name: one for one in self.description.modelVariables}

    @property
    def library(self) -> Path:
        """The library for this machine."""
        return next((self.folder / "binaries").rglob("*.so"))

    def instance(self, *, log: bool = False, **calls: Any) -> Instance:
        """One that is instantiated, and no more."""
        return Instance(self, log=log, **calls)

    @contextmanager
    def running(self, values: Mapping[str, float] | None = None, **how: Any) -> Iterator[Instance]:
        """One that is initialised with values."""
        made = self.instance()
        try:
            made.begin(values or {}, **how)
            yield made
        finally:
            made.free()


class Instance:
    """An instance, alike for both versions of FMI."""

    kinds: tuple[Any, Any] = (FMU2Slave, FMU3Slave)
    interface = "coSimulation"

    def __init__(self, fmu: Fmu, *, log: bool, event_mode: bool = False, early_return: bool = False) -> None:
        self.fmu, self.messages = fmu, list[tuple[int, str, str]]()
        model = getattr(fmu.description, self.interface).modelIdentifier
        kind = self.kinds[fmu.version != "2.0"]
        self.raw = kind(
            guid=fmu.description.guid, unzipDirectory=str(fmu.folder), modelIdentifier=model, instanceName="one"
        )
        if fmu.version == "2.0":
            self._callbacks = fmi2CallbackFunctions()
            self._callbacks.logger = fmi2CallbackLoggerTYPE(self._log_two)
            # fills in the arguments of messages
            addLoggerProxy(ctypes.byref(self._callbacks))
            self.raw.instantiate(callbacks=self._callbacks, loggingOn=log)
        else:
            steps = {"eventModeUsed": event_mode, "earlyReturnAllowed": early_return}
            more = steps if self.interface == "coSimulation" else {}
            self.raw.instantiate(loggingOn=log, logMessage=self._log_three(), **more)

    def _log_two(self, environment: Any, name: bytes, status: int, category: bytes, message: bytes, *_: Any) -> None:
        self.messages.append((status, category.decode(), message.decode()))

    def _log_three(self) -> Any:
        from fmpy.fmi3 import fmi3LogMessageCallback

        def say(environment: Any, status: int, category: bytes, message: bytes) -> None:
            self.messages.append((status, category.decode(), message.decode()))

        self._callback = fmi3LogMessageCallback(say)
        return self._callback

    # ------------------------------------------------------------------------------------------------------------ life

    def begin(self, values: Mapping[str, float], *, start: float = 0.0, tolerance: float | None = None) -> None:
        """Initialise with values."""
        if self.fmu.version == "2.0":
            self.raw.setupExperiment(startTime=start, tolerance=tolerance)
            self.raw.enterInitializationMode()
        else:
            self.raw.enterInitializationMode(startTime=start, tolerance=tolerance)
        for name, value in values.items():
            self.set(name, value)
        self.raw.exitInitializationMode()

    def free(self) -> None:
        """Free it."""
        self.raw.freeInstance()

    def step(self, time: float, size: float) -> Any:
        """One step."""
        return self.raw.doStep(time, size)

    # ---------------------------------------------------------------------------------------------------------- values

    def reference(self, name: str) -> int:
        """The value reference of a variable."""
        return int(self.fmu.variables[name].valueReference)

    def set(self, name: str, value: float) -> None:
        """Set a value, a signal also by its name in the model; an exception where the answer is not OK."""
        # the torque of a load has the name of the signal that sets its size
        known = f"{name}_signal" if f"{name}_signal" in self.fmu.variables else name
        (self.raw.setReal if self.fmu.version == "2.0" else self.raw.setFloat64)([self.reference(known)], [value])

    def rate(self, name: str, value: float) -> None:
        """Set the rate of an input over the coming step."""
        if self.fmu.version == "3.0":
            return self.set(f"der({name})", value)
        references, orders = (ctypes.c_uint * 1)(self.reference(name)), (ctypes.c_int * 1)(1)
        return self.raw.fmi2SetRealInputDerivatives(
            self.raw.component, references, 1, orders, (ctypes.c_double * 1)(value)
        )

    def get(self, names: Sequence[str]) -> list[float]:
        """Values of real variables."""
        references = [self.reference(name) for name in names]
        return list((self.raw.getReal if self.fmu.version == "2.0" else self.raw.getFloat64)(references))

    def mode(self, name: str) -> int:
        """Mode of a contact."""
        read = self.raw.getInteger if self.fmu.version == "2.0" else self.raw.getInt32
        return int(read([self.reference(name)])[0])

    # ---------------------------------------------------------------------------------------------------------- states

    def state(self) -> Any:
        """The present state."""
        return self.raw.getFMUstate() if self.fmu.version == "2.0" else self.raw.getFMUState()

    def go_to(self, state: Any) -> None:
        """Go to a state."""
        (self.raw.setFMUstate if self.fmu.version == "2.0" else self.raw.setFMUState)(state)

    def saved(self, state: Any) -> bytes:
        """A state as bytes."""
        two = self.fmu.version == "2.0"
        return bytes((self.raw.serializeFMUstate if two else self.raw.serializeFMUState)(state))

    def read(self, content: bytes) -> Any:
        """A state from bytes."""
        two = self.fmu.version == "2.0"
        return (self.raw.deSerializeFMUstate if two else self.raw.deserializeFMUState)(content)
