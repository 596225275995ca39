"""schema.gen.hpp: the declarations and the layout as texts, for doors that compare them with their own."""

from __future__ import annotations

import json
from collections.abc import Iterator

from clutchwork.declare.layout import layout_text
from clutchwork.declare.schema import schema_text

FILE = "schema.gen.hpp"
# compilers bound the length of one literal
LONGEST = 1000


def lines() -> Iterator[str]:
    """The header without its head."""
    yield "namespace clutchwork {"
    for name, text in (("schema_text", schema_text()), ("layout_text", layout_text())):
        yield f"inline constexpr const char* {name} ="
        yield from (f"    {json.dumps(text[at : at + LONGEST])}" for at in range(0, len(text), LONGEST))
        yield "    ;"
    yield "}"
