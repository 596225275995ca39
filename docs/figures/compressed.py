"""Pictures as they are committed: few colours, few digits."""

from __future__ import annotations

from pathlib import Path

COLOURS = 96


def compress(source: Path, target: Path) -> None:
    """Write a picture, or a text as it is."""
    target.parent.mkdir(parents=True, exist_ok=True)
    if source.suffix == ".png":
        _png(source, target)
    elif source.suffix == ".svg":
        target.write_text(_svg(source.read_text(encoding="utf-8")), encoding="utf-8")
    else:
        target.write_bytes(source.read_bytes())


def _png(source: Path, target: Path) -> None:
    from PIL import Image

    image = Image.open(source).convert("RGB")
    few = image.quantize(
        COLOURS, method=Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE
    )
    few.save(target, optimize=True)


def _svg(text: str) -> str:
    from scour import scour

    options = scour.sanitizeOptions(
        scour.parse_args(
            [
                "--set-precision=5",
                "--enable-id-stripping",
                "--shorten-ids",
                "--remove-metadata",
                "--enable-comment-stripping",
                "--strip-xml-prolog",
                "--indent=none",
                "--no-line-breaks",
                "--quiet",
            ]
        )
    )
    small = scour.scourString(text, options)
    return f"{small.rstrip()}\n"
