"""What makes a model, a design and an output the same: numbers that are the same in another process."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import replace
from hashlib import sha256
from typing import TYPE_CHECKING, Any

import numpy as np

from clutchwork.sweeps.outputs import Computed
from clutchwork.sweeps.variants import Variants, Varied

if TYPE_CHECKING:
    from types import CodeType

    from clutchwork.assembly.system import System
    from clutchwork.sweeps.outputs import Output
    from clutchwork.sweeps.variants import VariantSource

# variants that are looked at together
TOGETHER = 8192
# where an object lies in memory says nothing of it
_ADDRESS = re.compile(r" at 0x[0-9a-f]+")


def of_model(system: System) -> str:
    """Of the numbers of a System and the names that belong to them."""
    named = (system.nodes, system.elements, system.contacts, system.motions, system.thermal, system.inputs)
    names = repr([[thing.name for thing in group] for group in named])
    return sha256(system.to_bytes() + names.encode()).hexdigest()


def of_output(one: Output) -> str:
    """What is kept of a run; of a function its name and what it does."""
    if not isinstance(one, Computed):
        return repr(one)
    code = getattr(one.function, "__code__", None)
    said = _plain(one.function) if code is None else sha256(repr(list(_words(code))).encode()).hexdigest()[:16]
    return f"{one.name}, a function: {said}"


def _words(code: CodeType) -> Iterator[Any]:
    yield code.co_code
    yield code.co_names
    for constant in code.co_consts:
        yield from _words(constant) if hasattr(constant, "co_code") else (_plain(constant),)


def of_source(source: VariantSource) -> tuple[str, Variants]:
    """Of all values, and for each name those by which all are judged: the least and the most of numbers."""
    digest, ends = sha256(), dict[str, Varied]()
    for first in range(0, len(source), TOGETHER):
        part = source.part(first, min(first + TOGETHER, len(source)))
        for one in part.varied:
            digest.update(one.name.encode() if one.numbers is None else f"times {one.name}".encode())
            digest.update(_values(one))
            ends[one.name] = _ends(one, ends.get(one.name))
    return digest.hexdigest(), Variants(tuple(ends.values()), 0)


def _values(one: Varied) -> bytes:
    if _numbers(one):
        return np.array(one.values, dtype=float)[one.codes].tobytes()
    said = np.array([_plain(value) for value in one.values])
    return repr(said[one.codes].tolist()).encode()


def _ends(one: Varied, before: Varied | None) -> Varied:
    values = one.values if before is None else (*before.values, *one.values)
    if _numbers(one):
        values = (min(values), max(values))
    elif before is not None:
        # parts of one source share their objects
        values = tuple({id(value): value for value in values}.values())
    return replace(one, values=values, labels=values, codes=np.zeros(0, dtype=np.int64))


def _numbers(one: Varied) -> bool:
    return {float, int}.issuperset(map(type, one.values))


def _plain(thing: Callable[..., Any] | object) -> str:
    return _ADDRESS.sub("", repr(thing))
