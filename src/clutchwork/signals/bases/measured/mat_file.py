"""MAT of version 5 and 7.3: vectors, also inside of structures, beside the vector of their times."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from clutchwork.base import dataclass
from clutchwork.base.extras import need
from clutchwork.signals.bases.measured.other_units import own_unit
from clutchwork.signals.bases.measured.series import CLOCKS, Array, Clock, Series, numbers

# fields whose name says nothing of what is measured
BODIES = ("values", "value", "data", "samples", "y")
UNITS = ("unit", "units", "Unit", "Units")
DEEPEST = 12


@dataclass(frozen=True)
class Leaf:
    """A vector: its name, its siblings in the same structure, and the enclosing structures."""

    path: tuple[str, ...]
    values: Array
    around: tuple[Mapping[str, Any], ...]  # innermost first
    label: str = ""


@contextmanager
def opened(path: Path) -> Iterator[list[Series]]:
    """The vectors of a file."""
    leaves = list(_leaves(_tree(path), (), (), ""))
    yield [_series(leaf) for leaf in leaves]


def _tree(path: Path) -> dict[str, Any]:
    """All variables, structures as dictionaries."""
    scipy = need("scipy.io", "exchange", "a MAT file")
    try:
        found: dict[str, Any] = scipy.loadmat(str(path), simplify_cells=True)
    except NotImplementedError:
        h5py = need("h5py", "exchange", "a MAT file of version 7.3")
        with h5py.File(str(path), "r") as file:
            return {name: _of_hdf(h5py, item, DEEPEST) for name, item in file.items() if not name.startswith("#")}
    return {name: value for name, value in found.items() if not name.startswith("__")}


def _of_hdf(h5py: Any, item: Any, depth: int) -> Any:
    """A variable of version 7.3, which is HDF5: a group is a structure."""
    if isinstance(item, h5py.Group):
        return {name: _of_hdf(h5py, inner, depth - 1) for name, inner in item.items()} if depth else None
    if "MATLAB_empty" in item.attrs or item.dtype.kind not in "iufb":
        return None
    values = np.squeeze(item[()])
    if item.attrs.get("MATLAB_class") == b"char":
        return "".join(map(chr, np.atleast_1d(values).ravel().tolist())) if values.ndim < 2 else None
    return values


def _leaves(tree: Any, path: tuple[str, ...], around: tuple[Mapping[str, Any], ...], label: str) -> Iterator[Leaf]:
    if len(path) > DEEPEST:
        return
    if isinstance(tree, Mapping):
        told = tree.get("label", "")
        for name, value in tree.items():
            yield from _leaves(value, (*path, str(name)), (tree, *around), told if isinstance(told, str) else "")
    elif isinstance(tree, list) or (isinstance(tree, np.ndarray) and tree.dtype.kind == "O"):
        # an array of structures, counted as in MATLAB
        for number, value in enumerate(tree, 1):
            if isinstance(value, Mapping):
                yield from _leaves(value, (*path[:-1], f"{path[-1]}({number})"), around, "")
    elif isinstance(tree, np.ndarray) and tree.ndim == 1 and tree.dtype.kind in "iufbU":
        yield Leaf(path, tree, around, label)


def _series(leaf: Leaf) -> Series:
    name = ".".join(leaf.path)
    aliases = dict.fromkeys([leaf.label, *_aliases(leaf)])
    return Series(
        name,
        own_unit(_unit(leaf)),
        len(leaf.values),
        partial(numbers, leaf.values),
        partial(_clock, leaf),
        aliases=tuple(alias for alias in aliases if alias and alias != name),
        is_text=leaf.values.dtype.kind == "U",
    )


def _aliases(leaf: Leaf) -> Iterator[str]:
    last = leaf.path[-1]
    yield last
    names = leaf.around[0].get("names") if leaf.around else None
    if isinstance(names, Mapping) and isinstance(names.get(last), str):
        yield names[last]
    if last in BODIES:
        inner = [part for part in leaf.path[:-1] if not part.startswith("signals")]
        yield ".".join(inner)
        yield inner[-1] if inner else ""


def _unit(leaf: Leaf) -> str:
    """Its siblings: a table of units, or for a structure of one signal its unit."""
    last = leaf.path[-1]
    for tree in leaf.around[:1]:
        for key in UNITS:
            told = tree.get(key)
            if isinstance(told, Mapping) and isinstance(told.get(last), str):
                return str(told[last])
            if isinstance(told, str) and last in BODIES:
                return told
    return ""


def _clock(leaf: Leaf, wanted: str) -> Clock | None:
    """The times of a vector: in its own structure, else in those around it."""
    for tree in leaf.around:
        vectors = {str(name): value for name, value in tree.items() if _fits(value, leaf)}
        found = [name for name in vectors if name == wanted]
        if not found and wanted == CLOCKS[0]:
            found = [name for name in vectors if name.lower() in CLOCKS]
        if len(found) == 1:
            return Clock(found[0], _clock_unit(tree, found[0]), numbers(vectors[found[0]]))
    return None


def _fits(value: Any, leaf: Leaf) -> bool:
    is_vector = isinstance(value, np.ndarray) and value.ndim == 1 and value.dtype.kind in "iufb"
    return is_vector and len(value) == len(leaf.values)


def _clock_unit(tree: Mapping[str, Any], name: str) -> str:
    tables: list[Mapping[str, Any]] = [tree[key] for key in UNITS if isinstance(tree.get(key), Mapping)]
    told = tables[0].get(name, "") if tables else ""
    return own_unit(told) if isinstance(told, str) else ""
