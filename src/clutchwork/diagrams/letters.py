"""How wide a line of text is, without a font at hand: as wide as in the widest of those that are asked for."""

from __future__ import annotations

FONT = "Arial, Helvetica, 'DejaVu Sans', sans-serif"
# widths over the size, of DejaVu Sans, which is wider than Arial
_WIDE = {
    **dict.fromkeys("0123456789", 0.64),
    **dict.fromkeys("ijlI|.,:;'!", 0.34),
    **dict.fromkeys('frt()[]/- "', 0.42),
    **dict.fromkeys("mwMW%@", 0.96),
    **dict.fromkeys("ABCDEFGHJKLNOPQRSTUVXYZ&", 0.73),
    **dict.fromkeys("+=<>~\N{MINUS SIGN}\N{MULTIPLICATION SIGN}", 0.84),
}


def width_of(text: str, size: float, *, bold: bool = False) -> float:
    """Width of a line of text of a size [px]; no font sets it wider."""
    return size * sum(_WIDE.get(letter, 0.65) for letter in text) * (1.1 if bold else 1.0)
