"""The page of a run in a notebook: knots and sliders are traits that come back to Python."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from math import isfinite
from numbers import Real
from typing import Any

from clutchwork.base import UseError, near, quote
from clutchwork.base.extras import need
from clutchwork.page.page import quiet_data, refuse, wanted_of
from clutchwork.page.static import CORE, FOLDER, STYLE, WIDGET, built
from clutchwork.run.trajectory import Trajectory
from clutchwork.signals.table import Table

Data = Sequence[Mapping[str, Any]]


def widget_of(run: Trajectory, drag: Any, sliders: Any, show: Any) -> Any:
    """What `run.widget` does: the widget of a run."""
    refuse("run.widget", drag=drag, sliders=sliders, show=show)
    return _made(run, quiet_data(run.system, run.t_end, run.options, wanted_of(drag, sliders, show)))


def _made(run: Trajectory, data: dict[str, Any]) -> Any:
    anywidget, traitlets = need("anywidget", "notebook", "run.widget"), need("traitlets", "notebook", "run.widget")
    built(WIDGET)
    turned, tables = data["sliders"], data["tables"]
    knots = {one["name"]: one["points"] for one in tables}
    values = {one["name"]: one["start"] for one in turned}

    class DrivelineWidget(anywidget.AnyWidget):  # type: ignore[misc, name-defined]
        """A driveline that is run in the notebook: `knots` and `values` are what its reader changed."""

        _esm = FOLDER / WIDGET
        page = traitlets.Unicode().tag(sync=True)
        # not `style`, which notebooks take for a model of ipywidgets
        css = traitlets.Unicode().tag(sync=True)
        core = traitlets.Bytes().tag(sync=True)
        knots = traitlets.Dict().tag(sync=True)  # signal -> [[time, value], ...], SI
        values = traitlets.Dict().tag(sync=True)  # number -> value, SI

        # what is not given stays

        @traitlets.validate("knots")  # type: ignore[untyped-decorator, unused-ignore]
        def _knots(self, proposal: Any) -> Any:
            return {**knots, **self.knots, **knots_of(proposal["value"], tables)}

        @traitlets.validate("values")  # type: ignore[untyped-decorator, unused-ignore]
        def _turned(self, proposal: Any) -> Any:
            return {**values, **self.values, **values_of(proposal["value"], turned)}

        @property
        def system(self) -> Any:
            """The driveline as it is now."""
            drawn = {name: Table([tuple(knot) for knot in points]) for name, points in self.knots.items()}
            numbers = dict(pair for one in turned for pair in _values(one, self.values[one["name"]]))
            return run.system.changed({**drawn, **numbers})

    return DrivelineWidget(
        page=json.dumps(data, allow_nan=False, default=list),
        css=built(STYLE).decode(),
        core=built(CORE),
        knots=knots,
        values=values,
    )


def _values(slider: dict[str, Any], value: float) -> list[tuple[str, float]]:
    """Numbers that a slider gives a value; those of one that was not turned keep their own."""
    return [(name, value) for name in slider["names"]] if value != slider["start"] else []


def values_of(given: Mapping[str, Any], sliders: Data) -> dict[str, float]:
    """Values by name, each at the stop nearest to it where its slider has stops, as on the page; UseError."""
    known = {one["name"]: one for one in sliders}
    problems = list(
        _problems(given, known, "slider", lambda name, value: _value_fault(name, value, known[name]["unit"]))
    )
    if problems:
        raise UseError("widget.values", problems)
    return {name: _stop(known[name], float(value)) for name, value in given.items()}


def knots_of(given: Mapping[str, Any], tables: Data) -> dict[str, list[list[float]]]:
    """Knots by name; UseError for unknown names, and for values that knots cannot have."""
    known = {one["name"]: one for one in tables}
    problems = list(_problems(given, known, "table", _knots_fault))
    if problems:
        raise UseError("widget.knots", problems)
    return {name: [[float(time), float(value)] for time, value in knots] for name, knots in given.items()}


def _problems(
    given: Mapping[str, Any], known: Mapping[str, Any], what: str, fault: Callable[[str, Any], str]
) -> Iterator[str]:
    for name, value in given.items():
        if name not in known:
            there = f"there are {', '.join(map(repr, known))}" if known else f"it has no {what}s"
            yield f"{quote(name)} is no {what} of this widget{near(name, known, there)}"
        elif wrong := fault(name, value):
            yield wrong


def _value_fault(name: str, value: Any, unit: str) -> str:
    return "" if _is_number(value) else f"{name} is {quote(value)}, not a finite number in {unit or '1'}"


def _knots_fault(name: str, knots: Any) -> str:
    if isinstance(knots, list | tuple) and knots and all(map(_is_knot, knots)):
        return ""
    return f"{name} is {quote(knots)}; give knots, such as [[0.0, 0.0], [0.5, 2e5]], times in s and values in SI"


def _is_knot(knot: Any) -> bool:
    return isinstance(knot, list | tuple) and len(knot) == 2 and all(map(_is_number, knot))


def _is_number(value: Any) -> bool:
    return isinstance(value, Real) and not isinstance(value, bool) and isfinite(value)


def _stop(slider: Mapping[str, Any], value: float) -> float:
    """The value that a slider takes: of two stops as near as each other the lower one."""
    if slider["direct"] or value == slider["start"]:
        return value
    return float(min(slider["values"], key=lambda stop: abs(stop - value)))
