"""registry.gen.hpp: all components, the asserts that pair them, and the switches over the kinds of each role."""

from __future__ import annotations

from collections.abc import Iterator

from clutchwork.declare.hooks import HOOKS
from clutchwork.declare.schema import COMPILED_ROLES, Role
from registry.asserts import asserts
from registry.components import Field, components

FILE = "registry.gen.hpp"
PARTS = "<clutchwork/parts.gen.hpp>"


def lines() -> Iterator[str]:
    """The header without its head."""
    # what an exported model says of the parts of the core that it needs
    yield from (
        "#include <cstddef>",
        "#include <cstdint>",
        f"#if __has_include({PARTS})",
        f"#include {PARTS}",
        "#endif",
    )
    yield from ("#include <clutchwork/component.hpp>", "#include <clutchwork/layout.gen.hpp>")
    for component in components():
        yield f"#include <{component.header.removeprefix('cpp/include/')}>"
    # the parameters of a law may start with those of the Stribeck curve that it shares
    yield '#pragma GCC diagnostic ignored "-Winvalid-offsetof"'
    yield from ("namespace clutchwork {", *probes())
    for role in COMPILED_ROLES:
        for component in components(role):
            yield from asserts(component)
        yield from (*visitor(role), *fixed(role))
    yield f"inline constexpr int most_own_states = {max(len(one.states) for one in components())};"
    yield f"inline constexpr int most_ways = {max(len(one.ways) or 1 for one in components())};"
    yield "}"


def probes() -> Iterator[str]:
    """Whether a component has a member of a name, whatever its form: a second one beside it makes it ambiguous."""
    yield "template <class E, class Probe> struct Beside : E, Probe {};"
    for name in ("state_rates", *dict.fromkeys(name for hook in HOOKS for name in hook.names)):
        yield f"struct Probe_{name} {{ int {name}; }};"
        yield f"template <class E> concept has_{name} = !requires(Beside<E, Probe_{name}>& b) {{ b.{name}; }};"


def visitor(role: Role) -> Iterator[str]:
    """A switch over the kinds of one role that are compiled: all, or those of a mask of bits."""
    found, mask = list(components(role)), f"CLUTCHWORK_{role.value.upper()}"
    yield f"inline constexpr int {role.value}_kinds = {len(found)};"
    yield from (f"#ifndef {mask}", f"#define {mask} ~0ull", "#endif")
    yield f'static_assert({role.value}_kinds <= 64, "{mask} has 64 bits");'
    yield f"constexpr bool has_{role.value}(std::int64_t kind) {{"
    yield f"  return kind >= 0 && kind < {role.value}_kinds && (({mask}) >> kind & 1) != 0;"
    yield "}"
    yield f"template <class F> CLUTCHWORK_INLINE decltype(auto) visit_{role.value}(int kind, F&& f) {{"
    yield "  switch (kind) {"
    for number, component in enumerate(found):
        call = f"return f(Tag<{component.name}>{{}})"
        yield f"    case {number}: if constexpr (has_{role.value}({number})) {call}; else break;"
    yield "  }"
    yield "  __builtin_unreachable();"
    yield "}"


def fixed(role: Role) -> Iterator[str]:
    """Functions that say which parameters of a kind a run never changes.

    `curve` gets the place of each curve, `choice` that of a parameter that is one of a few words or a flag, and how
    many there are; 0: any number, which stays.
    """
    name = f"visit_{role.value}"
    yield "template <class Curve, class Choice>"
    yield f"void {name}_fixed(int kind, Curve&& curve, Choice&& choice) {{"
    yield "  (void)kind, (void)curve, (void)choice;"
    for number, component in enumerate(components(role)):
        calls = "".join(f" {call};" for call in map(fixed_call, component.fields) if call)
        if calls:
            yield f"  if (kind == {number}) {{{calls} }}"
    yield "}"
    yield f"template <class F> void {name}_curves(int kind, F&& f) {{ {name}_fixed(kind, f, [](int, int) {{}}); }}"
    yield f"template <class F> void {name}_choices(int kind, F&& f) {{ {name}_fixed(kind, [](int) {{}}, f); }}"


def fixed_call(field: Field) -> str:
    """What is called for one parameter; empty for a plain number."""
    if field.size == 2:
        return f"curve({field.offset})"
    few = len(field.spec.choices) or 2 * field.spec.flag
    return f"choice({field.offset}, {few})" if few or field.spec.fixed else ""
