"""Factors to SI of the units that model files use most: files that need no other are read without loading pint,
which takes longer than a modal analysis of a rotor.

They are pint's own numbers, to the last bit, so that a file reads the same with and without this table;
tests/unit/test_quantity.py asks pint for each of them. A unit that is not here is looked up by pint.
"""

from __future__ import annotations

# Dimension -> unit -> factor. A unit has blanks for "*", u for micro and no "^", as `quantity.py` looks it up: "kg mm2".
# Speeds, frequencies, temperatures and ratios have tables of their own there.
COMMON_UNITS: dict[str, dict[str, float]] = {
    "length": {
        "m": 1.0,
        "mm": 0.001,
        "cm": 0.01,
        "um": 1e-06,
        "nm": 1e-09,
        "km": 1000.0,
        "in": 0.0254,
        "inch": 0.0254,
        "ft": 0.30479999999999996,
    },
    "angle": {
        "rad": 1.0,
        "mrad": 0.001,
        "deg": 0.017453292519943295,
        "degree": 0.017453292519943295,
        "arcmin": 0.00029088820866572163,
        "arcsec": 4.84813681109536e-06,
    },
    "time": {"s": 1.0, "ms": 0.001, "us": 1e-06, "min": 60.0, "h": 3600.0},
    "rate": {"1/s": 1.0, "1/ms": 1000.0},
    "mass": {"kg": 1.0, "g": 0.001, "t": 1000.0, "lb": 0.4535923700000001},
    "inertia": {"kg m2": 1.0, "kg mm2": 1e-06, "kg cm2": 0.0001, "g mm2": 1e-09, "lbf in s2": 0.11298482902761671},
    "density": {"kg/m3": 1.0, "g/cm3": 999.9999999999999, "kg/dm3": 999.9999999999999, "t/m3": 1000.0},
    "modulus": {"Pa": 1.0, "kPa": 1e3, "MPa": 1e6, "GPa": 1e9, "N/mm2": 1e6, "psi": 6894.7572931683635},
    "torque": {"N m": 1.0, "Nm": 1.0, "kN m": 1e3, "N mm": 0.001, "Nmm": 0.001, "lbf in": 0.11298482902761671},
    "power": {"W": 1.0, "kW": 1000.0, "MW": 1000000.0},
    "stiffness": {
        "N/m": 1.0,
        "N/mm": 1000.0,
        "N/um": 1000000.0,
        "kN/mm": 1000000.0,
        "MN/m": 1000000.0,
        "kN/m": 1000.0,
        "lbf/in": 175.12683524647645,
    },
    "stiffness_per_area": {"N/m3": 1.0},
    "rotational_stiffness": {
        "N m/rad": 1.0,
        "Nm/rad": 1.0,
        "N m/deg": 57.29577951308232,
        "N m": 1.0,
        "kN m/rad": 1000.0,
        "lbf in/rad": 0.11298482902761671,
    },
    "unbalance": {"kg m": 1.0, "g mm": 1e-06, "g m": 0.001, "kg mm": 0.001, "g cm": 1e-05},
    "acceleration": {"m/s2": 1.0, "mm/s2": 0.001},
    "force": {"N": 1.0, "kN": 1000.0, "MN": 1000000.0, "mN": 0.001, "lbf": 4.4482216152605005},
    "viscosity": {"Pa s": 1.0, "mPa s": 0.001, "N s/m2": 1.0},
    "specific_heat": {"J/(kg K)": 1.0, "kJ/(kg K)": 1000.0},
    "damping": {"N s/m": 1.0, "kN s/m": 1000.0, "N s/mm": 1000.0},
    "rotational_damping": {"N m s/rad": 1.0, "N m s": 1.0},
}
