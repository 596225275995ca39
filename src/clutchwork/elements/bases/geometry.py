"""Radii of friction rings: docs/theory/clutches.md."""

from __future__ import annotations

Found = list[tuple[str, str, str]]


def mean_radius(outer: float, inner: float) -> float:
    """Effective radius of a ring under uniform pressure [m], from its diameters: 2/3 (ro^3 - ri^3)/(ro^2 - ri^2)."""
    ro, ri = outer / 2, inner / 2
    # the common factor ro - ri is cancelled, so that thin rings keep their digits
    return 2.0 / 3.0 * (ro * ro + ro * ri + ri * ri) / (ro + ri)


def effective_radius(radius: float | None, outer: float | None, inner: float | None) -> float:
    """The radius that is given, else that of the ring [m]."""
    return radius if radius is not None else mean_radius(outer or 0.0, inner or 0.0)


def derating_when_worn(outer: float | None, inner: float | None) -> float:
    """De-rating that uniform wear tends to: 3/4 (ro + ri)^2/(ro^2 + ro ri + ri^2); 1 without a ring.

    Times the effective radius it is the mean of both radii.
    """
    if outer is None or inner is None:
        return 1.0
    return 0.75 * (outer + inner) ** 2 / (outer * outer + outer * inner + inner * inner)


def ring_problems(radius: float | None, outer: float | None, inner: float | None) -> Found:
    """A radius that is given twice, not at all, or by a ring that is none."""
    if radius is not None and (outer, inner) != (None, None):
        return [("radius", "cannot be given together with a diameter", "give the radius, or both diameters")]
    if radius is not None:
        return []
    for name, value in (("outer_diameter", outer), ("inner_diameter", inner)):
        if value is None:
            return [(name, "is missing", "give `radius`, or both `outer_diameter` and `inner_diameter`")]
    if outer is not None and inner is not None and not inner < outer:
        fault = f"is {inner:g} m, not below the outer diameter {outer:g} m"
        return [("inner_diameter", fault, "give diameters, the inner one below the outer one")]
    return []
