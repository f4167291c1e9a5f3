"""What a model file describes: speeds, torques, meshes, masses, degrees of freedom, warnings."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any


@dataclass(frozen=True)
class ShaftRow:
    """A shaft: speed over that of the input, speed in rpm (None without one), length in m, mass in kg of shaft and bodies on it,
    polar inertia in kg m^2 of both.
    """

    name: str
    speed_ratio: float
    speed_rpm: float | None
    length_m: float
    shaft_mass_kg: float
    body_mass_kg: float
    polar_inertia_kg_m2: float


@dataclass(frozen=True)
class MeshRow:
    """A mesh: what follows from its gears and axes, at the operating point. None is what is not known for lumped gears."""

    name: str
    pinion: str
    gear: str
    ratio: float
    centre_distance_m: float | None
    centre_line_deg: float
    pressure_angle_deg: float
    base_helix_angle_deg: float
    transverse_contact_ratio: float | None
    overlap_ratio: float | None
    mesh_frequency_hz: float | None
    normal_force_n: tuple[float, ...]
    driver: str
    flank_assumed: bool
    stiffness_n_per_m: float
    damping_n_s_per_m: float


@dataclass(frozen=True)
class TorqueRow:
    """A torque on a shaft: N m about +z where the input turns positively, and the power it brings in W (None without a speed)."""

    name: str
    shaft: str
    torque_n_m: float
    power_w: float | None


@dataclass(frozen=True)
class ModelDescription:
    """All that `rotorgear check` shows."""

    title: str
    reference_shaft: str
    speed_rpm: float | None
    shafts: tuple[ShaftRow, ...]
    meshes: tuple[MeshRow, ...]
    torques: tuple[TorqueRow, ...]
    total_mass_kg: float
    counts: dict[str, int]
    nodes: int
    dofs: int
    mesh: str
    left_out: tuple[str, ...]
    warnings: tuple[str, ...]

    def to_dict(self) -> dict[str, Any]:
        """Plain values for JSON; the keys are the attributes'."""
        return {"analysis": "check", **asdict(self)}
