"""The words of units: what each is worth in SI, the quantities that they measure, and examples of them."""

from __future__ import annotations

from math import pi
from typing import NamedTuple, TypeAlias

Powers: TypeAlias = "tuple[int, int, int, int, int, int]"

# factor to SI, and powers of kg, m, s, rad, K and A
TABLE: dict[str, tuple[float, Powers]] = {
    "1": (1.0, (0, 0, 0, 0, 0, 0)),
    "%": (0.01, (0, 0, 0, 0, 0, 0)),
    "kg": (1.0, (1, 0, 0, 0, 0, 0)),
    "g": (1e-3, (1, 0, 0, 0, 0, 0)),
    "t": (1e3, (1, 0, 0, 0, 0, 0)),
    "lb": (0.45359237, (1, 0, 0, 0, 0, 0)),
    "m": (1.0, (0, 1, 0, 0, 0, 0)),
    "um": (1e-6, (0, 1, 0, 0, 0, 0)),
    "mm": (1e-3, (0, 1, 0, 0, 0, 0)),
    "cm": (1e-2, (0, 1, 0, 0, 0, 0)),
    "km": (1e3, (0, 1, 0, 0, 0, 0)),
    "in": (0.0254, (0, 1, 0, 0, 0, 0)),
    "ft": (0.3048, (0, 1, 0, 0, 0, 0)),
    "L": (1e-3, (0, 3, 0, 0, 0, 0)),
    "l": (1e-3, (0, 3, 0, 0, 0, 0)),
    "mL": (1e-6, (0, 3, 0, 0, 0, 0)),
    "ml": (1e-6, (0, 3, 0, 0, 0, 0)),
    "s": (1.0, (0, 0, 1, 0, 0, 0)),
    "ms": (1e-3, (0, 0, 1, 0, 0, 0)),
    "us": (1e-6, (0, 0, 1, 0, 0, 0)),
    "min": (60.0, (0, 0, 1, 0, 0, 0)),
    "h": (3600.0, (0, 0, 1, 0, 0, 0)),
    "rad": (1.0, (0, 0, 0, 1, 0, 0)),
    "mrad": (1e-3, (0, 0, 0, 1, 0, 0)),
    "deg": (pi / 180, (0, 0, 0, 1, 0, 0)),
    "rev": (2 * pi, (0, 0, 0, 1, 0, 0)),
    "U": (2 * pi, (0, 0, 0, 1, 0, 0)),
    "rpm": (pi / 30, (0, 0, -1, 1, 0, 0)),
    "Hz": (1.0, (0, 0, -1, 0, 0, 0)),
    "kHz": (1e3, (0, 0, -1, 0, 0, 0)),
    "mph": (0.44704, (0, 1, -1, 0, 0, 0)),
    "N": (1.0, (1, 1, -2, 0, 0, 0)),
    "mN": (1e-3, (1, 1, -2, 0, 0, 0)),
    "kN": (1e3, (1, 1, -2, 0, 0, 0)),
    "lbf": (4.4482216152605, (1, 1, -2, 0, 0, 0)),
    "Nm": (1.0, (1, 2, -2, 0, 0, 0)),
    "mNm": (1e-3, (1, 2, -2, 0, 0, 0)),
    "kNm": (1e3, (1, 2, -2, 0, 0, 0)),
    "J": (1.0, (1, 2, -2, 0, 0, 0)),
    "kJ": (1e3, (1, 2, -2, 0, 0, 0)),
    "MJ": (1e6, (1, 2, -2, 0, 0, 0)),
    "Wh": (3600.0, (1, 2, -2, 0, 0, 0)),
    "kWh": (3.6e6, (1, 2, -2, 0, 0, 0)),
    "W": (1.0, (1, 2, -3, 0, 0, 0)),
    "mW": (1e-3, (1, 2, -3, 0, 0, 0)),
    "kW": (1e3, (1, 2, -3, 0, 0, 0)),
    "MW": (1e6, (1, 2, -3, 0, 0, 0)),
    "hp": (745.69987158227022, (1, 2, -3, 0, 0, 0)),
    "PS": (735.49875, (1, 2, -3, 0, 0, 0)),
    "Pa": (1.0, (1, -1, -2, 0, 0, 0)),
    "hPa": (1e2, (1, -1, -2, 0, 0, 0)),
    "kPa": (1e3, (1, -1, -2, 0, 0, 0)),
    "MPa": (1e6, (1, -1, -2, 0, 0, 0)),
    "GPa": (1e9, (1, -1, -2, 0, 0, 0)),
    "bar": (1e5, (1, -1, -2, 0, 0, 0)),
    "mbar": (1e2, (1, -1, -2, 0, 0, 0)),
    "psi": (6894.757293168361, (1, -1, -2, 0, 0, 0)),
    "St": (1e-4, (0, 2, -1, 0, 0, 0)),
    "cSt": (1e-6, (0, 2, -1, 0, 0, 0)),
    "K": (1.0, (0, 0, 0, 0, 1, 0)),
    "A": (1.0, (0, 0, 0, 0, 0, 1)),
    "mA": (1e-3, (0, 0, 0, 0, 0, 1)),
    "Ah": (3600.0, (0, 0, 1, 0, 0, 1)),
    "V": (1.0, (1, 2, -3, 0, 0, -1)),
    "ohm": (1.0, (1, 2, -3, 0, 0, -2)),
    "mohm": (1e-3, (1, 2, -3, 0, 0, -2)),
}


