"""The forms of signals at a point, and how they change with numbers that are in them: ratios, inertias, stiffnesses."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from functools import cached_property, partial
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from clutchwork.assembly.provenance import PROBES
from clutchwork.assembly.wiring import wiring
from clutchwork.base.classes import dataclass
from clutchwork.base.errors import ModelError
from clutchwork.base.quote import measured
from clutchwork.gradients.finite_differences import ROUND_OFF, Bent, slope
from clutchwork.gradients.words import Words
from clutchwork.results.channels import channels
from clutchwork.results.forms import is_of_structure
from clutchwork.results.gradient import NoGradient

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.results.forms import Form

Array = NDArray[np.float64]

# shares of a signal that are less, of the largest one, are round-off of shares like that
LEFT = 1e-12


@dataclass(frozen=True, eq=False)
class SignalsAt:
    """Forms of some signals as functions of the numbers."""

    words: Words
    names: tuple[str, ...]
    _kept: dict[bytes, Mapping[str, Form]] = field(default_factory=dict, repr=False)

    @cached_property
    def plain(self) -> Mapping[str, Form]:
        """The forms of the driveline as it is."""
        return forms_of(self.words.system, self.names)

    @cached_property
    def _open(self) -> tuple[str, ...]:
        """Signals whose forms may be others for other numbers."""
        return tuple(name for name, form in self.plain.items() if not is_of_structure(name, form))

    @cached_property
    def within(self) -> tuple[int, ...]:
        """Numbers that are in the forms of signals, seen by moving each."""
        if not self._open:
            return ()
        start = np.array([one.start for one in self.words.parameters])
        # whole rows: a number that is zero may take a part of them into a form only where it is moved
        rows = np.random.default_rng(0).uniform(0.5, 1.5, (2, wiring(self.words.system).row_size))
        return tuple(n for n in range(len(start)) if self._is_within(n, start, rows))

    def _is_within(self, number: int, start: Array, rows: Array) -> bool:
        here = _evaluated({name: self.plain[name] for name in self._open}, rows)
        for share in PROBES:
            moved = start.copy()
            moved[number] += share * min(self.words.parameters[number].scale, self.words.parameters[number].reach)
            try:
                there = forms_of(self.words.assembled(moved), self._open)
            except ModelError:
                continue
            return _evaluated(there, rows).tobytes() != here.tobytes()
        return True

    def at(self, x: Array) -> Mapping[str, Form]:
        """The forms at a point."""
        if not self.within:
            return self.plain
        key = x[list(self.within)].tobytes()
        if key not in self._kept:
            self._kept.clear()
            self._kept[key] = forms_of(self.words.assembled(x), self.names)
        return self._kept[key]

    def bent(self, x: Array, rows: Array) -> dict[str, Array]:
        """Derivatives of the signals that have such numbers in them, in some rows: a column for each number."""
        if not self.within:
            return {}
        made = {name: np.zeros((len(rows), len(x))) for name in self._open}
        forms = {name: self.at(x)[name] for name in made}
        here = _evaluated(forms, rows)
        plain = _noise(forms, rows)
        for number in self.within:
            one = self.words.parameters[number]
            own, along = abs(float(x[number])), partial(self._along, x, number, tuple(made), rows)
            noise = np.maximum(plain, self._noise_beside(x, number, tuple(made), rows))
            try:
                found = slope(along, here, own, one.compared(own), one.reach, noise).value
            except Bent as bent:
                raise NoGradient([f"{one.name} = {measured(x[number], one.unit)}: {bent}"]) from None
            for name, line in zip(made, found.reshape(len(made), -1), strict=True):
                made[name][:, number] = line
        return made

    def _noise_beside(self, x: Array, number: int, names: tuple[str, ...], rows: Array) -> Array | float:
        """Round-off of the values beside: weights that are zero here may be the round-off of others there."""
        moved, one = x.copy(), self.words.parameters[number]
        moved[number] += PROBES[0] * min(one.scale, one.reach)
        try:
            return _noise(forms_of(self.words.assembled(moved), names), rows)
        except ModelError:
            return 0.0

    def _along(self, x: Array, number: int, names: tuple[str, ...], rows: Array, step: float) -> Array:
        moved = x.copy()
        moved[number] += step
        return _evaluated(forms_of(self.words.assembled(moved), names), rows)


def forms_of(system: System, names: tuple[str, ...]) -> dict[str, Form]:
    """The forms of signals of a System."""
    known = channels(system, True, True)
    return {name: known[name].evaluate for name in names}


def _evaluated(forms: Mapping[str, Form], rows: Array) -> Array:
    return np.concatenate([np.zeros(0), *(np.asarray(form(rows), dtype=float) for form in forms.values())])


def _noise(forms: Mapping[str, Form], rows: Array) -> Array:
    """Round-off of signals, of each row."""
    return ROUND_OFF * np.repeat([_largest(form, rows) for form in forms.values()], len(rows))


def _largest(form: Form, rows: Array) -> float:
    """Largest sum of the absolute terms of a signal.

    Terms may cancel to a small rest, and a tiny weight may be the round-off of larger ones.
    """
    known = form.weights(rows)
    shares = np.abs(known.values)
    most = shares.max(initial=0.0)
    shares = np.where((shares > 0.0) & (shares < LEFT * most), most, shares)
    return float((shares * np.abs(rows[:, known.columns])).sum(axis=1).max(initial=0.0))
