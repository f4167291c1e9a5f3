"""What a model file describes: speeds, torques, meshes, masses, degrees of freedom, warnings."""

from __future__ import annotations

import math
from collections.abc import Iterator

from rotorgear.quantity import counted
from rotorgear.results.result import Result
from rotorgear.results.schema import Record, of
from rotorgear.results.table import Block, Line, Table, grid, table_of, written

_GEAR_LEGEND = "r_b: base radius; z of its nodes; angle of a tooth's middle from the mark of its shaft"
_MESH_LEGEND = (
    "at: direction from pinion to gear from +x; a_wt: working transverse pressure angle; beta_b: base helix angle in deg; "
    "eps: contact ratios, transverse and overlap (of one helix)"
)
_BEVEL_LEGEND = "; of bevel gears those on the pinion at its mean point, towards its axis and away from the apex"
_FORCE_LEGEND = (
    "phase: in pitches, when the mark of the input shaft points to +x; "
    "forces on one helix: normal to the flank, tangential and radial at the working circle, axial; "
    "L and R: helix at the smaller and the larger z"
)


class ShaftRow(Record):
    """A shaft, with what is on it."""

    name: str = of("name", column="shaft")
    speed_ratio: float = of(
        "speed over that of the input shaft", note="; negative: turns the other way", form="+.6f", column="ratio"
    )
    speed_rpm: float | None = of(
        "speed of the shaft", "rpm", note="; `null` without an operating speed", form=".2f", column="rpm"
    )
    length_m: float = of("length", "m", form=".2f", column="length mm")
    shaft_mass_kg: float = of("mass of the shaft itself", "kg", form=".3f", column="shaft kg")
    body_mass_kg: float = of("mass of gears, disks and point masses on it", "kg", form=".3f", column="bodies kg")
    polar_inertia_kg_m2: float = of("moment of inertia about z of all that", "kg m^2", form=".5g", column="Ip kg m2")


class GearRow(Record):
    """A gear on its shaft."""

    name: str = of("name", column="gear")
    shaft: str = of("shaft", column="shaft")
    teeth: int | None = of("number of teeth", column="teeth")
    hand: str | None = of("hand of the helix", note="; of a herringbone: of that at the smaller z", column="hand")
    base_radius_m: float = of("base radius", "m", form=".3f", column="r_b mm")
    z_m: tuple[float, ...] = of("z of its nodes", "m", "node", form=".5g", column="z mm")
    clocking_deg: float = of(
        "angle of a tooth from the mark", "deg", note=", given or closing a loop", form=".3f", column="angle deg"
    )
    mass_kg: float = of("mass", "kg", form=".3f", column="kg")
    polar_inertia_kg_m2: float = of("moment of inertia about z", "kg m^2")


class PlaceRow(Record):
    """Where a part stands that is no gear."""

    part: str = of("address of the part")
    shaft: str = of("shaft it stands on")
    z_m: float = of("z", "m")


class MeshRow(Record):
    """A mesh: what follows from its gears and axes, at the operating point. None is what is not known for lumped gears."""

    name: str = of("name", column="mesh")
    pinion: str = of("gear that the file calls the pinion")
    gear: str = of("gear that meshes with the pinion")
    ratio: float = of("teeth of the gear over those of the pinion", form=".4f", column="ratio")
    centre_distance_m: float | None = of("distance of the axes", "m", form=".3f", column="axes mm")
    centre_line_deg: float = of("direction from pinion to gear", "deg", note=", from +x", form=".2f", column="at deg")
    pressure_angle_deg: float = of("working transverse pressure angle", "deg", form=".3f", column="a_wt deg")
    base_helix_angle_deg: float = of("base helix angle", "deg", form=".3f", column="beta_b")
    transverse_contact_ratio: float | None = of("transverse contact ratio", form=".3f", column="eps_a")
    overlap_ratio: float | None = of("overlap ratio", note=", of one helix", form=".3f", column="eps_b")
    mesh_frequency_hz: float | None = of("mesh frequency", "Hz", form=".2f", column="mesh Hz")
    phase_pitches: tuple[float | None, ...] = of(
        "phase of each helix in pitches", "", "helix", note=", when the mark of the input shaft points to +x"
    )
    normal_force_n: tuple[float, ...] = of("mean force along the flank normal", "N", "helix", note=", of each helix")
    driver: str = of("gear that drives")
    flank_assumed: bool = of("whether the working flank is an assumption", note=": no torque flows")
    stiffness_n_per_m: float | None = of(
        "stiffness along the flank normal", "N/m", note=", of all helices; `null` of a rigid mesh"
    )
    damping_n_s_per_m: float = of("damping coefficient along the flank normal", "N s/m", note=", of all helices")
    bevel_radial_force_n: float | None = of(
        "force on the pinion towards its axis", "N", note=", of bevel gears", default=None
    )
    bevel_axial_force_n: float | None = of(
        "force on the pinion away from the apex", "N", note=", of bevel gears; negative: towards it", default=None
    )


