"""The rules: every function of a file in `rules/` that is marked as one; a new rule needs no other edit."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import cache
from importlib import import_module
from pkgutil import iter_modules
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

from clutchwork.base.memoize import memoize
from clutchwork.hints.hint import Hint, Hints
from clutchwork.hints.look import Look

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.results.recorded import Recorded

OfModel: TypeAlias = "Callable[[System], Iterable[Hint]]"
OfRun: TypeAlias = "Callable[[Look], Iterable[Hint]]"


class Rule(NamedTuple):
    """A rule by its name: what it says of a System, or of a run."""

    name: str
    of_model: OfModel | None
    of_run: OfRun | None

    @property
    def doc(self) -> str:
        """What it looks for."""
        return str((self.of_model or self.of_run).__doc__)


_RULES: dict[str, Rule] = {}


def model_rule(name: str) -> Callable[[OfModel], OfModel]:
    """Mark a function of a System as the rule of a name."""

    def register(function: OfModel) -> OfModel:
        _RULES[name] = Rule(name, function, None)
        return function

    return register


def run_rule(name: str) -> Callable[[OfRun], OfRun]:
    """Mark a function of the `Look` at a run as the rule of a name."""

    def register(function: OfRun) -> OfRun:
        _RULES[name] = Rule(name, None, function)
        return function

    return register


@cache
def rules() -> tuple[Rule, ...]:
    """All rules by the alphabet, those of models first."""
    folder = import_module(f"{__name__.rpartition('.')[0]}.rules")
    for module in sorted(module.name for module in iter_modules(folder.__path__)):
        import_module(f"{folder.__name__}.{module}")
    return tuple(sorted(_RULES.values(), key=lambda rule: (rule.of_model is None, rule.name)))


@memoize
def of_model(system: System) -> Hints:
    """The hints about a model that need no run."""
    return Hints(hint for rule in rules() if rule.of_model for hint in rule.of_model(system))


def of_run(run: Recorded) -> Hints:
    """The hints about a run, after those about its model."""
    if not len(run):
        return of_model(run.system)
    look = Look.at(run)
    found = [hint for rule in rules() if rule.of_run for hint in rule.of_run(look)]
    return Hints([*of_model(run.system), *found])
