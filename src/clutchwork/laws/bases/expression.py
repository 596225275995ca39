"""Expressions of friction laws, read into operations on numbers: docs/theory/friction-laws.md.

Arithmetic, comparisons and the functions below, nothing else: the text is parsed as Python, and never run as such.
"""

from __future__ import annotations

import ast
import re
import warnings
from collections.abc import Callable, Collection, Sequence
from math import inf
from typing import NamedTuple

from clutchwork.base import near, quote
from clutchwork.base.quote import shortened

# what an expression may read beside the numbers that it names: the inputs of the law in their order
SLIP, TEMPERATURE, PRESSURE = "v", "temperature", "pressure"
INPUTS = (SLIP, TEMPERATURE, PRESSURE)
# functions by their name, with the number of their arguments
FUNCTIONS = {
    **dict.fromkeys(("exp", "log", "sqrt", "tanh", "atan", "sin", "cos", "abs", "sign"), 1),
    **dict.fromkeys(("min", "max", "pow"), 2),
    "where": 3,
}
LONGEST = 2000  # characters
LARGEST_POWER = 8  # whole powers up to here are products

ARITHMETIC: dict[type, tuple[str, str]] = {
    ast.Add: ("add", "+"),
    ast.Sub: ("subtract", "-"),
    ast.Mult: ("multiply", "*"),
    ast.Div: ("divide", "/"),
    ast.Pow: ("power", "**"),
}
# all ask which is less: whether the sides are exchanged, and the answer turned round
COMPARISONS: dict[type, tuple[bool, bool]] = {
    ast.Lt: (False, False),
    ast.LtE: (True, True),
    ast.Gt: (True, False),
    ast.GtE: (False, True),
}
PLAIN = {"exp": "exp", "log": "log", "sqrt": "root", "tanh": "tanh", "atan": "atan", "sin": "sin", "cos": "cos"}
PAIRS = {"min": "smaller", "max": "larger"}


class FormulaNode(NamedTuple):
    """One number of a graph: an operation on others, a name, or a constant."""

    operation: str  # "constant", "name", or one of program.OPERATIONS
    of: tuple[int, ...] = ()
    value: float = 0.0
    name: str = ""


class Mistake(NamedTuple):
    """What is wrong in an expression: where, what, and what to do about it."""

    field: str  # "expression", "at_rest", "rates.z"
    message: str
    remedy: str = ""


class Source(NamedTuple):
    """Where a node was first read."""

    field: str
    place: int  # number of its first character, from 1 on
    words: str

    def __str__(self) -> str:
        return f"{quote(self.words)} at character {self.place}"


