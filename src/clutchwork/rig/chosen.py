"""Which laws an experiment compares: by name, by instance, or the usual ones."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, TypeAlias

from clutchwork.base import near
from clutchwork.declare.node import Law
from clutchwork.rig.presets import Preset

# names, instances or both; with a mapping the keys are the labels
Laws: TypeAlias = "str | Law | Iterable[str | Law] | Mapping[str, str | Law] | None"


def chosen(laws: Laws, preset: Preset, usual: tuple[str, ...]) -> dict[str, Law]:
    """The laws by label.

    Parameters: laws, a name, a law, several of them, a mapping from labels to them, "all", or None for the usual
    ones. Case and underscores of names do not matter. ValueError for a name that is unknown, with a near match.
    """
    if laws is None:
        return {kind: preset.law(kind) for kind in usual if kind in preset.laws}
    if isinstance(laws, Mapping):
        return {label: _law(wanted, preset) for label, wanted in laws.items()}
    wishes = [laws] if isinstance(laws, str | Law) else list(laws)
    if wishes == ["all"]:
        wishes = [kind for kind in preset.laws if kind != "naive_sign"]
    made: dict[str, Law] = {}
    for wanted in wishes:
        law = _law(wanted, preset)
        made[_label(law, made)] = law
    if not made:
        raise ValueError("no friction law is given: name at least one, or leave the choice to the experiment")
    return made


def kind_of(name: str, preset: Preset) -> str:
    """The kind that a name means; ValueError with a near match when there is none."""
    known = {_plain(kind): kind for kind in preset.laws}
    if _plain(name) not in known:
        hint = near(name.strip().lower(), preset.laws, f"known laws: {', '.join(preset.laws)}")
        raise ValueError(f"unknown friction law {name!r}{hint}")
    return known[_plain(name)]


def _law(wanted: Any, preset: Preset) -> Law:
    if isinstance(wanted, str):
        return preset.law(kind_of(wanted, preset))
    if not isinstance(wanted, Law):
        raise TypeError(f"{wanted!r} is not a friction law: give a name or a law such as clutchwork.Coulomb(...)")
    return wanted


def _label(law: Law, taken: Mapping[str, Law]) -> str:
    kind: str = getattr(law, "kind", type(law).__name__)
    return kind if kind not in taken else f"{kind} {sum(label.startswith(kind) for label in taken) + 1}"


def _plain(name: str) -> str:
    return "".join(letter for letter in name.lower() if letter not in "_- ")
