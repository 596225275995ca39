"""How far a sweep is: a bar of tqdm, or a function."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from clutchwork.base.errors import UseError
from clutchwork.base.extras import need
from clutchwork.base.shown import shown

Shown = Callable[[int], None]


@contextmanager
def shown_by(progress: Any, total: int) -> Iterator[Shown]:
    """A function that takes how many variants are done."""
    if callable(progress):
        yield lambda done: progress(done, total)
    elif progress is True:
        with _tqdm()(total=total, unit=" runs", smoothing=0.0) as bar:
            yield lambda done: bar.update(max(0, done - bar.n))
    elif progress is False or progress is None:
        yield _silent
    else:
        raise UseError("sweep", [f"progress is {shown(progress)}: give True, or a function of (done, variants)"])


def _silent(done: int) -> None:
    """Nobody asked."""


def _tqdm() -> Any:
    return need("tqdm.auto", "notebook", "progress=True").tqdm
