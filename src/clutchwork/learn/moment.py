"""What a reward is a function of: one step of an environment."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from clutchwork.base import dataclass

if TYPE_CHECKING:
    from clutchwork.results.events import Event


@dataclass(frozen=True)
class Moment:
    """One step of an environment, just done.

    `now["engine.speed"]` and `before["engine.speed"]` are signals at its end and at its begin: all that the model has.
    `action` is what was set, in SI by name; `events` are those of this step; `failure` says why the run cannot go on,
    "" where it can: `now` is then the same as `before`.
    """

    time: float  # s, its end
    period: float  # s
    action: Mapping[str, float]  # what was set, by name
    before: Mapping[str, Any]
    now: Mapping[str, Any]
    events: tuple[Event, ...]  # of this step
    failure: str = ""  # why the run cannot go on, "" where it can
