"""Pages of models and of runs."""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from clutchwork.base import ModelWarning, UseError, quote
from clutchwork.base.paths import path_fault
from clutchwork.base.writing import put
from clutchwork.page.data import PageRequest, data_of
from clutchwork.page.html import html

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.declare.options import Options
    from clutchwork.run.trajectory import Trajectory

ENDINGS = (".html", ".htm")


def page_of(run: Trajectory, path: Any, drag: Any, sliders: Any, show: Any) -> Path:
    """What `run.page` does: write the page of a run; its path."""
    refuse("run.page", list(_path_problems(path)), drag=drag, sliders=sliders, show=show)
    return put(Path(path), page(run.system, run.t_end, run.options, wanted_of(drag, sliders, show)))


def page(system: System, t_end: float, options: Options, wanted: PageRequest) -> str:
    """The page of a System as HTML."""
    return html(quiet_data(system, t_end, options, wanted), system.name or "driveline")


def quiet_data(system: System, t_end: float, options: Options, wanted: PageRequest) -> dict[str, Any]:
    """Its data. Stops of sliders may be odd models; the page is that of a model that was looked at."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        return data_of(system, t_end, options, wanted)


def wanted_of(drag: Any, sliders: Any, show: Any) -> PageRequest:
    """The requested items, by name."""
    return PageRequest(_list(drag), _list(sliders), _list(show))


def refuse(call: str, problems: Sequence[str] = (), **lists: Any) -> None:
    """UseError for what was asked for wrongly, all at once."""
    found = [*problems, *_list_problems(lists)]
    if found:
        raise UseError(call, found)


def _list(given: Any) -> Sequence[str] | None:
    return None if given is None else [given] if isinstance(given, str) else list(given)


def _path_problems(path: Any) -> Iterator[str]:
    fault = path_fault(path, "shift.html")
    if fault:
        yield fault
    elif Path(path).suffix.lower() not in ENDINGS:
        yield f"{quote(str(path))} does not end in .html: a page is one file of HTML"


def _list_problems(lists: Mapping[str, Any]) -> Iterator[str]:
    for name, given in lists.items():
        words = [given] if isinstance(given, str) else given
        if words is not None and not (isinstance(words, list | tuple) and all(isinstance(word, str) for word in words)):
            yield f"{name} is {quote(given)}: give names, such as {name}=['F1.*']"