class TorqueRow(Record):
    """A torque on a shaft: N m about +z where the input turns positively, and the power it brings in W (None without a speed)."""

    name: str = of("where the torque is given", note=": a load, `operation`, or its output", column="load")
    shaft: str = of("shaft it acts on", column="shaft")
    torque_n_m: float = of("torque about +z", "N m", form=".2f", column="torque N m about z")
    power_w: float | None = of("power it brings", "W", note="; negative: takes", form=".3f", column="power in kW")


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

    def tables(self) -> Iterator[Block]:
        """Shafts, gears, meshes, forces, torques and notes."""
        speed = "no speed given"
        if self.speed_rpm is not None:
            speed = f"input shaft '{self.reference_shaft}' at {self.speed_rpm:.6g} rpm"
        yield Line(self.title or "Model")
        yield f"{speed}; {', '.join(counted(number, name) for name, number in self.counts.items())}"
        yield from ("", table_of(self, "shafts"))
        if self.gears:
            yield from ("", table_of(self, "gears"), Line(rest=_GEAR_LEGEND, dim=True))
        if self.places:
            parts_on: dict[str, list[str]] = {}
            for place in self.places:
                parts_on.setdefault(place.shaft, []).append(f"{place.part} {1e3 * place.z_m:.5g}")
            rows = [(shaft, ", ".join(parts)) for shaft, parts in parts_on.items()]
            yield from ("", grid(rows, "shaft", "z mm of the other parts on it", left=2, caption="Other parts"))
        if self.meshes:
            yield from ("", table_of(self, "meshes"), Line(rest=_MESH_LEGEND, dim=True))
            bevel = any(mesh.bevel_axial_force_n is not None for mesh in self.meshes)
            yield from ("", self._forces(), Line(rest=_FORCE_LEGEND + _BEVEL_LEGEND * bevel, dim=True))
        if self.torques:
            yield from ("", table_of(self, "torques"))
        mass = f"total mass {self.total_mass_kg:.6g} kg; " if self.total_mass_kg else ""
        if self.casing_mass_kg:
            casings = ", ".join(f"{name} {kg:.6g} kg" for name, kg in self.casing_mass_kg.items())
            mass = f"mass of shafts and what is on them {self.total_mass_kg:.6g} kg, of casing {casings}; "
        yield from ("", f"{mass}{self.nodes} nodes, {self.dofs} dofs with {self.mesh}", *self.remarks(), "")

    def _forces(self) -> Table:
        """Forces on each helix from F_n: F_t = F_n cos(beta_b) cos(alpha_wt), F_r = F_n cos(beta_b) sin(alpha_wt),
        F_a = F_n sin(beta_b); stiffness and damping of a mesh are shared evenly."""
        rows = []
        for mesh in self.meshes:
            alpha = math.radians(mesh.pressure_angle_deg)
            beta = math.radians(mesh.base_helix_angle_deg)
            transverse = math.cos(beta) * math.cos(alpha), math.cos(beta) * math.sin(alpha)
            helices = len(mesh.normal_force_n)
            for k, force in enumerate(mesh.normal_force_n):
                shares = [force * share for share in (1.0, *transverse, math.sin(beta))]
                if mesh.bevel_radial_force_n is not None and mesh.bevel_axial_force_n is not None:
                    shares[2:] = mesh.bevel_radial_force_n, mesh.bevel_axial_force_n
                rows.append(
                    (
                        mesh.name if helices == 1 else f"{mesh.name} {'LR'[k]}",
                        f"{mesh.driver} (assumed)" if mesh.flank_assumed else mesh.driver,
                        written(mesh.phase_pitches[k], ".3f"),
                        *(f"{share:.5g}" for share in shares),
                        "rigid" if mesh.stiffness_n_per_m is None else f"{mesh.stiffness_n_per_m / helices:.4g}",
                        f"{mesh.damping_n_s_per_m / helices:.4g}",
                    )
                )
        heads = ("mesh", "driver", "phase", "F_n N", "F_t N", "F_r N", "F_a N", "k N/m", "c N s/m")
        return grid(rows, *heads, left=2, caption="Forces between the teeth")
