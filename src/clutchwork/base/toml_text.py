"""TOML that is read with care: what takes more time than its length allows is refused before it is parsed."""

from __future__ import annotations

import re
from typing import Any

# parts of one key; a model needs four
MOST_PARTS = 16
# the time to read a dotted key grows with the square of its parts; it stands where a line or an inline table begins
_PART = r"""(?:[\w-]+|"(?:[^"\\\n]|\\.)*"|'[^'\n]*')[ \t]*"""
_LONG_KEY = re.compile(rf"(?:^|[\[{{,])[ \t]*(?:{_PART}\.[ \t]*){{{MOST_PARTS}}}", re.MULTILINE)


class DeepKeyError(ValueError):
    """A key with too many parts."""

    def __init__(self, line: int) -> None:
        super().__init__(f"a key has more than {MOST_PARTS} dotted parts (at line {line}, column 1)")
        self.line = line


def parsed(text: str) -> dict[str, Any]:
    """The tables of a file; ValueError says what is wrong and where."""
    # a start that reads no file needs none
    import tomllib

    if found := _LONG_KEY.search(text):
        raise DeepKeyError(text.count("\n", 0, found.end()) + 1)
    return tomllib.loads(text)
