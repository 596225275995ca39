"""What the compiler asserts of each header, with a message that names file and field."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from clutchwork.declare.hooks import hooks_of
from clutchwork.declare.schema import Role
from registry.components import Component, cpp_name


def asserts(component: Component) -> Iterator[str]:
    """static_asserts that functions, counts and fields agree with the declaration."""
    yield from (*functions(component), *names(component), *hooks(component), *params(component))


def says(condition: str, message: str) -> str:
    """One static_assert."""
    return f'static_assert({condition}, "{message}");'


def functions(component: Component) -> Iterator[str]:
    """The functions that its role asks for."""
    name, header, source = component.name, component.header, component.source
    concept = component.concept
    yield says(f"{concept}<{name}>", f"{header}: {component.cls.__name__} lacks a function of {concept}")
    if component.role is Role.LAW:
        sort = "StickingLaw" if component.cls.sticks else "CompliantLaw"
        yield says(f"{sort}<{name}>", f"{header}: {source} says otherwise whether the law sticks")
    if component.states:
        yield says(f"has_state_rates<{name}>", f"{header}: state_rates is missing, for the states of {source}")


def names(component: Component) -> Iterator[str]:
    """Number and places of inputs and states."""
    yield from counted(component, "states", component.states)
    yield from counted(component, "inputs", component.inputs)
    yield says(
        f"{component.name}::inputs <= most_inputs", f"{component.header}: more inputs than the core has room for"
    )
    for number, item in enumerate(map(cpp_name, component.inputs)):
        message = f"{component.header}: Input::{item} is not at the place that {component.source} gives it"
        yield says(f"int({component.name}::Input::{item}) == {number}", message)
    for number, item in enumerate(map(cpp_name, component.states)):
        message = f"{component.header}: State::{item} is not at the place that {component.source} gives it"
        yield says(f"int({component.name}::State::{item}) == {number}", message)


def counted(component: Component, what: str, found: Sequence[str]) -> Iterator[str]:
    """That a header has as many inputs or states as its declaration."""
    listed = f"{len(found)} ({', '.join(found)})" if found else "none"
    message = f"{component.header}: {what} is not {len(found)}; {component.source} declares {listed}"
    yield says(f"{component.name}::{what} == {len(found)}", message)


def hooks(component: Component) -> Iterator[str]:
    """That it has the optional functions that its declaration names, as the core calls them, and no others."""
    header, source = component.header, component.source
    for hook in hooks_of(component.role.value):
        for name in hook.names:
            if name in component.cls.hooks:
                yield says(f"has_{name}<{component.name}>", f"{header}: {name} is missing, a hook of {source}")
            else:
                message = f"{header}: {name} is not among the hooks of {source}; add it there, or give it another name"
                yield says(f"!has_{name}<{component.name}>", message)
        if hook.names[0] in component.cls.hooks:
            form = f"not in the form that {hook.concept} in components/component.hpp asks for"
            yield says(f"{hook.concept}<{component.name}>", f"{header}: {', '.join(hook.names)} {form}")


def params(component: Component) -> Iterator[str]:
    """Names, order, types and number of the parameters."""
    header, source = component.header, component.source
    fields, own = component.fields, f"{component.name}::Params<double>"
    for field in fields:
        name = cpp_name(field.name)
        place = f"{header}: Params::{name} is not at the place that {source} gives it"
        yield says(f"offsetof({own}, {name}) == {field.offset} * sizeof(double)", place)
        same = f"std::is_same_v<decltype({own}::{name}), {field.type('double')}>"
        yield says(same, f"{header}: Params::{name} is not a {field.type()}")
    if fields:
        size = fields[-1].offset + fields[-1].size
        extra = f"{header}: Params has fields that {source} does not declare"
        yield says(f"sizeof({own}) == {size} * sizeof(double)", extra)
