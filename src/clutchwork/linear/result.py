"""The linear system that `cw.linearise` gives."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from clutchwork.base import UseError, columns, counted, html, quote
from clutchwork.base.paths import fitting
from clutchwork.declare.calls import explained, explained_methods
from clutchwork.declare.quantity import QuantityError, has_unit, in_si
from clutchwork.linear.handover import to_control, to_dict, to_scipy
from clutchwork.linear.quantity import Quantity, amount, per_second
from clutchwork.linear.system import LinearSystem
from clutchwork.plot.chosen import PICTURES
from clutchwork.plot.figure import figure_of
from clutchwork.plot.style import COLOURS

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from clutchwork.linear.modes import NaturalMode

Array = NDArray[Any]

MOST_SHOWN = 20
STABLE, GROWING = COLOURS[0], COLOURS[1]
PANEL = 24.0  # mm
LEAST_HEIGHT = 62.0  # mm
MOST_MODES, MOST_SHAFTS = 6, 24


@explained_methods("lin")
class Linear(LinearSystem):
    """A linear system about one instant: d/dt x = rate + A x + B u, y = C x + D u.

    x, u and y are what states, inputs and outputs deviate from their values at the instant: `state`, `input`, `output`.
    `rate` is the rate of the states there; it is zero in steady motion.
    """

    @explained("frequency_response")
    def frequency_response(self, frequencies: Any) -> Array:
        """Response of every output to every input at frequencies [Hz, or with a unit].

        A complex array (frequencies, outputs, inputs), in units of the output per unit of the input. UseError where a
        frequency is that of an undamped mode, at which there is no finite response.
        """
        try:
            asked = np.atleast_1d(np.asarray(_in_hertz(frequencies), dtype=float))
        except QuantityError as error:
            raise UseError("frequency_response", [f"frequencies: {error}"]) from None
        except (TypeError, ValueError):
            asked = np.full(1, np.nan)
        if asked.ndim != 1 or not np.isfinite(asked).all():
            given = f"frequencies = {quote(frequencies)}: must be finite numbers in Hz"
            raise UseError("frequency_response", [given])
        made = np.empty((len(asked), *self.D.shape), dtype=complex)
        for place, frequency in enumerate(asked):
            matrix = 2j * np.pi * frequency * np.eye(len(self.A)) - self.A
            try:
                made[place] = self.C @ np.linalg.solve(matrix, self.B) + self.D
            except np.linalg.LinAlgError:
                fault = f"{frequency:g} Hz is the frequency of an undamped mode; ask beside it"
                raise UseError("frequency_response", [fault]) from None
        return made

    def to_control(self) -> Any:
        """The system for python-control, with names; dots in them become underscores, which that package asks for."""
        return to_control(self)

    def to_scipy(self) -> Any:
        """The system as a `scipy.signal.StateSpace`."""
        return to_scipy(self)

    @explained("plot")
    def plot(self, path: str | Path | None = None) -> Figure:
        """Picture of the eigenvalues and of the shapes of the modes; written to `path` when given. Needs matplotlib."""
        return picture(self, path)

    def to_dict(self) -> dict[str, Any]:
        """All of it as plain data, as `clutchwork linearise --json` prints it."""
        return to_dict(self)

    def __str__(self) -> str:
        sizes = (
            counted(len(part), name) for part, name in zip(self._parts, ("states", "inputs", "outputs"), strict=True)
        )
        head = f"{self.model} at {self.time:g} s: {', '.join(sizes)}"
        words = {"locked": [], "slipping forward": [], "slipping backward": [], "open": []}  # type: dict[str, list[str]]
        for name, how in self.contacts.items():
            words[f"slipping {how}" if how in ("forward", "backward") else how].append(name)
        contacts = [f"{how}: {', '.join(names)}" for how, names in words.items() if names]
        lines = [head, *(["; ".join(contacts)] if contacts else []), "", self._table(), "", str(self.modes)]
        return "\n".join([*lines, *(["", *self.notes] if self.notes else [])])

    def __repr__(self) -> str:
        sizes = (
            counted(len(part), name) for part, name in zip(self._parts, ("states", "inputs", "outputs"), strict=True)
        )
        return f"<Linear {quote(self.model)} at {self.time:g} s: {', '.join(sizes)}>"

    @property
    def _parts(self) -> Sequence[Sequence[Quantity]]:
        return self.state_quantities, self.input_quantities, self.output_quantities

    def _repr_html_(self) -> str:
        """States, inputs and outputs, modes and notes for a notebook."""
        head, *lines = self._lines()
        return html.page(
            html.heading(repr(self)[1:-1]),
            html.table(head, lines, right=(2, 3), most=len(lines)),
            self.modes._repr_html_(),
            *map(html.paragraph, self.notes),
        )

    def _table(self) -> str:
        return columns(self._lines(), right=(2, 3))

    def _lines(self) -> list[tuple[str, str, str, str]]:
        """Lines of the table of states, inputs and outputs, the head first."""
        lines = [("", "", "value", "rate of change")]
        for word, part in zip(("state", "input", "output"), self._parts, strict=True):
            for place, quantity in enumerate(part[:MOST_SHOWN]):
                rate = (
                    f"{quantity.rate:.4g} {per_second(quantity.unit)}"
                    if word == "state" and abs(quantity.rate) > 0.0
                    else ""
                )
                lines.append((word if place == 0 else "", quantity.name, amount(quantity.value, quantity.unit), rate))
            if len(part) > MOST_SHOWN:
                lines.append(("", f"and {len(part) - MOST_SHOWN} more", "", ""))
        return lines


def _in_hertz(frequencies: Any) -> Any:
    """Frequencies with units as numbers in Hz, all else as it is; QuantityError for a unit that does not fit."""
    if isinstance(frequencies, list | tuple):
        return [in_si(one, "Hz") for one in frequencies]
    return in_si(frequencies, "Hz") if has_unit(frequencies) else frequencies


def picture(lin: LinearSystem, path: str | Path | None = None) -> Figure:
    """Eigenvalues on the left, shapes of the slowest oscillating modes on the right; written to `path` when given."""
    shapes = [mode for mode in lin.modes.swinging if mode.shape][:MOST_MODES]
    shapes = shapes or [mode for mode in lin.modes if mode.shape][:MOST_MODES]
    with figure_of(max(LEAST_HEIGHT, 14.0 + PANEL * len(shapes)), formulas=False) as figure:
        rows = max(1, len(shapes))
        grid = figure.add_gridspec(rows, 2, width_ratios=[0.8, 1.2])
        _eigenvalues(figure.add_subplot(grid[:, 0]), lin)
        first: Axes | None = None
        for place, mode in enumerate(shapes):
            axes = figure.add_subplot(grid[place, 1], sharex=first)
            first = first or axes
            _shape(axes, mode, last=place == rows - 1)
        if path is not None:
            figure.savefig(fitting("plot", path, "modes.png", PICTURES))
    return figure


def _eigenvalues(axes: Axes, lin: LinearSystem) -> None:
    """Real parts over frequencies; what is right of the line grows."""
    values = lin.eigenvalues
    colours = [GROWING if value.real > 0.0 else STABLE for value in values]
    axes.axvline(0.0, color="#9A9A9A", linewidth=0.8, zorder=1)
    axes.scatter(values.real, values.imag / (2.0 * np.pi), marker="x", c=colours, s=28, linewidths=1.3, zorder=3)
    axes.set_xlabel("real part [1/s]")
    axes.set_ylabel("frequency [Hz]")
    axes.set_title("eigenvalues", loc="left")
    reach = max(float(np.abs(values.imag).max(initial=0.0)) / (2.0 * np.pi), 1e-3)
    axes.set_ylim(-1.15 * reach, 1.15 * reach)
    # a mode that is far faster than the others would press all of them onto the line
    swinging = np.abs(values.real[np.abs(values.imag) > 0.0])
    slow = values.real if not swinging.size else values.real[np.abs(values.real) <= 20.0 * swinging.max() + 1.0]
    least, most = float(slow.min(initial=0.0)), float(slow.max(initial=0.0))
    margin = 0.12 * max(most - least, 0.1)
    axes.set_xlim(least - margin, most + margin)
    hidden = len(values) - len(slow)
    if hidden:
        axes.set_title(f"eigenvalues ({hidden} faster, left out)", loc="left")


def _shape(axes: Axes, mode: NaturalMode, *, last: bool) -> None:
    """Amplitude of each shaft as a bar, below zero where it moves against the one that moves most."""
    names = list(mode.shape)[:MOST_SHAFTS]
    values = np.array([mode.shape[name] for name in names])
    signed = np.abs(values) * np.where(values.real < 0.0, -1.0, 1.0)
    axes.bar(np.arange(len(names)), signed, width=0.6, color=GROWING if mode.eigenvalue.real > 0.0 else STABLE)
    axes.axhline(0.0, color="#404040", linewidth=0.6)
    axes.set_ylim(-1.15, 1.15)
    axes.grid(visible=False, axis="x")
    words = f"{mode.frequency:.3g} Hz, damping {100.0 * mode.damping:.2g} %"
    axes.set_title(words if mode.frequency > 0.0 else f"{mode.kind}, {mode.time_constant:.3g} s", loc="left")
    axes.set_xticks(np.arange(len(names)), names if last else [""] * len(names))
    if last and max(map(len, names)) * len(names) > 60:
        axes.tick_params(axis="x", rotation=60)
    elif not last:
        axes.tick_params(axis="x", labelbottom=False)
