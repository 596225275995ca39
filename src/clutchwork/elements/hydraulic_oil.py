"""Oil whose viscosity and density follow its temperature."""

from __future__ import annotations

from typing import Any

from clutchwork.declare import Component, Found, Role, Signal, SignalLike, State, ThermalNode, component, param, signal
from clutchwork.elements.bases.ratios import at_start
from clutchwork.gearbox.losses import Oil

# temperature at which densities are given, the usual one, and that below which oil is solid [K]
DENSE, USUAL, COLDEST = 288.15, 353.15, 200.0


@component(
    Role.PROCESS, states=(State("viscosity", "m2/s", "kinematic viscosity"), State("density", "kg/m3", "density"))
)
class HydraulicOil(Component):
    """Oil: its kinematic viscosity by the law of Walther and its density, where valves and pumps find them.

    `log log(viscosity + 0.7 mm2/s)` is a straight line over the logarithm of the temperature, through the viscosities
    at 40 and at 100 degrees Celsius that a data sheet gives. Give `(oil, "viscosity")` and `(oil, "density")` to the
    elements that it flows through. The oil in them follows the temperature, that of a sump for instance, with a lag.

    Source: C. Walther, Erdöl und Teer 7 (1931) 382; ASTM D341, Standard Practice for Viscosity-Temperature Equations.
    """

    temperature: SignalLike = signal("K", "temperature of the oil", default=USUAL, above=0.0)
    viscosity_40: float = param(
        "m2/s", "kinematic viscosity at 40 degrees Celsius", above=5e-7, below=1e-2, example=30e-6
    )
    viscosity_100: float = param(
        "m2/s", "kinematic viscosity at 100 degrees Celsius", above=5e-7, below=1e-2, example=6e-6
    )
    density_15: float = param("kg/m3", "density at 15 degrees Celsius", default=850.0, above=0.0)
    expansion: float = param("1/K", "its loss of density per kelvin, over that", default=7.5e-4, at_least=0.0)
    lag: float = param(
        "s", "time constant with which the oil in valves follows the temperature", default=0.1, above=0.0
    )

    def problems(self) -> Found:
        if self.viscosity_40 > self.viscosity_100:
            return []
        return [
            ("viscosity_100", f"is not below {self.viscosity_40:g} m2/s, that at 40 °C", "give a thinner oil there")
        ]

    def at(self, kelvin: float) -> tuple[float, float]:
        """Kinematic viscosity [m2/s] and density [kg/m3] at a temperature [K] of 200 K or more: equation (1)."""
        kelvin = max(kelvin, COLDEST)
        density = self.density_15 * (1.0 - self.expansion * (kelvin - DENSE))
        return Oil(self.viscosity_40, self.viscosity_100).viscosity(kelvin), density

    def initial_states(self) -> tuple[float, ...]:
        """Viscosity and density at the temperature at the start."""
        given: Any = self.temperature
        value = given.temperature if isinstance(given, ThermalNode) else given
        known = isinstance(value, int | float | Signal | Component | tuple)
        return self.at(at_start(value) if known else USUAL)

    def state_scales(self) -> tuple[float, ...]:
        """The solver follows the viscosity in mm2/s."""
        return (1e-6, 1.0)
