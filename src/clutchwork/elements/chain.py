"""Chain or toothed belt."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from typing import Any

from clutchwork.declare import Found, Node, Role, component, exact, flag, option, param, port
from clutchwork.declare.node import Domain, Part
from clutchwork.elements.bases.meshing import Lossy
from clutchwork.elements.gear import Gear
from clutchwork.elements.mesh import Mesh
from clutchwork.elements.polygon_sprocket import PolygonSprocket


@component(Role.COMPOSITE)
class Chain(Lossy):
    """Chain or toothed belt over two sprockets, which turn the same way: ratio = teeth_output/teeth_input.

    Use it for bicycle, motorcycle, timing and transfer case drives. The mean ratio is exact; for an elastic chain put a
    `SpringDamper` in series. With `polygon` the strand moves with the corners of the sprockets, radius cos(angle in the
    link), so that the ratio ripples with every tooth; links are then `pitch` long, and the phases say where in a link
    each sprocket starts, -1 to 1. Losses follow the torque that the chain carries, as those of a `LossyGear`; it has
    none by default, and a polygon has none.

    Equations: docs/theory/belts.md.
    """

    input: Node = port("shaft whose speed is ratio times that of the output")
    output: Node = port("other shaft")
    support: Node | None = port("member that carries both and takes the reaction", default=None)
    teeth_input: int = param("1", "teeth of the sprocket on the input", above=0.0, whole=True)
    teeth_output: int = param("1", "teeth of the sprocket on the output", above=0.0, whole=True)
    polygon: bool = flag("the ratio ripples with the teeth", default=False)
    pitch: float | None = param("m", "length of a link, for the polygon", default=None, above=0.0)
    phase_input: float = option(
        "1", "place in the link at the input at the start", default=0.0, at_least=-1.0, at_most=1.0
    )
    phase_output: float = option("1", "the same at the output", default=0.0, at_least=-1.0, at_most=1.0)

    def problems(self) -> Found:
        found = []
        if self.polygon and self.pitch is None:
            found.append(("pitch", "is missing", "give the length of a link, or leave out `polygon`"))
        few = [name for name in ("teeth_input", "teeth_output") if getattr(self, name) < 3]
        if self.polygon and few:
            found.append((few[0], "does not make a polygon", "give at least 3 teeth, or leave out `polygon`"))
        if self.polygon and self.is_lossy():
            found.append(("polygon", "has no losses", "put a `LossyGear` beside it, or leave out `polygon`"))
        return found + list(self.loss_problems() or self.heat_problems())

    def exact_ratio(self) -> Fraction:
        """Ratio as a fraction, the mean one with `polygon`."""
        return exact(self.teeth_output) / exact(self.teeth_input)

    def parts(self) -> Iterator[Part]:
        """A gear of the same name, or the strand and two sprockets."""
        if not self.polygon:
            # teeth of an internal wheel count negative: both turn the same way
            teeth: dict[str, Any] = {"teeth_input": -self.teeth_input, "teeth_output": self.teeth_output}
            ends: dict[str, Any] = {"input": self.input, "output": self.output, "support": self.support}
            if self.is_lossy():
                yield Mesh(self.name, ratio=float(self.exact_ratio()), **ends, **self.mesh())
            else:
                yield Gear(self.name, **ends, **teeth)
            return
        strand = Node(f"{self.name}.strand", Domain.TRANSLATION)
        yield strand
        sprockets = (("input", self.input, self.teeth_input), ("output", self.output, self.teeth_output))
        for name, shaft, count in sprockets:
            yield PolygonSprocket(
                f"{self.name}.{name}",
                shaft=shaft,
                mass=strand,
                support=self.support,
                teeth=count,
                pitch=self.pitch or 1.0,
                phase=getattr(self, f"phase_{name}"),
            )
