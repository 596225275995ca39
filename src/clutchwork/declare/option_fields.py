"""The fields of `Options` by name, for type checkers: the build writes `option_fields.pyi` from the class."""

from __future__ import annotations

from typing import Any

OptionFields = dict[str, Any]
