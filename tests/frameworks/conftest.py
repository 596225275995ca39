"""Programs of the page about frameworks."""

from __future__ import annotations

import re
from typing import Any

import pytest


@pytest.fixture
def run_of_page():
    """What the first program of a page and the one below a heading define."""

    def run(text: str, heading: str) -> dict[str, Any]:
        names: dict[str, Any] = {}
        below = text.partition(f"\n## {heading}\n")[2]
        for source, language in ((text, "python"), (below, "py")):
            found = re.search(rf"^```{language}\n(.*?)^```", source, re.DOTALL | re.MULTILINE)
            exec(compile(found[1], f"{heading} of the page", "exec"), names)
        return names

    return run
