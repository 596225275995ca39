"""What the parameters of a declaration are, in words: for help(), editors, type stubs and the reference pages."""

from __future__ import annotations

import inspect
from collections.abc import Iterator
from dataclasses import MISSING, Field, fields
from inspect import Parameter, Signature
from typing import Any, NamedTuple

from clutchwork.base.classes import LazySignature
from clutchwork.declare.schema import Spec, specs

SORTS = {
    "param": "number",
    "alternative": "signal",
    "option": "setting",
    "law": "friction law",
    "thermal": "thermal port",
    "formula": "expression",
    "named": "numbers by name",
    "elements": "elements by name",
    "data": "name, file or table",
}
NAME = ("name", "(text, required): its path in results and messages")


class FieldDescription(NamedTuple):
    """Description of a field; empty if there is none."""

    name: str
    sort: str  # "number", "signal", "port" ...
    unit: str  # "Pa or N"
    default: str  # "required", "none", "0.001" ...
    bound: str  # "> 0", or the words of a choice
    meaning: str


def described(item: Field[Any], spec: Spec) -> FieldDescription:
    """A field in words."""
    bound = ", ".join(spec.choices) or spec.bound
    meaning = f"{spec.doc} (instead of `{spec.instead_of}`)" if spec.instead_of else spec.doc
    return FieldDescription(item.name, _sort(spec), _unit(spec), _default(item, spec), bound, meaning)


def _sort(spec: Spec) -> str:
    if spec.flag or spec.choices:
        return "flag" if spec.flag else "choice"
    return "whole number" if spec.whole else SORTS.get(spec.what, spec.what)


def _unit(spec: Spec) -> str:
    if spec.what in ("law", "formula") or spec.flag or spec.choices:
        return ""
    unit = f"{spec.unit_x} -> {spec.unit}" if spec.what == "curve" else spec.unit
    return " or ".join(dict.fromkeys((unit.replace("*", "of its input"), *spec.units))) if unit else ""


def _default(item: Field[Any], spec: Spec) -> str:
    return "required" if item.default is MISSING else default_in_words(item.default, spec)


def default_in_words(default: Any, spec: Spec) -> str:
    """A default as model files write it, or its replacement."""
    if default is None:
        return "the housing" if spec.what == "port" else "none"
    if spec.flag:
        return "true" if default else "false"
    return f"{default:.12g}" if isinstance(default, int | float) else str(default)


def parameters(cls: type) -> Iterator[tuple[str, str]]:
    """Name and text of each parameter, together in a form that editors know: `radius (number [m], required): ...`."""
    if "name" in {item.name for item in fields(cls)}:
        yield NAME
    for item, spec in specs(cls):
        told = described(item, spec)
        sort = (
            f"{told.sort}: {told.bound};" if spec.choices else f"{' '.join(filter(None, (told.sort, _bounded(told))))},"
        )
        default = told.default if told.default == "required" else f"default {told.default}"
        yield told.name, f"({sort} {default}): {told.meaning}"


def _bounded(told: FieldDescription) -> str:
    return " ".join(filter(None, (f"[{told.unit}]" if told.unit else "", told.bound)))


def words(cls: type) -> str:
    """The description of a declaration, without its parameters."""
    own = vars(cls).get("__doc__") or ""
    return inspect.cleandoc(own.words if isinstance(own, _Docstring) else own)


def summary(cls: type) -> str:
    """The first sentence or two of a description, on one line."""
    return words(cls).partition("\n\n")[0].replace("\n", " ")


def docstring(cls: type) -> str:
    """The description, then the parameters."""
    lines = "\n".join(f"    {name} {text}" for name, text in parameters(cls))
    return f"{words(cls)}\n\nParameters:\n{lines}" if lines else words(cls)


def signature(cls: type) -> Signature:
    """How a declaration is called, its parameters in the order of `parameters`."""
    order = {item.name: place for place, (item, _) in enumerate(specs(cls))}
    given = [item for item in fields(cls) if item.init]
    found = sorted(given, key=lambda item: (item.kw_only, order.get(item.name, len(order))))
    return Signature([_parameter(item) for item in found], return_annotation=None)


def _parameter(item: Field[Any]) -> Parameter:
    kind = Parameter.KEYWORD_ONLY if item.kw_only else Parameter.POSITIONAL_OR_KEYWORD
    default = Parameter.empty if item.default is MISSING else item.default
    return Parameter(item.name, kind, default=default, annotation=item.type)


class _Docstring:
    """The docstring of a class, composed on first access, so that the import costs nothing."""

    def __init__(self, words: str) -> None:
        self.words = words

    def __get__(self, thing: object, cls: type) -> str:
        return docstring(cls)


def document(cls: Any) -> None:
    """Make help() and editors show all parameters of a declaration."""
    cls.__doc__ = _Docstring(cls.__doc__ or "")
    cls.__signature__ = LazySignature(signature)
