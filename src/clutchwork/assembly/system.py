"""The frozen System: flat arrays that the compiled core reads, and the names that belong to them."""

from __future__ import annotations

import struct
from collections.abc import Mapping, Sequence
from copy import deepcopy
from dataclasses import field, fields, replace
from functools import cached_property
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np

from clutchwork.assembly.assemble import assembled
from clutchwork.assembly.changes import GROUPS, UNKNOWN_SOURCE, Quick, changed, quick
from clutchwork.assembly.dependence import dependent_sets
from clutchwork.assembly.patches import Numbered, numbered
from clutchwork.assembly.provenance import SystemParameters
from clutchwork.assembly.records import TYPES, Array, Gearing, Input, Link, frozen
from clutchwork.assembly.sparse import dense, entries
from clutchwork.assembly.storage_bounds import rooms
from clutchwork.base.classes import dataclass
from clutchwork.base.errors import ClutchworkError, ModelError, UseError, near, warn
from clutchwork.base.plural import counted
from clutchwork.base.quote import quote, shortened
from clutchwork.declare.calls import explained, explained_methods
from clutchwork.declare.core import core
from clutchwork.declare.layout import COUNTS, FIELDS, SPARSE
from clutchwork.declare.node import Component, Node, ShiftTable, ThermalNode
from clutchwork.declare.schema import Role
from clutchwork.model.findings import may_change
from clutchwork.model.model import Model
from clutchwork.model.settings import plain_settings

if TYPE_CHECKING:
    from pathlib import Path

    from clutchwork.model.findings import Findings

MAGIC = b"CLUTCHWK"
# what a Driveline can do itself
CALLS = {
    "simulate": "; run it by cw.simulate(system, t_end)",
    "sweep": "; cw.sweep(system, t_end, vary=..., outputs=...) does it",
    "gradient": "; cw.differentiable(system, t_end, of=..., by=...).gradient() does it",
}
# what of a changed System is made where it is asked for, and where it is noted what that is made of
LATER, CHANGE = frozenset((*GROUPS, "nodes", "gears", "inputs", "source")), "_change"
# of a file that holds a System
PARTS = ("content", "model", "independent")


class SystemFormatError(ClutchworkError, ValueError):
    """Bytes or a file that hold no System of this version."""


