"""Units as other programs write them, in the words that clutchwork knows."""

from __future__ import annotations

# revolutions per minute are what tools call 1/min
OTHERS = {
    "1/min": "rpm",
    "min-1": "rpm",
    "min^-1": "rpm",
    "/min": "rpm",
    "U/min": "rpm",
    "rev/min": "rpm",
    "r/min": "rpm",
    "RPM": "rpm",
    "°C": "degC",
    "℃": "degC",
    "Grad C": "degC",
    "deg C": "degC",
    "°": "deg",
    "Grad": "deg",
    "Kelvin": "K",
    "NM": "Nm",
    "N·m": "N m",
    "sec": "s",
    "msec": "ms",
    "kmh": "km/h",
    "km/h": "km/h",
    "KPa": "kPa",
    "Bar": "bar",
    "percent": "%",
    "-": "",
    "--": "",
    "[-]": "",
    "none": "",
    "unitless": "",
}


def own_unit(text: str) -> str:
    """A unit of another program; an unknown one stays unchanged."""
    bare = text.strip().replace("\N{MICRO SIGN}", "u")
    if len(bare) > 1 and bare[0] + bare[-1] == "[]":
        bare = bare[1:-1].strip()
    return OTHERS.get(bare, bare)
