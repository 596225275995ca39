"""Mutations of text, bytes and plain data; the same number gives the same mutation on every machine."""

from __future__ import annotations

import copy
import json
from random import Random
from typing import Any

NUMBERS = (
    0, -1, 1, 2, 3, -0.0, 1e-300, 5e-324, 1e300, -1e308, 1e16, 2**63, 10**400, -(10**400), 1e-9, 273.15, 20, 1e9,
)  # fmt: skip
TEXTS = (
    "", " ", "housing", "a", "b", "x", "c1", "engine", "load", "x.x", "a,b", 'a"b', "a\nb", "a\x1b[31mb", "a\u202eb",
    "$x$", "\\frac", "_a", "\ud800", "a" * 5000, "1 bar", "20 degC", "1e400 m", "1 m9999", "3 km9 h9", "1 " * 90, "nan",
    "/dev/zero", "/etc/passwd", "/", "../..", "p.csv", "clutch", "brake", "gear", "coulomb", "sine", "pulse", "column",
    "table", "stribeck", "damper", "disk_clutch", "dog_clutch", "wear", "true", "\0", "linear", "error", "power",
)  # fmt: skip
CURVES = ([], [[0, 1]], [[0, 1], [0, 1]], [[1, 1], [0, 1]], [[0, 1], [5e-324, 2]], [[0, 0.1], [10, 0.05], [20, 0.04]])
# texts of TOML and JSON that no value tree holds
SNIPPETS = (
    "nan", "-inf", "1_0", "0x" + "f" * 9000, "9" * 400, "9" * 5000, "[" * 3000, "{a=" * 500, '{"a":' * 3000, '"""',
    "'''", "#", "\0", "\r", "\ufeff", "[[element]]", "[[shaft]]", "a.b.c=1", "=", "}", "]", ",", '"',
    "1979-05-27T07:32:00Z",
)  # fmt: skip


def nasty(random: Random) -> Any:
    """A value that rarely fits."""
    sort = random.randrange(8)
    if sort < 3:
        return random.choice(NUMBERS)
    if sort < 5:
        return random.choice(TEXTS)
    if sort == 5:
        return copy.deepcopy(random.choice(CURVES))
    if sort == 6:
        return random.choice((True, False, None, [], {}, [[]], {"type": []}, {"type": "sine"}, {"value": 1, "unit": 2}))
    deep: Any = random.choice(NUMBERS)
    for _ in range(random.choice((2, 5, 300))):
        deep = {random.choice(("value", "points", "type", "of")): deep} if random.random() < 0.5 else [deep]
    return deep


def _places(data: Any) -> list[tuple[Any, Any]]:
    """Every place in a tree as (container, key)."""
    found, left = list[tuple[Any, Any]](), [data]
    while left:
        at = left.pop()
        keys = list(at) if isinstance(at, dict) else range(len(at)) if isinstance(at, list) else ()
        found += [(at, key) for key in keys]
        left += [at[key] for key in keys]
    return found


def tree(data: Any, random: Random) -> Any:
    """Plain data with some places changed."""
    made = copy.deepcopy(data)
    for _ in range(random.choice((1, 1, 1, 2, 3, 8))):
        places = _places(made)
        if not places:
            return nasty(random)
        at, key = random.choice(places)
        act = random.randrange(7)
        if act < 3:
            at[key] = nasty(random)
        elif act == 3:
            other, its = random.choice(places)
            at[key] = copy.deepcopy(other[its])
        elif act == 4:
            del at[key]
        elif isinstance(at, list):
            at.append(copy.deepcopy(at[key]))
        else:
            at[random.choice((*TEXTS, key.upper(), key[:-1], f"{key}s"))] = at[key]
    return made


def text(whole: str, random: Random) -> str:
    """A text with lines and characters changed."""
    for _ in range(random.choice((1, 1, 2, 4))):
        lines = whole.split("\n")
        at, act = random.randrange(len(lines)), random.randrange(7)
        if act == 0:
            lines.insert(at, random.choice(lines))
        elif act == 1:
            del lines[at]
        elif act == 2:
            lines = lines[:at]
        elif act == 3:
            head, equals, _ = lines[at].partition("=")
            lines[at] = f"{head}{equals} {random.choice((*SNIPPETS, json.dumps(nasty(random))))}"
        else:
            place = random.randrange(len(lines[at]) + 1)
            cut = place + random.choice((0, 1, 3))
            lines[at] = lines[at][:place] + random.choice((*SNIPPETS, chr(random.randrange(300)))) + lines[at][cut:]
        whole = "\n".join(lines)
    return whole


def data(whole: bytes, random: Random) -> bytes:
    """Bytes with some changed, cut off or repeated."""
    made = bytearray(whole)
    for _ in range(random.choice((1, 1, 2, 8, 40))):
        if not made:
            break
        at, act = random.randrange(len(made)), random.randrange(6)
        if act < 3:
            made[at] = random.choice((0, 1, 0x7F, 0x80, 0xFF, random.randrange(256)))
        elif act == 3:
            made[at : at + 8] = random.choice((b"\xff" * 8, b"\0" * 8, b"\xff" * 7 + b"\x7f", bytes(8 * [0x7F])))
        elif act == 4:
            del made[at : at + random.choice((1, 7, 8, 1000))]
        else:
            made[at:at] = made[at : at + random.choice((1, 8, 100))]
    return bytes(made)
