"""The compiled core, loaded when it is first needed."""

from __future__ import annotations

from functools import cache
from importlib import import_module
from typing import Any

from clutchwork.declare.layout import layout_text
from clutchwork.declare.schema import schema_hash

REMEDY = "build it in the project folder: make setup, or pip install -e ."


@cache
def core() -> Any:
    """The module of the core; ImportError with the remedy when it is missing or was built from other declarations."""
    try:
        found = import_module("clutchwork._core")
    except ImportError as error:
        raise ImportError(f"the compiled core of clutchwork cannot be loaded ({error}); {REMEDY}") from error
    if found.schema_hash() != schema_hash(layout_text()):
        raise ImportError(f"the compiled core of clutchwork was built from other declarations; {REMEDY}")
    return found
