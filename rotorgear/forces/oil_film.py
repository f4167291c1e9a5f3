"""What all oil films on a grid share: the oil, the shaft that turns in it, and the heat balance that gives it its viscosity."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import KW_ONLY, dataclass, replace
from typing import Any, ClassVar, Self

import numpy as np

from rotorgear.forces.inside import OilField
from rotorgear.forces.law import ForceLaw, parameter
from rotorgear.forces.oil import CELSIUS, film_temperature, oil_temperature, oil_viscosity

TURN = 2.0 * np.pi
# Mineral oil does not stay what it is above, deg C.
_HOTTEST = 200.0


@dataclass(frozen=True)
class OilFilm(ForceLaw):
    """A film whose oil has one viscosity: as given, or, with a grade, that of its temperature in heat balance (oil.py)."""

    passive: ClassVar[bool] = False
    shaft_ratio: ClassVar[str] = "order"
    carries_at_rest: ClassVar[bool] = False
    many_kinks: ClassVar[bool] = True

    viscosity: float = parameter("Pa s", "dynamic viscosity mu; with a grade that of the film's temperature", above=0.0)
    _: KW_ONLY
    order: float = parameter("rad/rad", "turns of the shaft for each turn of the reference", 1.0)
    density: float = parameter("kg/m^3", "of the oil, for Reynolds' number and the heat balance", 870.0, above=0.0)
    grade: float = parameter(
        "m^2/s", "kinematic viscosity of the oil at 40 degC; 0: the viscosity is given", 0.0, least=0.0
    )
    inlet_temperature: float = parameter("K", "of the oil that flows in", 313.15, above=0.0)
    heat_share: float = parameter(
        "",
        "share of the power loss that the oil carries away; 0: the film stays at the inlet temperature",
        1.0,
        least=0.0,
        most=1.0,
    )
    specific_heat: float = parameter("J/(kg K)", "of the oil", 1900.0, above=0.0)

    def state_size(self) -> int:
        """Speed of the shaft."""
        return 1

    @abstractmethod
    def inside(self, d: Any, *, angle: float = 0.0, speed: float = 0.0) -> OilField:
        """Pressure, gap, side flow and power loss with the shaft at rest at displacements d (k,)."""

    @property
    def heats(self) -> bool:
        """Whether its viscosity follows from its heat balance."""
        return self.grade > 0.0 and self.heat_share > 0.0

    @property
    def temperature(self) -> float | None:
        """Temperature in K that belongs to the viscosity; None where the viscosity is given."""
        return oil_temperature(self.grade, self.density, self.viscosity) if self.grade else None

    def warmed(self, d: Any, speed: float) -> Self:
        """The film with the viscosity of its heat balance, with the shaft at rest at displacements d (k,)."""
        if not self.heats:
            return self
        field = self.inside(d, speed=speed)
        carried = self.density * self.specific_heat * field.side_flow
        heat = self.heat_share * field.power_loss / self.viscosity
        rise = heat / carried if carried > 0.0 else np.inf * heat if heat else 0.0
        T = film_temperature(self.grade, self.density, self.inlet_temperature, rise)
        return replace(self, viscosity=oil_viscosity(self.grade, self.density, T))

    def kept_at(self, temperature: float | None, inlet: float | None) -> Self:
        """The film of motions in time, which are too fast to warm it: at one temperature (K), with its inlet (rad) in one place.

        None leaves what follows from no equilibrium as it is.
        """
        kept: dict[str, Any] = {}
        if temperature is not None:
            viscosity = oil_viscosity(self.grade, self.density, temperature)
            kept = {"viscosity": viscosity, "inlet_temperature": temperature, "heat_share": 0.0}
        if inlet is not None:
            kept |= {"follows": False, "inlet": inlet}
        return replace(self, **kept)

    def too_hot(self) -> str:
        """Why the film does not hold at its temperature, as a clause; or ""."""
        T = self.temperature if self.heats else None
        if T is None or T - CELSIUS <= _HOTTEST:
            return ""
        return (
            f"the film would be at {T - CELSIUS:.3g} degC, hotter than mineral oil bears (at most {_HOTTEST:g} degC): too little "
            "oil leaves it for its power loss; check clearance, grade, speed and load, or give the viscosity"
        )

    @property
    def heat_left_out(self) -> str:
        """What of the heat is left out, as a clause."""
        if not self.grade:
            return "heat"
        if not self.heat_share:
            return "heat of the film's own, which is at the inlet temperature"
        return "differences of temperature within the film, changes of it in small and fast motions"
