"""Packages that only some need: imported where they are used, with the command that installs a missing one."""

from __future__ import annotations

from importlib import import_module
from typing import Any


def need(module: str, extra: str, use: str = "this") -> Any:
    """A module of another package, such as "pyarrow.parquet".

    Parameters: extra, what of clutchwork installs it; use, what needs it, as the message begins. ImportError with the
    remedy when it is missing.
    """
    try:
        return import_module(module)
    except ImportError as error:
        package = module.partition(".")[0]
        raise ImportError(f'{use} needs {package}: pip install "clutchwork[{extra}]"') from error


def program() -> str:
    """Name and version of what writes a file."""
    # brings some fifty modules
    from importlib.metadata import PackageNotFoundError, version

    try:
        return f"clutchwork {version('clutchwork')}"
    except PackageNotFoundError:
        return "clutchwork (not installed)"
