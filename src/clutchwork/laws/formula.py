"""Friction law given by an expression."""

from __future__ import annotations

from collections.abc import Iterator

from clutchwork.declare import Role, component
from clutchwork.laws.bases.expression import SLIP
from clutchwork.laws.bases.formula import ROUND_OFF, SLIPS, FormulaLaw, Found, no_number
from clutchwork.laws.bases.jumps import where
from clutchwork.laws.bases.program import Program


@component(Role.LAW)
class Formula(FormulaLaw):
    """Kinetic coefficient as an expression over the slip, static coefficient at rest; it sticks exactly.

    `cw.Formula("mu_k + (mu_s - mu_k)*exp(-v/v_s)", mu_k=0.3, mu_s=0.4, v_s="0.1 rad/s")`: names that are not inputs are
    numbers of the law, which are given by keyword, with units or without. Use it for a law that is not built in, from a
    paper or a supplier. The slip `v` is that in the direction of sliding, never below zero, and `at_rest` defaults to
    the coefficient at `v = 0`.

    Equations: docs/theory/friction-laws.md.
    """

    def faults(self, program: Program) -> Iterator[Found]:
        for place in self.places(program):
            for slip in SLIPS:
                at = {**place, SLIP: slip}
                registers = program.run(at)
                found = no_number(program, registers, at) or _negative(program, registers, at)
                if slip == 0.0:
                    found = found or _below(program, registers, at)
                if found:
                    yield found


def _negative(program: Program, registers: list[float], at: dict[str, float]) -> Found:
    """A negative coefficient, with which friction would drive."""
    kinetic = registers[program.coefficient]
    if kinetic >= -ROUND_OFF:
        return []
    fault = f"is {kinetic:g} {where(program, at)}: below zero friction drives"
    return [("expression", fault, "keep it above: max(0, ...)")]


def _below(program: Program, registers: list[float], at: dict[str, float]) -> Found:
    """A coefficient at rest below that at vanishing slip."""
    static, kinetic = registers[program.at_rest], registers[program.coefficient]
    if kinetic <= static * (1 + ROUND_OFF):
        return []
    fault = f"is {static:g}, below the kinetic coefficient {kinetic:g} {where(program, at)}"
    return [("at_rest", fault, f"raise it to at least {kinetic:g}")]
