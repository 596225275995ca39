"""Words of a System as functions of its numbers: the bytes of assembling them, and their derivatives."""

from __future__ import annotations

from collections.abc import Iterator
from typing import ClassVar

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.assembly.changes import quick
from clutchwork.assembly.masses import masses
from clutchwork.base.errors import ModelError
from clutchwork.declare.schema import Role
from clutchwork.gradients.assembled import Assembled, made, words_of
from clutchwork.gradients.finite_differences import Bent, slope
from clutchwork.gradients.parameters import changes, parameters
from clutchwork.gradients.words import Words
from clutchwork.model.changes import changed_model
from support import free_numbers, random_drivelines, random_parts, random_stops, six_speed

SEEDS = range(12)


def model(seed):
    kinds = (random_parts.driveline, random_stops.driveline, lambda s: random_drivelines.describe(s).driveline())
    return kinds[seed % 3](seed).assemble()


def assembled(system, chosen, x):
    """The System with values, or what is wrong with them."""
    try:
        return made(system, chosen, x), ""
    except ModelError as error:
        return None, str(error)


@pytest.mark.parametrize("seed", SEEDS)
def test_words_are_those_of_assembling(seed):
    system, rng = model(seed), np.random.default_rng(seed)
    chosen = free_numbers.some(system, rng, 15)
    words, seen = Words(system, chosen), 0
    for share in (0.0, 1e-3, 1e-2, 0.1):
        x = free_numbers.beside(chosen, rng, share)
        exact, wrong = assembled(system, chosen, x)
        if exact is None:
            with pytest.raises(ModelError) as caught:
                words.at(x)
            assert str(caught.value) == wrong
            continue
        assert words.bytes_at(x) == exact.to_bytes()
        seen += 1
    assert seen > 0


def with_masses(system, chosen, x):
    """The System with other inertias without assembling it; None where more follows from them."""
    values = changes(system, chosen, x)
    return system.changed(values) if quick(system, values) else None


def anew(system, chosen, x):
    """The same by assembling the whole driveline."""
    model = changed_model(system.source, changes(system, chosen, x))
    return cw.System.of(model, system.wanted)


@pytest.mark.parametrize("seed", SEEDS)
def test_words_with_other_inertias_are_those_of_assembling(seed):
    system, rng = model(seed), np.random.default_rng(seed)
    chosen = [one for one in free_numbers.free(system) if one.field.endswith((".inertia", ".mass"))]
    groups = [chosen, *([one] for one in chosen)]
    found = 0
    # far enough that other speeds become independent
    for share in (1e-3, 0.3, 3.0):
        for group in groups:
            x = free_numbers.start(group) * (1.0 + share * rng.random(len(group)))
            changed = with_masses(system, group, x)
            assert changed is None or changed.to_bytes() == anew(system, group, x).to_bytes()
            found += changed is not None
    # most changes leave the independent speeds as they are
    assert found > len(groups) if masses(system) else found == 0


def test_inertias_of_most_drivelines_change_the_mass_matrix_alone():
    known = [seed for seed in SEEDS if masses(model(seed))]
    # the weights of vehicles follow from their masses
    assert len(known) >= len(SEEDS) - 2


class Tuned(cw.Damper):
    """A damper that follows from the ratio of two inertias."""

    role: ClassVar[Role] = Role.COMPOSITE
    kind: ClassVar[str] = "tuned"

    def parts(self) -> Iterator[cw.Damper]:
        ratio = self.base.inertia / self.follower.inertia
        yield cw.Damper(self.name, base=self.base, follower=self.follower, damping=self.damping * ratio)


def test_what_follows_from_a_ratio_of_inertias_is_assembled():
    d = cw.Driveline("tuned")
    a, b = d.shaft("a", inertia=0.3, speed=1.0), d.shaft("b", inertia=0.8)
    d.add(Tuned("t", base=a, follower=b, damping=0.5))
    system = d.assemble()
    chosen = parameters(system, ["a.inertia"])
    assert with_masses(system, chosen, np.array([0.4])) is None


def test_a_gearbox_with_other_inertias_is_not_assembled():
    system = six_speed.gearbox(six_speed.SHIFT).assemble()
    chosen = parameters(system, [f"{name}.inertia" for name in six_speed.INERTIA])
    x = free_numbers.start(chosen) * 1.01
    found = with_masses(system, chosen, x)
    assert found is not None
    assert found.to_bytes() == anew(system, chosen, x).to_bytes()
    # another order of inertias may make other speeds independent
    assert with_masses(system, chosen, x[::-1].copy()) is None


