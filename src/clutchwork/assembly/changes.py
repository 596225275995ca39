"""A System with other numbers: what assembling the driveline with them gives, bit for bit."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from clutchwork.assembly.assemble import assembled
from clutchwork.base.errors import ModelError, Problem
from clutchwork.declare.speech import words_of_files
from clutchwork.model.changes import changed_model
from clutchwork.model.findings import findings
from clutchwork.model.problems import TOO_FAR_APART

if TYPE_CHECKING:
    from clutchwork.base.errors import Problem as Found
    from clutchwork.model.model import Model

UNKNOWN_SOURCE = Problem(
    "system",
    "",
    "has numbers without names, because it was made from bytes",
    remedy="assemble its driveline, or read a file of System.save",
)


def changed(
    source: Model, independent: Sequence[str], speeds: int, changes: Mapping[str, Any]
) -> tuple[Model, dict[str, Any], list[Found]]:
    """The model with other values, the fields of its System, and what is rarely wanted of it.

    Parameters: source, the model; independent, names of the independent speeds where they were asked for; speeds, how
    many there are; changes, values by name.
    """
    with words_of_files(source.from_file):
        model = changed_model(source, changes)
        found = findings(model)
        if found.problems:
            raise ModelError(found.problems, model.name)
        try:
            made = assembled(model, independent)
        except ArithmeticError:
            raise ModelError([TOO_FAR_APART], model.name) from None
    count = len(made["independent"])
    if count != speeds:
        message = f"makes {count} speeds independent, where {speeds} were"
        remedy = "build a driveline of its own for it: its rigid rows are others"
        raise ModelError([Problem(", ".join(changes), "", message, remedy=remedy)], model.name)
    return model, made, found.advice
