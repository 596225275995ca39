"""declared.gen.hpp: what the header of a component takes from its declaration, names in place of numbers."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from clutchwork.declare.schema import Role
from clutchwork.laws.bases.program import MOST_REGISTERS, OPERATIONS, PER_WORD
from registry.components import Component, components, cpp_name, enum_name

FILE = "declared.gen.hpp"


def lines() -> Iterator[str]:
    """The header without its head."""
    yield "namespace clutchwork {"
    yield "/// Words of a parameter that is one of several."
    yield "namespace choice {"
    yield "template <class Enum> inline constexpr int words = 0;"
    for field, words in choices().items():
        yield f"enum class {enum_name(field)} : int {enumerators(words)};"
        yield f"template <> inline constexpr int words<{enum_name(field)}> = {len(words)};"
    yield "}"
    yield "/// What a formula is made of: its operations, and the numbers that it may have at once."
    yield f"enum class Operation : int {enumerators(OPERATIONS)};"
    yield f"inline constexpr int operations = {len(OPERATIONS)}, words_per_operation = {PER_WORD};"
    yield f"inline constexpr int most_registers = {MOST_REGISTERS};"
    yield "/// Base of every component: its inputs and states by name, and how many it has."
    yield "namespace declared {"
    for component in components():
        yield from base(component)
    yield from ("}", "}")


def choices() -> dict[str, tuple[str, ...]]:
    """The words of every choice by the name of its field; pairs.py asks for the same words at the same name."""
    return {field.name: field.spec.choices for one in components() for field in one.fields if field.spec.choices}


def enumerators(words: Iterable[str]) -> str:
    """The words of an enum, in braces."""
    inside = ", ".join(map(cpp_name, words))
    return f"{{ {inside} }}" if inside else "{}"


def base(component: Component) -> Iterator[str]:
    """The struct that the header of a component derives from."""
    yield f"struct {component.cls.__name__} {{  // {component.source}"
    yield f"  enum class Input : int {enumerators(component.inputs)};"
    yield f"  enum State : int {enumerators(component.states)};"
    yield f"  static constexpr int inputs = {len(component.inputs)}, states = {len(component.states)};"
    if component.role is Role.PROCESS:
        yield f"  static constexpr bool gathers = {str(component.cls.gathers).lower()};"
    if component.ways:
        yield f"  enum class Way : int {enumerators(component.ways)};"
    if component.role is Role.TORQUE:
        yield f"  static constexpr int ways = {len(component.ways) or 1};"
    if component.states:
        span = ", ".join(repr(float(state.span)) for state in component.cls.states)
        yield f"  static constexpr double span[states] = {{{span}}};  ///< [s] of each state"
    yield "};"
