"""Units of what a formula computes, as far as its numbers say theirs: docs/theory/friction-laws.md.

A number without a unit may have any, so that `0.3 + 0.01*v` is allowed. Angles count as numbers.
"""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

from clutchwork.declare import units
from clutchwork.laws.bases.expression import INPUTS, PRESSURE, SLIP, TEMPERATURE, Mistake

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from clutchwork.laws.bases.expression import FormulaNode
    from clutchwork.laws.bases.program import Program

# powers of kg, m, s, K and A; None: any
Powers = tuple[Fraction, ...] | None
NAMES = ("kg", "m", "s", "K", "A")
REMEDY = "give its numbers other units, or none, which fits any"
NUMBER = (Fraction(0),) * len(NAMES)
# results that take numbers without a unit, and give one
PURE = {"exp", "exp_behind", "fade", "fade_behind", "log", "tanh", "atan", "sin", "cos"}
SAME = {"add": "adds", "subtract": "subtracts", "smaller": "compares", "larger": "compares", "pick": "takes"}
SAME |= {"less": "compares"}


def mistakes_of_units(
    program: Program, given: Mapping[str, str], slips: Sequence[str] = ("rad/s", "m/s")
) -> list[Mistake]:
    """What does not fit whichever unit the slip has, that of shafts or that of masses.

    Parameters: given, the unit of each number that has one; slips, the units that the slip may have.
    """
    found = list[Mistake]()
    for slip in slips:
        known = {SLIP: slip, TEMPERATURE: "K", PRESSURE: "Pa", **dict.fromkeys(program.states, "1"), **given}
        wrong = _mistakes(program, {name: powers_of(unit) for name, unit in known.items()})
        if not wrong:
            return []
        found = found or wrong
    return found


def powers_of(unit: str) -> Powers:
    """Powers of the base units but the radian."""
    found = units.powers_of(unit)
    return tuple(Fraction(power) for place, power in enumerate(found) if place != 3)


def _mistakes(program: Program, known: Mapping[str, Powers]) -> list[Mistake]:
    leaves = (*INPUTS, *program.states, *program.names)
    registers: list[Powers] = [known.get(name) for name in leaves]
    registers += [None] * len(program.constants)
    begin, found = len(registers), list[Mistake]()
    for node, source in zip(program.nodes, program.sources, strict=True):
        of = [registers[i] for i in node.of]
        made, wrong = _unit(node.operation, of, _exponent(node, begin, program))
        registers.append(made)
        if wrong:
            found.append(Mistake(source.field, f"{wrong} in {source}", REMEDY))
    wanted: list[tuple[str, int, Powers]] = [
        ("expression", program.coefficient, NUMBER),
        ("at_rest", program.at_rest, NUMBER),
    ]
    per_second = powers_of("1/s")
    wanted += [(f"rates.{name}", i, per_second) for name, i in zip(program.states, program.rates, strict=True)]
    for field, register, unit in dict.fromkeys(wanted):
        if not found and registers[register] not in (None, unit):
            message = f"is in {shown(registers[register])}, must be in {shown(unit)}"
            found.append(Mistake(field, message, REMEDY))
    return found


def _exponent(node: FormulaNode, begin: int, program: Program) -> float | None:
    """The exponent of a power, where it is a constant."""
    place = node.of[1] - begin + len(program.constants) if node.operation == "power" else -1
    return program.constants[place] if 0 <= place < len(program.constants) else None


def _unit(operation: str, of: Sequence[Powers], exponent: float | None) -> tuple[Powers, str]:
    """The unit of a result, and what is wrong."""
    if operation in PURE or operation == "power":
        return _of_function(operation, of, exponent)
    sort, _, joined = operation.partition("_")
    if joined in ("product", "quotient"):
        inner, _ = _unit("multiply" if joined == "product" else "divide", of[1:], None)
        return _unit(sort, (of[0], inner), None)
    if operation == "bell":
        root, _ = _unit("divide", of, None)
        square, _ = _unit("multiply", (root, root), None)
        return _of_function("exp", (square,), None)
    if operation in SAME:
        first, second = of[-2:]
        made = second if first is None else first
        differs = first is not None and second is not None and first != second
        wrong = f"{SAME[operation]} {shown(first)} and {shown(second)}" if differs else ""
        return NUMBER if operation == "less" else made, wrong
    if operation in ("multiply", "divide"):
        sign = 1 if operation == "multiply" else -1
        # a constant may have a unit
        if of[0] is None or of[1] is None:
            return None, ""
        return tuple(a + sign * b for a, b in zip(of[0], of[1], strict=True)), ""
    if operation == "root":
        return of[0] and tuple(power / 2 for power in of[0]), ""
    return (NUMBER if operation == "sign" else of[0]), ""


def _of_function(operation: str, of: Sequence[Powers], exponent: float | None) -> tuple[Powers, str]:
    if operation == "power" and exponent is not None:
        share = Fraction(exponent).limit_denominator(1000)
        return of[0] and tuple(power * share for power in of[0]), ""
    name = operation.removesuffix("_behind").replace("fade", "exp")
    # behind the zero of the slip exp looks at that too
    taken = of[:1] if operation.endswith("_behind") else of
    wrong = next((f"takes {name} of {shown(one)}" for one in taken if one not in (None, NUMBER)), "")
    return NUMBER, wrong


def shown(powers: Powers) -> str:
    """A unit in words: "1/s", "kg m/s2"."""
    parts = zip(NAMES, powers or (), strict=False)
    above, below = list[str](), list[str]()
    for name, power in parts:
        if power:
            size = abs(power)
            words = name if size == 1 else f"{name}{size}" if size.denominator == 1 else f"{name}^({size})"
            (above if power > 0 else below).append(words)
    under = f"/({' '.join(below)})" if len(below) > 1 else f"/{below[0]}" if below else ""
    return f"[{' '.join(above) or '1'}{under}]"
