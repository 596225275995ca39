"""The components that the core knows, by the names that they have in C++."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from clutchwork.declare.schema import COMPILED_ROLES, REGISTRY, WORDS, Role, Spec, inputs, kinds, specs

# role: folder of the files, namespace of the headers, and concept that they fulfil
FOLDER = {"torque": "elements", "contact": "elements", "law": "laws", "flow": "elements", "process": "elements"}
CONCEPT = {
    "torque": "TorqueElement",
    "contact": "ContactElement",
    "law": "FrictionLaw",
    "flow": "FlowElement",
    "process": "ProcessElement",
}
# names that C++ keeps for itself; those of Python cannot be fields anyway
KEYWORDS = {
    "auto", "bool", "case", "catch", "char", "const", "default", "delete", "do", "double", "enum", "explicit", "extern",
    "false", "float", "friend", "goto", "inline", "int", "long", "mutable", "namespace", "new", "operator", "private",
    "protected", "public", "register", "short", "signed", "sizeof", "static", "struct", "switch", "template", "this",
    "throw", "true", "typedef", "typename", "union", "unsigned", "using", "virtual", "void", "volatile",
}  # fmt: skip


def cpp_name(name: str) -> str:
    """The C++ name of a field or a word: the same, with an underscore where C++ reserves it."""
    return f"{name}_" if name in KEYWORDS else name.replace(" ", "_")


def enum_name(field: str) -> str:
    """The C++ enum of a choice: `wear_mode` becomes `WearMode`."""
    return "".join(part.capitalize() for part in field.split("_"))


@dataclass(frozen=True)
class Field:
    """One field of the C++ `Params`."""

    name: str
    spec: Spec
    offset: int  # in numbers

    @property
    def size(self) -> int:
        """How many numbers it has: a curve has two."""
        return 1 if self.spec.what == "param" else 2

    def type(self, scalar: str = "T") -> str:
        """Its C++ type for parameters of a scalar type."""
        if self.spec.choices:
            return f"Word<{scalar}, choice::{enum_name(self.name)}>"
        return scalar if self.spec.what == "param" else f"Curve<{scalar}>"

    @property
    def comment(self) -> str:
        """What its comment says first: the unit, of a curve both."""
        if self.spec.what == "curve":
            return f"{self.spec.unit_x} -> {self.spec.unit}"
        return f"[{self.spec.unit}]" if self.spec.what == "param" else self.spec.unit

    @property
    def line(self) -> str:
        """Its line in the header."""
        return f"{self.type()} {cpp_name(self.name)};  ///< {self.comment}"


@dataclass(frozen=True)
class Component:
    """A declaration and its header."""

    role: Role
    kind: str
    cls: Any

    @property
    def folder(self) -> str:
        """Folder of both files."""
        return FOLDER[self.role.value]

    @property
    def source(self) -> str:
        """Path of the declaration."""
        return f"src/clutchwork/{self.folder}/{self.kind}.py"

    @property
    def header(self) -> str:
        """Path of the equations."""
        return f"cpp/include/clutchwork/{self.folder}/{self.kind}.hpp"

    @property
    def name(self) -> str:
        """Its struct inside namespace clutchwork."""
        return f"{self.folder}::{self.cls.__name__}"

    @property
    def inputs(self) -> list[str]:
        """Names of its inputs; a flow has the temperatures of its two ends first, one that gathers their sum."""
        ends = [item.name for item, _ in specs(self.cls, "thermal")] if self.role is Role.FLOW else []
        ends += ["gathered"] if self.cls.role is Role.PROCESS and self.cls.gathers else []
        return ends + [names[0] for names, _ in inputs(self.cls)]

    @property
    def ways(self) -> list[str]:
        """Names of its ways; none where it has one direction."""
        return [way.name for way in self.cls.ways] if self.role is Role.TORQUE and len(self.cls.ways) > 1 else []

    @property
    def concept(self) -> str:
        """The concept that its header fulfils."""
        if "ratio" in self.cls.hooks:
            return "TransmissionElement"
        return "CoupledElement" if self.ways else CONCEPT[self.role.value]

    @property
    def states(self) -> list[str]:
        """Names of its states."""
        return [state.name for state in self.cls.states]

    @property
    def fields(self) -> list[Field]:
        """Its parameters in order."""
        found: list[Field] = []
        for item, spec in specs(self.cls, *WORDS):
            found.append(Field(item.name, spec, found[-1].offset + found[-1].size if found else 0))
        return found


def components(role: Role | None = None) -> Iterator[Component]:
    """All components that the core knows, or those of a role, in the order of their numbers."""
    for one in COMPILED_ROLES if role is None else (role,):
        for kind in kinds(one):
            yield Component(one, kind, REGISTRY[one][kind])
