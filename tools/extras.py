"""Print the requirements of the package and of some of its extras, one a line, for pip.

The package itself is left out, so that tools can be installed before it is built.
"""

from __future__ import annotations

import re
import sys
import tomllib
from pathlib import Path

PROJECT = Path(__file__).resolve().parent.parent / "pyproject.toml"


def requirements(extras: list[str]) -> list[str]:
    """The requirements of the package and of the named extras, references between extras followed."""
    project = tomllib.loads(PROJECT.read_text(encoding="utf-8"))["project"]
    own = re.compile(rf"{project['name']}\[(.*)\]")
    found: dict[str, None] = dict.fromkeys(project["dependencies"])
    todo = list(extras)
    while todo:
        for line in project["optional-dependencies"][todo.pop(0)]:
            reference = own.fullmatch(line)
            if reference:
                todo += reference[1].split(",")
            else:
                found[line] = None
    return list(found)


if __name__ == "__main__":
    print("\n".join(requirements(sys.argv[1:])))
