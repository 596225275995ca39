"""Lines of a TOML model file at which its tables and keys stand."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from clutchwork.base import Problem

_HEAD = re.compile(r'\s*(\[\[?)\s*"?([A-Za-z_]+)"?\s*((?:\.\s*(?:"[^"]*"|[\w-]+)\s*)*)\]\]?\s*(#.*)?')
_KEY = re.compile(r'\s*"?([A-Za-z_][\w-]*)"?\s*[=.]')
_PATH = re.compile(r'(\w+)(?: number (\d+)| "(.*?)"(?= \(| and |$))?', re.DOTALL)


class LineNumbers:
    """Where the tables of a file stand; nothing is known of JSON and of tables in one line."""

    def __init__(self, text: str, suffix: str) -> None:
        self._heads: dict[tuple[str, int], int] = {}
        self._keys: dict[tuple[str, int, str], int] = {}
        self._unread = text if suffix == ".toml" else ""

    def _read(self, text: str) -> None:
        counts: dict[str, int] = {}
        inside, table, below = False, ("file", 0), ""
        for number, line in enumerate(text.split("\n"), 1):
            head = None if inside else _HEAD.fullmatch(line)
            if head and head[3]:
                # a table inside of the last one: [element.shift.A]
                below = re.sub(r"[\s\"]", "", head[3])[1:] + "."
                table = (head[2], counts.get(head[2], 0))
                self._keys.setdefault((*table, below[:-1]), number)
            elif head:
                below = ""
                counts[head[2]] = counts.get(head[2], 0) + 1
                table = (head[2], counts[head[2]] if head[1] == "[[" else 0)
                self._heads.setdefault(table, number)
            elif not inside and (key := _KEY.match(line)):
                self._keys.setdefault((*table, below + key[1]), number)
            # a text over several lines may look like anything
            if (line.count('"""') + line.count("'''")) % 2:
                inside = not inside

    def placed(self, problem: Problem, data: Any) -> Problem:
        """A problem with its line, where that is known; most files have none, so they are read for the first one."""
        unread, self._unread = self._unread, ""
        self._read(unread)
        match = _PATH.match(problem.path)
        if match is None or not self._keys or not isinstance(data, Mapping):
            return problem
        kind, number = match[1], int(match[2] or 0)
        if match[3] is not None:
            entries = data.get(kind)
            listed = entries if isinstance(entries, list) else []
            names = [entry.get("name") if isinstance(entry, Mapping) else None for entry in listed]
            number = names.index(match[3]) + 1 if match[3] in names else -1
        words = re.split(r"[., ]", problem.quantity)
        key = words[0]
        ways = [".".join(words[:cut]) for cut in range(len(words), 0, -1)]
        line = next((self._keys[kind, number, way] for way in ways if (kind, number, way) in self._keys), 0)
        line = line or self._heads.get((kind, number), 0)
        if kind == "file":
            # a table with an unknown head
            line = line or self._heads.get((key, 1)) or self._heads.get((key, 0), 0)
        return replace(problem, line=line)
