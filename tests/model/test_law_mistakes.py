"""Friction laws: rules between their fields, choices by word, and what is allowed but warned of."""

from __future__ import annotations

import json
import warnings

import pytest

import clutchwork as cw
from clutchwork.command.main import main
from clutchwork.model.components import component_problems

CURVE = {"static": 0.15, "kinetic": 0.1, "speed": 2.0}
FOUR = [(2e-5, 0.1), (5e-5, 0.2), (1e-4, 0.3), (2e-4, 0.4)]
BRISTLES = {**CURVE, "stiffness": 1e3, "damping": 1e-3, "viscous": 1e-3}


def _brake(law, **other):
    d = cw.Driveline("brake")
    d.add(cw.Brake("b", shaft=d.shaft("a", inertia=1.0), friction=law, gain=1.0, pressure=1.0, **other))
    return d


def _mistakes(law):
    return [str(problem) for problem in _brake(law).check()]


MISTAKES = {
    "static below kinetic": (
        cw.Stribeck(static=0.1, kinetic=0.2, speed=1.0),
        "friction.static is 0.1, below the kinetic coefficient 0.2; raise it to at least 0.2",
    ),
    "static below kinetic, compliant": (
        cw.LuGre(**{**BRISTLES, "static": 0.05}),
        "friction.static is 0.05, below the kinetic coefficient 0.1",
    ),
    "static below kinetic, own fields": (
        cw.Mykhalevych(static=0.1, kinetic=0.2, elastic=1e-4, speed=1.0, viscous=1.0),
        "friction.static is 0.1, below the kinetic coefficient 0.2",
    ),
    "exponent without its shape": (
        cw.Stribeck(**CURVE, exponent=0.5),
        "friction.exponent is 0.5, but shape 'gaussian' has no exponent; remove it, or give shape \"power\"",
    ),
    "unknown shape": (
        cw.Stribeck(**CURVE, shape="gauss"),
        "friction.shape = 'gauss': is an unknown choice; did you mean 'gaussian'? choose one of gaussian, tustin",
    ),
    "number for a word": (
        cw.Stribeck(**CURVE, shape=1),
        "friction.shape = 1: is an unknown choice; choose one of gaussian",
    ),
    "no kinetic coefficient to divide by": (
        cw.LuGre(**{**BRISTLES, "kinetic": 0.0}),
        "friction.kinetic is 0, and this law divides by it",
    ),
    "elastic above the steady deflection": (
        cw.ElastoPlastic(**BRISTLES, elastic=1e-4),
        "friction.elastic is 0.0001, not below kinetic/stiffness = 0.0001; lower it",
    ),
    "elastic above plastic": (
        cw.ElastoPlastic(**BRISTLES, elastic=8e-5, plastic=7e-5),
        "friction.elastic is 8e-05, not below plastic = 7e-05",
    ),
    "plastic above the steady deflection": (
        cw.ElastoPlastic(**BRISTLES, elastic=5e-5, plastic=1.2e-4),
        "friction.plastic is 0.00012, above the steady deflection kinetic/stiffness = 0.0001; lower it",
    ),
    "too few elements": (cw.GMS(**CURVE, elements=FOUR[:3]), "friction.elements has 3 points, must have 4 to 10"),
    "too many elements": (
        cw.Leuven(**CURVE, elements=[(k * 1e-5, 0.1) for k in range(1, 12)]),
        "friction.elements has 11 points, must have 1 to 10",
    ),
    "element without deflection": (
        cw.Leuven(**CURVE, elements=[(0.0, 0.5), (1e-4, 0.5)]),
        "friction.elements point 1 is (0, 0.5); give deflections > 0 that rise, and shares > 0",
    ),
    "element without share": (
        cw.GMS(**CURVE, elements=[*FOUR[:3], (2e-4, 0.0)]),
        "friction.elements point 4 is (0.0002, 0)",
    ),
    "deflections that fall": (
        cw.GMS(**CURVE, elements=FOUR[::-1]),
        "friction.elements, point 2 = 0.0001 rad: comes after 0.0002 rad",
    ),
    "shares of too little": (
        cw.GMS(**CURVE, elements=[(x, 0.9 * y) for x, y in FOUR]),
        "friction.elements has shares that sum to 0.9, must be 1; divide each by the sum",
    ),
    "shares that never slide": (
        cw.Leuven(**CURVE, elements=FOUR[:3]),
        "friction.elements has shares that sum to 0.6, must be >= 1, or it never slides",
    ),
    "range without its reset": (
        cw.Mykhalevych(static=0.2, kinetic=0.1, elastic=1e-4, speed=1.0, viscous=1.0, reset="clip", range=2.0),
        "friction.range is 2, but reset 'clip' has no range",
    ),
    "flag that is none": (
        cw.Mykhalevych(static=0.2, kinetic=0.1, elastic=1e-4, speed=1.0, viscous=1.0, passive="yes"),
        "friction.passive = 'yes': must be true or false",
    ),
}


