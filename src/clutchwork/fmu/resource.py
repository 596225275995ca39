"""What the library of an FMU reads: the System, its options and variables, and the words for its log, as bytes."""

from __future__ import annotations

import struct
from collections.abc import Callable, Sequence
from hashlib import sha256
from typing import Any, TypeVar

from clutchwork.assembly.wiring import wiring
from clutchwork.base import dataclass
from clutchwork.base.bounds import in_words
from clutchwork.declare.core import core
from clutchwork.declare.layout import CAUSES, MODES, STATUS
from clutchwork.declare.schema import Role
from clutchwork.fmu.interface import MODEL_EXCHANGE, Interface
from clutchwork.fmu.terms import FormTerm, RowSum, terms
from clutchwork.fmu.variables import FmuVariable, NumberThatFollows, Place, VariableKind
from clutchwork.results.forms import Form
from clutchwork.results.rows import numbers
from clutchwork.run.failure import JAMS, covered, jam_of
from clutchwork.run.simulation import acting

# the last digits are the version of this format
MAGIC = b"CWFMU004"
T = TypeVar("T")


@dataclass(frozen=True)
class Resource:
    """Bytes of a resource, and the token that description and library compare."""

    token: str
    content: bytes


class ResourceWriter:
    """Numbers and strings one after another, as interfaces/fmi/reader.hpp reads them."""

    def __init__(self) -> None:
        self._parts: list[bytes] = []

    def integer(self, value: int) -> None:
        """A whole number."""
        self._parts.append(struct.pack("<q", value))

    def number(self, value: float) -> None:
        """A number."""
        self._parts.append(struct.pack("<d", value))

    def block(self, data: bytes) -> None:
        """Bytes with their number before them, filled up to a multiple of eight."""
        self.integer(len(data))
        self._parts.append(data + bytes(-len(data) % 8))

    def text(self, value: str) -> None:
        """A string."""
        self.block(value.encode())

    def each(self, items: Sequence[T], write: Callable[[T], Any]) -> None:
        """Several, with their number before them."""
        self.integer(len(items))
        for item in items:
            write(item)

    def content(self) -> bytes:
        """All of it."""
        return b"".join(self._parts)


def resource(made: Interface) -> Resource:
    """The resource of an FMU. The same interface gives the same bytes."""
    body = _body(made)
    digest = sha256(body).hexdigest()
    token = f"{{{digest[:8]}-{digest[8:12]}-{digest[12:16]}-{digest[16:20]}-{digest[20:32]}}}"
    head = ResourceWriter()
    head.integer(core().schema_hash())
    head.text(token)
    head.integer(checksum(body))
    return Resource(token, MAGIC + head.content() + body)


def checksum(data: bytes) -> int:
    """A checksum of words of eight bytes, as interfaces/fmi/model.cpp computes it."""
    found, whole = len(data), 2**64 - 1
    for (word,) in struct.iter_unpack("<Q", data):
        found = (found ^ word) * 0x9E3779B97F4A7C15 & whole
        found ^= found >> 32
    return found - 2**64 if found >> 63 else found


def _body(made: Interface) -> bytes:
    system, to = made.system, ResourceWriter()
    names = [name for name, _ in numbers(wiring(system))]
    to.block(system.to_bytes())
    to.integer(len(names))
    to.number(made.options.t_start)
    to.each(list(made.options.core_options().items()), lambda option: _option(to, *option))
    forms = [one.form for one in made.variables if one.form is not None]
    places = {number: place for place, (number, _) in enumerate(made.of(VariableKind.SIGNAL, VariableKind.MODE))}
    to.integer(len(made.variables))
    for number, one in enumerate(made.variables):
        _variable(to, one, places.get(number, one.of))
    to.each(forms, lambda form: _form(to, form))
    _parts(to, made)
    to.each(names, to.text)
    to.each([item.name for item in system.inputs], to.text)
    to.each([part.name for part in (*system.processes, *system.flows)], to.text)
    to.each(STATUS, lambda status: _texts(to, *status[1:]))
    to.each([CAUSES[k][0] if k in CAUSES else "start" for k in range(max(CAUSES) + 1)], to.text)
    to.each([MODES[k] for k in sorted(MODES)], to.text)
    to.integer(int(MODEL_EXCHANGE in made.kinds))
    to.each(made.states, lambda state: _state(to, state.number, state.nominal, state.variable))
    return to.content()


def _state(to: ResourceWriter, number: int, nominal: float, variable: int) -> None:
    to.integer(number)
    to.number(nominal)
    to.integer(variable)


def _option(to: ResourceWriter, name: str, value: float) -> None:
    to.text(name)
    to.number(value)


def _texts(to: ResourceWriter, *words: str) -> None:
    for one in words:
        to.text(one)


def _variable(to: ResourceWriter, one: FmuVariable, of: int) -> None:
    to.integer(one.kind)
    to.text(one.name)
    words = in_words(one.bounds)
    to.text(f"{words} {one.unit}" if words and one.unit != "1" else words)
    for number in (one.start, *one.bounds, one.nominal):
        to.number(number)
    to.integer(of)
    to.integer(1 if one.kind is VariableKind.SLOPE else 0)
    to.each(one.inputs, to.integer)
    to.each(one.words, lambda place: _place(to, place))
    to.each(one.params, lambda place: _place(to, place))
    to.each(one.forms, lambda number: _follows(to, number))


def _follows(to: ResourceWriter, number: NumberThatFollows) -> None:
    for place in (number.form, number.term, number.side, number.share, number.is_reciprocal):
        to.integer(int(place))
    to.number(number.slope)


def _place(to: ResourceWriter, place: Place | tuple[int, float]) -> None:
    to.integer(int(place[0]))
    to.number(float(place[1]))


def _parts(to: ResourceWriter, made: Interface) -> None:
    """Elements, then contacts, as messages name them."""
    elements = len(wiring(made.system).elements)
    to.integer(elements)
    everything = acting(made.system)
    to.integer(len(everything))
    for number, part in enumerate(everything):
        jams = part.role is Role.CONTACT or number in made.system.transmission_element.tolist()
        jam = JAMS[jam_of(made.system, part, number)] if jams else ("", "")
        ranges = covered(part) if part.role is Role.CONTACT and part.friction is not None else ""
        _texts(to, part.name, ranges, jam[0], jam[1] or (STATUS[_jammed()][2] if jam[0] else ""))


def _jammed() -> int:
    return next(number for number, status in enumerate(STATUS) if status[0] == "jammed")


# ------------------------------------------------------------------------------------------------------------- signals


def _form(to: ResourceWriter, form: Form) -> None:
    """A signal as a sum of terms: a combination of numbers of the row, or the product of two."""
    to.each(terms(form), lambda term: _term(to, term))


def _term(to: ResourceWriter, term: FormTerm) -> None:
    to.integer(term.gate)
    to.integer(0 if term.other is None else 1)
    for part in (term.one, term.other or RowSum(None, ())):
        to.integer(0 if part.offset is None else 1)
        to.number(part.offset or 0.0)
        to.each(part.shares, lambda place: _place(to, place))