def test_the_weight_of_a_vehicle_follows_its_mass():
    d = cw.Driveline("car")
    wheel, car = d.shaft("wheel", inertia=1.0), d.mass("body", mass=1200.0)
    d.add(cw.RollingWheel("tyre", shaft=wheel, mass=car, radius=0.3))
    d.add(cw.Vehicle("car", mass=car))
    system = d.assemble()
    chosen = parameters(system, ["body.mass"])
    x = np.array([1300.0])
    assert with_masses(system, chosen, x) is None
    assert Words(system, chosen).bytes_at(x) == made(system, chosen, x).to_bytes()


def differences(system, chosen, x, number, width):
    """The derivative of all words by two plain differences, where the structure stays."""
    found = []
    for step in (-width, width):
        moved = x.copy()
        moved[number] += step
        found.append(words_of(made(system, chosen, moved)))
    return (found[1] - found[0]) / (2 * width)


@pytest.mark.parametrize("seed", SEEDS)
def test_derivatives_of_words_are_those_of_differences(seed):
    system, rng = model(seed), np.random.default_rng(100 + seed)
    chosen = free_numbers.some(system, rng, 12)
    compared = 0
    try:
        Words(system, chosen).slopes_at(free_numbers.start(chosen))
    except cw.NoGradient as none:
        # such as the start of a sine at 0, before which there is another piece
        chosen = tuple(one for one in chosen if not any(text.startswith(one.name) for text in none.problems))
    x = free_numbers.start(chosen)
    found = Words(system, chosen).slopes_at(x)
    base = np.where(np.isfinite(words_of(system)), words_of(system), 0.0)
    for number, one in enumerate(chosen):
        width = 1e-5 * min(one.scale, one.reach)
        try:
            other = differences(system, chosen, x, number, width)
        except (ModelError, ValueError):
            # at a bound, or where there are more words beside
            continue
        whole = np.zeros(len(base))
        whole[found.places] = found.matrix[:, number]
        size = np.maximum(np.abs(base) / one.scale, np.abs(whole))
        other = np.where(np.isfinite(other), other, 0.0)
        # structure that changes beside, such as other independent speeds, is compared elsewhere
        if np.array_equal(whole != 0.0, np.abs(other) > 1e-9 * size):
            np.testing.assert_array_less(np.abs(whole - other), 1e-7 * size + 1e-300)
            compared += 1
    assert compared > 0


def test_an_ordinate_in_an_optimiser_costs_a_fraction_of_a_run():
    d = cw.Driveline("launch")
    engine, load = d.shaft("engine", inertia=0.2, speed=100.0), d.shaft("load", inertia=0.8)
    p = cw.Table([(number / 30, 1e5 * number / 30) for number in range(31)])
    lining = cw.Coulomb(static=0.125, kinetic=0.1)
    d.add(cw.Clutch("c1", base=engine, follower=load, friction=lining, gain=5e-4, pressure=p))
    system = d.assemble()
    chosen = parameters(system, "c1.pressure.values")
    words, x = Words(system, chosen), free_numbers.start(chosen)
    chart, _ = words.at(x)
    assert not chart.bound
    # no System is assembled: all points have the chart of the first
    for number in range(1, 100):
        there, _ = words.at(x * (1 + 1e-3 * number))
        assert there is chart


def test_other_structures_have_charts_of_their_own():
    system = six_speed.gearbox(six_speed.SHIFT).assemble()
    chosen = parameters(system, ["w6.inertia", "w1.inertia", "w7.inertia"])
    words = Words(system, chosen)
    for x in ([27.31, 19.37, 4.2], [0.01, 19.37, 4.2], [27.31, 0.001, 40.0]):
        x = np.array(x)
        assert words.bytes_at(x) == made(system, chosen, x).to_bytes()
        assert np.all(np.isfinite(words.slopes_at(x).matrix))


def test_knots_of_jumps_move_together():
    d = cw.Driveline("step")
    a = d.shaft("a", inertia=1.0)
    d.add(cw.Torque("t", shaft=a, torque=cw.Table([(0.0, 0.0), (0.5, 0.0), (0.5, 10.0), (1.0, 20.0)])))
    system = d.assemble()
    chosen = parameters(system, "t.torque.times")
    assert [one.name for one in chosen] == ["t.torque.times[1]", "t.torque.times[2]", "t.torque.times[4]"]
    words = Words(system, chosen)
    x = np.array([0.0, 0.6, 1.0])
    assert words.bytes_at(x) == made(system, chosen, x).to_bytes()
    found = words.slopes_at(x)
    # the start of the last two pieces and the slope of one
    assert np.count_nonzero(found.matrix[:, 1]) == 2