@pytest.mark.parametrize("case", MISTAKES)
def test_mistake(case):
    law, words = MISTAKES[case]
    (message,) = _mistakes(law)
    assert words in message
    assert ";" in message


@pytest.mark.parametrize(
    "law",
    [
        cw.Stribeck(static=0.1, kinetic=0.1, speed=1.0),
        cw.Stribeck(**CURVE, shape="power", exponent=0.5),
        # 0.1/1e3 is not 1e-4 to the last digit
        cw.ElastoPlastic(**BRISTLES, elastic=5e-5, plastic=1e-4),
        cw.Leuven(**CURVE, elements=[(1e-4, 1.5)]),
        cw.GMS(**CURVE, elements=[(k * 1e-5, 0.1) for k in range(1, 11)]),
        cw.LuGre(**{**BRISTLES, "static": 0.1, "damping": 100.0, "viscous": 0.0}),
    ],
    ids=repr,
)
def test_what_is_just_allowed(law):
    assert _mistakes(law) == []


def test_a_law_that_never_locks_cannot_start_locked():
    (problem,) = _brake(cw.Tanh(kinetic=0.1, speed=0.1), locked=True).check()
    assert problem.quantity == "locked"
    assert "with a law that never locks; remove it, or use a law that sticks: coefficient_table" in str(problem)
    assert _brake(cw.Stribeck(**CURVE), locked=True).check() == []
    # a freewheel locks by itself
    d = cw.Driveline()
    law = cw.Tanh(kinetic=0.1, speed=0.1)
    d.add(cw.OneWayClutch("o", base=d.housing, follower=d.shaft("a", inertia=1.0), friction=law, locked=True))
    assert d.check() == []


# --- warnings ---

TOO_MUCH = cw.LuGre(**{**BRISTLES, "damping": 0.3})
ADVICE = (
    'cw.Brake("b"): friction.damping = 0.3 s/rad: is too large for passivity: it must be <='
    " viscous/(static/kinetic - 1) = 0.002; lower it, or raise viscous to 0.15"
)

IN_FILES = ADVICE.replace('cw.Brake("b")', 'element "b" (brake)')


def _warnings(act):
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        act()
    return caught


def test_checking_assembling_and_running_warn_once():
    d = _brake(TOO_MUCH)
    for act in (d.check, d.assemble, lambda: d.simulate(0.001), lambda: cw.simulate(d, 0.001)):
        (caught,) = _warnings(act)
        assert caught.category is cw.ModelWarning
        assert str(caught.message) == ADVICE
        assert caught.message.problem.quantity == "friction.damping"
        # the line that asked, not one inside the package
        assert caught.filename == __file__
    with pytest.warns(cw.ModelWarning):
        assert d.assemble().warnings == (ADVICE,)
    with pytest.warns(cw.ModelWarning):
        assert d.check() == []


@pytest.mark.parametrize(
    ("law", "warned"),
    [
        (cw.LuGre(**{**BRISTLES, "damping": 0.002}), False),
        (cw.LuGre(**{**BRISTLES, "damping": 0.0021}), True),
        (cw.ElastoPlastic(**{**BRISTLES, "damping": 0.0021}, elastic=5e-5), True),
        (cw.LuGre(**{**BRISTLES, "viscous": 0.0, "damping": 0.0}), False),
        # 1e-3/(1.5^2 - 1) = 8e-4
        (cw.Leuven(**CURVE, elements=FOUR, order=2.0, viscous=1e-3, damping=0.79e-3), False),
        (cw.Leuven(**CURVE, elements=FOUR, order=2.0, viscous=1e-3, damping=0.81e-3), True),
        # 1.52 (1 - 0.1/0.2) = 0.76
        (cw.Mykhalevych(static=0.2, kinetic=0.1, elastic=1e-4, speed=1.0, viscous=0.77), False),
        (cw.Mykhalevych(static=0.2, kinetic=0.1, elastic=1e-4, speed=1.0, viscous=0.75), True),
        (cw.Mykhalevych(static=0.2, kinetic=0.1, elastic=1e-4, speed=1.0, viscous=0.0, passive=True), False),
    ],
    ids=repr,
)
def test_warned_of(law, warned):
    assert bool(_warnings(_brake(law).check)) is warned


