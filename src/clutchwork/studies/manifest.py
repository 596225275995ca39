"""`study.json`: what a data set is of, so that nothing else is ever added to it."""

from __future__ import annotations

import json
import platform
from collections.abc import Iterator, Mapping
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import TYPE_CHECKING, Any

from clutchwork.assembly.system import System, SystemFormatError
from clutchwork.base import ClutchworkError, dataclass
from clutchwork.base.quote import shortened
from clutchwork.base.writing import put
from clutchwork.studies.fingerprints import of_model, of_output
from clutchwork.studies.parts import DataField

if TYPE_CHECKING:
    from clutchwork.sweeps.request import Order

FILE = "study.json"
MODEL = "model.cwsystem"
FORMAT = 1
# whose versions are kept
PACKAGES = ("clutchwork", "numpy", "scipy", "pyarrow")
MOST_SHOWN = 6


class StudyError(ClutchworkError, ValueError):
    """A folder that holds no study, or one of another model or design."""


@dataclass(frozen=True)
class Manifest:
    """What is kept of a study beside its data."""

    name: str
    asked: Mapping[str, Any]  # model, design, outputs, options: what must be the same to go on
    count: int  # variants
    chunk: int  # of them in each part
    columns: tuple[DataField, ...]
    varied: int  # columns of what varies
    versions: Mapping[str, str]
    begun: str  # date and time, UTC

    @property
    def sizes(self) -> dict[int, int]:
        """Variants of each part."""
        starts = range(0, self.count, self.chunk)
        return {number: min(self.chunk, self.count - first) for number, first in enumerate(starts)}

    def write(self, folder: Path) -> None:
        """Into its folder."""
        columns = [{"name": one.name, "type": one.type, "unit": one.unit} for one in self.columns]
        content = {"format": FORMAT, **vars(self), "columns": columns}
        put(folder / FILE, json.dumps(content, indent=1))

    @classmethod
    def read(cls, folder: Path) -> Manifest:
        """From its folder; StudyError where there is none."""
        path = folder / FILE
        try:
            content = json.loads(path.read_text(encoding="utf-8"))
            if content.pop("format") != FORMAT:
                raise StudyError(f"{path}: was written by another version; read it with that one")
            columns = tuple(DataField(**one) for one in content.pop("columns"))
            return cls(**content, columns=columns)
        except FileNotFoundError:
            raise StudyError(f"{folder} holds no study: {FILE} is missing; give the folder of one") from None
        except (OSError, ValueError, KeyError, TypeError) as error:
            if isinstance(error, StudyError):
                raise
            raise StudyError(f"{path}: cannot be read: {error}; begin again in another folder") from None


def asked_of(order: Order, fingerprint: str) -> dict[str, Any]:
    """What a study is of."""
    described = getattr(order.source, "described", {"method": "given", "count": len(order)})
    options = {name: _plain(value) for name, value in sorted(vars(order.options).items())}
    return {
        "model": {"fingerprint": of_model(order.system)},
        "design": {**described, "fingerprint": fingerprint},
        "outputs": {name: of_output(one) for name, one in order.outputs.items()},
        "options": {"t_end": order.t_end, **options},
    }


def _plain(value: Any) -> Any:
    return value if isinstance(value, str | int | float | None) else repr(value)


def versions() -> dict[str, str]:
    """Of what has a share in the numbers."""
    made = {"python": platform.python_version()}
    for name in PACKAGES:
        try:
            made[name] = version(name)
        except PackageNotFoundError:
            continue
    return made


def now() -> str:
    """Date and time."""
    return datetime.now(UTC).isoformat(timespec="seconds")


def refuse_other(folder: Path, was: Manifest, asked: Mapping[str, Any], model: Mapping[str, Any]) -> None:
    """StudyError with all that is not as it was when the study began.

    Parameters: model, the driveline as in a model file.
    """
    found = [
        *(f"model: {line}" for line in _model_changes(folder, was, asked, model)),
        *(line for part in ("design", "outputs", "options") for line in changes(was.asked[part], asked[part], part)),
    ]
    mine = versions().get("clutchwork", "")
    if was.versions.get("clutchwork", mine) != mine:
        found.append(f"clutchwork: {was.versions['clutchwork']} there, {mine} here")
    if found:
        head = f"{folder} holds another study, so nothing can be added to it:"
        remedy = "give another folder, or the definition that it was started with"
        raise StudyError("\n".join([head, *(f"  {line}" for line in found), remedy]))


def _model_changes(folder: Path, was: Manifest, asked: Mapping[str, Any], model: Mapping[str, Any]) -> list[str]:
    if was.asked["model"] == asked["model"]:
        return []
    try:
        before: Mapping[str, Any] = System.load(folder / MODEL).model
    except (SystemFormatError, ValueError):
        before = {}
    told = list(changes(before, model, "")) if before and model else []
    return told[:MOST_SHOWN] or ["its numbers have another fingerprint"]


def changes(was: Any, now: Any, path: str) -> Iterator[str]:
    """What differs between two trees of plain values."""
    if isinstance(was, Mapping) and isinstance(now, Mapping):
        for key in dict.fromkeys([*was, *now]):
            below = f"{path}.{key}" if path else str(key)
            if key == "fingerprint":
                continue
            if key not in was or key not in now:
                yield f"{below} is {'new' if key not in was else 'missing'}"
            else:
                yield from changes(was[key], now[key], below)
        if was.get("fingerprint") != now.get("fingerprint") and {**was, "fingerprint": 0} == {**now, "fingerprint": 0}:
            yield f"{path}: other values"
    elif isinstance(was, list | tuple) and isinstance(now, list | tuple) and len(was) == len(now):
        for number, (one, other) in enumerate(zip(was, now, strict=True)):
            yield from changes(one, other, _place(one, f"{path}[{number}]"))
    elif was != now:
        yield f"{path} was {shortened(repr(was), 60)} and is {shortened(repr(now), 60)}"


def _place(one: Any, path: str) -> str:
    """What has a name stands under it alone, as users know it."""
    return str(one["name"]) if isinstance(one, Mapping) and "name" in one else path
