"""Mistakes of a call that are collected, so that all are reported at once."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from clutchwork.base.errors import UseError


class Mistakes:
    """All that is wrong with a call."""

    def __init__(self) -> None:
        self.found = list[str]()

    def caught(self, what: Callable[[], Any], instead: Any) -> Any:
        """What a function gives; where it refuses, something instead."""
        try:
            return what()
        except UseError as error:
            self.found += error.problems
            return instead

    def refuse(self, call: str) -> None:
        """UseError with all of them, each once; nothing where there are none."""
        if self.found:
            raise UseError(call, list(dict.fromkeys(self.found)))