def test_the_bound_of_mykhalevych_is_named():
    law = cw.Mykhalevych(static=0.2, kinetic=0.1, elastic=1e-4, speed=1.0, viscous=0.5)
    (caught,) = _warnings(_brake(law).check)
    text = str(caught.message)
    assert "friction.viscous = 0.5: is too small to be dissipative" in text
    assert "1.52 (1 - kinetic/static) = 0.76" in text
    assert ">= 0.319 at rest" in text
    assert "passive=True" in text


def test_no_warning_of_a_law_with_mistakes():
    d = _brake(cw.LuGre(**{**BRISTLES, "damping": 0.3, "static": 0.05}))
    assert len(d.check()) == 1


def test_loading_does_not_warn_before_the_model_is_used(tmp_path):
    d = _brake(TOO_MUCH)
    d.save(tmp_path / "model.toml")
    assert _warnings(lambda: cw.Driveline.load(tmp_path / "model.toml")) == []


@pytest.mark.parametrize("command", [["check"], ["run", "--t-end", "0.001"], ["run", "--t-end", "0.001", "--quiet"]])
def test_the_command_line_tells_warnings_in_a_line(tmp_path, capsys, command):
    path = tmp_path / "model.json"
    _brake(TOO_MUCH).save(path)
    assert main([command[0], str(path), *command[1:]]) == 0
    assert f"warning: {IN_FILES}\n" == capsys.readouterr().err
    if "--quiet" not in command:
        assert main([command[0], str(path), *command[1:], "--json"]) == 0
        assert json.loads(capsys.readouterr().out)["warnings"] == [IN_FILES]


# --- choices in model files ---


def test_choices_are_words_in_files_and_numbers_in_the_core(tmp_path):
    d = _brake(cw.Stribeck(**CURVE, shape="lorentz"))
    d.save(tmp_path / "model.toml")
    assert 'shape = "lorentz"' in (tmp_path / "model.toml").read_text()
    system = cw.Driveline.load(tmp_path / "model.toml").assemble()
    assert system.params[system.places["b.friction.shape"]] == 2.0


def test_a_misspelt_word_in_a_file(tmp_path):
    d = _brake(cw.Stribeck(**CURVE, shape="lorentz"))
    d.save(tmp_path / "model.toml")
    text = (tmp_path / "model.toml").read_text().replace("lorentz", "lorenz")
    (tmp_path / "model.toml").write_text(text)
    with pytest.raises(
        cw.ModelError, match=r"friction\.shape = 'lorenz': is an unknown choice; did you mean 'lorentz'\?"
    ):
        cw.Driveline.load(tmp_path / "model.toml")


def test_units_of_a_law_between_masses(tmp_path):
    law = {"type": "lugre", "static": 0.15, "kinetic": 0.1, "speed": "2 mm/s", "stiffness": "1 1/mm", "damping": 0.0}
    d = cw.Driveline("belt")
    mass = d.mass("m", mass=1.0)
    d.add(cw.BearingFriction("b", shaft=mass, friction=cw.LuGre(**BRISTLES), torque=1.0))
    data = d.to_dict()
    data["element"][0]["friction"] = law
    (element,) = cw.Driveline.from_dict(data).elements
    assert (element.friction.speed, element.friction.stiffness) == (pytest.approx(2e-3), pytest.approx(1e3))


# --- what a law gives to the system ---


def test_the_band_of_karnopp_is_a_tolerance_at_least():
    law = cw.Karnopp(**CURVE, band=0.01)
    assert _brake(law).assemble().contact_tolerance.tolist() == [0.01]
    assert _brake(law, tolerance=0.02).assemble().contact_tolerance.tolist() == [0.02]


def test_as_many_states_as_elements():
    assert len(cw.GMS(**CURVE, elements=FOUR).own_states()) == 4
    assert len(cw.Leuven(**CURVE, elements=[(1e-4, 1.0)]).own_states()) == 1
    assert [state.name for state in cw.Leuven(**CURVE, elements=FOUR).own_states()] == [
        "element_1",
        "element_2",
        "element_3",
        "element_4",
    ]


def test_a_law_in_a_list_of_problems_has_its_path():
    brake = cw.Brake("x", shaft=cw.Node("a"), friction=cw.GMS(**CURVE, elements=FOUR[:2]), gain=1.0, pressure=1.0)
    (problem,) = component_problems(brake)
    assert (problem.path, problem.quantity) == ('cw.Brake("x")', "friction.elements")
