"""What all oil films on a grid share: the oil and its heat balance, its flow and friction, and the journal bearings among them.

Viscosity over temperature is Vogel's equation for mineral oils of a viscosity index near 100, in the form of DIN 31652-2, with
the temperature theta in deg C, the kinematic viscosity nu at 40 deg C that names the grade of ISO 3448, and mu_x = 0.18 mPa s:

    mu = mu_x (rho nu/mu_x)^(159.56/(theta + 95) - 0.181913)

The oil that leaves a film at its sides, Q, is what flows in anew. It carries the share s of the power loss P away, from the inlet
temperature T_1 to the outlet temperature T_2, and the viscosity is that at the mean of the two (ISO 7902-1, DIN 31652-1):

    s P = rho c Q (T_2 - T_1),   T = (T_1 + T_2)/2

With the shaft at one place P is in proportion to mu and Q does not depend on it, so that T = T_1 + a mu(T)/2 with
a = s P/(mu rho c Q) has one solution: mu falls with T.

Each end of a film lets out  h^3/(12 mu) |dp/dz|  a length. The journal feels  mu U/h + h/2 dp/dx, and where the film has broken
mu U/h as if it were whole, as Raimondi and Boyd (ASLE Trans. 1 (1958) 159) have it: oil in streamers drags less, so that this is
the most.
"""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import KW_ONLY, dataclass, replace
from typing import Any, ClassVar, Self

import numpy as np
from scipy.optimize import brentq

from rotorgear.forces.inside import FilmField, OilField
from rotorgear.forces.law import ForceLaw, parameter, refuse
from rotorgear.quantity import ZERO_CELSIUS

TURN = 2.0 * np.pi
# Mineral oil does not stay what it is above, deg C.
_HOTTEST = 200.0
# Beyond these the equation or the grid does not describe the film: diameters, share of the clearance, Taylor's number.
_LONGEST = 2.0
_DEEPEST = 0.95
_TAYLOR = 41.2
_LEAST_VISCOSITY = 0.18e-3
_POLE = 95.0
_SLOPE = 159.56
_SHIFT = 0.181913
# Above the inlet temperature, in K: a film that no oil leaves has no temperature at all.
_HOTTEST_RISE = 500.0


def oil_viscosity(grade: float, density: float, temperature: float) -> float:
    """Return the dynamic viscosity in Pa s.

    Args:
        grade: kinematic viscosity at 40 deg C in m^2/s. density: kg/m^3. temperature: K.
    """
    power = _SLOPE / (temperature - ZERO_CELSIUS + _POLE) - _SHIFT
    return float(_LEAST_VISCOSITY * (density * grade / _LEAST_VISCOSITY) ** power)


def oil_temperature(grade: float, density: float, viscosity: float) -> float:
    """Return the temperature in K at which the oil has a dynamic viscosity in Pa s."""
    power = np.log(viscosity / _LEAST_VISCOSITY) / np.log(density * grade / _LEAST_VISCOSITY)
    return float(_SLOPE / (power + _SHIFT) - _POLE + ZERO_CELSIUS)


def film_temperature(grade: float, density: float, inlet: float, rise: float) -> float:
    """Return T of the heat balance in K, at most 500 K above the inlet temperature.

    Args:
        grade, density: of the oil. inlet: T_1 in K. rise: a = (T_2 - T_1)/mu in K/(Pa s); infinite where no oil leaves the film.
    """
    if rise <= 0.0:
        return inlet

    def excess(temperature: float) -> float:
        return temperature - inlet - 0.5 * rise * oil_viscosity(grade, density, temperature)

    hottest = inlet + _HOTTEST_RISE
    return hottest if excess(hottest) <= 0.0 else float(brentq(excess, inlet, hottest, xtol=1e-11, rtol=1e-14))


def side_flow(gap: np.ndarray, pressure: np.ndarray, dz: float, step: float, viscosity: float) -> float:
    """Return the oil in m^3/s that leaves a pad at both ends.

    Args:
        gap: (t,) m. pressure: (t, j) Pa, cells from the middle to one end.
        dz, step: of a cell along the shaft and around it, m. viscosity: Pa s.
    """
    # The slope at the end of a film whose profile is a parabola there, as the grid has it.
    end = 2.0 / (1.0 - 1.0 / (3.0 * pressure.shape[1]))
    return float(2.0 * step * np.sum(gap**3 * end * pressure[:, -1] / dz) / (12.0 * viscosity))


def power_loss(
    gap: np.ndarray, pressure: np.ndarray, dz: float, step: float, viscosity: float, velocity: float
) -> float:
    """Return the power in W that the surface of the journal, at a velocity in m/s, puts into a pad.

    The other arguments are those of `side_flow`.
    """
    shear = viscosity * velocity / gap[:, None] + 0.5 * gap[:, None] * np.gradient(pressure, step, axis=0)
    return float(2.0 * velocity * step * dz * np.sum(shear))


