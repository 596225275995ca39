"""Formulas as words of the core: registers, instructions, and what they compute here: docs/theory/friction-laws.md."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache
from typing import Any, NamedTuple

from clutchwork.base import counted
from clutchwork.laws.bases.expression import INPUTS, SLIP, FormulaGraph, FormulaNode, Mistake, Reader, Source

Points = tuple[tuple[float, float, float], ...]

# what the core does, in the order of its numbers there: declared.gen.hpp has them from here
OPERATIONS = (
    "add", "subtract", "add_product", "subtract_product", "add_quotient", "subtract_quotient", "multiply", "divide",
    "negate", "size", "smaller", "larger", "power", "root", "exp", "exp_behind", "fade", "fade_behind", "bell", "log",
    "tanh", "atan", "sin", "cos", "sign", "less", "pick",
)  # fmt: skip
# those whose results bend or jump
BENDING = frozenset({"size", "smaller", "larger", "sign", "less", "pick"})
# numbers that a formula may have at once: what it reads, its constants and its results
MOST_REGISTERS = 64
# an instruction says what it does, and where the first of three numbers stands, in one word
PER_WORD = 64
# beyond these exp stays where it is behind the zero of the slip; a base of a power is not below, nor what has a root
HIGHEST, LOWEST, LOWEST_ROOT = 20.0, 1e-12, 1e-24


class Program(NamedTuple):
    """Formulas of one law, as the core computes them."""

    names: tuple[str, ...]  # of the numbers, in order
    states: tuple[str, ...]
    constants: tuple[float, ...]
    nodes: tuple[FormulaNode, ...]  # instructions, their numbers being registers
    sources: tuple[Source, ...]
    coefficient: int  # registers of the results
    at_rest: int
    rates: tuple[int, ...]
    for_coefficient: int  # instructions that the coefficient needs, and with it the rates
    for_rates: int
    reads: frozenset[str]

    @property
    def bends(self) -> bool:
        """Whether any of its operations bends."""
        return any(node.operation in BENDING for node in self.nodes)

    @property
    def code(self) -> Points:
        """Constants, then instructions: operation, first and second register."""
        words = [(value, 0.0, 0.0) for value in self.constants]
        for node in self.nodes:
            of = {1: (0, *node.of, 0), 2: (0, *node.of), 3: node.of}[len(node.of)]
            words.append((OPERATIONS.index(node.operation) + PER_WORD * of[0], of[1], of[2]))
        return tuple((float(a), float(b), float(c)) for a, b, c in words) or ((0.0, 0.0, 0.0),)

    @property
    def head(self) -> Points:
        """Registers of both coefficients, counts of numbers and constants, instructions of the first and of rates."""
        first = (self.coefficient, self.at_rest, self.for_coefficient)
        second = (len(self.names), len(self.constants), self.for_rates)
        return tuple((float(a), float(b), float(c)) for a, b, c in (first, second))

    @property
    def rate_words(self) -> Points:
        """A dummy word, then the register of each rate."""
        return ((0.0, 0.0, 0.0), *((float(register), 0.0, 0.0) for register in self.rates))

    def run(self, given: Mapping[str, float]) -> list[float]:
        """All registers for given inputs, as doubles, without checks."""
        start = [given.get(name, 0.0) for name in (*INPUTS, *self.states, *self.names)]
        registers = [*map(float, start), *self.constants]
        for node in self.nodes:
            registers.append(_computed(node.operation, [registers[i] for i in node.of]))
        return registers

    def first_fault(self, registers: Sequence[float]) -> Source | None:
        """The first instruction whose result is not finite; None where all are."""
        begin = len(registers) - len(self.nodes)
        results = zip(self.nodes, self.sources, registers[begin:], strict=True)
        return next((source for _, source, value in results if not math.isfinite(value)), None)


def _computed(operation: str, of: Sequence[float]) -> float:
    """What the core computes, except for round-off of its functions."""
    try:
        return CALLS[operation](*of)
    except (OverflowError, ValueError):
        return math.inf if operation in ("exp", "exp_behind", "power", "fade", "fade_behind") else math.nan


def _quotient(a: float, b: float) -> float:
    if b == 0.0:
        return math.nan if a == 0.0 or math.isnan(a) else math.copysign(math.inf, a)
    return a / b


CALLS: dict[str, Callable[..., float]] = {
    "add": lambda a, b: a + b,
    "subtract": lambda a, b: a - b,
    "multiply": lambda a, b: a * b,
    "divide": _quotient,
    "negate": lambda a: -a,
    "size": abs,
    "smaller": min,
    "larger": max,
    # one below zero is told apart from others by what is no number
    "power": lambda a, b: math.nan if a < 0.0 else math.pow(max(a, LOWEST), b),
    "root": lambda a: math.nan if a < 0.0 else math.sqrt(a) if a > LOWEST_ROOT else 0.0,
    "exp": math.exp,
    "add_product": lambda a, b, c: a + b * c,
    "subtract_product": lambda a, b, c: a - b * c,
    "add_quotient": lambda a, b, c: a + _quotient(b, c),
    "subtract_quotient": lambda a, b, c: a - _quotient(b, c),
    "bell": lambda a, b: math.exp(-_quotient(a, b) * _quotient(a, b)),
    "fade": lambda a: math.exp(-a),
    "fade_behind": lambda a, slip: math.exp(min(-a, HIGHEST) if slip < 0.0 else -a),
    "exp_behind": lambda a, slip: math.exp(min(a, HIGHEST) if slip < 0.0 else a),
    "log": math.log,
    "tanh": math.tanh,
    "atan": math.atan,
    "sin": math.sin,
    "cos": math.cos,
    "sign": lambda a: float((a > 0.0) - (a < 0.0)),
    "less": lambda a, b: float(a < b),
    "pick": lambda asked, a, b: a if asked else b,
}


class Texts(NamedTuple):
    """The texts of a law."""

    expression: Any
    at_rest: Any
    rates: tuple[tuple[str, Any], ...]
    names: tuple[str, ...]
    forward: bool


@lru_cache(256)
def compiled(texts: Texts) -> tuple[Program | None, tuple[Mistake, ...]]:
    """The program of a law, None where there are mistakes, and all of these."""
    states = tuple(name for name, _ in texts.rates)
    graph = FormulaGraph((*INPUTS, *states, *texts.names), texts.forward)
    written: list[tuple[str, Any, tuple[str, ...]]] = [("expression", texts.expression, ())]
    written += [(f"rates.{name}", text, ()) for name, text in texts.rates]
    written += [] if texts.at_rest is None else [("at_rest", texts.at_rest, (SLIP, *states))]
    readers = [Reader(graph, field, unread) for field, _, unread in written]
    roots = [reader.root(text) for reader, (_, text, _) in zip(readers, written, strict=True)]
    mistakes = [mistake for reader in readers for mistake in reader.mistakes]
    if mistakes:
        return None, tuple(mistakes)
    found = [root for root in roots if root is not None]
    made = _laid_out(graph, found, states, texts)
    used = len(made.constants) + len(made.nodes) + len(INPUTS) + len(states) + len(texts.names)
    if used > MOST_REGISTERS:
        fault = f"needs {counted(used, 'numbers')}, those that it reads, names and computes"
        return None, (Mistake("expression", fault, f"the core has room for {MOST_REGISTERS}: shorten it"),)
    return made, ()


def _laid_out(graph: FormulaGraph, roots: Sequence[int], states: tuple[str, ...], texts: Texts) -> Program:
    """Registers in the order in which they are computed: first what the coefficient needs, then the rest."""
    leaves = (*INPUTS, *states, *texts.names)
    register: dict[int, int] = {i: leaves.index(node.name) for i, node in enumerate(graph.nodes) if node.name}
    needed = list[int]()
    ends = list[int]()
    for root in roots:
        _collect(graph, root, needed, set(needed))
        ends.append(len(needed))
    numbers = [i for i in needed if graph.nodes[i].operation == "constant"]
    steps = [i for i in needed if graph.nodes[i].of]
    register |= {i: len(leaves) + place for place, i in enumerate(numbers)}
    register |= {i: len(leaves) + len(numbers) + place for place, i in enumerate(steps)}
    nodes = tuple(graph.nodes[i]._replace(of=tuple(register[j] for j in graph.nodes[i].of)) for i in steps)
    until = [len([i for i in needed[:end] if graph.nodes[i].of]) for end in ends]
    return Program(
        texts.names,
        states,
        tuple(graph.nodes[i].value for i in numbers),
        nodes,
        tuple(graph.sources[i] for i in steps),
        register[roots[0]],
        register[roots[-1]] if texts.at_rest is not None else register[roots[0]],
        tuple(register[root] for root in roots[1 : 1 + len(states)]),
        until[0],
        until[len(states)],
        frozenset(graph.read),
    )


def _collect(graph: FormulaGraph, root: int, needed: list[int], seen: set[int]) -> None:
    """Collect the operands of a node before the node itself."""
    if root in seen:
        return
    for part in graph.nodes[root].of:
        _collect(graph, part, needed, seen)
    seen.add(root)
    if not graph.nodes[root].name:
        needed.append(root)