class FormulaGraph:
    """The operations of all expressions, each once: common subexpressions are computed once."""

    def __init__(self, names: Collection[str], forward: bool) -> None:
        self.names = names  # that may be read
        self.forward = forward  # the slip has the direction of sliding: never below zero
        self.nodes: list[FormulaNode] = []
        self.sources: list[Source] = []
        self.truths: set[int] = set()
        self.read: set[str] = set()
        self._known: dict[FormulaNode, int] = {}
        self._moving: list[bool] = []

    def add(self, node: FormulaNode, source: Source) -> int:
        """The number of a node, the same for the same one."""
        if node not in self._known:
            self._known[node] = len(self.nodes)
            self.nodes.append(node)
            self.sources.append(source)
            self._moving.append(node.name == SLIP or any(self._moving[i] for i in node.of))
        return self._known[node]

    def constant(self, value: float, source: Source) -> int:
        """A number as it is written."""
        return self.add(FormulaNode("constant", value=float(value)), source)

    def operation(self, name: str, of: Sequence[int], source: Source) -> int:
        """An operation; sums, differences and products of constants are constants, to the same bits."""
        parts = [self.nodes[i] for i in of]
        if name in FOLDED and all(part.operation == "constant" for part in parts):
            return self.constant(FOLDED[name](*(part.value for part in parts)), source)
        return self._fused(name, list(of), parts, source)

    def _fused(self, name: str, of: list[int], parts: Sequence[FormulaNode], source: Source) -> int:
        """An operation fused with another one if the core has that, to the same bits."""
        last = parts[-1]
        if name in ("multiply", "divide") and "negate" in (parts[0].operation, last.operation):
            # the sign of a product or quotient is put behind it
            place = int(parts[0].operation != "negate")
            of[place] = parts[place].of[0]
            return self.operation("negate", [self.operation(name, of, source)], source)
        if name in ("add", "subtract") and last.operation == "negate":
            return self.operation("subtract" if name == "add" else "add", [of[0], last.of[0]], source)
        if name == "add" and parts[0].operation in JOINED and last.operation not in JOINED:
            of, last = of[::-1], parts[0]
        if name in ("add", "subtract") and last.operation in JOINED:
            return self.add(FormulaNode(f"{name}_{JOINED[last.operation]}", (of[0], *last.of)), source)
        if name in ("exp", "exp_behind") and parts[0].operation == "negate":
            square = self.nodes[parts[0].of[0]]
            root = self.nodes[square.of[0]] if square.operation == "multiply" and len({*square.of}) == 1 else None
            if root is not None and root.operation == "divide":
                return self.add(FormulaNode("bell", root.of), source)
            return self.add(FormulaNode(name.replace("exp", "fade"), (parts[0].of[0], *of[1:])), source)
        return self.add(FormulaNode(name, tuple(of)), source)

    def moves_with_slip(self, i: int) -> bool:
        """Whether a number follows from the slip."""
        return self._moving[i]

    def size(self, i: int, source: Source) -> int:
        """The absolute value; for a slip in the direction of sliding it is smooth across zero, as the core requires."""
        node = self.nodes[i]
        if self.forward and node.name == SLIP:
            return i
        if self.forward and node.operation == "negate":
            return self.size(node.of[0], source)
        if self.forward and node.operation in ("multiply", "divide") and self.moves_with_slip(i):
            return self.operation(node.operation, [self.size(part, source) for part in node.of], source)
        return self.operation("size", [i], source)

    def power(self, base: int, exponent: int, source: Source) -> int:
        """A power: whole ones are products, which hold for negative numbers too."""
        node = self.nodes[exponent]
        if node.operation != "constant":
            return self.operation("power", [base, exponent], source)
        if node.value == 0.5:
            return self.operation("root", [base], source)
        count = abs(node.value)
        if not count.is_integer() or count > LARGEST_POWER:
            return self.operation("power", [base, exponent], source)
        made = self._product(base, int(count), source)
        one = self.constant(1.0, source)
        return made if node.value >= 0.0 else self.operation("divide", [one, made], source)

    def _product(self, base: int, count: int, source: Source) -> int:
        if count == 0:
            return self.constant(1.0, source)
        if count == 1:
            return base
        half = self._product(base, count // 2, source)
        square = self.operation("multiply", [half, half], source)
        return self.operation("multiply", [square, base], source) if count % 2 else square


# what a sum or a difference takes in
JOINED = {"multiply": "product", "divide": "quotient"}
FOLDED: dict[str, Callable[..., float]] = {
    "add": lambda a, b: a + b,
    "subtract": lambda a, b: a - b,
    "multiply": lambda a, b: a * b,
    "negate": lambda a: -a,
}


class Reader:
    """Reads the expression of one field into a graph; every mistake is collected."""

    def __init__(self, graph: FormulaGraph, field: str, unread: Collection[str] = ()) -> None:
        self.graph = graph
        self.field = field
        self.unread = unread  # names that have no meaning here
        self.text = ""
        self.begin = 0
        self.mistakes: list[Mistake] = []

    def root(self, text: object) -> int | None:
        """The number of the whole expression; None where there are mistakes."""
        if isinstance(text, int | float) and not isinstance(text, bool):
            text = repr(float(text))
        if not isinstance(text, str) or not text.strip():
            self.mistakes.append(Mistake(self.field, "must be an expression", 'write one as a string: "0.3 + 0.1*v"'))
            return None
        try:
            tree = self._parsed(text)
            found = None if tree is None else self._number(tree.body)
        except RecursionError:
            self._mistake("is too deep to be read", "write it with fewer operations")
        return None if self.mistakes else found

    def _parsed(self, text: str) -> ast.Expression | None:
        if len(text) > LONGEST:
            self.mistakes.append(Mistake(self.field, f"has {len(text)} characters", f"write at most {LONGEST}"))
            return None
        foreign = next((sign for sign in text if not sign.isascii() or sign in "\0#"), "")
        if foreign:
            place = text.index(foreign) + 1
            self._mistake(f"has {quote(foreign)} at character {place}", "use plain letters, digits and signs")
            return None
        # it may have any number of lines, and begin anywhere
        self.text = re.sub(r"\s", " ", text)
        self.begin = len(text) - len(text.lstrip())
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                return ast.parse(self.text.strip(), mode="eval")
        except SyntaxError as error:
            place = min(max(error.offset or 1, 1) + self.begin, len(text))
            remedy = "write an expression such as mu_k + (mu_s - mu_k)*exp(-v/v_s)"
            self._mistake(f"cannot be read at character {place}", remedy)
        except (MemoryError, ValueError):
            self._mistake("is too deep to be read", "write it with fewer operations")
        return None

    def _mistake(self, message: str, remedy: str = "") -> int:
        self.mistakes.append(Mistake(self.field, message, remedy))
        return self.graph.constant(1.0, Source(self.field, 1, ""))

    def source(self, tree: ast.expr) -> Source:
        """Where something was read."""
        first, last = self.begin + tree.col_offset, self.begin + (tree.end_col_offset or 0)
        return Source(self.field, first + 1, shortened(self.text[first:last], 40))

    def _number(self, tree: ast.expr) -> int:
        """A number, which a comparison is not."""
        found = self._any(tree)
        if found in self.graph.truths:
            return self._mistake(f"takes the comparison {self.source(tree)} as a number", "write where(a < b, x, y)")
        return found

    def _truth(self, tree: ast.expr) -> int:
        found = self._any(tree)
        if found not in self.graph.truths and not self.mistakes:
            return self._mistake(f"asks whether {self.source(tree)}, which is a number", "compare it: v < v_s")
        return found

    def _any(self, tree: ast.expr) -> int:
        reader = getattr(self, f"_read_{type(tree).__name__.lower()}", None)
        if reader is None:
            remedy = f"use + - * / ** < <= > >= and or not, if else, and {', '.join(FUNCTIONS)}"
            return self._mistake(f"has {self.source(tree)}, which has no meaning in a formula", remedy)
        found: int = reader(tree)
        return found

    def _read_constant(self, tree: ast.Constant) -> int:
        if type(tree.value) not in (int, float):
            return self._mistake(f"has {self.source(tree)}, which is not a number", "write a number or a name")
        try:
            number = float(tree.value)  # type: ignore[arg-type]
        except OverflowError:
            number = inf
        if number == inf:
            return self._mistake(f"has {self.source(tree)}, beyond all numbers", "write a smaller one")
        return self.graph.constant(number, self.source(tree))

    def _read_name(self, tree: ast.Name) -> int:
        name, source = tree.id, self.source(tree)
        if name in self.unread:
            return self._mistake(f"reads {source}, which has no meaning at rest", f"write it without {name}")
        if name not in self.graph.names:
            # a short name is not a misspelt input of one letter
            meant = near(name, [known for known in self.graph.names if len(known) > 1])
            remedy = f"{'or ' if meant else ''}give it a value: {name}=0.3; known names: {', '.join(self.graph.names)}"
            return self._mistake(f"has the unknown name {source}{meant}", remedy)
        self.graph.read.add(name)
        return self.graph.add(FormulaNode("name", name=name), source)

    def _read_unaryop(self, tree: ast.UnaryOp) -> int:
        source = self.source(tree)
        if isinstance(tree.op, ast.Not):
            return self._not(self._truth(tree.operand), source)
        if isinstance(tree.op, ast.Invert):
            return self._mistake(f"has {source}, which has no meaning in a formula", "write not, or -")
        operand = self._number(tree.operand)
        return operand if isinstance(tree.op, ast.UAdd) else self.graph.operation("negate", [operand], source)

    def _read_binop(self, tree: ast.BinOp) -> int:
        source = self.source(tree)
        if type(tree.op) not in ARITHMETIC:
            remedy = "a power is written **" if isinstance(tree.op, ast.BitXor) else "use + - * / **"
            return self._mistake(f"has {source}, whose operator has no meaning in a formula", remedy)
        left, right = self._number(tree.left), self._number(tree.right)
        name = ARITHMETIC[type(tree.op)][0]
        if name == "power":
            return self.graph.power(left, right, source)
        return self.graph.operation(name, [left, right], source)

    def _read_ifexp(self, tree: ast.IfExp) -> int:
        return self._picked(tree.test, tree.body, tree.orelse, self.source(tree))

    def _picked(self, test: ast.expr, yes: ast.expr, no: ast.expr, source: Source) -> int:
        return self.graph.operation("pick", [self._truth(test), self._number(yes), self._number(no)], source)

    def _read_compare(self, tree: ast.Compare) -> int:
        source, left, found = self.source(tree), self._number(tree.left), list[int]()
        for sign, side in zip(tree.ops, tree.comparators, strict=True):
            right = self._number(side)
            if type(sign) not in COMPARISONS:
                return self._mistake(f"has {source}, whose operator has no meaning in a formula", "use < <= > >=")
            swapped, turned = COMPARISONS[type(sign)]
            less = self._asked("less", [right, left] if swapped else [left, right], source)
            found.append(self._not(less, source) if turned else less)
            left = right
        return self._all(found, "smaller", source)

    def _read_boolop(self, tree: ast.BoolOp) -> int:
        name = "smaller" if isinstance(tree.op, ast.And) else "larger"
        return self._all([self._truth(part) for part in tree.values], name, self.source(tree))

    def _all(self, found: Sequence[int], name: str, source: Source) -> int:
        made = found[0]
        for other in found[1:]:
            made = self._asked(name, [made, other], source)
        return made

    def _not(self, truth: int, source: Source) -> int:
        zero, one = self.graph.constant(0.0, source), self.graph.constant(1.0, source)
        return self._asked("pick", [truth, zero, one], source)

    def _asked(self, name: str, of: Sequence[int], source: Source) -> int:
        """A truth: 1 or 0."""
        found = self.graph.operation(name, of, source)
        self.graph.truths.add(found)
        return found

    def _read_call(self, tree: ast.Call) -> int:
        source = self.source(tree)
        name = tree.func.id if isinstance(tree.func, ast.Name) else ""
        if name not in FUNCTIONS:
            meant = near(name, FUNCTIONS) if name else ""
            remedy = "" if meant else f"known functions: {', '.join(FUNCTIONS)}"
            return self._mistake(f"has the unknown function {source}{meant}", remedy)
        wanted, given = FUNCTIONS[name], len(tree.args)
        several = name in PAIRS and given > 2
        if tree.keywords or any(isinstance(one, ast.Starred) for one in tree.args) or not (several or given == wanted):
            plural = "" if wanted == 1 else "s"
            return self._mistake(f"gives {source} {given} arguments", f"{name} takes {wanted} number{plural}")
        if name == "where":
            return self._picked(tree.args[0], tree.args[1], tree.args[2], source)
        parts = [self._number(one) for one in tree.args]
        if name in PAIRS:
            made = parts[0]
            for other in parts[1:]:
                made = self.graph.operation(PAIRS[name], [made, other], source)
            return made
        if name == "pow":
            return self.graph.power(parts[0], parts[1], source)
        return self._function(name, parts[0], source)

    def _function(self, name: str, of: int, source: Source) -> int:
        graph = self.graph
        if name == "abs":
            return graph.size(of, source)
        if name == "sign":
            forward = graph.forward and graph.nodes[of].name == SLIP
            return graph.constant(1.0, source) if forward else graph.operation("sign", [of], source)
        if name == "exp" and graph.forward and graph.moves_with_slip(of):
            # what a trial step meets far behind the zero of the slip stays finite
            slip = graph.add(FormulaNode("name", name=SLIP), source)
            return graph.operation("exp_behind", [of, slip], source)
        return graph.operation(PLAIN[name], [of], source)
