"""Which terms messages use: those of Python, or those of a model file."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Any

from clutchwork.declare.schema import REGISTRY, Role

_OF_FILES: ContextVar[bool] = ContextVar("of_files", default=False)


@contextmanager
def words_of_files(wanted: bool = True) -> Iterator[None]:
    """Messages made inside speak of tables and kinds, as a model file does; else of classes and keywords."""
    token = _OF_FILES.set(wanted)
    try:
        yield
    finally:
        _OF_FILES.reset(token)


def of_files() -> bool:
    """Whether messages use the words of model files."""
    return _OF_FILES.get()


def say(in_files: str, in_python: str) -> str:
    """One of two wordings."""
    return in_files if of_files() else in_python


def where_signals() -> str:
    """Where to find the names of all signals of a run."""
    return say("clutchwork check MODEL --signals lists all signals", "`run.names` lists all signals")


def path_of(component: Any) -> str:
    """Path of an element in messages."""
    return element_path(component.name, type(component))


def element_path(name: object, cls: Any) -> str:
    """Path of an element by its name and class."""
    return say(f'element "{name}" ({cls.kind})', f'cw.{cls.__name__}("{name}")')


def kinds_of(role: Role) -> str:
    """All components of a role."""
    known: Any = REGISTRY[role]
    return ", ".join(say(kind, f"cw.{known[kind].__name__}") for kind in known)
