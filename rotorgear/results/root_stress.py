"""Result of tooth root stresses over the mesh cycle: at the 30 degree tangent and where they are largest."""

from __future__ import annotations

import numpy as np

from rotorgear.results.result import Result
from rotorgear.results.schema import Record, of


class GearRootStress(Record):
    """One gear: largest principal stress in the fillet of the loaded side while a tooth passes through the mesh."""

    name: str = of("name", note=" of the gear")
    phase: np.ndarray = of(
        "position of the tooth", "", "phase", note=" in mesh periods from its contact at the pitch point"
    )
    at_tangent: np.ndarray = of(
        "stress at the 30 degree tangent", "Pa", "phase", json="at_tangent_pa", note=", largest along the face"
    )
    largest: np.ndarray = of("largest stress of the fillet", "Pa", "phase", json="largest_pa")
    tangent_diameter: float = of("diameter of the 30 degree tangent", "m", json="tangent_diameter_m")
    tangent_thickness: float = of("thickness of the tooth there", "m", json="tangent_thickness_m")
    worst_at_tangent: float = of(
        "largest stress at the 30 degree tangent in the cycle", "Pa", json="worst_at_tangent_pa"
    )
    worst_at_tangent_phase: float = of("its position", note=" in mesh periods")
    worst: float = of("largest stress in the cycle", "Pa", json="worst_pa")
    worst_phase: float = of("position of the largest stress", note=" in mesh periods")
    worst_diameter: float = of("diameter of the largest stress", "m", json="worst_diameter_m")
    worst_z: float = of(
        "place of the largest stress along the face",
        "m",
        json="worst_z_m",
        note=", from its middle; 0 for a plane model",
    )
    nominal: float | None = of(
        "nominal stress of ISO 6336-3 without factors of load",
        "Pa",
        json="nominal_pa",
        note=": method B, the whole load at the outer point of single contact; `null` where there is none",
    )


class RootStress(Result, kind="root_stress"):
    """Both gears of the first helix of a mesh."""

    title: str = of("title of the model")
    mesh: str = of("mesh", note=": its name")
    preset: str = of("preset of the finite elements")
    pinion_torque_n_m: float = of("torque on the pinion about +z", "N m")
    positions: int = of("positions in the mesh period")
    gears: tuple[GearRootStress, GearRootStress] = of("both gears", "", "pinion_and_gear", record=GearRootStress)
