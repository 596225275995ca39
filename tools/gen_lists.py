"""Write the pages that list what is there: all tests with what they show, and the help of every command.

Usage: gen_lists.py FOLDER. The documentation build calls it; its output is never committed.
"""

from __future__ import annotations

import argparse
import ast
import os
import re
import sys
from collections.abc import Iterator
from pathlib import Path

from clutchwork.command.main import parser

ROOT = Path(__file__).resolve().parent.parent
# a page that other pages link to, and no table of contents
ORPHAN = "---\norphan: true\n---\n\n"
COLUMNS = "100"


def test_files(root: Path = ROOT) -> list[Path]:
    """All files with tests."""
    return sorted([*root.glob("tests/*/test_*.py"), *root.glob("tests/cpp/test_*.cpp")])


def shows(path: Path) -> str:
    """What the tests of a file show, as its first comment says."""
    text = path.read_text(encoding="utf-8")
    if path.suffix == ".py":
        words = ast.get_docstring(ast.parse(text)) or ""
        return words.partition("\n\n")[0].replace("\n", " ")
    return " ".join(re.findall(r"^/// (.*)", (re.search(r"(?:^///.*\n)+", text, re.MULTILINE) or [""])[0], re.MULTILINE))


def tests() -> Iterator[str]:
    """The page of all tests."""
    yield ORPHAN + "# All tests\n\nEvery file with tests, and what it shows, in its own words.\n\n| file | |\n|---|---|"
    for path in test_files():
        yield f"| `{path.relative_to(ROOT)}` | {shows(path).replace('|', ', ')} |"


def commands() -> Iterator[str]:
    """The page of the command line: the help of every command."""
    os.environ["COLUMNS"] = COLUMNS
    yield ORPHAN + "# The command line\n\nWhat `--help` prints."
    top = parser()
    yield f"\n## clutchwork\n\n```text\n{top.format_help()}```"
    for action in top._actions:
        if isinstance(action, argparse._SubParsersAction):
            for name, command in action.choices.items():
                yield f"\n## clutchwork {name}\n\n```text\n{command.format_help()}```"


def write(folder: Path) -> list[Path]:
    """Write the pages and return their paths."""
    folder.mkdir(parents=True, exist_ok=True)
    pages = {"tests.md": tests, "command-line.md": commands}
    for name, lines in pages.items():
        path, text = folder / name, "\n".join(lines()) + "\n"
        # an unchanged file keeps its date, so that the documentation build stays incremental
        if not path.exists() or path.read_text(encoding="utf-8") != text:
            path.write_text(text, encoding="utf-8")
    return [folder / name for name in pages]


if __name__ == "__main__":
    for page in write(Path(sys.argv[1])):
        print(page)
