"""Our dataclass makes what that of the standard library makes."""

from __future__ import annotations

import copy
import dataclasses
import inspect
import pickle
import weakref
from collections.abc import Callable
from dataclasses import FrozenInstanceError, asdict, astuple, field, fields, is_dataclass, replace
from typing import Any, ClassVar

import pytest

from clutchwork.base.classes import dataclass as ours

MAKERS: dict[str, Any] = {"ours": ours, "theirs": dataclasses.dataclass}


def classes(dataclass: Callable[..., Any]) -> dict[str, Any]:
    """Frozen, open, derived, with all that a field may say."""

    @dataclass(frozen=True)
    class Point:
        """A point."""

        names: ClassVar[tuple[str, ...]] = ("x", "y")
        x: float
        y: float = 0.0

        def size(self) -> float:
            return abs(self.x) + abs(self.y)

    @dataclass(frozen=True)
    class Marked(Point):
        """With more."""

        mark: str = field(default="", kw_only=True, repr=False)
        hidden: int = field(default=3, init=False, compare=False)
        many: tuple[int, ...] = field(default_factory=tuple)

    @dataclass(frozen=True, eq=False, repr=False)
    class Alone:
        """Equal to nothing else."""

        x: int

    @dataclass
    class Open:
        """May change."""

        x: int
        items: list[int] = field(default_factory=list)

    @dataclass(frozen=True, kw_only=True)
    class Named:
        """By keyword alone, checked."""

        low: float
        high: float = 1.0

        def __post_init__(self) -> None:
            if self.low > self.high:
                raise ValueError("low above high")

    @dataclass(frozen=True)
    class Own:
        """Words and equality of its own."""

        x: int

        def __repr__(self) -> str:
            return "own"

        def __eq__(self, other: object) -> bool:
            return True

        def __hash__(self) -> int:
            return 7

    return {cls.__name__: cls for cls in (Point, Marked, Alone, Open, Named, Own)}


MADE = {name: classes(maker) for name, maker in MAKERS.items()}
CALLS: list[tuple[str, tuple[Any, ...], dict[str, Any]]] = [
    ("Point", (1.0,), {}),
    ("Point", (1.0, 2.0), {}),
    ("Point", (), {"y": 2.0, "x": 1.0}),
    ("Marked", (1.0, 2.0, (3,)), {"mark": "m"}),
    ("Marked", (1.0,), {"many": (3, 4)}),
    ("Alone", (1,), {}),
    ("Open", (1,), {}),
    ("Open", (1, [2]), {}),
    ("Named", (), {"low": 0.5}),
    ("Own", (1,), {}),
]
WRONG: list[tuple[str, tuple[Any, ...], dict[str, Any]]] = [
    ("Point", (), {}),
    ("Point", (1.0, 2.0, 3.0), {}),
    ("Point", (1.0,), {"x": 2.0}),
    ("Point", (1.0,), {"z": 2.0}),
    ("Marked", (1.0,), {"hidden": 2}),
    ("Marked", (1.0, 2.0, (), "m"), {}),
    ("Named", (0.5,), {}),
    ("Named", (), {"high": 0.5}),
]


@pytest.mark.parametrize(("name", "args", "named"), CALLS)
def test_what_is_made_is_the_same(name: str, args: Any, named: Any) -> None:
    one, other = (MADE[maker][name](*args, **named) for maker in MAKERS)
    assert vars(one) == vars(other)
    if name != "Alone":
        assert repr(one) == repr(other)
        assert one == type(one)(*args, **named)
    assert (one == 3) is (other == 3)
    assert asdict(one) == asdict(other)
    assert astuple(one) == astuple(other)
    assert is_dataclass(one)
    changed = [{} if name == "Named" else {"x": 9}, *([{"mark": "n"}] if name == "Marked" else [])]
    for change in changed:
        assert vars(replace(one, **change)) == vars(replace(other, **change))
    assert vars(copy.deepcopy(one)) == vars(one)
    assert weakref.ref(one)() is one
    if name == "Open":
        with pytest.raises(TypeError, match="unhashable"):
            hash(one)
        one.x = 5
        assert one.items is not type(one)(1).items
    elif name != "Alone":
        assert hash(one) == hash(other)


@pytest.mark.parametrize(("name", "args", "named"), WRONG)
@pytest.mark.parametrize("maker", MAKERS)
def test_wrong_calls_are_refused(maker: str, name: str, args: Any, named: Any) -> None:
    with pytest.raises(TypeError, match=name if maker == "ours" else "argument"):
        MADE[maker][name](*args, **named)


@pytest.mark.parametrize("name", MADE["ours"])
def test_the_class_is_described_alike(name: str) -> None:
    one, other = (MADE[maker][name] for maker in MAKERS)
    assert str(inspect.signature(one)) == str(inspect.signature(other)).replace(" -> None", "") + " -> None"
    assert one.__match_args__ == other.__match_args__
    assert one.__dataclass_params__.frozen is other.__dataclass_params__.frozen
    told = ("name", "type", "default", "default_factory", "init", "repr", "compare", "kw_only")
    for mine, theirs in zip(fields(one), fields(other), strict=True):
        assert [getattr(mine, what) for what in told] == [getattr(theirs, what) for what in told]
    assert ("x" in vars(one)) is ("x" in vars(other))


@pytest.mark.parametrize("maker", MAKERS)
def test_frozen_is_frozen(maker: str) -> None:
    thing = MADE[maker]["Marked"](1.0)
    for change in (lambda: setattr(thing, "x", 2.0), lambda: delattr(thing, "x"), lambda: setattr(thing, "z", 2.0)):
        with pytest.raises(FrozenInstanceError):
            change()
    assert thing.x == 1.0

    class Derived(MADE[maker]["Point"]):  # type: ignore[misc]
        def __init__(self) -> None:
            super().__init__(1.0)
            self.more = 2

    derived = Derived()
    assert derived.more == 2
    with pytest.raises(FrozenInstanceError):
        derived.x = 2.0


@pytest.mark.parametrize("maker", MAKERS)
def test_checks_and_mutable_defaults(maker: str) -> None:
    with pytest.raises(ValueError, match="low above high"):
        MADE[maker]["Named"](low=2.0)
    with pytest.raises(ValueError, match="default_factory"):

        @MAKERS[maker]
        class Shared:
            """A list that all would share."""

            items: list[int] = []  # noqa: RUF012


def test_the_standard_library_may_derive_from_ours() -> None:
    @dataclasses.dataclass(frozen=True)
    class Further(MADE["ours"]["Point"]):  # type: ignore[misc]
        z: float = 5.0

    made = Further(1.0, z=6.0)
    assert asdict(made) == {"x": 1.0, "y": 0.0, "z": 6.0}
    assert made.size() == 1.0
    with pytest.raises(FrozenInstanceError):
        made.z = 7.0


@ours(frozen=True)
class Stored:
    """One that pickle finds."""

    x: float
    y: tuple[int, ...] = ()


def test_pickles_and_patterns() -> None:
    thing = Stored(1.0, (2,))
    assert pickle.loads(pickle.dumps(thing)) == thing
    match thing:
        case Stored(x, y):
            assert (x, y) == (1.0, (2,))


def test_a_class_that_holds_itself_can_be_shown() -> None:
    thing = MADE["ours"]["Open"](1)
    thing.items.append(thing)
    assert repr(thing).endswith("Open(x=1, items=[...])")
