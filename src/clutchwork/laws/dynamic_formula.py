"""Friction law with states, given by expressions."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, ClassVar

from clutchwork.declare import Role, State, component, formula
from clutchwork.laws.bases.expression import SLIP
from clutchwork.laws.bases.formula import NAME, SLIPS, TAKEN, FormulaLaw, Found, no_number
from clutchwork.laws.bases.jumps import where
from clutchwork.laws.bases.program import Program

MOST_STATES = 4
SPAN = 1e-5
# what a contact calls by these names
SIGNALS = {"torque", "slip", "power", "work", "heat", "capacity", "load", "angle", "state", "friction", "gain"}
# what a coefficient jumps by where its slip changes its sign, over its size
JUMP = 1e-3


@component(
    Role.LAW,
    states=tuple(
        State("z" if i == 1 else f"z_{i}", "1", "state of the formula", span=SPAN) for i in range(1, MOST_STATES + 1)
    ),
    hooks=("count",),
)
class DynamicFormula(FormulaLaw):
    """Coefficient as an expression over slip and states of its own, whose rates are expressions too; it never sticks.

    `rates={"z": "s*(v - abs(v)*z/(mu_k + (mu_s - mu_k)*exp(-(v/v_s)**2)))"}` and the expression `z` are LuGre friction
    without damping. Use it for a bristle model that is not built in. The slip `v` has a sign; states begin at zero,
    where a contact without load puts them again, and should be of the size of a coefficient: stiffness times
    deflection.

    Equations: docs/theory/friction-laws.md.
    """

    sticks: ClassVar[bool] = False

    at_rest: str = formula("coefficient that it holds for a while, without slip and states", example="0.15")
    rates: Mapping[str, str] = formula(
        "rate [1/s] of each state by the name of that, 1 to 4 of them",
        example={"z": "1000*(v - abs(v)*z/(0.1 + 0.05*exp(-(v/2)**2)))"},
    )
    expression: str = formula(
        "coefficient over the slip `v` [rad/s], the states, `temperature` [K], `pressure` [Pa] and the numbers",
        kw_only=False,
        example="z + 0.01*v",
    )

    def rate_texts(self) -> Mapping[str, Any]:
        return self.rates if isinstance(self.rates, Mapping) else {}

    def own_states(self) -> tuple[State, ...]:
        """One state for each rate, by its name."""
        return tuple(State(name, "1", "state of the formula", span=SPAN) for name in self.rate_texts())

    def slips(self) -> tuple[float, ...]:
        return (*(-slip for slip in SLIPS[:0:-1]), *SLIPS)

    def problems(self) -> Found:
        rates: Any = self.rates
        if not isinstance(rates, Mapping) or not 1 <= len(rates) <= MOST_STATES:
            fault, remedy = f"must be a table of 1 to {MOST_STATES} rates by the names of states", 'write {"z": "..."}'
            return [("rates", fault, remedy)]
        numbers = {one.name for one in type(self).numbers}
        if not all(isinstance(rate, str) for rate in rates.values()):
            return [("rates", "must hold an expression for each state, as a string", 'write {"z": "..."}')]
        taken = [name for name in rates if not _is_state(name) or name in numbers]
        if taken:
            return [
                (f"rates.{name}", "is not a name for a state", "give it one that nothing else has") for name in taken
            ]
        return super().problems()

    def faults(self, program: Program) -> Iterator[Found]:
        for place in self.places(program):
            for slip in (*SLIPS, *(-slip for slip in SLIPS if slip)):
                at = {**place, SLIP: slip}
                found = no_number(program, program.run(at), at) or _drives(program, at)
                if found:
                    yield found
            yield from _jump(program, place)


def _is_state(name: Any) -> bool:
    return isinstance(name, str) and NAME.fullmatch(name) is not None and name not in TAKEN | SIGNALS


def _jump(program: Program, place: dict[str, float]) -> Iterator[Found]:
    """A coefficient that jumps with the sign of the slip, with which nothing can come to rest."""
    after, before = (program.run({**place, SLIP: slip})[program.coefficient] for slip in (1e-9, -1e-9))
    if abs(after - before) > JUMP * max(abs(after), abs(before), 1e-3):
        fault = f"jumps from {before:g} to {after:g} where the slip changes its sign"
        yield [("expression", fault, "a law that jumps there sticks: write it as cw.Formula, over abs(v)")]


def _drives(program: Program, at: dict[str, float]) -> Found:
    """A coefficient with which friction drives in steady sliding."""
    settled = _settled(program, at)
    if settled is None or not at[SLIP]:
        return []
    coefficient = program.run(settled)[program.coefficient]
    if coefficient * at[SLIP] >= 0.0:
        return []
    fault = f"is {coefficient:g} in steady sliding {where(program, at)}: friction that drives"
    return [("expression", fault, "give it the sign of the slip")]


def _settled(program: Program, at: dict[str, float]) -> dict[str, float] | None:
    """Where the states come to rest at a steady slip, by Newton's method; None where none is found."""
    from clutchwork.laws.bases.newton import root

    names = program.states

    def rates(values: list[float]) -> list[float]:
        registers = program.run({**at, **dict(zip(names, values, strict=True))})
        return [registers[i] for i in program.rates]

    found = root(rates, [0.0] * len(names))
    return None if found is None else {**at, **dict(zip(names, found, strict=True))}