@dataclass(frozen=True)
class OilFilm(ForceLaw):
    """A film whose oil has one viscosity: as given, or, with a grade, that of its temperature in heat balance."""

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
        if T is None or T - ZERO_CELSIUS <= _HOTTEST:
            return ""
        return (
            f"the film would be at {T - ZERO_CELSIUS:.3g} degC, hotter than mineral oil bears (at most {_HOTTEST:g} degC): too "
            "little oil leaves it for its power loss; check clearance, grade, speed and load, or give the viscosity"
        )

    @property
    def heat_left_out(self) -> str:
        """What of the heat is left out, as a clause."""
        if not self.grade:
            return "heat"
        if not self.heat_share:
            return "heat of the film's own, which is at the inlet temperature"
        return "differences of temperature within the film, changes of it in small and fast motions"


@dataclass(frozen=True)
class JournalOil(OilFilm):
    """A journal of radius R in a film of length L."""

    grid: ClassVar[tuple[str, ...]] = ("around", "along")
    components: ClassVar[int] = 2

    radius: float = parameter("m", "radius R of the journal", above=0.0)
    length: float = parameter("m", "length L of the bearing", above=0.0)
    clearance: float = parameter("m", "radial clearance c where the gap is least: of lobes, or at pivots", above=0.0)
    _: KW_ONLY
    preload: float = parameter("", "preload m of lobes or pads", 0.0, least=0.0, below=1.0)
    cavitation: str = parameter("", "how the film cavitates", "reynolds", choices=("reynolds", "half_sommerfeld"))
    around: int = parameter("", "cells of the grid around the circle, over all lobes or pads", 240, least=24, most=2000)
    along: int = parameter("", "cells over half the length", 12, least=2, most=200)
    contact: float = parameter(
        "", "displacement over c at which the journal lies on the shell", 0.95, above=0.0, below=1.0
    )
    wall: float = parameter("N/m", "stiffness of the shell", 1e9, least=0.0)

    def check(self) -> None:
        """The bearing is not longer than the grid serves."""
        if self.length > 2.0 * _LONGEST * self.radius:
            raise refuse(self, "length", f"at most {_LONGEST:g} diameters, beyond which shafts bend in their bearing")

    @property
    def cells(self) -> str:
        """Around the journal and along all of it."""
        return f"{self.around} x {2 * self.along}"

    @property
    def extents(self) -> np.ndarray:
        """The clearance, over which pressures around the journal change."""
        return np.full(2, self.clearance)

    @property
    def pad_clearance(self) -> float:
        """Radius of a lobe or pad less that of the journal, c/(1 - m) in m."""
        return self.clearance / (1.0 - self.preload)

    def of_grid(self, around: int, follows: bool, pads: list[tuple[float, float, float]]) -> np.ndarray:
        """Parameters in the order of journal_pressure.py.

        Args:
            around: cells of a pad. follows: whether the inlet does. pads: start, extent and place of the least gap of each.
        """
        own = [self.viscosity, self.radius, self.length, self.clearance, self.order, self.contact, self.wall]
        cut = float(self.cavitation == "half_sommerfeld")
        each = [value for pad in pads for value in pad]
        return np.array([*own, self.preload, around, self.along, cut, float(follows), len(pads), *each])

    def film_field(self, pads: list[tuple[np.ndarray, np.ndarray, np.ndarray, float]], speed: float) -> FilmField:
        """The film at a speed of the reference, from angles (t,), gap (t,), pressure (t, j) and extent in rad of each pad."""
        dz = 0.5 * self.length / self.along
        velocity = self.radius * (self.order * speed)
        flow = 0.0
        loss = 0.0
        for t, h, pressure, extent in pads:
            step = self.radius * extent / (t.size + 1)
            flow += side_flow(h, pressure, dz, step, self.viscosity)
            loss += power_loss(h, pressure, dz, step, self.viscosity, velocity)
        angles, gaps, pressures, _ = zip(*pads, strict=True)
        z = 0.5 * self.length * (np.arange(self.along) + 0.5) / self.along
        return FilmField(np.concatenate(angles), np.concatenate(gaps), np.concatenate(pressures), flow, loss, z)

    def beyond(self, d: Any, speed: float) -> str:
        """Heat, turbulence by Taylor's number, and an eccentricity near the shell."""
        if hot := self.too_hot():
            return hot
        omega = abs(self.order * speed)
        reynolds = self.density * omega * self.radius * self.clearance / self.viscosity
        most = _TAYLOR * np.sqrt(self.radius / self.clearance)
        if reynolds > most:
            return (
                f"the film is turbulent (Reynolds' number {reynolds:.4g}, laminar up to {most:.4g}), which is not modelled; "
                "check viscosity and clearance"
            )
        eccentricity = float(np.hypot(*d)) / self.clearance
        if eccentricity > _DEEPEST:
            return (
                f"the journal runs at {eccentricity:.3g} of the clearance, where the film is too thin for this model (at most "
                f"{_DEEPEST:g}); check load, viscosity, clearance and speed"
            )
        return ""