def test_a_number_at_a_kink_of_the_assembly_is_refused():
    d = cw.Driveline("band")
    a = d.shaft("a", inertia=1.0, speed=1.0)
    law = cw.Karnopp(static=0.1, kinetic=0.1, speed=1.0, band=1e-3)
    d.add(cw.Brake("b", shaft=a, friction=law, gain=1.0, normal_force=1.0, tolerance=1e-3))
    system = d.assemble()
    words = Words(system, parameters(system, ["b.friction.band", "b.tolerance"]))
    with pytest.raises(cw.NoGradient) as caught:
        words.slopes_at(np.array([1e-3, 1e-3]))
    assert len(caught.value.problems) == 2
    assert "b.tolerance = 0.001" in str(caught.value)
    # beside the kink one of both counts
    assert words.slopes_at(np.array([1e-3, 2e-3])).matrix[0] == pytest.approx([0.0, 1.0], abs=1e-12)


def test_a_number_that_comes_to_a_kink_at_zero_is_refused_there():
    d = cw.Driveline("step")
    a = d.shaft("a", inertia=1.0)
    d.add(cw.Torque("t", shaft=a, torque=cw.Step(height=10.0, start=0.5)))
    system = d.assemble()
    words = Words(system, parameters(system, "t.torque.start"))
    assert np.count_nonzero(words.slopes_at(np.array([0.5])).matrix) == 1
    # before 0 the step is there from the beginning
    with pytest.raises(cw.NoGradient, match="kink"):
        words.slopes_at(np.array([0.0]))


def test_a_product_of_which_one_factor_is_zero_depends_on_both():
    """The torque of a spring at the start is its stiffness times its twist, which is zero at first."""
    d = cw.Driveline("spring")
    a, b = d.shaft("a", inertia=1.0), d.shaft("b", inertia=2.0)
    d.add(cw.SpringDamper("k", base=a, follower=b, stiffness=50.0, damping=1.0))
    system = d.assemble()
    chosen = parameters(system, ["k.stiffness", "k.initial_twist"])
    words, x = Words(system, chosen), np.array([60.0, 0.1])
    words.at(free_numbers.start(chosen))
    found = words.slopes_at(x)
    torque = np.flatnonzero(words_of(made(system, chosen, x)) == 6.0)
    assert len(torque) == 1
    np.testing.assert_allclose(found.of(torque), [[0.1, 60.0]], rtol=1e-11)
    assert words.bytes_at(x) == made(system, chosen, x).to_bytes()


def test_derivatives_by_inertias_are_those_of_differences_of_exact_sums():
    """Shares of the mass matrix; differences of eighth order leave 1e-13 of them."""
    system = six_speed.gearbox(six_speed.SHIFT).assemble()
    chosen = parameters(system, [f"{name}.inertia" for name in six_speed.INERTIA])
    words, x = Words(system, chosen), free_numbers.start(chosen)
    chart, _ = words.at(x)
    assert not chart.bound
    whole = Assembled(system, chart.assembled.structure, chosen, x, tuple(range(len(x)))).slopes(x)
    found = words.slopes_at(x)
    np.testing.assert_allclose(found.matrix, whole[found.places], rtol=1e-12, atol=1e-12)
    assert not whole[np.setdiff1d(np.arange(len(whole)), found.places)].any()


def same_as_assembled(d: cw.Driveline, by: list[str], x: list[float]) -> None:
    """What an optimiser gets that has been elsewhere is what the driveline says there: words, or its refusal."""
    system = d.assemble()
    numbers = parameters(system, by)
    words, there = Words(system, numbers), np.array(x)
    words.at(np.array([one.start for one in numbers]))
    try:
        expected = made(system, numbers, there).to_bytes()
    except cw.ModelError:
        with pytest.raises(cw.ModelError):
            words.at(there)
        return
    assert words.bytes_at(there) == expected


def geared(ratio: float) -> cw.Driveline:
    """Two shafts that a gear joins, beside a fast one."""
    d = cw.Driveline("geared")
    a, b = d.shaft("a", inertia=1.0, speed=0.1), d.shaft("b", inertia=0.5)
    d.shaft("c", inertia=1.0, speed=1000.0)
    d.add(cw.Gear("g", input=a, output=b, ratio=ratio))
    d.add(cw.Damper("d", base=d.housing, follower=b, damping=0.1))
    return d


