"""Largest pressure in the film of a plain journal bearing under a load."""

from __future__ import annotations

import rotorgear as rg


def measure(quantity: str, mode: str) -> float:
    """Pressure in kPa at rpm and N such as "250 rpm 150 N"."""
    speed, _, load, _ = quantity.removeprefix("pressure at ").split()
    rotor = rg.Model(
        motions=("bending",),
        operation={"input_shaft": "s", "speed": f"{speed} rpm"},
        materials={"steel": {"youngs_modulus": 2.06e11, "poisson_ratio": 0.3, "density": 7850.0}},
        shafts={"s": {"material": "steel", "sections": [{"length": 0.04, "outer_diameter": 0.03997}]}},
        bearings={
            "film": {
                "shaft": "s",
                "at": "20 mm",
                "journal": {"diameter": "40 mm", "length": "40 mm", "clearance": "75 um", "viscosity": "45 mPa s"},
            }
        },
        supports={"upright": {"shaft": "s", "at": "20 mm", "fixed": ["tilt_x", "tilt_y"]}},
        loads={"pull": {"shaft": "s", "at": "20 mm", "force": (0.0, -float(load), 0.0)}},
    )
    film = rg.bearing(rotor, "film", stability=False).film
    assert film is not None
    return 1e-3 * film.largest_pressure
