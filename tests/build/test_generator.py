"""What the generator and the compiler refuse, each with a message that names file and field."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from support import project
from support.refused import ELEMENTS, HEADERS, LAWS, edit, refused_by_compiler, refused_by_generator


def test_the_untouched_project_passes(copy: Path) -> None:
    assert project.generate(copy).returncode == 0
    result = project.compile_registry(copy)
    assert result.returncode == 0, result.stderr


@pytest.mark.parametrize("stem", ["elements/damper", "laws/coulomb"])
def test_missing_header(copy: Path, stem: str) -> None:
    (copy / f"{HEADERS}/{stem}.hpp").unlink()
    refused_by_generator(copy, f"src/clutchwork/{stem}.py", f"{HEADERS}/{stem}.hpp")


@pytest.mark.parametrize("stem", ["elements/quadratic_torque", "laws/exponential"])
def test_missing_declaration(copy: Path, stem: str) -> None:
    (copy / f"src/clutchwork/{stem}.py").unlink()
    refused_by_generator(copy, f"{HEADERS}/{stem}.hpp", f"src/clutchwork/{stem}.py")


def test_other_unit_in_the_header(copy: Path) -> None:
    edit(copy / f"{HEADERS}/elements/damper.hpp", "[N m s/rad]", "[N mm s/rad]")
    refused_by_generator(copy, "damper.hpp", "field damping", "[N mm s/rad]", "[N m s/rad]", f"{ELEMENTS}/damper.py")


def test_swapped_parameters(copy: Path) -> None:
    header = copy / f"{HEADERS}/laws/exponential.hpp"
    lines = header.read_text().splitlines(keepends=True)
    slow, fast = (next(i for i, line in enumerate(lines) if f" {name};" in line) for name in ("slow", "fast"))
    lines[slow], lines[fast] = lines[fast], lines[slow]
    header.write_text("".join(lines))
    refused_by_compiler(copy, "exponential.hpp", "slow", f"{LAWS}/exponential.py")


def test_renamed_parameter(copy: Path) -> None:
    header = copy / f"{HEADERS}/elements/damper.hpp"
    header.write_text(header.read_text().replace("damping", "dumping"))
    refused_by_generator(copy, "damper.hpp", "no line `T damping;  ///< [N m s/rad]`", f"{ELEMENTS}/damper.py")


def test_parameter_that_the_declaration_does_not_have(copy: Path) -> None:
    edit(copy / f"{HEADERS}/elements/damper.hpp", "[N m s/rad]\n", "[N m s/rad]\n    T extra;\n")
    refused_by_compiler(copy, "damper.hpp", "does not declare")


def test_parameter_that_the_header_does_not_have(copy: Path) -> None:
    path = copy / f"{ELEMENTS}/damper.py"
    path.write_text(path.read_text() + '    extra: float = param("1", "nothing")\n')
    refused_by_generator(copy, "damper.hpp", "no line `T extra;  ///< [1]`", f"{ELEMENTS}/damper.py")


def test_missing_function(copy: Path) -> None:
    header = copy / f"{HEADERS}/laws/coulomb.hpp"
    header.write_text(header.read_text().replace("slide(", "glide("))
    refused_by_compiler(copy, "coulomb.hpp", "FrictionLaw")


def test_other_number_of_states(copy: Path) -> None:
    edit(copy / f"{HEADERS}/elements/spring.hpp", "  };\n", "  };\n  static constexpr int states = 2;\n")
    refused_by_compiler(copy, "spring.hpp: states is not 1", f"{ELEMENTS}/spring.py declares 1 (spring_torque)")


# file, text, what it becomes, who refuses it, words of the message
GENERATOR, COMPILER = refused_by_generator, refused_by_compiler
WET_DRAG, OIL, PLATE = (f"{HEADERS}/elements/{stem}.hpp" for stem in ("wet_drag", "oil_flow", "plate_contact"))
TABLE, MAP, RESET = (f"{HEADERS}/laws/{stem}.hpp" for stem in ("temperature_table", "friction_map", "mykhalevych"))
TEMPERATURE = '    temperature: SignalLike | None = signal("K", "temperature of the lining", default=None)\n'
EDITS = {
    "a signal that nothing reads": (
        f"{ELEMENTS}/wet_drag.py",
        "    scale: SignalLike",
        '    more: SignalLike = signal("1", "nothing")\n    scale: SignalLike',
        (GENERATOR, "wet_drag.hpp: nothing reads Input::more", f"{ELEMENTS}/wet_drag.py"),
    ),
    "inputs too many": (
        WET_DRAG,
        "  };\n",
        "  };\n  static constexpr int inputs = 2;\n",
        (COMPILER, "wet_drag.hpp: inputs is not 1", f"{ELEMENTS}/wet_drag.py declares 1 (scale)"),
    ),
    "a signal that the declaration has not": (
        f"{ELEMENTS}/oil_flow.py",
        '    flow: SignalLike = signal("kg/s", "flow of oil; below zero counts as zero", clips=True)\n',
        "",
        (GENERATOR, "oil_flow.hpp: Input::flow is not an input", f"{ELEMENTS}/oil_flow.py, which has hot, inlet"),
    ),
    "inputs too few": (
        OIL,
        "  };\n",
        "  };\n  static constexpr int inputs = 2;\n",
        (COMPILER, "oil_flow.hpp: inputs is not 3", f"{ELEMENTS}/oil_flow.py declares 3 (hot, inlet, flow)"),
    ),
    "signals in an order of their own": (
        PLATE,
        "  };\n",
        "  };\n  enum class Input : int { wear, pressure, fault_signal, fault_time };\n",
        (COMPILER, "plate_contact.hpp: Input::wear is not at the place", f"{ELEMENTS}/plate_contact.py"),
    ),
    "a signal by number": (
        PLATE,
        "at.input[Input::wear]",
        "at.input[1]",
        (GENERATOR, "plate_contact.hpp: input[1]", "input[Input::wear]"),
    ),
    "a signal by a number of its own": (
        PLATE,
        "at.input[Input::wear]",
        "at.input[int(Input::wear)]",
        (GENERATOR, "plate_contact.hpp: input[int(Input::wear)]", "write input[Input::name]"),
    ),
    "states in an order of their own": (
        f"{HEADERS}/elements/dog_clutch.hpp",
        "  };\n",
        "  };\n  enum State : int { sleeve, angle };\n",
        (COMPILER, "dog_clutch.hpp: State::angle is not at the place", f"{ELEMENTS}/dog_clutch.py"),
    ),
    "a state by number": (
        f"{HEADERS}/elements/dog_clutch.hpp",
        "rates[angle]",
        "rates[0]",
        (GENERATOR, "dog_clutch.hpp: rates[0]", "rates[angle]"),
    ),
    "a choice as a number": (
        RESET,
        "Word<T, choice::Reset> reset;",
        "T reset;",
        (GENERATOR, "mykhalevych.hpp: field reset is `T reset;", "`Word<T, choice::Reset> reset;  ///< [1]`"),
    ),
    "a choice with an enum of its own": (
        RESET,
        "Word<T, choice::Reset> reset;",
        "Word<T, Own> reset;",
        (GENERATOR, "mykhalevych.hpp: field reset is `Word<T, Own> reset;", "`Word<T, choice::Reset> reset;"),
    ),
    "choices in an order of their own": (
        f"{ELEMENTS}/diaphragm_spring.py",
        '("linear", "smooth")',
        '("smooth", "linear")',
        (GENERATOR, "interpolation has its words in another order", f"{ELEMENTS}/diaphragm_spring.py"),
    ),
    "choices of one name with other words": (
        f"{ELEMENTS}/diaphragm_spring.py",
        '("linear", "smooth")',
        '("linear", "smooth", "cubic")',
        (GENERATOR, "the choice interpolation has other words", f"{ELEMENTS}/diaphragm_spring.py"),
    ),
    "a choice that is no name in C++": (
        f"{LAWS}/mykhalevych.py",
        '"literal")',
        '"to-the-letter")',
        (GENERATOR, f"{LAWS}/mykhalevych.py: the choice reset", "'to-the-letter'"),
    ),
    "a word that the declaration has not": (
        f"{LAWS}/mykhalevych.py",
        '"literal")',
        '"printed")',
        (COMPILER, "mykhalevych.hpp", "literal"),
    ),
    "a temperature that the declaration forgets": (
        f"{LAWS}/temperature_table.py",
        TEMPERATURE,
        "",
        (GENERATOR, "temperature_table.hpp: Input::temperature is not an input", f"{LAWS}/temperature_table.py"),
    ),
    "a temperature that the header forgets": (
        MAP,
        "Input::temperature",
        "temperature",
        (GENERATOR, "friction_map.hpp: nothing reads Input::temperature", f"{LAWS}/friction_map.py"),
    ),
    "a law that takes nothing from its declaration": (
        TABLE,
        ", declared::TemperatureTable",
        "",
        (COMPILER, "temperature_table.hpp", "Input"),
    ),
    "no unit of a number": (
        f"{HEADERS}/elements/spring.hpp",
        "  ///< [rad]",
        "",
        (GENERATOR, "spring.hpp: field initial_twist is `T initial_twist;`", "`T initial_twist;  ///< [rad]`"),
    ),
    "a comment without unit": (
        f"{HEADERS}/elements/spring.hpp",
        "///< [rad]",
        "///< twist at the start",
        (GENERATOR, "spring.hpp: field initial_twist", "`T initial_twist;  ///< [rad]`"),
    ),
    "no unit of a shared parameter": (
        f"{HEADERS}/components/stribeck_curve.hpp",
        "  ///< [rad/s]",
        "",
        (GENERATOR, "components/stribeck_curve.hpp: field speed is `T speed;`", "`T speed;  ///< [rad/s]`"),
    ),
    "no unit of a curve": (
        f"{HEADERS}/elements/speed_torque.hpp",
        "  ///< rad/s -> N m",
        "",
        (GENERATOR, "speed_torque.hpp: field torque is `Curve<T> torque;`", "///< rad/s -> N m`"),
    ),
    "no unit of numbers": (
        MAP,
        "  ///< K\n",
        "\n",
        (GENERATOR, "friction_map.hpp: field temperatures is `Curve<T> temperatures;`", "///< K`"),
    ),
    "another unit of a curve": (
        f"{HEADERS}/elements/speed_torque.hpp",
        "rad/s -> N m",
        "rad/s -> N",
        (GENERATOR, "speed_torque.hpp: field torque", f"{ELEMENTS}/speed_torque.py asks for", "rad/s -> N m`"),
    ),
    "another unit along a curve": (
        f"{ELEMENTS}/speed_torque.py",
        'curve("rad/s", "N m"',
        'curve("1/min", "N m"',
        (GENERATOR, "speed_torque.hpp: field torque", "rad/s -> N m`", "1/min -> N m`"),
    ),
    "another unit of numbers": (
        f"{LAWS}/friction_map.py",
        'numbers(\n        "K"',
        'numbers(\n        "degC"',
        (GENERATOR, "friction_map.hpp: field temperatures", "///< degC`"),
    ),
    "no rates of the states": (
        f"{HEADERS}/laws/dahl.hpp",
        "void state_rates",
        "void rates_of_states",
        (COMPILER, "dahl.hpp: state_rates is missing", f"{LAWS}/dahl.py"),
    ),
}


@pytest.mark.parametrize("name", EDITS)
def test_an_edit_of_one_side_ends_the_build(copy: Path, name: str) -> None:
    path, old, new, (refused, *words) = EDITS[name]
    text = (copy / path).read_text()
    assert old in text, f"{path} has changed: the test has to follow"
    everywhere = old.startswith("Input::")
    (copy / path).write_text(text.replace(old, new) if everywhere else text.replace(old, new, 1))
    refused(copy, *words)


@pytest.mark.parametrize(
    ("path", "old", "new", "generated"),
    [
        (
            f"{ELEMENTS}/plate_contact.py",
            r"(    wear: .*\n)(    fault_signal: .*\n)",
            r"\2\1",
            "enum class Input : int { pressure, fault_signal, wear, fault_time };",
        ),
        (
            f"{LAWS}/mykhalevych.py",
            r'"saturate", "clip", "literal"',
            r'"literal", "clip", "saturate"',
            "enum class Reset : int { literal, clip, saturate };",
        ),
    ],
)
def test_another_order_in_the_declaration_moves_the_names(
    copy: Path, path: str, old: str, new: str, generated: str
) -> None:
    """The order is written once: what the equations read by name stays what it was."""
    text = (copy / path).read_text()
    (copy / path).write_text(re.sub(old, new, text))
    assert (copy / path).read_text() != text
    assert project.generate(copy).returncode == 0
    assert generated in (copy / "gen/clutchwork/declared.gen.hpp").read_text()
    result = project.compile_registry(copy)
    assert result.returncode == 0, result.stderr


def test_an_edited_declaration_changes_the_hash(copy: Path) -> None:
    """A compiled core that is older than the declarations is recognised."""
    header = copy / "gen/clutchwork/layout.gen.hpp"
    project.generate(copy)
    before = next(line for line in header.read_text().splitlines() if "schema_hash =" in line)
    for path in (copy / f"{ELEMENTS}/damper.py", copy / f"{HEADERS}/elements/damper.hpp"):
        path.write_text(re.sub(r"\bdamping\b", "dumping", path.read_text()))
    assert project.generate(copy).returncode == 0
    after = next(line for line in header.read_text().splitlines() if "schema_hash =" in line)
    assert before != after


def test_generated_files_are_not_in_the_repository() -> None:
    import subprocess

    listed = subprocess.run(["git", "ls-files"], cwd=project.ROOT, capture_output=True, text=True, check=False)
    # outside a repository, as in an unpacked archive, nothing is listed
    assert not [name for name in listed.stdout.splitlines() if ".gen." in name]