@pytest.mark.parametrize("x", [[0.4, 9.0], [0.01, 0.1], [1.1, -0.1]])
def test_inertias_that_make_another_shaft_independent(x: list[float]) -> None:
    d = geared(3.0)
    same_as_assembled(d, ["a.inertia", "a.speed"], x)
    # the Jacobian at a point that is reached from another one is that of the point
    f = cw.differentiable(d, 1.0, of="b.speed", by=["a.inertia", "a.speed"])
    f.value_and_jacobian(np.array([1.0, 0.1]))
    value, jacobian = f.value_and_jacobian(np.array(x))
    fresh = cw.differentiable(d.assemble().changed({"a.inertia": x[0], "a.speed": x[1]}), 1.0, of="b.speed", by=f.by)
    assert value == pytest.approx(fresh.value_and_jacobian(np.array(x))[0], rel=1e-9)
    assert jacobian == pytest.approx(fresh.value_and_jacobian(np.array(x))[1], rel=1e-6)


def test_a_speed_that_another_one_contradicts() -> None:
    d = cw.Driveline("two")
    a, b = d.shaft("a", inertia=1.0, speed=0.1), d.shaft("b", inertia=1.0, speed=0.1)
    d.shaft("c", inertia=1.0, speed=1000.0)
    d.add(cw.Gear("g", input=a, output=b, ratio=1.0))
    same_as_assembled(d, ["a.speed"], [0.5])


@pytest.mark.parametrize("x", [[0.25, 0.2, 0.2], [0.15, 0.2, 0.2], [0.05, 0.02, 0.01]])
def test_a_number_and_points_of_one_law(x: list[float]) -> None:
    d = cw.Driveline("braked")
    a = d.shaft("a", inertia=1.0, speed=10.0)
    law = cw.CoefficientTable(static=0.3, kinetic=[(0.0, 0.1), (10.0, 0.1)])
    d.add(cw.Brake("b", shaft=a, gain=1.0, normal_force=10.0, friction=law))
    same_as_assembled(d, ["b.friction.static", "b.friction.kinetic.values"], x)


@pytest.mark.parametrize(
    ("by", "x"), [(["m.angle"], [0.5]), (["m.angle"], [2.0]), (["m.angle", "stop.upper"], [0.9, 0.8])]
)
def test_an_angle_beyond_an_end(by: list[str], x: list[float]) -> None:
    d = cw.Driveline("stop")
    m = d.shaft("m", inertia=1.0, angle=0.2)
    d.add(cw.EndStop("stop", follower=m, upper=1.0))
    same_as_assembled(d, by, x)


@pytest.mark.parametrize("x", [[1.0, 2.0], [-1.0, 2.0], [-1.0, -2.0]])
def test_a_load_that_is_never_above_zero(x: list[float]) -> None:
    d = cw.Driveline("pressed")
    a = d.shaft("a", inertia=1.0, speed=10.0)
    force = cw.Table([(0.0, 10.0), (1.0, 20.0)])
    d.add(cw.Brake("b", shaft=a, gain=1.0, normal_force=force, friction=cw.Coulomb(static=0.3, kinetic=0.2)))
    same_as_assembled(d, ["b.normal_force.values"], x)


@pytest.mark.parametrize(
    "signal", [cw.Step(height=2.0, start=1.0, offset=0.5), cw.Pulse(height=2.0, period=1.0, width=0.5, start=1.0)]
)
def test_a_start_before_zero(signal: cw.Signal) -> None:
    d = cw.Driveline("started")
    d.add(cw.Torque("t", shaft=d.shaft("a", inertia=1.0), torque=signal))
    same_as_assembled(d, ["t.torque.start"], [-0.7])


def test_a_number_that_hardly_moves_a_weight_that_is_solved_for_has_no_kink():
    """A weight of a signal has hundreds of units of round-off, more than the number moves it: a lead of a screw."""
    here, chance, lead = np.array([1.1e-4]), np.random.default_rng(1), 4.4e-3

    def along(step):
        return here * (1.0 + 3e-8 * step / lead + 5e-14 * chance.uniform(-1.0, 1.0))

    found = slope(along, here, lead, lead, np.inf, 4e-16 * here).value
    assert found * lead / here == pytest.approx([3e-8], abs=1e-10)
    with pytest.raises(Bent):
        slope(lambda step: here + 1e-9 * np.abs([step]), here, lead, lead, np.inf, 4e-16 * here)
