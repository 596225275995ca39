"""Names, numbers, comments and strings of C."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator


def identifiers(prefix: str, names: Iterable[str]) -> list[str]:
    """One identifier for each name; names that C cannot tell apart get a number."""
    found: list[str] = []
    for name in names:
        plain = prefix + re.sub(r"[^A-Za-z0-9]", "_", name)
        plain = plain.upper() if prefix.isupper() else plain
        taken, identifier, number = {item.upper() for item in found}, plain, 1
        while identifier.upper() in taken:
            number += 1
            identifier = f"{plain}_{number}"
        found.append(identifier)
    return found


def comment(text: str) -> str:
    """Text that ends no comment and opens none."""
    return " ".join(text.split()).replace("*/", "* /").replace("/*", "/ *")


def string(text: str) -> str:
    """A string literal; every byte that is not plain is written as a number."""
    plain = (chr(byte) if 32 <= byte < 127 and chr(byte) not in '"\\?' else f"\\{byte:03o}" for byte in text.encode())
    return f'"{"".join(plain)}"'


def enumeration(name: str, members: Iterable[tuple[str, int, str]]) -> Iterator[str]:
    """An enum from (identifier, value, comment)."""
    yield f"enum {name} {{"
    for identifier, value, words in members:
        yield f"  {identifier} = {value}," + (f" /* {comment(words)} */" if words else "")
    yield "};"