class Offset(NamedTuple):
    """A temperature with an offset zero: `number * factor + zero` is in K."""

    factor: float
    zero: float


OTHER_ZERO: dict[str, Offset] = {
    "degC": Offset(1.0, 273.15),
    "C": Offset(1.0, 273.15),
    "degF": Offset(5 / 9, 459.67 * 5 / 9),
    "F": Offset(5 / 9, 459.67 * 5 / 9),
}
# words that mean one unit in whatever case: not those that m for milli and M for mega tell apart, nor single letters
TOLERANT = {
    word.lower(): word
    for word in (
        *("kg", "km", "cm", "in", "ft", "min", "rad", "deg", "rev", "rpm", "Hz", "kHz", "mph", "lb", "lbf", "kNm"),
        *("kJ", "kW", "kWh", "hp", "Pa", "hPa", "kPa", "bar", "psi", "degC", "degF"),
    )
}


class UnitGroup(NamedTuple):
    """What units measure."""

    name: str
    unit: str  # of SI
    examples: tuple[str, ...]


QUANTITIES = (
    UnitGroup("share", "1", ("0.5", "50 %")),
    UnitGroup("mass", "kg", ("1200 kg", "1.2 t")),
    UnitGroup("length", "m", ("0.1 m", "100 mm")),
    UnitGroup("area", "m2", ("0.01 m2", "100 cm2")),
    UnitGroup("volume", "m3", ("5e-4 m3", "500 cm3")),
    UnitGroup("time", "s", ("2 s", "20 ms")),
    UnitGroup("angle", "rad", ("0.5 rad", "30 deg")),
    UnitGroup("rotational speed", "rad/s", ("955 rpm", "100 rad/s", "955 1/min")),
    UnitGroup("frequency", "1/s", ("5 Hz", "5 1/s")),
    UnitGroup("speed", "m/s", ("36 km/h", "10 m/s")),
    UnitGroup("rotational acceleration", "rad/s2", ("10 rad/s2", "600 deg/s2")),
    UnitGroup("acceleration", "m/s2", ("9.81 m/s2",)),
    UnitGroup("inertia", "kg m2", ("0.2 kg m2", "2000 kg cm2")),
    UnitGroup("force", "N", ("2 kN", "450 lbf")),
    UnitGroup("torque", "N m", ("150 N m", "0.15 kNm", "110 lbf ft")),
    UnitGroup("work", "J", ("2 kJ", "0.5 kWh")),
    UnitGroup("power", "W", ("80 kW", "110 PS")),
    UnitGroup("pressure", "Pa", ("2 bar", "200 kPa")),
    UnitGroup("rise of pressure over a length", "Pa/m", ("2 bar/mm",)),
    UnitGroup("torsional stiffness", "N m/rad", ("5000 N m/rad", "90 N m/deg")),
    UnitGroup("torsional damping", "N m s/rad", ("0.5 N m s/rad", "0.05 Nm/rpm")),
    UnitGroup("stiffness", "N/m", ("2 kN/mm",)),
    UnitGroup("damping", "N s/m", ("500 N s/m",)),
    UnitGroup("temperature", "K", ("363 K", "90 degC")),
    UnitGroup("heat capacity", "J/K", ("2 kJ/K",)),
    UnitGroup("specific heat capacity", "J/(kg K)", ("480 J/(kg K)", "0.48 kJ/(kg K)")),
    UnitGroup("conductance", "W/K", ("25 W/K",)),
    UnitGroup("conductivity", "W/(m K)", ("50 W/(m K)",)),
    UnitGroup("heat transfer coefficient", "W/(m2 K)", ("500 W/(m2 K)",)),
    UnitGroup("mass flow", "kg/s", ("0.1 kg/s", "6 kg/min")),
    UnitGroup("volume flow", "m3/s", ("1e-4 m3/s", "6 L/min")),
    UnitGroup("electric current", "A", ("0.8 A", "800 mA")),
    UnitGroup("electric charge", "A s", ("6.5 Ah", "23400 A s")),
    UnitGroup("voltage", "V", ("200 V",)),
    UnitGroup("electrical resistance", "ohm", ("0.3 ohm", "300 mohm")),
    UnitGroup("kinematic viscosity", "m2/s", ("30 mm2/s", "30 cSt")),
    UnitGroup("density", "kg/m3", ("7800 kg/m3", "7.8 t/m3")),
)
