"""Other speeds at the start in a System: the independent ones follow from those that are given, on straight lines."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from copy import copy
from fractions import Fraction
from math import isfinite
from typing import TYPE_CHECKING, Any

from clutchwork.assembly.assemble import chosen
from clutchwork.assembly.masses import is_all, judges
from clutchwork.assembly.patches import Patch
from clutchwork.base import ModelError, dataclass
from clutchwork.base.memoize import memoize
from clutchwork.declare.node import Component, Node
from clutchwork.declare.rational import ONE, ZERO, exact
from clutchwork.declare.schema import Role
from clutchwork.model.findings import findings
from clutchwork.model.start import Started, initial_speeds
from clutchwork.signals.bases.waveform import value

if TYPE_CHECKING:
    from clutchwork.assembly.system_data import SystemData
    from clutchwork.model.findings import Structure
    from clutchwork.model.model import Model

# speeds [rad/s], m/s for masses, of one to two times this size show that no more follows from them
PROBE = 1e-3


@dataclass(frozen=True, eq=False)
class StartSpeeds:
    """How the independent speeds answer to some that are given at the start, all others as they are."""

    base: Sequence[Fraction]  # where those are 0
    slopes: Mapping[str, Sequence[Fraction]]  # by name, of all independent speeds

    @classmethod
    def of(cls, system: SystemData, source: Model, names: Sequence[str]) -> StartSpeeds | None:
        """That of a System; None where more follows from the speeds, or they contradict others."""
        found = findings(source).structure
        known = {} if found is None else _places(source, found)
        if found is None or not known.keys() >= set(names) or any(map(judges, source.elements)):
            return None
        if any(map(_begins_with_a_speed, found.mechanism.components)):
            return None
        if any(motion.begins_with_shaft() for motion in found.mechanism.role(Role.MOTION)):
            return None
        own = dict(enumerate(found.mechanism.speed))
        zero, given = {known[name]: ZERO for name in names}, {place: ZERO for place, v in own.items() if v is not None}
        starts = [value(signal, 0.0) for _, signal in found.motions]
        base = _begun(found, system, own | zero, starts)
        none = dict.fromkeys(own) | given | zero
        lines = {name: _begun(found, system, none | {known[name]: ONE}, [0.0] * len(starts)) for name in names}
        if base is None or base.answers != chosen(found, system.wanted)[1].answers:
            return None
        made = cls(base.speeds, {name: line.speeds for name, line in lines.items() if line is not None})
        return made if made._is_all(system, source, names) else None

    def _is_all(self, system: SystemData, source: Model, names: Sequence[str]) -> bool:
        """Whether nothing else changes, seen by moving all."""
        moved = {name: PROBE * (1.0 + number / len(names)) for number, name in enumerate(names)}
        return is_all(system, source, moved, self.patches(moved) or [])

    def patches(self, changes: Mapping[str, Any]) -> list[Patch] | None:
        """The words of other speeds; None where others change too.

        Parameters: changes, values by name.
        """
        if not changes.keys() <= self.slopes.keys() or not all(map(_is_speed, changes.values())):
            return None
        speeds = list(self.base)
        for name, wanted in changes.items():
            by = exact(wanted)
            speeds = [
                speed + by * slope if slope else speed for speed, slope in zip(speeds, self.slopes[name], strict=True)
            ]
        return [Patch("initial_speed", 0, [float(speed) for speed in speeds])]


def _places(source: Model, found: Structure) -> dict[str, int]:
    """Places of the nodes by the name of their speed, without those of which elements make more: they have parts."""
    places = {id(node): place for place, node in enumerate(found.mechanism.nodes)}
    composed = {
        id(node)
        for element in source.elements
        if type(element).parts is not Component.parts
        for node in vars(element).values()
        if isinstance(node, Node)
    }
    return {f"{node.name}.speed": places[id(node)] for node in source.nodes if id(node) in places.keys() - composed}


def _begun(
    found: Structure, system: SystemData, speeds: Mapping[int, Fraction | None], prescribed: Sequence[float]
) -> Started | None:
    """The independent speeds that follow from others; None where these contradict each other.

    Parameters: speeds, of the nodes by place, None where it is not given; prescribed, those of the motions.
    """
    mechanism = copy(found.mechanism)
    vars(mechanism)["speed"] = [speeds[place] for place in range(len(mechanism.nodes))]
    begun, problems = initial_speeds(mechanism, chosen(found, system.wanted)[0], prescribed)
    return None if problems else begun


def _is_speed(given: Any) -> bool:
    return type(given) is float and isfinite(given)


def _begins_with_a_speed(element: Component) -> bool:
    return type(element).states_at is not Component.states_at


@memoize
def start_speeds(system: SystemData, *names: str) -> StartSpeeds | None:
    """Those of a System and of the names of some speeds, found once."""
    try:
        return None if system.source is None else StartSpeeds.of(system, system.source, names)
    except ModelError:
        return None
