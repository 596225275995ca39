"""Pictures and printed tables of the pages, which are committed so that a forge shows them: `make pictures`.

Usage: committed.py [--all]. Draws the groups of which a file is missing or something has changed that they are made
from, or all of them; each group in a process of its own. A change of the core that alters results is not seen by
itself: `make pictures ARGS=--all` draws everything.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
import sys
import tempfile
from collections.abc import Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor, as_completed
from importlib import import_module
from multiprocessing import get_context
from pathlib import Path

import included
from compressed import compress
from groups import GROUPS, ROOT

DOCS = ROOT / "docs"
FOLDER = DOCS / "pictures"
RECORD = FOLDER / "made_from.json"
SHOWN = re.compile(r"(?:^|[^\w/])(?:\.\./)?pictures/([\w-]+/[\w./-]+\.(?:png|svg|txt))")


def pages() -> list[Path]:
    """Pages that people read, whatever shows them."""
    folders = ("", "guide", "theory", "elements")
    return sorted(path for folder in folders for path in (DOCS / folder).glob("*.md"))


def shown() -> dict[str, list[str]]:
    """Pictures and texts that pages show, by their groups."""
    texts = (path.read_text(encoding="utf-8") for path in pages())
    found = sorted({name for text in texts for name in SHOWN.findall(text)})
    return {
        group: [name for name in found if name.startswith(f"{group}/")]
        for group in GROUPS
    }


def record() -> dict[str, dict[str, str]]:
    """For each group the fingerprint of what it was made from, and those of its files."""
    return (
        dict(json.loads(RECORD.read_text(encoding="utf-8"))) if RECORD.exists() else {}
    )


def write_record(known: dict[str, dict[str, str]]) -> None:
    """Write the record, without groups that are gone."""
    kept = {group: known[group] for group in GROUPS if group in known}
    RECORD.write_text(json.dumps(kept, indent=1) + "\n", encoding="utf-8")


def now(group: str, names: Iterable[str]) -> dict[str, str]:
    """The record of a group as its files are now."""
    files = {name: _digest(FOLDER / name) for name in names}
    return {"made from": GROUPS[group].fingerprint(), **files}


def _digest(path: Path) -> str:
    return (
        hashlib.sha256(path.read_bytes()).hexdigest()[:16]
        if path.exists()
        else "missing"
    )


def faults() -> Iterator[tuple[str, str]]:
    """Groups to draw, each with what is wrong with it."""
    known = record()
    for group, names in shown().items():
        then, there = known.get(group, {}), now(group, names)
        for name in names:
            if there[name] == "missing":
                yield group, f"docs/pictures/{name} is missing"
            elif then.get(name) != there[name]:
                yield group, f"docs/pictures/{name} is not as it was drawn"
            elif then["made from"] != there["made from"]:
                yield (
                    group,
                    f"docs/pictures/{name} is stale: what it is made from has changed",
                )


def unused() -> list[str]:
    """Committed files that no page shows."""
    wanted = {name for names in shown().values() for name in names}
    files = (path for path in FOLDER.rglob("*") if path.is_file() and path != RECORD)
    return sorted(
        name
        for path in files
        if (name := path.relative_to(FOLDER).as_posix()) not in wanted
    )


def draw(group: str) -> str:
    """Draw a group and put what pages show of it into its folder."""
    with tempfile.TemporaryDirectory() as folder:
        import_module(GROUPS[group].module).write(Path(folder))
        for name in shown()[group]:
            compress(Path(folder) / name.partition("/")[2], FOLDER / name)
    return group


def _jobs() -> int:
    return int(os.environ.get("JOBS") or os.cpu_count() or 1)


def main(everything: bool) -> None:
    """Draw what has to be drawn, and let pages have the texts that they include."""
    todo = [group for group in GROUPS if everything or group in dict(faults())]
    known = record()
    context = get_context("spawn")
    with ProcessPoolExecutor(_jobs(), context, max_tasks_per_child=1) as pool:
        for done in as_completed([pool.submit(draw, group) for group in todo]):
            group = done.result()
            known[group] = now(group, shown()[group])
            write_record(known)
            print(f"docs/pictures/{group}", flush=True)
    for name in unused():
        (FOLDER / name).unlink()
    for path in pages():
        included.update(path)


if __name__ == "__main__":
    main("--all" in sys.argv[1:])
