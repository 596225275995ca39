"""The page of a run in a notebook: knots and sliders are traits that come back to Python."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from clutchwork.base.extras import need
from clutchwork.page.page import quiet_data, refuse, wanted_of
from clutchwork.page.static import CORE, FOLDER, STYLE, WIDGET, built
from clutchwork.page.traits import knots_of, values_of
from clutchwork.signals.table import Table

if TYPE_CHECKING:
    from clutchwork.run.trajectory import Trajectory


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
