"""Twist of the 6 mm shaft under a torque, by statics, with some length at each end rigid."""

from __future__ import annotations

import rotorgear as rg

LENGTH = 0.342
DIAMETER = 0.006
SHEAR_MODULUS = 80e9
TORQUE = 1.0


def measure(quantity: str, mode: str) -> float:
    """Torsional stiffness in N m/rad with so many mm rigid at each end."""
    seat = 1e-3 * float(mode or 0.0)
    whole = {"outer_diameter": DIAMETER}
    ends = [{**whole, "length": seat, "rigid": True}] if seat else []
    model = rg.Model(
        motions=("torsion",),
        materials={"steel": {"youngs_modulus": 2.6 * SHEAR_MODULUS, "poisson_ratio": 0.3, "density": 7850.0}},
        shafts={"s": {"material": "steel", "sections": [*ends, {**whole, "length": LENGTH - 2.0 * seat}, *ends]}},
        supports={"held": {"shaft": "s", "at": "start", "fixed": ["torsion"]}},
        loads={"twist": {"shaft": "s", "at": "end", "moment": (0.0, 0.0, TORQUE)}},
        points={"end": {"shaft": "s", "at": "end", "direction": "torsion"}},
    )
    return TORQUE / rg.static(model).point_displacement["end"]
