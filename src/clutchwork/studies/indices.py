"""Sobol indices: which share of the variance of an output comes from which value that varies."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from clutchwork.base import UseError, columns, dataclass, html, quote
from clutchwork.base.arrays import Array
from clutchwork.base.extras import need
from clutchwork.declare.calls import explained, explained_methods
from clutchwork.studies.picture import indices
from clutchwork.studies.points import Saltelli
from clutchwork.studies.result import Study
from clutchwork.sweeps.result import Sweep

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# resampled sets of points that an interval is from
RESAMPLED = 100
HEADS = ("name", "first order", "+-", "total", "+-")


@explained_methods("sobol_indices")
@dataclass(frozen=True, eq=False)
class SobolIndices:
    """Sobol indices of one output, by name of what varies.

    `first` is the share of the variance that a value has alone, `total` the one with all its interactions; `second`
    that of pairs, where the design was made for them. `first_interval` and the others are half widths of intervals
    that hold the index with the probability `level`.
    """

    output: str
    names: tuple[str, ...]
    first: Array
    total: Array
    first_interval: Array
    total_interval: Array
    second: Array | None  # above its diagonal
    second_interval: Array | None
    variance: float
    level: float
    points: int  # base points

    def to_pandas(self) -> Any:
        """A pandas DataFrame with a line for each name. Needs pandas."""
        content = {
            "first": self.first,
            "first_interval": self.first_interval,
            "total": self.total,
            "total_interval": self.total_interval,
        }
        return need("pandas", "tables", "a table").DataFrame(content, index=list(self.names))

    def __repr__(self) -> str:
        return f"<Sobol indices of {self.output} from {self.points} points; {', '.join(self.names)}>"

    def __str__(self) -> str:
        table = columns([HEADS, *self._lines()], right=range(1, len(HEADS)))
        return "\n".join([self._head(), "", table, *self._pairs()])

    def _repr_html_(self) -> str:
        table = html.table(HEADS, self._lines(), right=range(1, len(HEADS)))
        return html.page(html.heading(self._head()), table, *map(html.paragraph, self._pairs()))

    def _head(self) -> str:
        return f"Sobol indices of {self.output}, from {self.points} points, intervals of {100 * self.level:g} %"

    def _lines(self) -> list[tuple[str, ...]]:
        """The largest total first."""
        order = np.argsort(-self.total, kind="stable")
        numbers = (self.first, self.first_interval, self.total, self.total_interval)
        return [(self.names[place], *(f"{column[place]:.4f}" for column in numbers)) for place in order.tolist()]

    def _pairs(self) -> list[str]:
        """Pairs that are more than their interval."""
        if self.second is None or self.second_interval is None:
            return []
        found = []
        for one, other in zip(*np.triu_indices(len(self.names), 1), strict=True):
            index, width = self.second[one, other], self.second_interval[one, other]
            if index > width:
                found.append(f"{self.names[one]} with {self.names[other]}: {index:.4f} +- {width:.4f}")
        return ["", *found] if found else []

    @explained("sobol_indices.plot", path="'indices.png'")
    def plot(self, path: str | Path | None = None) -> Figure:
        """Bars with their intervals, written to `path` when given. Needs matplotlib."""
        totals, firsts = (self.total, self.total_interval), (self.first, self.first_interval)
        return indices(self.output, self.names, totals, firsts, path)


@explained("cw.sobol_indices", found="study", output="'lock(c1)'")
def sobol_indices(
    found: Study | Sweep, output: str, *, missing: float | None = None, level: float = 0.95, seed: int = 0
) -> SobolIndices:
    """Sobol indices of an output over a design with the method "saltelli", with their intervals.

    Parameters: found, a study or a sweep; output, its name; missing, what stands for a value that is not there, such as
    the end time for a clutch that never locks; level, probability of the intervals; seed, of their resampling.

    UseError where the design is another, or values are missing. Needs SALib.
    """
    if not isinstance(found, Study | Sweep):
        raise UseError("sobol_indices", [f"{quote(found)} is neither a study nor a sweep; give what cw.study returns"])
    names, base, second = _design(found)
    values = _complete(output, found[output], base * _step(len(names), second), missing)
    made = _analysed(names, values, second, level, seed)
    return SobolIndices(
        output=output,
        names=names,
        first=np.asarray(made["S1"]),
        total=np.asarray(made["ST"]),
        first_interval=np.asarray(made["S1_conf"]),
        total_interval=np.asarray(made["ST_conf"]),
        second=np.asarray(made["S2"]) if second else None,
        second_interval=np.asarray(made["S2_conf"]) if second else None,
        variance=float(values.var()),
        level=level,
        points=base,
    )


def _design(found: Study | Sweep) -> tuple[tuple[str, ...], int, bool]:
    """Names that vary, base points, and whether it is for pairs."""
    if isinstance(found, Study):
        told = found.manifest.asked["design"]
        method, base, names = told["method"], told["count"], tuple(told.get("vary", ()))
    else:
        made = found.swept.variants.design
        whole = made is not None and len(made) == len(found)
        method, base, names = (made.method, made.base, made.names) if whole else ("given", 0, ())
    if not method.startswith("saltelli"):
        remedy = "draw it with cw.design(..., method='saltelli')"
        raise UseError("sobol_indices", [f"the design has the method {method!r}, which gives no indices; {remedy}"])
    return names, base, method != "saltelli"


def _step(names: int, second: bool) -> int:
    return Saltelli(names, 1, 0, second).step


def _complete(output: str, values: NDArray[Any], count: int, missing: float | None) -> Array:
    """A number for every variant."""
    problems = []
    if values.dtype.kind not in "fiub":
        problems.append(f"{output} holds words; take an output of numbers")
    elif len(values) != count:
        problems.append(f"{len(values)} of {count} variants are there; let the study go on first")
    else:
        values = values.astype(float)
        lacking = int(np.sum(~np.isfinite(values)))
        if lacking and missing is None:
            remedy = "say with missing=... what counts there, such as the end time for a clutch that never locks"
            problems.append(f"{output} has no value in {lacking} of {count} variants; {remedy}")
        elif missing is not None:
            values = np.where(np.isfinite(values), values, missing)
        if not problems and not values.var() > 0.0:
            problems.append(f"{output} is the same in all variants, so there is no variance to apportion")
    if problems:
        raise UseError("sobol_indices", problems)
    return values


def _analysed(names: tuple[str, ...], values: Array, second: bool, level: float, seed: int) -> Any:
    """The indices by SALib."""
    analyze = need("SALib.analyze.sobol", "study", "Sobol indices").analyze
    problem = {"num_vars": len(names), "names": list(names), "bounds": [[0.0, 1.0]] * len(names)}
    with warnings.catch_warnings():
        # of pandas and numpy, inside of it
        warnings.simplefilter("ignore")
        return analyze(
            problem,
            values,
            calc_second_order=second,
            num_resamples=RESAMPLED,
            conf_level=level,
            print_to_console=False,
            # it takes 0 for none
            seed=seed + 1,
        )
