"""`clutchwork elements`, `laws`, `signals`, `units`: the reference in the shell, from the declarations."""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Mapping
from typing import Any

from clutchwork.base import columns, counted, listed
from clutchwork.base.errors import nearest
from clutchwork.base.shell import DONE, Example, add_command, add_json, paragraphs, tell, tell_json, width
from clutchwork.declare.docs import FieldDescription, described, summary, words
from clutchwork.declare.purposes import ELEMENT_ROLES, groups
from clutchwork.declare.schema import Role, specs
from clutchwork.declare.unit_table import UnitRow, unit_table

ROLES: dict[str, tuple[Role, ...]] = {"elements": ELEMENT_ROLES, "laws": (Role.LAW,), "signals": (Role.SIGNAL,)}
PURPOSES = {
    "elements": "list all elements, or all fields of one",
    "laws": "list all friction laws, or all fields of one",
    "signals": "list what a value over time may be",
    "units": "list the units that values may have",
}
EXAMPLES: dict[str, tuple[Example, ...]] = {
    "elements": (
        ("clutchwork elements", "all of them, by what they are for"),
        ("clutchwork elements disk_clutch", "every field of one, with unit, bound, default, and an example"),
        ("clutchwork elements heat", "those that a word appears in"),
    ),
    "laws": (
        ("clutchwork laws", "all of them"),
        ("clutchwork laws stribeck", "every field of one, with unit, bound, default, and an example"),
        ("clutchwork laws temperature", "those that a word appears in"),
    ),
    "signals": (
        ("clutchwork signals", "all of them"),
        ("clutchwork signals table", "every field of one, with unit, bound, default, and an example"),
    ),
    "units": (
        ("clutchwork units", "all of them"),
        ("clutchwork units pressure", "those of one quantity"),
        ("clutchwork units rpm", "one unit, and the others of its quantity"),
    ),
}


def add_commands(commands: Any) -> None:
    """Add the commands of the reference."""
    for name in ROLES:
        parser = add_command(commands, name, look_up, PURPOSES[name], examples=EXAMPLES[name])
        parser.add_argument("name", nargs="?", help=f"one of them, or a word that the descriptions of {name} hold")
        parser.set_defaults(topic=name)
        add_json(parser)
    parser = add_command(
        commands,
        "units",
        look_up_units,
        PURPOSES["units"],
        about='A value in a model file or on the command line may be a number with a unit, such as "2 bar". A plain '
        'number is in SI. Units may be joined: "N m s/rad", "kg cm2", "1/s".',
        examples=EXAMPLES["units"],
    )
    parser.add_argument("name", nargs="?", help="a unit or a quantity, such as rpm or pressure")
    add_json(parser)


def kinds(topic: str) -> dict[str, Any]:
    """All declarations of a topic, "elements", "laws" or "signals", by kind."""
    return {kind: cls for found in groups(*ROLES[topic]).values() for kind, cls in found.items()}


def look_up(asked: argparse.Namespace) -> int:
    """Print all of them, one, or those that a word appears in; the exit code."""
    topic, known = asked.topic, kinds(asked.topic)
    if asked.name is None:
        chosen = groups(*ROLES[topic])
    elif _kind(asked.name, known):
        kind = _kind(asked.name, known)
        more = [other for other in known if kind in other and other != kind]
        if asked.json:
            tell_json(_data(known[kind], whole=True) | {"see_also": more})
        else:
            tell("\n\n".join(_page(known[kind], more)))
        return DONE
    else:
        found = _with_word(asked.name, known)
        if not found:
            raise ValueError(_unknown(asked.name, topic, known))
        chosen = {
            heading: {kind: cls for kind, cls in those.items() if kind in found}
            for heading, those in groups(*ROLES[topic]).items()
        }
    chosen = {heading: those for heading, those in chosen.items() if those}
    if asked.json:
        tell_json(
            {topic: [_data(cls) | {"purpose": group} for group, those in chosen.items() for cls in those.values()]}
        )
    else:
        tell("\n\n".join([*(_listed(heading, those) for heading, those in chosen.items()), _next(topic)]))
    return DONE


def _kind(name: str, known: Mapping[str, Any]) -> str:
    """The kind that a name means: "disk_clutch", "DiskClutch", "disk-clutch"; empty where there is none."""
    plain = {kind.replace("_", ""): kind for kind in known}
    return plain.get(name.lower().replace("_", "").replace("-", "").replace(" ", "").removeprefix("cw."), "")


def _with_word(word: str, known: Mapping[str, Any]) -> list[str]:
    """The kinds whose name or description holds a word."""
    return [kind for kind, cls in known.items() if word.lower() in f"{kind} {words(cls)}".lower()]


