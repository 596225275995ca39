"""The data of a System: flat arrays that the compiled core reads, and the names that belong to them."""

from __future__ import annotations

import struct
from collections.abc import Callable, Mapping
from dataclasses import field, fields
from functools import cached_property
from types import MappingProxyType
from typing import Any

import numpy as np

from clutchwork.assembly.dependence import dependent_sets
from clutchwork.assembly.patches import Numbered, numbered
from clutchwork.assembly.records import TYPES, Array, Gearing, Input, Link, frozen
from clutchwork.assembly.sparse import dense, entries
from clutchwork.assembly.storage_bounds import rooms
from clutchwork.base import ModelError, counted, dataclass, near, quote
from clutchwork.declare.calls import explained_methods
from clutchwork.declare.core import core
from clutchwork.declare.layout import COUNTS, FIELDS, SPARSE
from clutchwork.declare.node import Component, Node, ShiftTable, ThermalNode
from clutchwork.declare.schema import Role
from clutchwork.model.model import Model

MAGIC = b"CLUTCHWK"
# what a Driveline can do itself
CALLS = {
    "simulate": "; run it by cw.simulate(system, t_end)",
    "sweep": "; cw.sweep(system, t_end, vary=..., outputs=...) does it",
    "gradient": "; cw.differentiable(system, t_end, of=..., by=...).gradient() does it",
}
# what holds the elements of a System
GROUPS = ("elements", "contacts", "motions", "sensors", "flows", "processes")
# what of a changed System is made where it is asked for, and where it is noted what makes it
LATER, MAKES = frozenset((*GROUPS, "nodes", "gears", "inputs", "source")), "_makes"


@explained_methods("system")
@dataclass(frozen=True, eq=False, repr=False)
class SystemData:
    """What a System holds, and what follows from that alone."""

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

    def __getattr__(self, name: str) -> Array:
        own = self.__dict__
        try:
            if name in LATER:
                makes = own.get(MAKES)
                found: Array = own[name] if makes is None else self._later(name, makes)
                return found
            arrays = own["arrays"]
            return dense(arrays, name) if name in SPARSE else arrays[name]
        except KeyError:
            known = [*SPARSE, *(n for n, *_ in FIELDS)]
            told = CALLS.get(name) or near(name, known)
            raise AttributeError(f"a System has no {name!r}{told}") from None

    def _later(self, name: str, makes: Callable[[str], Mapping[str, Any]]) -> Any:
        """What of a changed System is made where it is asked for."""
        for item, value in makes(name).items():
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
