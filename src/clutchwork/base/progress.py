"""How far something is: a bar of tqdm, in a notebook or a terminal, or a function of the user."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, TypeVar

from clutchwork.base.errors import UseError
from clutchwork.base.extras import need
from clutchwork.base.quote import quote

N = TypeVar("N", int, float)

# how far of how much, and the time that is left, in the unit that is counted
COUNTED = "{l_bar}{bar}| {n_fmt} of {total_fmt} {unit} [{elapsed}<{remaining}]"
MEASURED = "{l_bar}{bar}| {n:.4g} of {total:.4g} {unit} [{elapsed}<{remaining}]"


@contextmanager
def followed(
    progress: Any, total: N, call: str, asks: str, begin: float = 0, **looks: Any
) -> Iterator[Callable[[N], None] | None]:
    """Progress callback, or None.

    Parameters: progress, as the user gave it: True for a bar, or a function of (done, total); total, all that is to do;
    call and asks, for the message where it is neither; begin, where a bar counts from; looks, of the bar, as tqdm takes
    them.
    """
    if callable(progress):
        yield lambda done: progress(done, total)
    elif progress is True:
        with _tqdm()(total=total - begin, smoothing=0.0, **looks) as bar:
            yield lambda done: _set(bar, done - begin)
    elif progress is False or progress is None:
        yield None
    else:
        raise UseError(call, [f"progress is {quote(progress)}: give True, or a function of {asks}"])


def _set(bar: Any, done: float) -> None:
    bar.update(max(0, done - bar.n))


def _tqdm() -> Any:
    """The bar of the place where this runs; in a notebook without widgets that of a terminal."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return need("tqdm.auto", "notebook", "progress=True").tqdm
