"""What of the arrays of a System changes when one element or thermal node gets other values, and nothing else does."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import takewhile
from math import copysign
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from clutchwork.assembly.inputs import plain_signal
from clutchwork.assembly.shared_states import beginning
from clutchwork.declare.node import DIRECT, Component, Node, ThermalNode, is_reference
from clutchwork.declare.schema import WORDS, Role, inputs, specs
from clutchwork.model.parts import is_open, is_stop, role
from clutchwork.model.pools import Pools
from clutchwork.model.structure import follows_load
from clutchwork.signals.bases import waveform

if TYPE_CHECKING:
    from clutchwork.assembly.records import Input
    from clutchwork.declare.node import Signal
    from clutchwork.model.model import Model

# elements that stand in the arrays as they are
PLAIN = (Role.TORQUE, Role.CONTACT, Role.FLOW, Role.PROCESS)


class Patch(NamedTuple):
    """New numbers of an array from a place on, in its flat order."""

    array: str
    start: int
    values: Any


class Numbered(NamedTuple):
    """What a patch needs of a System."""

    arrays: Mapping[str, NDArray[Any]]
    places: Mapping[str, tuple[Role, int]]  # role and number of each element
    inputs: Mapping[str, int]  # numbers of the signals by name
    shared: Mapping[str, int]  # numbers of the thermal nodes by name
    heats: Mapping[int, int]  # direction -> number of its path of heat
    massless: bool  # whether a shaft has no inertia, so that springs and dampers decide what moves
    referred: frozenset[str]  # elements that others refer to


class Unpatched(Exception):  # noqa: N818, it is caught where it is raised
    """The arrays must be assembled anew."""


def numbered(
    arrays: Mapping[str, NDArray[Any]],
    groups: Mapping[Role, tuple[Component, ...]],
    given: tuple[Input, ...],
    thermal: tuple[ThermalNode, ...],
    nodes: tuple[Node, ...],
    source: Model,
) -> Numbered:
    """The places of everything in a System."""
    # an element of several ways has as many places, of which the first counts
    first = np.flatnonzero(arrays["element_way"] == 0).tolist()
    numbers = {kind: first if kind is Role.TORQUE else range(len(parts)) for kind, parts in groups.items()}
    return Numbered(
        arrays,
        {part.name: (kind, n) for kind, parts in groups.items() for n, part in zip(numbers[kind], parts, strict=True)},
        {item.name: number for number, item in enumerate(given)},
        {node.name: number for number, node in enumerate(thermal)},
        {int(direction): number for number, direction in enumerate(arrays["heat_direction"])},
        any(not node.inertia for node in nodes),
        frozenset(name for element in source.elements for name in _referred(element)),
    )


def _referred(element: Component) -> Iterator[str]:
    """Names of the elements that one refers to, its friction law and the elements that it describes included."""
    for entry in element.entries():
        yield from _referred(entry.made) if entry.made is not None else ()
    for value in (*vars(element).values(), *(vars(element.friction).values() if element.friction else ())):
        target = value.of if isinstance(value, DIRECT) else value[0] if _is_state(value) else value
        if isinstance(target, Component | ThermalNode):
            yield target.name


def _is_state(value: Any) -> bool:
    """Whether a value is (process, state)."""
    return isinstance(value, tuple) and is_reference(value)


def patches(where: Numbered, old: Any, new: Any) -> list[Patch]:
    """How the arrays change where one thing has other values; Unpatched where more follows from them."""
    if isinstance(old, ThermalNode):
        return list(_thermal(where, old, new))
    if not isinstance(old, Component) or role(old) not in PLAIN or type(old).parts is not Component.parts:
        raise Unpatched
    if "ratio" in type(old).hooks and old.start_ratio() != new.start_ratio():
        raise Unpatched
    if type(old).ways and old.directions() != new.directions():
        raise Unpatched
    if follows_load(old) and _rows(old) != _rows(new):
        raise Unpatched
    if is_stop(old) and (old.initial_states() != new.initial_states() or is_open(old)):
        # its position is the state of an element of its own, and may follow from what moves its mass
        raise Unpatched
    if old.start_positions() != new.start_positions():
        raise Unpatched
    if where.massless and type(old).passive is not Component.passive:
        raise Unpatched
    # first, because it sees whether the friction law is of another kind
    found = list(_parameters(where, old, new))
    found += [patch for name, signal in changed_signals(old, new) for patch in signal_patches(where, name, signal)]
    return [*found, *_start(where, old, new)]


def _rows(contact: Any) -> Any:
    """Those of a contact that is a gear with friction."""
    return contact.rows()


def _thermal(where: Numbered, old: ThermalNode, new: ThermalNode) -> Iterator[Patch]:
    number = where.shared.get(old.name)
    if number is None or (old.capacity is None) != (new.capacity is None):
        raise Unpatched
    if new.capacity is None:
        yield from signal_patches(where, f"{old.name}.temperature", plain_signal(new.temperature))
        return
    yield Patch("shared_scale", number, [1.0 / new.capacity])
    yield Patch("shared_offset", number, [float(new.temperature)])  # type: ignore[arg-type]


def _offset(where: Numbered, element: Component) -> int:
    """Where the parameters of an element begin."""
    kind, number = where.places[element.name]
    return int(where.arrays[f"{'element' if kind is Role.TORQUE else kind.value}_param"][number])


def parameter_place(where: Numbered, element: Component, name: str) -> int:
    """The place of a number of an element that is plain among all parameters."""
    before = takewhile(lambda one: one[0].name != name, specs(type(element), *WORDS))
    # a curve has two: where it begins, and how long it is
    return _offset(where, element) + sum(1 if spec.what == "param" else 2 for _, spec in before)


def _parameters(where: Numbered, old: Component, new: Component) -> Iterator[Patch]:
    kind, number = where.places[old.name]
    yield from _pool(where, _offset(where, old), old, new)
    if len(old.own_states()) != len(new.own_states()):
        raise Unpatched
    if kind is not Role.CONTACT:
        return
    before, after = old.friction, new.friction
    if before is after:
        return
    if type(before) is not type(after) or len(before.own_states()) != len(after.own_states()):  # type: ignore[union-attr]
        raise Unpatched
    yield from _pool(where, int(where.arrays["contact_law_param"][number]), before, after)


def _pool(where: Numbered, offset: int, old: Any, new: Any) -> Iterator[Patch]:
    """Parameters from an offset on; curves keep their place and length."""
    own = specs(type(old), *WORDS)
    if all(getattr(old, item.name) is getattr(new, item.name) for item, _ in own):
        return
    pools, params = Pools(), where.arrays["params"]
    pools.add(new, "")
    at = 0
    for _, spec in own:
        if spec.what == "param":
            yield Patch("params", offset + at, [pools.params[at]])
            at += 1
            continue
        first, count = int(pools.params[at]), int(pools.params[at + 1])
        if count != int(params[offset + at + 1]):
            raise Unpatched
        points = [number for point in pools.points[first : first + count] for number in point]
        yield Patch("points", 3 * int(params[offset + at]), points)
        at += 2


def changed_signals(old: Component, new: Component) -> Iterator[tuple[str, Signal]]:
    """Name and value of each signal of an element and its friction law that is another; Unpatched for a reference."""
    yield from _differing(old, new, old.name)
    if old.friction is not new.friction:
        yield from _differing(old.friction, new.friction, f"{old.name}.friction")


def _differing(old: Any, new: Any, path: str) -> Iterator[tuple[str, Signal]]:
    for names, _ in inputs(type(old)):
        before, after = _given(names, old), _given(names, new)
        was, value = getattr(old, before), getattr(new, after)
        if before == after and was is value:
            continue
        # one that was not given, or no longer is, has no signal in the results
        if before != after or value is None or was is None or is_reference(value) or is_reference(was):
            raise Unpatched
        yield f"{path}.{after}", plain_signal(value)


def _given(names: tuple[str, ...], thing: Any) -> str:
    return next((name for name in names if getattr(thing, name) is not None), names[0])


def signal_patches(where: Numbered, name: str, signal: Signal) -> Iterator[Patch]:
    """The pieces of a signal, which keeps its number of pieces and its period."""
    number, arrays = where.inputs.get(name, -1), where.arrays
    if number < 0:
        raise Unpatched
    pieces, first, period = signal.segments(), int(arrays["input_first"][number]), signal.repeats()
    if len(pieces) != int(arrays["input_count"][number]):
        raise Unpatched
    yield from _word(arrays, "input_period", number, period)
    yield from _word(arrays, "input_value", number, waveform.value_of(pieces, period, 0.0))
    yield Patch("segment_time", first, [piece[0] for piece in pieces])
    yield Patch("segment_coef", 12 * first, [number for piece in pieces for number in piece[1:]])


def _word(arrays: Mapping[str, NDArray[Any]], name: str, number: int, value: float) -> Iterator[Patch]:
    """A number where it is another one, a zero of the other sign too."""
    old = float(arrays[name][number])
    if old != value or copysign(1.0, old) != copysign(1.0, value):
        yield Patch(name, number, [value])


def _start(where: Numbered, old: Component, new: Component) -> Iterator[Patch]:
    """Initial states, what a contact starts with, the share of its heat."""
    kind, number = where.places[old.name]
    if kind is Role.PROCESS and new.state_scales() != old.state_scales():
        raise Unpatched
    if kind in (Role.TORQUE, Role.PROCESS) and old.states:
        states: tuple[float, ...] = new.initial_states()
        scales = (new.state_scales() or (1.0,) * len(states)) if kind is Role.PROCESS else (1.0,) * len(states)
        first = int(where.arrays["element_state" if kind is Role.TORQUE else "process_state"][number])
        starts = [start / unit for start, unit in zip(states, scales, strict=True)] if kind is Role.PROCESS else states
        yield Patch("initial_state", first, list(starts))
        if kind is Role.PROCESS and new.begins_with() != old.begins_with():
            yield Patch("process_begins", number, [beginning(new)])
    if kind is Role.CONTACT:
        before, made = _of_contact(old), _of_contact(new)
        if made != before:
            yield Patch("contact_tolerance", number, [max(float(made[0]), float(made[1]))])
            yield Patch("contact_initial", number, [int(made[2])])
    path, was = new.heat_path(), old.heat_path()
    if (path is None) != (was is None):
        raise Unpatched
    if path is not None and was is not None and path.share != was.share:
        direction = number + (len(where.arrays["element_kind"]) if kind is Role.CONTACT else 0)
        yield Patch("heat_share", where.heats[direction], [path.share])


def _of_contact(contact: Any) -> tuple[Any, Any, Any]:
    """What a contact starts with."""
    return contact.tolerance, contact.friction.band, contact.locked


def patched(arrays: Mapping[str, NDArray[Any]], found: list[Patch]) -> dict[str, NDArray[Any]]:
    """Copies of the arrays that have patches, with these."""
    made = dict[str, NDArray[Any]]()
    for name, start, values in found:
        array = made[name] if name in made else made.setdefault(name, arrays[name].copy())
        if len(values) == 1:
            array.flat[start] = values[0]
        else:
            array.reshape(-1)[start : start + len(values)] = values
    return made
