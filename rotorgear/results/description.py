"""What a model file describes: speeds, torques, meshes, masses, degrees of freedom, warnings."""

from __future__ import annotations

from rotorgear.results.result import Result
from rotorgear.results.schema import Record, of


class ShaftRow(Record):
    """A shaft, with what is on it."""

    name: str = of("name")
    speed_ratio: float = of("speed over that of the input shaft", note="; negative: turns the other way")
    speed_rpm: float | None = of("speed of the shaft", "rpm", note="; `null` without an operating speed")
    length_m: float = of("length", "m")
    shaft_mass_kg: float = of("mass of the shaft itself", "kg")
    body_mass_kg: float = of("mass of gears, disks and point masses on it", "kg")
    polar_inertia_kg_m2: float = of("moment of inertia about z of all that", "kg m^2")


class GearRow(Record):
    """A gear on its shaft."""

    name: str = of("name")
    shaft: str = of("shaft")
    teeth: int | None = of("number of teeth")
    hand: str | None = of("hand of the helix", note="; of a herringbone: of that at the smaller z")
    base_radius_m: float = of("base radius", "m")
    z_m: tuple[float, ...] = of("z of its nodes", "m", "node")
    clocking_deg: float = of(
        "angle of a tooth's middle from the mark of its shaft", "deg", note=", given or what closes a loop"
    )
    mass_kg: float = of("mass", "kg")
    polar_inertia_kg_m2: float = of("moment of inertia about z", "kg m^2")


class PlaceRow(Record):
    """Where a part stands that is no gear."""

    part: str = of("address of the part")
    shaft: str = of("shaft it stands on")
    z_m: float = of("z", "m")


class MeshRow(Record):
    """A mesh: what follows from its gears and axes, at the operating point. None is what is not known for lumped gears."""

    name: str = of("name")
    pinion: str = of("gear that the file calls the pinion")
    gear: str = of("gear that meshes with the pinion")
    ratio: float = of("teeth of the gear over those of the pinion")
    centre_distance_m: float | None = of("distance of the axes", "m")
    centre_line_deg: float = of("direction from pinion to gear", "deg", note=", from +x")
    pressure_angle_deg: float = of("working transverse pressure angle", "deg")
    base_helix_angle_deg: float = of("base helix angle", "deg")
    transverse_contact_ratio: float | None = of("transverse contact ratio")
    overlap_ratio: float | None = of("overlap ratio", note=", of one helix")
    mesh_frequency_hz: float | None = of("mesh frequency", "Hz")
    phase_pitches: tuple[float | None, ...] = of(
        "phase of each helix in pitches", "", "helix", note=", when the mark of the input shaft points to +x"
    )
    normal_force_n: tuple[float, ...] = of("mean force along the flank normal", "N", "helix", note=", of each helix")
    driver: str = of("gear that drives")
    flank_assumed: bool = of("whether the working flank is an assumption", note=": no torque flows")
    stiffness_n_per_m: float = of("stiffness along the flank normal", "N/m", note=", of all helices")
    damping_n_s_per_m: float = of("damping coefficient along the flank normal", "N s/m", note=", of all helices")


class TorqueRow(Record):
    """A torque on a shaft: N m about +z where the input turns positively, and the power it brings in W (None without a speed)."""

    name: str = of("where the torque is given", note=": a load, `operation`, or its output")
    shaft: str = of("shaft it acts on")
    torque_n_m: float = of("torque about +z", "N m")
    power_w: float | None = of("power it brings", "W", note="; negative: takes")


class ModelDescription(Result, kind="check"):
    """All that `rotorgear check` shows."""

    title: str = of("title of the model")
    reference_shaft: str = of("name of the input shaft")
    speed_rpm: float | None = of("speed of the input shaft", "rpm", note="; `null` without an operating speed")
    shafts: tuple[ShaftRow, ...] = of("shafts", "", "shaft", record=ShaftRow)
    gears: tuple[GearRow, ...] = of("gears", "", "gear", record=GearRow)
    places: tuple[PlaceRow, ...] = of("places of the other parts", "", "place", record=PlaceRow)
    meshes: tuple[MeshRow, ...] = of("meshes", "", "mesh", record=MeshRow)
    torques: tuple[TorqueRow, ...] = of("torques", "", "torque", record=TorqueRow)
    total_mass_kg: float = of("mass of all shafts and what is on them", "kg")
    casing_mass_kg: dict[str, float] = of("mass of each casing", "kg", "CASING", note=", where it is known")
    counts: dict[str, int] = of("number of parts in each table of the file", "", "TABLE")
    nodes: int = of("number of nodes")
    dofs: int = of("degrees of freedom")
    mesh: str = of("the discretisation in words")
