"""Linear algebra on one thread: for small matrices several wait for each other longer than they compute."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from importlib import import_module
from typing import Any


@contextmanager
def one_thread() -> Iterator[None]:
    """While this lasts, where threadpoolctl is installed."""
    control = _control()
    if control is None:
        yield
        return
    with control.limit(limits=1, user_api="blas"):
        yield


@cache
def _control() -> Any:
    """The libraries that are loaded, found once."""
    # the one of SciPy must be among them
    import_module("scipy.optimize")
    try:
        return import_module("threadpoolctl").ThreadpoolController()
    except ImportError:
        return None
