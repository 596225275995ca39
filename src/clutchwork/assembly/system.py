"""The frozen System: flat arrays that the compiled core reads, and the names that belong to them."""

from __future__ import annotations

import struct
from collections.abc import Mapping, Sequence
from copy import deepcopy
from dataclasses import replace
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np

from clutchwork.assembly.assemble import assembled
from clutchwork.assembly.changes import changed_system
from clutchwork.assembly.provenance import SystemParameters
from clutchwork.assembly.records import TYPES, frozen
from clutchwork.assembly.system_data import MAGIC, SystemData
from clutchwork.base import ClutchworkError, UseError, dataclass, quote
from clutchwork.base.quote import shortened
from clutchwork.declare.calls import explained, explained_methods
from clutchwork.declare.core import core
from clutchwork.declare.layout import COUNTS, FIELDS
from clutchwork.model.findings import may_change
from clutchwork.model.model import Model
from clutchwork.model.settings import plain_settings

if TYPE_CHECKING:
    from pathlib import Path

    from clutchwork.model.findings import Findings

# of a file that holds a System
PARTS = ("content", "model", "independent")


class SystemFormatError(ClutchworkError, ValueError):
    """Bytes or a file that hold no System of this version."""


@explained_methods("system")
@dataclass(frozen=True, eq=False, repr=False)
class System(SystemData):
    """A driveline ready to run; never changes, so any number of runs and threads may share it.

    `arrays` holds what `layout.FIELDS` lists; each is also an attribute: `system.inertia`. So are the matrices of
    `layout.SPARSE`, made whole: `system.mass`.
    Elements, contacts, motions, flows, processes and nodes stand in the order of their arrays.
    """

    def _repr_mimebundle_(self, **_: Any) -> dict[str, Any]:
        from clutchwork.base.rich import bundle
        from clutchwork.base.verbs import do

        return bundle(self, *do("system.show", self))

    @classmethod
    def of(cls, model: Model, independent: Sequence[str] = (), found: Findings | None = None) -> System:
        """The System of a model without mistakes; `independent` names the shafts with the independent speeds.

        Parameters: found, what the checks of the model have found, where they were made already.
        """
        made, settings = assembled(model, independent, found), MappingProxyType(plain_settings(model.settings))
        # lists inside may be changed by their owner later
        source = deepcopy(model.copy()) if may_change(model) else model.copy()
        return cls(**made, settings=settings, source=source, wanted=tuple(independent))

    def changed(self, changes: Mapping[str, Any]) -> System:
        """The System of the same driveline with other numbers, initial values and signals.

        Parameters: changes, values by name: "engine.inertia", "c1.gain", "row1.ratio", "c1.friction.kinetic", or
        "c1.pressure", a number, one with a unit, "2 bar", or a signal. ModelError names everything unknown or out of
        bounds at once.

        The result is that of assembling a driveline with these values, bit for bit. What it warns of is new.
        """
        if not isinstance(changes, Mapping):
            remedy = 'give values by name: changed({"engine.inertia": 0.3, "c1.gain": 5e-4})'
            raise UseError("changed", [f"changes is {quote(changes)}: {remedy}"])
        return changed_system(self, changes)

    @property
    def parameters(self) -> SystemParameters:
        """All that may be changed, by name: its value, unit and bounds, the words that it reaches, and when it may."""
        return SystemParameters(self)

    @classmethod
    def from_bytes(cls, data: bytes, name: str = "system") -> System:
        """A System without names from the bytes of `to_bytes`."""
        head = len(MAGIC) + 8 + 8 * len(COUNTS)
        if len(data) < head or data[: len(MAGIC)] != MAGIC:
            raise SystemFormatError("these bytes are not a System; use those from System.to_bytes")
        if struct.unpack_from("<q", data, len(MAGIC))[0] != core().schema_hash():
            raise SystemFormatError("this System was assembled by another version; assemble the driveline again")
        sizes = dict(zip((n for n, _ in COUNTS), struct.unpack_from(f"<{len(COUNTS)}q", data, 16), strict=True))
        arrays, start = {}, head
        for item, kind, shape, _ in FIELDS:
            lengths = [size if isinstance(size, int) else sizes[size] for size in shape]
            count = int(np.prod(lengths))
            if start + count * TYPES[kind].itemsize > len(data):
                raise SystemFormatError(f"these bytes end inside {item!r}; the file is truncated")
            arrays[item] = np.frombuffer(data, TYPES[kind], count, start).reshape(lengths)
            start += -(-count * TYPES[kind].itemsize // 8) * 8
        return cls(name=name, arrays=frozen(arrays))

    @explained("system.save", path="'model.cwsystem'")
    def save(self, path: str | Path) -> None:
        """Write arrays and model to an archive, whatever its ending; nothing in it is code."""
        from clutchwork.base import archive
        from clutchwork.base.paths import fitting

        parts = self.parts()
        archive.write(fitting("system.save", path, "model.cwsystem"), parts)

    def parts(self) -> dict[str, bytes]:
        """What a file holds of it, by the names of `PARTS`."""
        import json

        if not self.model:
            raise SystemFormatError(
                "this System has a controller in Python or no names; save its driveline or to_bytes()"
            )
        model = {**self.model, "simulation": plain_settings(self.settings)}
        stored = {"model": json.dumps(model, allow_nan=False), "independent": json.dumps(self.independent)}
        return {"content": self.to_bytes(), **{key: value.encode() for key, value in stored.items()}}

    @classmethod
    @explained("cw.System.load", path="'model.cwsystem'")
    def load(cls, path: str | Path) -> System:
        """Read a file that `save` wrote; SystemFormatError or ModelError for any other."""
        from clutchwork.base import archive
        from clutchwork.base.paths import path_of
        from clutchwork.base.regular import reason

        path_of("cw.System.load", path, "model.cwsystem")
        try:
            return cls.of_parts(archive.read(path, PARTS), str(path))
        except (ValueError, OSError) as error:
            if isinstance(error, ClutchworkError):
                raise
            if isinstance(error, FileNotFoundError):
                raise SystemFormatError(f"{path} does not exist; check the path") from None
            why = reason(error) if isinstance(error, OSError) else shortened(str(error))
            raise SystemFormatError(f"{path}: cannot read a System: {why}; write the file with System.save") from None

    @classmethod
    def of_parts(cls, parts: Sequence[bytes], path: str) -> System:
        """From what `parts` gave, in the order of `PARTS`; a ValueError where they are damaged.

        Parameters: path, the file that messages name.
        """
        import json

        from clutchwork.files.model_file import from_dict

        content, *texts = parts
        try:
            model, independent = map(json.loads, texts)
        except RecursionError as error:
            raise ValueError(str(error)) from None
        if not isinstance(independent, list) or not all(isinstance(name, str) for name in independent):
            raise SystemFormatError(f"{path}: its independent speeds are not names; write the file with System.save")
        named = cls.of(from_dict(model), independent)
        plain = cls.from_bytes(content, named.name)
        if any(plain.arrays[name].shape != array.shape for name, array in named.arrays.items()):
            raise SystemFormatError(f"{path}: its arrays do not fit its model; write the file with System.save")
        return replace(named, arrays=plain.arrays)
