"""What is wrong with a gearbox: members, shift table, published ratios, freewheels."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from clutchwork.base import Problem, listed, near, quote
from clutchwork.declare.rational import eliminate
from clutchwork.gearbox.gear_set import HOUSING
from clutchwork.gearbox.motion import (
    GEAR,
    INPUT_HELD,
    NEUTRAL,
    OUTPUT_HELD,
    SPLIT,
    TIE_UP,
    Combination,
    combination,
    speeds,
)
from clutchwork.gearbox.state import state
from clutchwork.gearbox.teeth import teeth_problems

if TYPE_CHECKING:
    from clutchwork.gearbox.definition import Definition, ShiftElement

# rows of a shift table that are no gears, and what they may be
NO_GEARS = {"N": (NEUTRAL, INPUT_HELD), "P": (OUTPUT_HELD, TIE_UP, NEUTRAL)}


def problems(box: Definition) -> list[Problem]:
    """All mistakes; of gears only once members and elements make sense."""
    found = [*_name_problems(box), *_member_problems(box), *_element_problems(box)]
    found += [problem for one in box.sets for problem in teeth_problems(one)]
    found += _row_problems(box)
    if not found:
        found += _rigid_problems(box)
    if not found:
        found += [problem for gear in box.gears for problem in _gear_problems(box, gear)]
        found += _published_problems(box)
        # a typo in one name shows up as a fault of many gears
        found = [*(_likely_typos(box) if found else ()), *found]
    return found


def _likely_typos(box: Definition) -> Iterator[Problem]:
    """Members of sets that occur once and look like another one, in a box whose gears are wrong."""
    ports = [(one.name, port, member) for one in box.sets for port, member in one.members.items()]
    named = [*(member for *_, member in ports), *(member for e in box.elements for member in e.members)]
    known = [member for member in dict.fromkeys([box.input, box.output, *named]) if member != HOUSING]
    ends = (box.input, box.output, *box.shafts, HOUSING)
    for name, port, member in ports:
        if named.count(member) == 1 and member not in ends:
            meant = near(member, [other for other in known if other != member])
            if meant:
                fault = f"is {quote(member)}, which nothing else is joined to{meant}"
                yield Problem(f'set "{name}"', port, fault, remedy="correct the name, or rename the member")


def _name_problems(box: Definition) -> Iterator[Problem]:
    for what, names in (("set", [one.name for one in box.sets]), ("element", [e.name for e in box.elements])):
        for name in dict.fromkeys(name for name in names if names.count(name) > 1):
            yield Problem(f'{what} "{name}"', "", "appears twice", remedy="give each its own name")
    shared = {one.name for one in box.sets} & {element.name for element in box.elements}
    taken = shared | set(box.members) & ({one.name for one in box.sets} | {e.name for e in box.elements})
    # a machine may have the name of its member
    taken |= {name for name in box.machines if name in shared or name in {one.name for one in box.sets}}
    taken |= {name for name in box.machines if name in {element.name for element in box.elements}}
    named = [*(one.name for one in box.sets), *(element.name for element in box.elements), *box.gears, *box.machines]
    for name in dict.fromkeys(name for name in named if name in ("", HOUSING)):
        yield Problem("gearbox", "", f"{quote(name)} cannot name a set, an element or a gear", remedy="rename it")
    for name in sorted(taken):
        yield Problem("gearbox", "", f"{quote(name)} names two things", remedy="rename one of them")
    for name in ("input", "output"):
        if getattr(box, name) == HOUSING:
            yield Problem("gearbox", name, "is the housing", remedy="name a member that turns")
    if box.input == box.output:
        yield Problem("gearbox", "output", "is the input too", quote(box.output), "name two members")
    if not box.sets:
        yield Problem("gearbox", "sets", "are missing", remedy="give at least one gear set: [sets.P1]")


def _member_problems(box: Definition) -> Iterator[Problem]:
    """Members that nothing is joined to: mostly names that are misspelt."""
    places: dict[str, list[str]] = {}
    for one in box.sets:
        for port, member in one.members.items():
            places.setdefault(member, []).append(f'set "{one.name}": {port}')
    for element in box.elements:
        for member in element.members:
            places.setdefault(member, []).append(f'element "{element.name}"')
    for member in box.members:
        if member.strip().lower() == HOUSING:
            remedy = f"write {HOUSING!r}, all small, for what never turns"
            yield Problem("gearbox", "", f"{quote(member)} is not the name of a member", remedy=remedy)
    ends = {box.input, box.output, HOUSING, *box.shafts}
    for name, member in box.machines.items():
        if member not in places:
            meant = near(member, places)
            fault = f"is not a member of any set or element{meant}"
            yield Problem(f'machine "{name}"', "", fault, quote(member), _known(places))
    for name in ("input", "output"):
        member = getattr(box, name)
        if member not in places and member != HOUSING:
            meant = near(member, places)
            yield Problem(
                "gearbox", name, f"is not a member of any set or element{meant}", quote(member), _known(places)
            )
    for member, where in places.items():
        if len(where) == 1 and member not in ends and where[0].startswith("element"):
            others = [other for other in places if other != member]
            fault = f"joins {quote(member)}, which no set and no other element has{near(member, others)}"
            yield Problem(where[0], "", fault, remedy="correct the name, or list it under `shafts`")


def _known(places: dict[str, list[str]]) -> str:
    return f"known members: {listed(places)}"


def _element_problems(box: Definition) -> Iterator[Problem]:
    for element in box.elements:
        path, held = f'element "{element.name}"', HOUSING in element.members
        if element.first == element.second:
            yield Problem(path, "", f"joins {element.first} to itself", remedy="give two members")
        elif element.kind == "brake" and not held:
            remedy = 'give ["member", "housing"], or the type clutch'
            yield Problem(path, "", "is a brake between two members", remedy=remedy)
        elif element.kind == "clutch" and held:
            yield Problem(path, "", "is a clutch to the housing", remedy="give it the type brake")


def _row_problems(box: Definition) -> Iterator[Problem]:
    """Rows of the shift table that name what is not there, or the same as another row."""
    names = [element.name for element in box.elements]
    rows = {f'gear "{gear}"': row for gear, row in box.gears.items()} | {"always_closed": box.always_closed}
    for path, row in rows.items():
        for name in row:
            if name not in names:
                meant = near(name, names)
                remedy = "" if meant else f"known elements: {listed(names)}" if names else "give elements: [elements]"
                yield Problem(
                    path, "", f"closes {quote(name)}, which is not an element of this box{meant}", remedy=remedy
                )
    seen: dict[frozenset[str], str] = {}
    for gear in box.gears:
        closed = frozenset(box.closed_in(gear))
        # neutral and park may open the same elements: a pawl holds the output
        if closed in seen and not {gear, seen[closed]} <= set(NO_GEARS):
            fault = f'closes the same as gear "{seen[closed]}": {listed(sorted(closed)) or "nothing"}'
            yield Problem(f'gear "{gear}"', "", fault, remedy="correct one of the two rows")
        seen.setdefault(closed, gear)
    for gear in box.published:
        if gear not in box.gears:
            meant = near(gear, box.gears)
            remedy = "" if meant else f"known gears: {listed(box.gears)}"
            yield Problem(f'published "{gear}"', "", f"is not a gear of the shift table{meant}", remedy=remedy)


def _rigid_problems(box: Definition) -> Iterator[Problem]:
    """Sets that hold members without any element, and such as repeat what others say."""
    open_ = combination(box, ())
    held = [member for member, row in speeds(box, ()).items() if not row]
    if held:
        remedy = "correct the members of the sets; one that never turns is called housing"
        yield Problem("gearbox", "sets", f"hold {listed(held)} without any element closed", remedy=remedy)
    elif open_.redundant:
        places = {member: place for place, member in enumerate(box.members)}
        rows = [(one, {places[m]: v for m, v in row.items()}) for one in box.sets for row in one.rows()]
        known = eliminate((), range(len(places)))
        for one, row in rows:
            before = len(known.spare)
            known.add(row)
            if len(known.spare) > before:
                fault = "repeats what other sets say about the speeds of its members"
                remedy = (
                    "correct its members, or write sets that share their torque, such as twin countershafts, as one"
                )
                yield Problem(f'set "{one.name}"', "", fault, remedy=remedy)


def _gear_problems(box: Definition, gear: str) -> Iterator[Problem]:
    """A row that does not make a gear with one degree of freedom."""
    found, path = combination(box, box.closed_in(gear)), f'gear "{gear}"'
    if gear in NO_GEARS:
        if found.kind not in NO_GEARS[gear]:
            ratio = f" of ratio {float(found.ratio):.4g}" if found.ratio is not None else ""
            fault = (
                f"is not {'neutral' if gear == 'N' else 'park'}: closing {_named(found)} makes {_a(found.kind)}{ratio}"
            )
            yield Problem(path, "", fault, remedy="correct the row or rename it")
        return
    if found.kind == SPLIT or (box.machines and found.kind == INPUT_HELD and found.dof == 1):
        return
    fault, remedy = _fault(box, found)
    if fault:
        yield Problem(path, "", fault, remedy=remedy)
    else:
        yield from _freewheel_problems(box, gear)


def _fault(box: Definition, found: Combination) -> tuple[str, str]:
    """What is wrong with a gear and what to do, in words of elements and members."""
    moving = {member: row for member, row in speeds(box, found.closed).items() if row}
    still = [member for member in box.members if member not in moving]
    some = _named(found)
    if found.kind == TIE_UP:
        return f"closing {some} ties the box up: it holds {listed(still)}", "leave one of them open"
    if found.kind in (INPUT_HELD, OUTPUT_HELD):
        which = "input" if found.kind == INPUT_HELD else "output"
        member = getattr(box, which)
        return (
            f"closing {some} holds the {which} {member}",
            f"leave open what holds {listed(still)}, or close another element",
        )
    if found.kind == NEUTRAL:
        free = [box.members[place] for place in sorted({n for row in moving.values() for n in row})]
        missing = found.dof - 1
        return (
            f"closing {some} leaves {found.dof} speeds free: "
            f"{box.input} does not drive {box.output}; {listed(free)} turn freely",
            f"close {missing} more element{'s' if missing > 1 else ''}",
        )
    if found.idle:
        column = next(iter(moving[box.output]))
        idle = [member for member, row in moving.items() if set(row) - {column} and member not in box.shafts]
        if idle:
            fault = f"closing {some} leaves {found.dof} speeds free, those of {listed(idle)}"
            return fault, "close one more element, or list under `shafts` what may turn freely"
    return "", ""


def _named(found: Combination) -> str:
    *others, last = found.closed or ("nothing",)
    return f"{', '.join(others)} and {last}" if others else last


def _a(kind: str) -> str:
    return {GEAR: "a gear", NEUTRAL: "neutral", TIE_UP: "a tie-up"}.get(kind, f"the {kind.split()[0]} stand still")


def _freewheel_problems(box: Definition, gear: str) -> Iterator[Problem]:
    """Freewheels of the row that would overrun under torque from the input, and others that would hold."""
    found = state(box, box.closed_in(gear), gear)
    if found is None:
        return
    wheels: list[ShiftElement] = [e for e in box.elements if e.kind == "freewheel"]
    for wheel in wheels:
        if found.slips.get(wheel.name, 0.0) < 0.0:
            fault = f"freewheel {wheel.name} would hold, and it is not in this row"
            remedy = "swap its members, or correct the row"
            yield Problem(f'gear "{gear}"', "", fault, remedy=remedy)
        elif found.torques.get(wheel.name, 0.0) < 0.0:
            fault = f"freewheel {wheel.name} would overrun under torque from {box.input}"
            remedy = f"swap its members: [{quote(wheel.second)}, {quote(wheel.first)}]"
            yield Problem(f'gear "{gear}"', "", fault, remedy=remedy)


def _published_problems(box: Definition) -> Iterator[Problem]:
    for gear, wanted in box.published.items():
        ratio = combination(box, box.closed_in(gear)).ratio
        if not ratio:
            continue
        value = float(1 / ratio if box.ratio_form == "out/in" else ratio)
        allowed = max(box.tolerance, box.tolerance_relative * abs(wanted))
        # one unit in the last place of the tolerance
        if abs(value - wanted) > allowed * (1.0 + 1e-9):
            fault = f"is {value:.4f} by its teeth, {abs(value - wanted):.4f} away, more than the tolerance {allowed:g}"
            remedy = f'correct the teeth, the members or the row of gear "{gear}"'
            yield Problem(f'published "{gear}"', "", fault, f"{wanted:g}", remedy)
