"""A spur pair on two short shafts with everything that a transient takes, as a model that is solved in a blink."""

from __future__ import annotations

import copy
from typing import Any

import rotorgear as rg

_DATA: dict[str, Any] = {
    "title": "Spur pair",
    "operation": {"input_shaft": "one", "output_shaft": "two", "speed": "1500 rpm", "torque": "200 N m"},
    "materials": {"steel": {"youngs_modulus": "206 GPa", "poisson_ratio": 0.3, "density": "7850 kg/m^3"}},
    "shafts": {
        "one": {
            "position": ["0 mm", "0 mm"],
            "material": "steel",
            "sections": [{"length": "120 mm", "outer_diameter": "40 mm"}],
        },
        "two": {
            "position": ["120 mm", "0 mm"],
            "material": "steel",
            "sections": [{"length": "120 mm", "outer_diameter": "50 mm"}],
        },
    },
    "gears": {
        "pinion": {
            "shaft": "one",
            "at": "60 mm",
            "kind": "spur",
            "teeth": 24,
            "normal_module": "4 mm",
            "width": "30 mm",
        },
        "wheel": {
            "shaft": "two",
            "at": "60 mm",
            "kind": "spur",
            "teeth": 36,
            "normal_module": "4 mm",
            "width": "30 mm",
        },
    },
    "meshes": {
        "pair": {
            "pinion": "pinion",
            "gear": "wheel",
            "stiffness": "3e8 N/m",
            "damping_ratio": 0.05,
            "transmission_error": [
                {"harmonic": 1, "amplitude": "4 um"},
                {"harmonic": 2, "amplitude": "1 um", "phase": "40 deg"},
            ],
        }
    },
    "bearings": {
        name: {
            "shaft": shaft,
            "at": at,
            "stiffness": {"radial": "2e8 N/m", "axial": "5e7 N/m"},
            "damping": {"radial": "3e3 N s/m", "axial": "1e3 N s/m"},
        }
        for name, shaft, at in (("a", "one", "start"), ("b", "one", "end"), ("c", "two", "start"), ("d", "two", "end"))
    },
    "damping": {"rayleigh_beta": "2e-6 s"},
    "points": {"housing": {"on": "bearings.d", "direction": "y"}},
}


def spur_pair(**changes: Any) -> rg.Model:
    """Return the model; `changes` by address, with __ between names: meshes__pair__backlash="0.1 mm". None removes."""
    data = copy.deepcopy(_DATA)
    for address, value in changes.items():
        *way, last = address.split("__")
        place = data
        for name in way:
            place = place.setdefault(name, {})
        if value is None:
            place.pop(last, None)
        else:
            place[last] = value
    return rg.Model(**data)
