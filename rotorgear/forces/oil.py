"""Viscosity of mineral oil over temperature, and the one temperature of a film in heat balance.

Vogel's equation for oils of a viscosity index near 100, in the form of DIN 31652-2, with the temperature theta in deg C, the
kinematic viscosity nu at 40 deg C that names the grade of ISO 3448, and mu_x = 0.18 mPa s:

    mu = mu_x (rho nu/mu_x)^(159.56/(theta + 95) - 0.181913)

The oil that leaves a film at its sides, Q, is what flows in anew. It carries the share s of the power loss P away, from the inlet
temperature T_1 to the outlet temperature T_2, and the viscosity is that at the mean of the two (ISO 7902-1, DIN 31652-1):

    s P = rho c Q (T_2 - T_1),   T = (T_1 + T_2)/2

With the shaft at one place P is in proportion to mu and Q does not depend on it, so that T = T_1 + a mu(T)/2 with
a = s P/(mu rho c Q) has one solution: mu falls with T.
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq

CELSIUS = 273.15
# Of ISO 3448, in mm^2/s at 40 deg C.
GRADES = (10, 15, 22, 32, 46, 68, 100, 150, 220, 320, 460, 680, 1000)
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
    power = _SLOPE / (temperature - CELSIUS + _POLE) - _SHIFT
    return float(_LEAST_VISCOSITY * (density * grade / _LEAST_VISCOSITY) ** power)


def oil_temperature(grade: float, density: float, viscosity: float) -> float:
    """Return the temperature in K at which the oil has a dynamic viscosity in Pa s."""
    power = np.log(viscosity / _LEAST_VISCOSITY) / np.log(density * grade / _LEAST_VISCOSITY)
    return float(_SLOPE / (power + _SHIFT) - _POLE + CELSIUS)


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