def _unknown(name: str, topic: str, known: Mapping[str, Any]) -> str:
    """What to say where a name leads nowhere: near ones, or where else it leads."""
    elsewhere = [other for other in ROLES if other != topic and _kind(name, kinds(other))]
    if elsewhere:
        return f"no {topic.removesuffix('s')} {name!r}, but one of the {elsewhere[0]}: clutchwork {elsewhere[0]} {name}"
    found = nearest(name.lower(), known) or nearest(name, [cls.__name__ for cls in known.values()])
    meant = f"; did you mean {found!r}?" if found else ""
    first = f"no {topic.removesuffix('s')} {name!r}, and no description holds this word{meant}"
    return f"{first}\n{_hanging('known: ', listed(known))}"


def _listed(heading: str, found: Mapping[str, Any]) -> str:
    wide = max(map(len, found))
    lines = [_hanging(f"  {kind:<{wide}}  ", summary(cls)) for kind, cls in found.items()]
    return "\n".join([heading, *lines])


def _next(topic: str) -> str:
    lines = {
        "elements": "In Python, disk_clutch is cw.DiskClutch, and so on.",
        "laws": 'In a model file: friction = {type = "NAME", ...}.',
        "signals": 'In a model file: pressure = {type = "NAME", ...}. The name of a thermal node, an actuator or '
        'another process gives its temperature or state: pressure = "piston".',
    }
    return paragraphs(f"All fields of one: clutchwork {topic} NAME. {lines[topic]}", width())


def _hanging(head: str, text: str) -> str:
    """Text behind a head, further lines below its first word."""
    lines = paragraphs(text, width() - len(head)).split("\n")
    return "\n".join([head + lines[0], *(" " * len(head) + line for line in lines[1:])])


def _page(cls: Any, more: list[str]) -> Iterator[str]:
    """All there is to say of one."""
    yield f'{cls.kind}: type = "{cls.kind}" in a model file, cw.{cls.__name__} in Python'
    yield paragraphs(words(cls), width())
    fields = [described(item, spec) for item, spec in specs(cls)]
    if fields:
        wide = max(len(told.name) for told in fields)
        lines = [_hanging(f"  {told.name:<{wide}}  ", f"{_about(told)}: {told.meaning}") for told in fields]
        yield "\n".join(["fields", *lines])
    states = [(f"  {state.name}", f"[{state.unit}]", state.doc) for state in cls.states] if cls.states else []
    if states:
        yield "\n".join(["states", columns(states[:4]), *(["  ..."] if len(states) > 4 else [])])
    example = _example(cls)
    yield f"example\n{example}" if example else "It holds a Python function, so a model file cannot have one."
    if more:
        yield _hanging("see also: ", listed(more))


def _example(cls: Any) -> str:
    """Lines of a model file; what writes these needs numpy, and help does without."""
    from clutchwork.command.toml_example import toml_example

    return toml_example(cls)


def _about(told: FieldDescription) -> str:
    """Sort, unit, bound and default in a few words."""
    unit = f"[{told.unit}]" if told.unit and told.unit != "1" else ""
    sort = f"one of {told.bound}" if told.sort == "choice" else " ".join(filter(None, (told.sort, unit, told.bound)))
    return f"{sort}, {told.default if told.default == 'required' else f'default {told.default}'}"


def _data(cls: Any, *, whole: bool = False) -> dict[str, Any]:
    """A declaration as plain data."""
    data = {"type": cls.kind, "class": cls.__name__, "summary": summary(cls)}
    if not whole:
        return data
    return data | {
        "description": words(cls),
        "fields": [described(item, spec)._asdict() for item, spec in specs(cls)],
        "states": [{"name": state.name, "unit": state.unit, "meaning": state.doc} for state in cls.states or ()],
        "example": _example(cls),
    }


def look_up_units(asked: argparse.Namespace) -> int:
    """Print the units; the exit code."""
    rows = list(unit_table())
    if asked.name is not None:
        word = asked.name
        quantities = {row.quantity for row in rows if word == row.name or word.lower() in row.quantity.lower()}
        if not quantities:
            names = [*(row.name for row in rows), *(row.quantity for row in rows)]
            found = nearest(word, names)
            meant = f"; did you mean {found!r}?" if found else ""
            known = _hanging("known: ", listed(row.name for row in rows))
            raise ValueError(f"no unit or quantity {word!r}{meant}\n{known}")
        rows = [row for row in rows if row.quantity in quantities]
    if asked.json:
        tell_json({"units": [row._asdict() for row in rows]})
    else:
        lines = [(row.quantity, row.name, f"{_in_si(row)}") for row in rows]
        tell(columns([("quantity", "unit", "in SI"), *lines]))
        tell(f'\n{counted(len(rows), "units")}; they may be joined: "N m s/rad", "2000 kg cm2", "1/s"')
    return DONE


def _in_si(row: UnitRow) -> str:
    """One of a unit in SI, such as "100000 Pa", with its zero where that is another."""
    one = f"{row.factor:.10g} {'' if row.si == '1' else row.si}".strip()
    return f"{one}, 0 is {row.offset:g} {row.si}" if row.offset else one
