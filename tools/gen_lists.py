"""Write the pages that list what is there: all tests with what they show, and the help of every command.

Usage: gen_lists.py FOLDER. The documentation build calls it; its output is never committed.
"""

from __future__ import annotations

import ast
import contextlib
import io
import os
import re
import sys
from collections.abc import Iterator
from pathlib import Path

from clutchwork.command.main import main, parser

ROOT = Path(__file__).resolve().parent.parent
# a page that other pages link to, and no table of contents
ORPHAN = "---\norphan: true\n---\n\n"
COLUMNS = "100"


def shows(path: Path) -> str:
    """What the tests of a file show, as its first comment says."""
    text = path.read_text(encoding="utf-8")
    if path.suffix == ".py":
        words = ast.get_docstring(ast.parse(text)) or ""
        return words.partition("\n\n")[0].replace("\n", " ")
    first = re.match(r"(?:// .*\n)+", text)
    return " ".join(line.removeprefix("// ") for line in first[0].splitlines()) if first else ""


def tests() -> Iterator[str]:
    """The page of all tests."""
    yield ORPHAN + "# All tests\n\nEvery file with tests, and what it shows, in its own words.\n\n| file | |\n|---|---|"
    for path in sorted([*ROOT.glob("tests/*/test_*.py"), *ROOT.glob("tests/cpp/test_*.cpp")]):
        yield f"| `{path.relative_to(ROOT)}` | {shows(path).replace('|', ', ')} |"


def commands() -> Iterator[str]:
    """The page of the command line: the help of every command."""
    os.environ["COLUMNS"] = COLUMNS
    yield ORPHAN + "# The command line\n\nWhat `--help` prints."
    names = re.findall(r"^    (\w+) ", parser().format_help(), re.MULTILINE)
    for command in ([], *([name] for name in names)):
        yield f"\n## {' '.join(['clutchwork', *command])}\n\n```text\n{printed([*command, '--help'])}```"


def printed(arguments: list[str]) -> str:
    """What the command line prints before it ends."""
    with contextlib.redirect_stdout(io.StringIO()) as out, contextlib.suppress(SystemExit):
        main(arguments)
    return out.getvalue()


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
