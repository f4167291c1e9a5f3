"""Force laws of bearings from the geometry in the model file."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rotorgear.errors import AnalysisError
from rotorgear.model.parts.supports import Bearing

if TYPE_CHECKING:
    from rotorgear.forces.law import ForceLaw

# Temperatures in deg C beyond which mineral oil is no liquid, and Vogel's equation no viscosity.
_CELSIUS = 273.15
_LIQUID = (-60.0, 200.0)


def check_oil(address: str, bearing: Bearing) -> None:
    """The oil of a film in heat balance flows in as a liquid.

    Raises:
        AnalysisError: it does not.
    """
    given = bearing.film.inlet_temperature if bearing.film is not None else None
    if given is not None and not _LIQUID[0] <= given - _CELSIUS <= _LIQUID[1]:
        raise AnalysisError(
            f"{address}: the oil would flow in at {given - _CELSIUS:.4g} degC, where mineral oil is no liquid "
            f"({_LIQUID[0]:g} to {_LIQUID[1]:g} degC); check inlet_temperature and its unit"
        )


def bearing_law(bearing: Bearing, ratio: float, sense: float) -> ForceLaw:
    """The law of a bearing that has one.

    Args:
        bearing: with a geometry. ratio: turns of its shaft for each turn of the reference.
        sense: of rotation of the reference for which it is built, 1 or -1.
    """
    assert bearing.geometry is not None
    linear = [row[i] for i, row in enumerate(bearing.stiffness.as_rows())] if bearing.stiffness else [0.0] * 6
    return bearing.geometry.law(ratio, sense, linear)
