"""The complete state of a run at an instant: what a run is continued from, here or elsewhere."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import field
from numbers import Real
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from clutchwork.base import ClutchworkError, UseError, dataclass, quote
from clutchwork.base.memoize import memoize
from clutchwork.base.paths import fitting, path_of
from clutchwork.base.quote import shortened
from clutchwork.base.regular import reason
from clutchwork.declare.calls import explained, explained_methods
from clutchwork.declare.quantity import QuantityError, has_unit, in_si
from clutchwork.results.external_settings import Held, held_of, plain_held

if TYPE_CHECKING:
    from pathlib import Path

    from clutchwork.assembly.system import System

FORMAT = 1
PARTS = ("head", "core", "row", "left")


class StateError(ClutchworkError, ValueError):
    """A state that is damaged, or that of another model."""


@explained_methods("state")
@dataclass(frozen=True, eq=False, repr=False)
class State:
    """A run at an instant, bit for bit: motion, contacts, angles and work, and what was set from outside.

    `Simulator.save` and `Trajectory.state` make it, `Simulator.restore` and `simulate(start=...)` go on from it. It
    belongs to the model that it is of, with all its numbers and signals; options of a run are not part of it. It can be
    pickled, and `save` writes one file without code inside. What a Python function of a controller remembers by itself
    is not in it.
    """

    time: float  # s
    model: str  # name of the driveline
    fingerprint: str  # of its System
    core: bytes = field(repr=False)  # as the compiled core saves it
    row: bytes = field(repr=False)  # output row at this instant
    left: bytes = field(default=b"", repr=False)  # the one before what was set there, which controllers see
    held: Held = field(default_factory=dict)  # signals that were set from outside
    changed: Mapping[str, Any] = field(default_factory=dict)  # parameters that were

    def __repr__(self) -> str:
        size = len(self.core) + len(self.row) + len(self.left)
        return f"<State of {quote(self.model)} at {self.time:g} s, {size / 1024:.1f} KiB>"

    @property
    def values(self) -> NDArray[np.float64]:
        """The output row of the core at this instant."""
        return np.frombuffer(self.row, dtype=np.float64)

    @property
    def before(self) -> NDArray[np.float64]:
        """The output row before what was set at this instant."""
        return np.frombuffer(self.left or self.row, dtype=np.float64)

    @explained("state.save", path="'run.cwstate'")
    def save(self, path: str | Path) -> None:
        """Write it to one file, whatever its ending; nothing in it is code."""
        # zip files, for those that are written
        from clutchwork.base import archive

        archive.write(fitting("state.save", path, "run.cwstate"), self.parts())

    def parts(self) -> dict[str, bytes]:
        """What a file holds of it, by the names in PARTS."""
        head = {"format": FORMAT, "time": self.time, "model": self.model, "fingerprint": self.fingerprint}
        head |= {"held": plain_held(self.held), "changed": dict(self.changed)}
        return {"head": json.dumps(head).encode(), "core": self.core, "row": self.row, "left": self.left}

    @classmethod
    def of_parts(cls, head: bytes, core: bytes, row: bytes, left: bytes) -> State:
        """The state of such parts; ValueError where they are none."""
        return cls(core=core, row=row, left=left, **_read_head(head))

    @classmethod
    @explained("cw.State.load", path="'run.cwstate'")
    def load(cls, path: str | Path) -> State:
        """Read a file of `save`; StateError for any other. Whether it fits a model is seen where it is used."""
        # as above
        from clutchwork.base import archive

        path_of("cw.State.load", path, "run.cwstate")
        try:
            return cls.of_parts(*archive.read(path, PARTS))
        except (ValueError, RecursionError, OSError) as error:
            if isinstance(error, FileNotFoundError):
                raise StateError(f"{path} does not exist; check the path") from None
            why = reason(error) if isinstance(error, OSError) else shortened(str(error))
            raise StateError(f"{path}: cannot read a state: {why}; write the file with State.save") from None

    def fits(self, system: System) -> None:
        """StateError where it is the state of another model."""
        if self.fingerprint != fingerprint(system):
            same = (
                f"{quote(system.name)} with other numbers or signals" if self.model == system.name else "another model"
            )
            told = (
                f"this is a state of {quote(self.model)}"
                if self.model != system.name
                else "this is a state of the model"
            )
            raise StateError(
                f"{told} at {self.time:g} s, and the model here is {same}: "
                "continue with the model that it was saved from, and change what may change with Simulator.set"
            )


@memoize
def fingerprint(system: System) -> str:
    """What a System is recognised by, found once."""
    # loads the library of OpenSSL
    import hashlib

    return hashlib.sha256(system.to_bytes()).hexdigest()


def instant(at: object, begin: float, reached: float) -> float:
    """A time of a run [s] that goes from begin to what it has reached, None: its end; UseError for any other."""
    if at is None:
        return reached
    if has_unit(at):
        try:
            at = in_si(at, "s")
        except QuantityError as bad:
            raise UseError("run.state", [f"at is {quote(at)}: {bad.message}; give a time in s"]) from None
    if isinstance(at, bool) or not isinstance(at, Real):
        raise UseError("run.state", [f"at is {quote(at)}: give a time in s, or nothing for the end"])
    if not begin <= float(at) <= reached:
        raise UseError("run.state", [f"at is {float(at):g} s: the run goes from {begin:g} to {reached:g} s"])
    return float(at)


def _read_head(data: bytes) -> dict[str, Any]:
    """The fields beside the bytes; ValueError where they are not what they must be."""
    head = json.loads(data)
    if not isinstance(head, dict) or head.get("format") != FORMAT:
        raise ValueError("it was written by another version")
    kinds = {"time": float, "model": str, "fingerprint": str, "held": dict, "changed": dict}
    if any(not isinstance(head.get(name), kind) for name, kind in kinds.items()):
        raise ValueError("its head is damaged")
    return {name: head[name] for name in kinds} | {"held": held_of(head["held"])}