@explained_methods("system")
@dataclass(frozen=True, eq=False, repr=False)
class System:
    """A driveline ready to run; never changes, so any number of runs and threads may share it.

    `arrays` holds what `layout.FIELDS` lists; each is also an attribute: `system.inertia`. So are the matrices of
    `layout.SPARSE`, made whole: `system.mass`.
    Elements, contacts, motions, flows, processes and nodes stand in the order of their arrays.
    """

    name: str
    arrays: Mapping[str, Array]
    nodes: tuple[Node, ...] = field(default_factory=tuple)
    elements: tuple[Component, ...] = field(default_factory=tuple)
    contacts: tuple[Component, ...] = field(default_factory=tuple)
    motions: tuple[Component, ...] = field(default_factory=tuple)
    gears: tuple[Gearing, ...] = field(default_factory=tuple)
    sensors: tuple[Component, ...] = field(default_factory=tuple)
    thermal: tuple[ThermalNode, ...] = ()
    flows: tuple[Component, ...] = field(default_factory=tuple)
    processes: tuple[Component, ...] = field(default_factory=tuple)
    inputs: tuple[Input, ...] = field(default_factory=tuple)
    links: tuple[Link, ...] = ()
    gearboxes: tuple[ShiftTable, ...] = ()  # gears by name
    sums: Mapping[str, tuple[str, ...]] = field(default_factory=dict)  # "c1" -> parts that count as "c1"
    independent: tuple[str, ...] = ()  # names of the nodes with independent speeds
    places: Mapping[str, int] = field(default_factory=dict)  # "c1.gain" -> place in params
    notes: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()  # what the driveline was warned of when it was assembled
    settings: Mapping[str, Any] = field(default_factory=dict)  # of its runs, as in [simulation] of a model file
    # the driveline, as it was when it was assembled
    source: Model | None = field(default_factory=lambda: None, repr=False)
    wanted: tuple[str, ...] = ()  # names of the independent speeds where they were asked for

    def __repr__(self) -> str:
        sizes = {"shafts and masses": self.counts["nodes"]}
        if self.source is not None:
            # as a Driveline says it
            sizes |= {"thermal nodes": len(self.source.thermal), "elements": len(self.source.elements)}
        parts = {"independent speeds": "speeds", "torque elements": "elements", "contacts": "contacts"}
        sizes |= {words: self.counts[name] for words, name in parts.items()} | {"inputs": self.counts["inputs"]}
        return f"<System {quote(self.name)}: {', '.join(counted(size, words) for words, size in sizes.items())}>"

    def _repr_mimebundle_(self, **_: Any) -> dict[str, Any]:
        from clutchwork.base.rich import bundle
        from clutchwork.base.verbs import do

        return bundle(self, *do("system.show", self))

    def __getattr__(self, name: str) -> Array:
        own = self.__dict__
        try:
            if name in LATER:
                change = own.get(CHANGE)
                found: Array = own[name] if change is None else self._later(name, *change)
                return found
            arrays = own["arrays"]
            return dense(arrays, name) if name in SPARSE else arrays[name]
        except KeyError:
            known = [*SPARSE, *(n for n, *_ in FIELDS)]
            told = CALLS.get(name) or near(name, known)
            raise AttributeError(f"a System has no {name!r}{told}") from None

    def _later(self, name: str, old: System, found: Quick) -> Any:
        """What of a changed System is made where it is asked for."""
        made = {"source": old.source and found.source(old.source)} if name == "source" else found.content(old)
        for item, value in made.items():
            # what another thread made first stays
            self.__dict__.setdefault(item, value)
        return self.__dict__[name]

    def __getstate__(self) -> dict[str, Any]:
        # a view of a dictionary cannot be pickled; what was found since comes again
        own = {item.name: getattr(self, item.name) for item in fields(self)}
        return own | {"arrays": dict(self.arrays), "settings": dict(self.settings)}

    def __setstate__(self, own: dict[str, Any]) -> None:
        settings = MappingProxyType(own["settings"])
        vars(self).update(own | {"arrays": frozen(own["arrays"]), "settings": settings})

    @cached_property
    def counts(self) -> dict[str, int]:
        """Sizes as `layout.COUNTS` lists them."""
        sizes = {name: 0 for name, _ in COUNTS}
        for name, _, shape, _ in FIELDS:
            for size, length in zip(shape, self.arrays[name].shape, strict=True):
                if isinstance(size, str):
                    sizes[size] = max(sizes[size], length)
        return sizes | rooms(self.arrays)

    @cached_property
    def model(self) -> Mapping[str, Any]:
        """The driveline as in a model file; empty where there is none, or it holds Python functions."""
        from clutchwork.files.model_file import to_dict

        try:
            return {} if self.source is None else to_dict(self.source, embed=True)
        except ModelError:
            return {}

    @property
    def dependent(self) -> tuple[tuple[str, ...], ...]:
        """Sets of contacts that depend on each other when locked together, so that their shares are a convention."""
        return dependent_sets([contact.name for contact in self.contacts], entries(self.arrays, "contact_rate"))

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
        "c1.pressure", a number, one with a unit, "2 bar", or a signal. ModelError names all that is unknown or out of
        bounds at once.

        The result is that of assembling a driveline with these values, bit for bit. What it warns of is new.
        """
        if not isinstance(changes, Mapping):
            remedy = 'give values by name: changed({"engine.inertia": 0.3, "c1.gain": 5e-4})'
            raise UseError("changed", [f"changes is {quote(changes)}: {remedy}"])
        if self.source is None:
            raise ModelError([UNKNOWN_SOURCE])
        found = quick(self, changes)
        # elements that are warned of are looked at as a whole
        if found is not None and not (self.warnings and found.values):
            return self._with(found)
        source, made, advice = changed(self.source, self.wanted, len(self.independent), changes)
        for one in advice:
            if str(one) not in self.warnings:
                warn(one)
        return System(**made, settings=self.settings, source=source, wanted=self.wanted)

    @cached_property
    def numbered(self) -> Numbered:
        """Where everything stands in the arrays, for changes of numbers."""
        groups = {
            Role.TORQUE: self.elements,
            Role.CONTACT: self.contacts,
            Role.FLOW: self.flows,
            Role.PROCESS: self.processes,
        }
        return numbered(self.arrays, groups, self.inputs, self.thermal, self.nodes, self.source or Model())

    def _with(self, found: Quick) -> System:
        """The same structure with other numbers."""
        # of changes of changes none waits for another
        own = {item.name: getattr(self, item.name) for item in fields(self)}
        vars(self).pop(CHANGE, None)
        data = bytearray(self.to_bytes())
        for name, array in found.arrays.items():
            if array is not self.arrays[name]:
                array.flags.writeable = False
                data[self.starts[name] : self.starts[name] + array.nbytes] = array.tobytes()
        made, arrays = object.__new__(System), MappingProxyType(found.arrays)
        vars(made).update({name: value for name, value in own.items() if name not in LATER})
        vars(made).update({"arrays": arrays, "numbered": self.numbered._replace(arrays=arrays), CHANGE: (self, found)})
        # what follows from its structure alone
        vars(made).update({"counts": self.counts, "starts": self.starts, "_bytes": bytes(data)})
        return made

    @property
    def parameters(self) -> SystemParameters:
        """All that may be changed, by name: its value, unit and bounds, the words that it reaches, and when it may."""
        return SystemParameters(self)

    @cached_property
    def starts(self) -> Mapping[str, int]:
        """Where each array begins in the bytes of `to_bytes`."""
        starts, at = {}, 16 + 8 * len(COUNTS)
        for name, _, _, _ in FIELDS:
            starts[name] = at
            at += -(-self.arrays[name].nbytes // 8) * 8
        return MappingProxyType(starts)

    def to_bytes(self) -> bytes:
        """The System as the compiled core reads it: little endian, every array aligned to 8 bytes; made once."""
        return self._bytes

    @cached_property
    def _bytes(self) -> bytes:
        head = MAGIC + struct.pack("<q", core().schema_hash())
        head += struct.pack(f"<{len(COUNTS)}q", *(self.counts[name] for name, _ in COUNTS))
        parts = [head]
        for name, kind, _, _ in FIELDS:
            data = np.ascontiguousarray(self.arrays[name], dtype=TYPES[kind]).tobytes()
            parts.append(data + bytes(-len(data) % 8))
        return b"".join(parts)

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
