"""Which values the variants of a study have: points in the unit cube, through a distribution of each name."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from clutchwork.base import UnknownName, UseError, columns, counted, dataclass, near, quote
from clutchwork.base.extras import need
from clutchwork.declare.calls import explained, explained_methods
from clutchwork.model.changes import targets_of
from clutchwork.model.model import Model
from clutchwork.studies.distributions import Discrete, Distribution, distribution
from clutchwork.studies.points import METHODS, Points
from clutchwork.sweeps.factors import Factors, multiplied
from clutchwork.sweeps.variants import Variants, Varied

# named as users do, to what it is called in a table
WAYS = ("latin", "sobol", "random", "saltelli")
# values of a table that are made at once
ROWS = 8192


@explained_methods("design")
@dataclass(frozen=True, eq=False)
class Design:
    """Values of many variants, drawn from distributions; what `sweep` and `study` take as `vary`.

    `design["c1.gain"]` is the column of a name, `design.to_pandas()` the table. The same seed gives the same values,
    and a part of them is drawn without the others.
    """

    given: Mapping[str, Any]  # distributions by name
    points: Points
    method: str
    seed: int
    base: int  # what was asked for as `count`
    units: Mapping[str, str]  # of SI, where the model is known
    numbers: Mapping[str, Mapping[str, float]] = field(default_factory=dict)  # that factors multiply

    def __len__(self) -> int:
        """Number of variants."""
        return self.points.count

    @property
    def names(self) -> tuple[str, ...]:
        """What varies."""
        return tuple(self.given)

    def part(self, first: int, last: int) -> Variants:
        """Variants from first to last, of numbers as they are given."""
        rows = self.points.rows(first, last)
        varied = [self._varied(name, how, share) for (name, how), share in zip(self.given.items(), rows.T, strict=True)]
        return Variants(tuple(varied), last - first, design=self)

    def _varied(self, name: str, how: Any, share: NDArray[np.float64]) -> Varied:
        unit = self.units.get(name, "")
        if isinstance(how, Factors):
            return replace(self._varied(name, how.how, share), numbers=self.numbers.get(name, {}))
        if isinstance(how, Discrete):
            return Varied(name, how.values, how.labels, how.codes(share), unit)
        drawn = np.asarray(how.quantile(share) if isinstance(how, Distribution) else how.ppf(share), dtype=float)
        # by their bits, for both zeros are numbers of their own; Saltelli's points share most of their values
        words, codes = np.unique(np.ascontiguousarray(drawn).view(np.uint64), return_inverse=True)
        values = tuple(words.view(float).tolist())
        return Varied(name, values, values, codes.astype(np.int64), unit)

    def in_si(self, model: Model) -> Design:
        """The same design in SI."""
        plain = {name: how for name, how in self.given.items() if not isinstance(how, Factors)}
        numbers = {name: multiplied(model, name) for name in self.given if name not in plain}
        unknown = {one.path: str(one) for one in targets_of(model, plain)[1]}
        made: dict[str, Any] = {**self.given}
        units, problems = dict.fromkeys(numbers, "1"), list[str]()
        for name, how in plain.items():

            def of(value: Any, name: str = name) -> Any:
                return _si(model, name, (value,)).values[0]

            found = _si(model, name, how.values if isinstance(how, Discrete) else (1.0,))
            units[name], made[name] = found.unit, how
            if isinstance(how, Discrete):
                labels = found.labels if how.labels == how.values else how.labels
                made[name] = replace(how, values=found.values, labels=labels)
            elif isinstance(how, Distribution) and how.unit:
                if isinstance(of(f"1 {how.unit}"), str):
                    unfit = f"{name}: {how} has a unit that does not fit; give it in [{found.unit or '1'}]"
                    problems.append(unknown.get(name, unfit))
                else:
                    made[name] = how.in_si(of)
        if problems:
            raise UseError("design", problems)
        return replace(self, given=made, units=units, numbers=numbers)

    def __getitem__(self, name: str) -> NDArray[Any]:
        """The values of a name, or their labels; KeyError with near names when there is none."""
        if name not in self.given:
            raise UnknownName(f"the design does not vary {quote(name)}{near(name, self.given)}")
        parts = [self.part(first, min(first + ROWS, len(self))) for first in range(0, len(self), ROWS)]
        place = self.names.index(name)
        return np.concatenate([part.varied[place].column for part in parts])

    def to_pandas(self) -> Any:
        """A pandas DataFrame with one line for each variant. Needs pandas."""
        return need("pandas", "tables", "a table").DataFrame({name: self[name] for name in self.names})

    @cached_property
    def described(self) -> dict[str, Any]:
        """What makes it the design that it is."""
        given = {name: _said(how) for name, how in self.given.items()}
        return {"method": self.method, "count": self.base, "seed": self.seed, "vary": given}

    def __repr__(self) -> str:
        return f"<Design of {counted(len(self), 'variants')}: {self.method}, seed {self.seed}; {', '.join(self.names)}>"

    def __str__(self) -> str:
        heads = ("name", "distribution", "unit")
        lines = [(name, _said(how), self.units.get(name, "")) for name, how in self.given.items()]
        return "\n".join([repr(self), "", columns([heads, *lines])])


@explained("cw.design", vary="{'c1.gain': cw.normal(5e-4, 2e-5)}", count="1000")
def design(
    vary: Mapping[str, Any], count: int, *, method: str = "latin", seed: int = 0, second_order: bool = False
) -> Design:
    """Draw the values of many variants from distributions, for `sweep` and `study`.

    Parameters: vary, for each name a distribution: `cw.uniform`, `cw.log_uniform`, `cw.normal`, `cw.truncated_normal`,
    `cw.lognormal`, `cw.triangular`, `cw.discrete`, a frozen one of scipy.stats, (low, high) for all values between
    them, or a list to choose from; count, how many; method, "latin" for a Latin hypercube, "sobol" for a Sobol
    sequence (best with a power of two), "random", or "saltelli" for `sobol_indices`; seed, another one gives other
    values; second_order, with "saltelli", also for pairs of names.

    With "saltelli" the design has (names + 2) variants for each of `count`, 2 names + 2 with `second_order`. Needs
    SciPy.
    """
    problems = list[str]()
    if not isinstance(vary, Mapping) or not vary or not all(isinstance(name, str) for name in vary):
        problems.append(f"vary is {quote(vary)}: give distributions by name, {{'c1.gain': cw.normal(5e-4, 2e-5)}}")
    for name, number in (("count", count), ("seed", seed)):
        if not isinstance(number, int | np.integer) or isinstance(number, bool) or number < (name == "count"):
            problems.append(f"{name} is {quote(number)}: give a whole number of at least {int(name == 'count')}")
    if method not in WAYS:
        problems.append(f"method is {quote(method)}{near(method, WAYS)}; known: {', '.join(WAYS)}")
    if second_order and method != "saltelli":
        problems.append("second_order goes with method='saltelli' alone; remove it")
    if problems:
        raise UseError("design", problems)
    given = {name: distribution("design", name, how) for name, how in vary.items()}
    way = "saltelli second order" if second_order else method
    return Design(given, METHODS[way](len(given), int(count), int(seed)), way, int(seed), int(count), {})


def _si(model: Model, name: str, values: tuple[Any, ...]) -> Varied:
    """Values of a name in SI where they fit."""
    varied = Varied(name, values, values, np.arange(len(values), dtype=np.int64))
    return Variants((varied,), len(values)).in_si(model).varied[0]


def _said(how: Any) -> str:
    """A distribution in words; of scipy.stats its name and numbers."""
    if isinstance(how, Factors):
        return f"times {_said(how.how)}"
    if isinstance(how, Distribution | Discrete):
        return str(how)
    numbers = [f"{number:g}" for number in getattr(how, "args", ())]
    numbers += [f"{name}={number:g}" for name, number in getattr(how, "kwds", {}).items()]
    return f"{getattr(getattr(how, 'dist', how), 'name', type(how).__name__)}({', '.join(numbers)})"
