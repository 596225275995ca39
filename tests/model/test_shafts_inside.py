"""Composites with shafts inside: names, results, starts, files, changes, pictures."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, ClassVar

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.declare.node import Domain, Node
from clutchwork.declare.schema import Role, component
from clutchwork.schematic.diagram import diagram


def _model(segments=4, **start: float) -> tuple[cw.Driveline, Any]:
    d = cw.Driveline("shaft")
    a = d.shaft("a", inertia=0.2, speed=start.get("a", 30.0))
    b = d.shaft("b", inertia=0.1, speed=start.get("b", 10.0))
    flex = d.add(cw.FlexibleShaft("flex", base=a, follower=b, stiffness=500.0, inertia=0.04, segments=segments))
    return d, flex


def test_shafts_inside_have_names_and_results_and_start_between_the_ends():
    d, flex = _model()
    assert flex.part("node_2") == Node("flex.node_2", Domain.ROTATION, 0.01)
    assert d.check() == []
    run = d.simulate(0.01)
    starts = [run[f"flex.node_{k}.speed"][0] for k in range(1, 6)]
    assert starts == pytest.approx([30.0, 25.0, 20.0, 15.0, 10.0])
    system = d.assemble()
    assert [node.name for node in system.nodes] == ["a", "b", *(f"flex.node_{k}" for k in range(1, 6))]


def test_ends_may_follow_from_others():
    # the speed of b comes through a gear, so that of the shafts inside does too
    d = cw.Driveline("behind a gear")
    a, b, c = d.shaft("a", inertia=0.2), d.shaft("b"), d.shaft("c", inertia=1.0, speed=8.0)
    d.add(cw.FlexibleShaft("flex", base=a, follower=b, stiffness=500.0, inertia=0.04, segments=2))
    d.add(cw.Gear("g", input=b, output=c, ratio=2.0))
    run = d.simulate(1e-3)
    assert run["flex.node_2.speed"][0] == pytest.approx(8.0)
    assert run["b.speed"][0] == pytest.approx(16.0)


def test_something_may_be_attached_inside(tmp_path):
    d, flex = _model()
    inside = flex.part("node_3")
    d.add(cw.Damper("bearing", base=d.housing, follower=inside, damping=0.5))
    d.add(cw.SpringDamper("twice", base=flex.part("node_3"), follower=d.elements[0].part("node_4"), stiffness=10.0))
    assert d.check() == []
    run = d.simulate(0.1)
    assert run["bearing.rate"] == pytest.approx(run["flex.node_3.speed"])
    assert abs(run.energy.residual) <= 1e-6 * run.energy.turnover
    d.save(tmp_path / "model.toml")
    again = cw.Driveline.load(tmp_path / "model.toml").simulate(0.1)
    assert np.array_equal(again["flex.node_3.speed"], run["flex.node_3.speed"])
    things = {thing.name: thing for thing in diagram(d._model).things}
    assert things["bearing"].pins["follower"] is things["flex.node_3"] is things["flex"].pins["node_3"]
    assert "flex.node_2" not in things
    d.draw(run=run, at=0.05)


def test_changes_reach_the_parts():
    d, _ = _model()
    changed = d.assemble().changed({"flex.inertia": 0.08})
    assert [node.inertia for node in changed.nodes[2:]] == pytest.approx([0.01, 0.02, 0.02, 0.02, 0.01])
    with pytest.raises(cw.ModelError, match="makes 3 speeds independent, where 5 were"):
        d.assemble().changed({"flex.segments": 2})
    d, _ = _model(2)
    d.add(cw.Damper("bearing", base=d.housing, follower=d.elements[0].part("node_2"), damping=0.5))
    other, _ = _model(2)
    other.add(cw.Damper("bearing", base=d.housing, follower=other.elements[0].part("node_2"), damping=0.25))
    changed = d.assemble().changed({"bearing.damping": 0.25})
    assert np.array_equal(cw.simulate(changed, 0.05)["b.speed"], other.simulate(0.05)["b.speed"])
    found = cw.sweep(d, 0.01, vary={"flex.inertia": [0.02, 0.04]}, outputs="b.speed")
    assert found["b.speed"][1] == pytest.approx(d.simulate(0.01)["b.speed"][-1])
    assert abs(found["b.speed"][0] - found["b.speed"][1]) > 1e-3


def test_mistakes_are_named():
    d, _ = _model()
    d.shaft("flex.node_2", inertia=1.0)
    (problem,) = d.check()
    assert str(problem).startswith("shaft \"flex.node_2\": name = 'flex.node_2': is already the name of")
    d, _ = _model()
    d.add(cw.Damper("x", base=d.housing, follower=Node("flex.node_9"), damping=1.0))
    (problem,) = d.check()
    assert "belongs to another driveline" in str(problem)
    d, flex = _model()
    inside = flex.part("node_2")
    d._model.elements[0] = cw.FlexibleShaft("flex", base=flex.base, follower=flex.follower, stiffness=500.0)
    d.add(cw.Damper("x", base=d.housing, follower=inside, damping=1.0))
    (problem,) = d.check()
    assert "inertia is missing" in str(problem)
    d, flex = _model()
    d.add(cw.Spring("x", base=flex.part("node_2"), follower=flex.part("node_2"), stiffness=1.0))
    (problem,) = d.check()
    assert "both attached to 'flex.node_2'" in str(problem)


class Lump(cw.Gear):
    """A wheel that a port drives by a ratio, with a brake at it; massless wheels follow from the ratio."""

    role: ClassVar[Role] = Role.COMPOSITE
    kind: ClassVar[str] = "lump"

    def parts(self) -> Iterator[Any]:
        wheel, light = Node(f"{self.name}.wheel", Domain.ROTATION, 0.3), Node(f"{self.name}.light")
        yield from (wheel, light)
        yield cw.Gear(f"{self.name}.first", input=self.input, output=light, ratio=2.0)
        yield cw.Gear(f"{self.name}.second", input=light, output=Node(f"{self.name}.wheel"), ratio=0.5)
        yield cw.Damper(f"{self.name}.drag", base=self.output, follower=wheel, damping=0.1)


def test_gears_and_shafts_without_inertia_inside():
    assert component is not None
    d = cw.Driveline("lump")
    a, b = d.shaft("a", inertia=0.2, speed=5.0), d.shaft("b", inertia=0.5)
    d.add(Lump("lump", input=a, output=b, ratio=1.0))
    assert d.check() == []
    run = d.simulate(5.0, rtol=1e-9)
    assert run["lump.wheel.speed"] == pytest.approx(run["a.speed"])
    assert run["lump.light.speed"] == pytest.approx(run["a.speed"] / 2.0)
    # momentum of all three
    assert run["a.speed"][-1] == pytest.approx(5.0 * 0.5 / 1.0, rel=0.2)
    assert abs(run.energy.residual) <= 1e-8 * run.energy.turnover
