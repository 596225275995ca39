"""From variants to what the core takes: bytes of Systems, words that change in them, and who has which.

Names whose numbers stand at places of their own, such as a gain or a pressure, become axes: words of eight bytes in
the System that are replaced for each value. Names inside of one signal share an axis, whose words are replaced for each
combination. Where values act together, as inertias and ratios do in the mass matrix, each combination gets a System of
its own.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from itertools import islice
from typing import TYPE_CHECKING, Any

import numpy as np

from clutchwork.assembly.changes import UNKNOWN_SOURCE
from clutchwork.assembly.patches import PLAIN, Unpatched, patches
from clutchwork.assembly.provenance import is_shared, parameter
from clutchwork.base import ModelError, Problem
from clutchwork.declare.layout import FIELDS
from clutchwork.declare.node import Component, Law, Signal, ThermalNode
from clutchwork.declare.quantity import has_unit
from clutchwork.declare.schema import specs
from clutchwork.declare.to_si import settled
from clutchwork.declare.wording import path_of
from clutchwork.model.changes import Target, renewed, targets_of
from clutchwork.model.components import component_problems
from clutchwork.model.fields import law_problems
from clutchwork.model.numbers import At, are_right, is_right, number_problems
from clutchwork.model.parts import role
from clutchwork.model.thermal import thermal_problems
from clutchwork.sweeps.driven import IndependentInput
from clutchwork.sweeps.mistakes import MOST_PROBLEMS, few
from clutchwork.sweeps.system_words import Axis, Line, words_of
from clutchwork.sweeps.variants import Codes, Variants, Varied

if TYPE_CHECKING:
    from clutchwork.assembly.system import System


@dataclass
class Plan:
    """The axes of a sweep, and the names whose values act together."""

    base: System
    variants: Variants
    axes: list[Axis] = field(default_factory=list)
    bound: list[Varied] = field(default_factory=list)
    targets: dict[str, Target] = field(default_factory=dict)
    whole: set[int] = field(default_factory=set)  # identities of the Systems of a block that need no axes

    @classmethod
    def of(cls, base: System, variants: Variants) -> Plan:
        """Look at every value; ModelError names all that are wrong."""
        plan = cls(base, variants)
        problems = plan.find()
        if problems:
            raise ModelError(problems, base.name)
        for group in plan._groups():
            try:
                plan._add(group)
            except ModelError as error:
                problems += error.problems
        if problems:
            problems += [found for one in plan.bound for found in plan._wrong(one)]
            raise ModelError(few(problems), base.name)
        problems = list(islice(plan._together(), MOST_PROBLEMS))
        if problems:
            raise ModelError(problems, base.name)
        plan._part()
        return plan

    def find(self) -> list[Problem]:
        """Find what the names lead to; those that lead nowhere."""
        if self.base.source is None:
            raise ModelError([UNKNOWN_SOURCE])
        self.targets, problems = targets_of(self.base.source, [one.name for one in self.variants.varied])
        return problems

    def wrong_alone(self, one: Varied) -> list[Problem]:
        """What is wrong with the values of a name, whatever other names have."""
        aim = self.targets[one.name]
        spec = _plain_number(aim) if isinstance(aim.owner, Component) else None
        if spec is None:
            return list(self._wrong(one))
        if are_right(one.values, spec):
            return []
        return [found for value in one.values for found in _number_problems(value, spec, aim)]

    def _wrong(self, one: Varied) -> Iterable[Problem]:
        """What is wrong with the values of a name, each alone."""
        for value in one.values:
            try:
                self.base.changed({one.name: value})
            except ModelError as error:
                yield from error.problems

    def _groups(self) -> list[list[Varied]]:
        """Names whose numbers stand together, such as those inside of one signal."""
        found = dict[Any, list[Varied]]()
        for one in self.variants.varied:
            aim = self.targets[one.name]
            found.setdefault((id(aim.owner), _slot(aim)), []).append(one)
        return list(found.values())

    def _add(self, group: Sequence[Varied]) -> None:
        """Names that stand together as an axis where they are one."""
        aims = [self.targets[one.name] for one in group]
        names = {one.name for one in group}
        others = [o for name, o in self.targets.items() if name not in names and o.owner is aims[0].owner]
        if not all(_alone(aim, [*others, *(o for o in aims if o is not aim)], self.base) for aim in aims):
            self.bound += group
            return
        try:
            self.axes.append(self._axis(group[0], aims[0]) if len(group) == 1 else self._joint(group, aims))
        except Unpatched:
            self.bound += group

    def _axis(self, one: Varied, aim: Target) -> Axis:
        if _plain_number(aim) is not None:
            problems = self.wrong_alone(one)
            if problems:
                raise ModelError(few(problems), self.base.name)
            known, ends = parameter(self.base, one.name), (min(one.values), max(one.values))
            if known.is_word and all(map(known.is_word_at, ends)):
                words = np.array(one.values, dtype=float).view(np.uint64).reshape(-1, 1)
                return Axis((one.name,), known.words, np.repeat(words, len(known.words), axis=1), one.codes)
        return self._of_lines([one], aim.owner, [[(aim.path, value)] for value in one.values], one.codes)

    def _joint(self, group: Sequence[Varied], aims: Sequence[Target]) -> Axis:
        """One axis for names of one signal."""
        lines, codes = combined(group)
        paths = [aim.path for aim in aims]
        return self._of_lines(group, aims[0].owner, [list(zip(paths, line, strict=True)) for line in lines], codes)

    def _of_lines(self, group: Sequence[Varied], owner: Any, changes: Sequence[Line], codes: Codes) -> Axis:
        """The axis that gives an element other values."""
        driven, where = IndependentInput.of(owner, changes[0][0][0][0]), self.base.numbered
        if driven is not None and driven.fits(changes):
            found = driven.patches(where, changes, MOST_PROBLEMS)
        else:
            found = [patches(where, owner, new) for new in self._all_renewed(owner, changes)]
        place, words = words_of(self.base, found)
        return Axis(tuple(one.name for one in group), place, words, codes)

    def _all_renewed(self, owner: Any, changes: Sequence[Line]) -> list[Any]:
        """The owner with each set of values at its paths; ModelError names all that are wrong."""
        made, problems = list[Any](), list[Problem]()
        for values in changes:
            try:
                made.append(self._renewed(owner, values))
            except ModelError as error:
                problems += error.problems
        if problems:
            raise ModelError(few(problems), self.base.name)
        return made

    def _renewed(self, owner: Any, values: Any) -> Any:
        """The owner with other values, which must be right on their own."""
        made = renewed(owner, values)
        found = list(thermal_problems(made) if isinstance(made, ThermalNode) else component_problems(made))
        if found:
            raise ModelError(found[:MOST_PROBLEMS], self.base.name)
        return made

    def _together(self) -> Iterable[Problem]:
        """Mistakes of values that are right one by one, where an element or its friction law has rules between them."""
        free = self._named()
        groups = dict[tuple[int, bool], list[Varied]]()
        for one in self.variants.varied:
            aim = self.targets[one.name]
            if one.name in free and _has_rules(aim):
                of_law = aim.path[0] == "friction" and type(aim.owner).law_problems is Component.law_problems
                groups.setdefault((id(aim.owner), of_law), []).append(one)
        for (_, of_law), varied in groups.items():
            aims = [self.targets[one.name] for one in varied]
            at = At(path_of(aims[0].owner), "friction")
            for values in combinations(varied):
                new = renewed(aims[0].owner, [(aim.path, value) for aim, value in zip(aims, values, strict=True)])
                yield from law_problems(new.friction, at) if of_law else component_problems(new)

    def _part(self) -> None:
        """Axes that touch the same words act together after all."""
        owner = dict[int, Axis]()
        both = set[str]()
        for axis in self.axes:
            for word in axis.place.tolist():
                both |= {*axis.names, *owner[word].names} if word in owner else set()
                owner[word] = axis
        self.bound += [one for one in self.variants.varied if one.name in both]
        self.axes = [axis for axis in self.axes if both.isdisjoint(axis.names)]

    def _named(self) -> set[str]:
        """Names that axes give."""
        return {name for axis in self.axes for name in axis.names}

    # --------------------------------------------------------------------------------------------------------- batches

    def systems(self, first: int, last: int) -> tuple[list[System], Codes]:
        """The Systems of some variants, without their axes, and which of them each has."""
        found, which = systems_of(self.base, self.bound, first, last)
        odd = [number for number, system in enumerate(found) if not self._fits(system)]
        self.whole = set()
        return self._made_whole(found, which, odd, first) if odd else (found, which)

    def _fits(self, system: System) -> bool:
        """Whether the axes, or as many of another layout, give all that varies beside this System."""
        if not self.axes or self.key(system) == self.key(self.base):
            return True
        return {name for axis in self.axes_on(system) for name in axis.names} == self._named()

    def _made_whole(
        self, found: list[System], which: Codes, odd: Sequence[int], first: int
    ) -> tuple[list[System], Codes]:
        """A System of its own, with all that varies, for each variant of those that the axes do not fit."""
        made, places = list(found), which.copy()
        for place in np.flatnonzero(np.isin(which, odd)).tolist():
            own, _ = systems_of(self.base, self.variants.varied, first + place, first + place + 1)
            places[place] = len(made)
            made += own
        self.whole = {id(system) for system in made[len(found) :]}
        return made, places

    def key(self, system: System) -> tuple[Any, ...]:
        """What two Systems share where the words of an axis are at the same places in both."""
        if any(_holds_points(self.targets[one.name], one.values) for one in self.bound):
            return (id(system),)
        names = [name for name, kind, _, _ in FIELDS if kind == "i4"]
        massless = bool(np.any(system.arrays["massless"]))
        return (massless, *system.counts.values(), *(system.arrays[name].tobytes() for name in names))

    def axes_on(self, system: System) -> list[Axis]:
        """The axes for a System of another layout."""
        named = self._named()
        varied = tuple(one for one in self.variants.varied if one.name in named)
        return Plan.of(system, replace(self.variants, varied=varied, shape=None)).axes

    def relevant(self, signal: str) -> list[Varied]:
        """Names that the form of a signal may depend on."""
        bound = {one.name for one in self.bound}
        return [one for one in self.variants.varied if one.name in bound or self._of(one.name, signal)]

    def _of(self, name: str, signal: str) -> bool:
        owner = self.targets[name].owner
        return isinstance(owner, ThermalNode) or signal.startswith(f"{owner.name}.")


def systems_of(base: System, varied: Sequence[Varied], first: int, last: int) -> tuple[list[System], Codes]:
    """A System for each combination of values that variants from first to last have, and which of them each has."""
    if not varied:
        return [base], np.zeros(last - first, dtype=np.int64)
    lines = list(zip(*(one.codes[first:last].tolist() for one in varied), strict=True))
    number = {line: place for place, line in enumerate(dict.fromkeys(lines))}
    made, problems = list["System"](), list[Problem]()
    for line in number:
        try:
            made.append(base.changed({one.name: one.values[code] for one, code in zip(varied, line, strict=True)}))
        except ModelError as error:
            problems += error.problems
    if problems:
        raise ModelError(few(problems), base.name)
    return made, np.array([number[line] for line in lines], dtype=np.int64)


def combinations(varied: Sequence[Varied]) -> list[tuple[Any, ...]]:
    """Values of names that variants have together, each combination once."""
    return combined(varied)[0]


def combined(varied: Sequence[Varied]) -> tuple[list[tuple[Any, ...]], Codes]:
    """Values of names that variants have together, each combination once, and which of them each variant has."""
    lines = list(zip(*(one.codes.tolist() for one in varied), strict=True))
    number = {line: place for place, line in enumerate(dict.fromkeys(lines))}
    values = [tuple(one.values[code] for one, code in zip(varied, line, strict=True)) for line in number]
    return values, np.array([number[line] for line in lines], dtype=np.int64)


def _alone(aim: Target, others: Sequence[Target], base: System) -> bool:
    """Whether what follows from a value does not depend on the other values of its owner that vary."""
    owner = aim.owner
    if isinstance(owner, ThermalNode):
        return True
    if not isinstance(owner, Component) or role(owner) not in PLAIN or type(owner).parts is not Component.parts:
        return False
    if base.numbered.massless and type(owner).passive is not Component.passive:
        return False
    if not others:
        return True
    if any(getattr(type(owner), hook) is not getattr(Component, hook) for hook in ("initial_states", "state_scales")):
        return False
    return not (_entangled(aim) and any(map(_entangled, others)))


def _slot(aim: Target) -> tuple[str, ...]:
    """The field whose numbers stand together: one of the element, or one of its friction law."""
    return aim.path[: 2 if aim.path[0] == "friction" else 1]


def _entangled(aim: Target) -> bool:
    """Whether a value goes into numbers that others of its owner go into, such as the tolerance of a contact."""
    return is_shared(aim) or aim.path == ("friction",)


def _holds_points(aim: Target, values: Sequence[Any]) -> bool:
    """Whether values are curves or friction laws, whose number of points may differ from variant to variant."""
    thing = aim.owner
    for name in aim.path:
        if isinstance(thing, Signal):
            return False
        thing = getattr(thing, name)
    return not all(isinstance(value, int | float | str | Signal | None) for value in values)


def _plain_number(aim: Target) -> Any:
    """The spec of a parameter that is a plain number, None for anything else."""
    thing = aim.owner
    for name in aim.path[:-1]:
        thing = getattr(thing, name)
    found = next((spec for item, spec in specs(type(thing), "param") if item.name == aim.path[-1]), None)
    return None if found is None or found.choices or found.flag or found.optional else found


def _number_problems(value: Any, spec: Any, aim: Target) -> Iterable[Problem]:
    if is_right(value, spec):
        return ()
    if has_unit(value):
        spec = settled(aim.path[-1], spec, type(aim.owner), vars(aim.owner))
    return list(number_problems(value, spec, At(path_of(aim.owner), ".".join(aim.path), spec.unit)))


def _has_rules(aim: Target) -> bool:
    """Whether what has a value has rules between its values."""
    owner = aim.owner
    if not isinstance(owner, Component):
        return False
    if type(owner).law_problems is not Component.law_problems:
        return True
    law = owner.friction
    if isinstance(law, Law) and aim.path[0] == "friction":
        return law.sticks or type(law).problems is not Law.problems
    return type(owner).problems is not Component.problems
