"""Result of a static analysis: deflections, forces of meshes and bearings, how branches and helices share the load."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from rotorgear.quantity import RPM_PER_RAD_S
from rotorgear.results.internal_load import InternalLoad, load_named
from rotorgear.results.laws import AboutEquilibrium
from rotorgear.results.modal import NODE_COUNT, NodeTable
from rotorgear.results.schema import Record, Written, derived, force_and_moment, of, rows
from rotorgear.results.table import Block, Cell, Column, Line, Table, error_words, grid, table_of, table_over, written

# The change that one line of the sensitivity table is for, by the end of the parameter's name, and its words.
_STEPS = {
    "index_error": (10e-6, "10 um later"),
    "stiffness": (0.1, "10 % stiffer"),
    "centre_line_angle": (math.radians(1.0), "1 deg on"),
}
_MOST_SENSITIVE = 12


class Share(Record):
    """Share of a mesh in the load of a gear that it drives, or is driven by, together with other meshes.

    The sharing factor K_gamma of the group is the largest factor in it.
    """

    gear: str = of("gear", note=" whose meshes share a load", column="shared by")
    mesh: str = of("mesh", note=": one of these meshes", column="mesh")
    share: float = of("share", note=" of the mesh in the force of them all", form=".3f", column="share %")
    factor: float = of("factor", note=": the share times the number of meshes", form=".4f", column="times mean")
    decided_by: str = of(
        "what decides the share", note=': `"stiffness"` of a loop, or `"loads"`: torques alone', column="decided by"
    )


class LoopAssembly(Record):
    """How a closed loop of gears goes together."""

    mesh: str = of("mesh", note=" that closes the loop")
    gear: str = of("gear", note=' that closes it by its place on the shaft; `""` where all clockings are given')
    clocking_deg: float = of("angle of that gear's tooth from the shaft's mark", "deg")
    rest_pitches: float = of("what is missing where the gear stands at angle 0, or as the file says, in pitches")
    gap_m: float = of("gap along the flank normal that is taken for it", "m", note=", as an index error of the mesh")


class MeshFace(Record):
    """How a helix carries along its face, in equilibrium with its shafts."""

    mesh: str = of("mesh", column="along the face")
    helix: int = of("helix", note=": 0 at the smaller z, 1 at the larger")
    shaft_misalignment_m: float = of(
        "misalignment over the face by the shafts",
        "m",
        note=": f_ma, from the tilt of both gears; positive where the flanks stand apart at larger z",
        form="+.3f",
        column="f_ma um",
    )
    given_misalignment_m: float = of(
        "misalignment over the face that the model gives", "m", form="+.3f", column="given um"
    )
    fed_back: bool = of("whether the teeth feel the misalignment by the shafts", note="; what follows is `null` if not")
    face_load_factor: float | None = of(
        "face load factor", note=" K_Hbeta: largest load per width over the mean one", form=".3f", column="K_Hbeta"
    )
    load_place_m: float | None = of(
        "place of the resulting force", "m", note=" from the face's middle", form="+.3f", column="F at z mm"
    )
    peak_place_m: float | None = of(
        "place of the largest load per width", "m", note=" from the face's middle", form="+.2f", column="peak at mm"
    )
    peak_pressure_pa: float | None = of(
        "largest contact pressure", "Pa", note="; `null` without loaded teeth", form=".1f", column="p_max MPa"
    )
    tilt_stiffness_n_m: float | None = of(
        "stiffness against tilt", "N m", note=": moment for a tilt of the flanks in m/m, about the centre of stiffness"
    )
    z_m: np.ndarray = of("place along the face", "m", "place", note=" from its middle")
    line_load_n_per_m: np.ndarray = of("load per width", "N/m", "place", note=", mean of the mesh cycle")

    @property
    def misalignment_m(self) -> float:
        """The whole misalignment (m): what `misalignment` of the mesh in a file would be for rigid shafts."""
        return self.shaft_misalignment_m + self.given_misalignment_m


class StaticResult(AboutEquilibrium, kind="static"):
    """Static equilibrium of a model with p nodes and c contacts (helices of meshes, in the order of the file).

    `force_derivative` and `share_derivative` are the changes for a unit of each parameter; for a stiffness the unit is 100 %.
    """

    json_axes = ("MESH",)

    speed: float | None = of(
        "speed of the input shaft", "rad/s", note=", for flanks and bearings with tables; `null` without one"
    )
    torque: dict[str, float] = of("applied torque", "N m", "TORQUE", note=" about +z, by name")
    load_force: dict[str, np.ndarray] = of(
        "constant force and moment", "N, N m", "LOAD", "component", json=force_and_moment("load", "the structure")
    )
    contact_mesh: tuple[str, ...] = of("mesh of each contact", "", "contact", json=None)
    contact_helix: np.ndarray = of("0 or 1 for the helix at the smaller or larger z", "", "contact", json=None)
    mesh_force: np.ndarray = of("force along the flank normal", "N", "contact", note=" of each contact", form=".1f")
    mesh_force_on_gear: np.ndarray = of(
        "force of the pinion on the gear", "N", "contact", "xyz", note=", in the frame of the gear's shaft", form=".0f"
    )
    mesh_stiffness: np.ndarray = of(
        "stiffness along the flank normal", "N/m", "contact", note="; of loaded teeth the mean tangent of a mesh cycle"
    )
    mesh_deflection: np.ndarray = of("deflection of the teeth along the flank normal", "m", "contact")
    rigid_mesh: tuple[str, ...] = of(
        "mesh of each contact of rigid meshes", "", "rigid", json="rigid_mesh", default=(), kw_only=True
    )
    rigid_mesh_force: np.ndarray = of(
        "force along the flank normal of a rigid mesh",
        "N",
        "rigid",
        note=", of each contact of it",
        default_factory=lambda: np.zeros(0),
        kw_only=True,
    )
    carries: np.ndarray = of("whether the contact is closed", "", "contact", json="mesh_carries")
    driver: tuple[str, ...] = of(
        "gear that drives",
        "",
        "contact",
        json=Written(
            "mesh_driver",
            lambda result, driver: {mesh: driver[result.contact_mesh.index(mesh)] for mesh in result.contact_mesh},
            axes=("MESH",),
        ),
    )
    helix_share: np.ndarray = of("share of a contact in the force of its mesh", "", "contact")
    shares: tuple[Share, ...] = of("sharing of each gear with several meshes", "", "share", record=Share)

    @derived("largest sharing factor", note=", like K_gamma; 1 where no meshes share")
    def sharing_factor(self) -> float:
        """The largest sharing factor of all groups of meshes; 1 where none shares."""
        return max((row.factor for row in self.shares), default=1.0)

    faces: tuple[MeshFace, ...] = of(
        "load along the faces",
        "",
        "face",
        note=", of meshes that feel the tilt of their shafts, or whose stiffness is that of loaded teeth",
        record=MeshFace,
        default=(),
        kw_only=True,
    )
    passes: int = of(
        "passes until shafts and faces agreed", note="; 0 where no mesh feels the tilt", default=0, kw_only=True
    )
    bearing_force: dict[str, np.ndarray] = of(
        "force and moment on the shaft", "N, N m", "BEARING", "component", json=force_and_moment("bearing")
    )
    support_force: dict[str, np.ndarray] = of(
        "force and moment on the shaft", "N, N m", "SUPPORT", "component", json=force_and_moment("support")
    )
    casing_force: dict[str, np.ndarray] = of(
        "force and moment of the ground on a casing",
        "N, N m",
        "CASING",
        "component",
        json=force_and_moment("casing", "the casing"),
        note=", all that holds it together; the moment about the origin of the model",
        default_factory=dict,
        kw_only=True,
    )
    casing_ground_force: dict[str, np.ndarray] = of(
        "force and moment of the ground on a casing at one held set or mount",
        "N, N m",
        "CASING.SET",
        "component",
        json=force_and_moment("casing_ground", "the casing"),
        note="; the moment about the origin of the model",
        default_factory=dict,
        kw_only=True,
    )
    casing_seat_force: dict[str, np.ndarray] = of(
        "force and moment on a seat of a casing",
        "N, N m",
        "CASING.SEAT",
        "component",
        json=force_and_moment("casing_seat", "the casing"),
        note="; the moment about the point of the seat",
        default_factory=dict,
        kw_only=True,
    )
    nodes: NodeTable = of("nodes", record=NodeTable, json=NODE_COUNT)
    displacement: np.ndarray = of("displacements x y z tx ty tz", "m, rad", "node", "component", json=None)
    point_displacement: dict[str, float] = of(
        "displacement of a named point", "m, rad", "POINT", note=" along its direction"
    )
    sensitivity = rows("what the forces depend on", "parameter")
    parameter: tuple[str, ...] = of(
        "parameter on which the shares depend", "", "parameter", note=", such as `meshes.stage_1a.index_error`"
    )
    parameter_unit: tuple[str, ...] = of(
        "unit", "", "parameter", note=" of the force derivatives; for a stiffness they are for 100 % of it", json="unit"
    )
    force_derivative: np.ndarray = of(
        "derivative of each contact's force", "N over the parameter's unit", "parameter", "contact", json="mesh_force_n"
    )
    share_derivative: np.ndarray = of("derivative of each row of `shares`", "", "parameter", "share", json="share")
    mesh_phase: dict[str, float] = of("phase of a mesh in pitches", "", "MESH", note="; `null` where teeth are missing")
    assembly: tuple[LoopAssembly, ...] = of("how closed loops go together", "", "loop", record=LoopAssembly)
    internal_loads: tuple[InternalLoad, ...] = of(
        "loads inside shafts and couplings",
        "",
        "load",
        note=" at the points that read one",
        record=InternalLoad,
        default=(),
        kw_only=True,
    )
    imbalance: float = of(
        "largest force that is missing for equilibrium",
        note=" at a degree of freedom, relative to the largest of an element or load; moments beside moments",
    )
    error_estimate: float = of(
        "estimated relative discretisation error",
        note=": change of forces when every element is halved",
        form=error_words,
    )
    place_displacement: dict[str, np.ndarray] = of(
        "displacements of parts on shafts", "m, rad", "PLACE", "component", json="displacement", default_factory=dict
    )

    def load_at(self, point: str) -> float:
        """The load that a point reads inside its shaft or coupling, in N or N m.

        Raises:
            AnalysisError: no such point reads a load.
        """
        return load_named(self.internal_loads, point).load

    def contacts_of(self, mesh: str) -> list[int]:
        """Numbers of the contacts of a mesh."""
        return [k for k, name in enumerate(self.contact_mesh) if name == mesh]

    def tables(self, *, sensitivity: bool = False) -> Iterator[Block]:
        """Forces of meshes, faces and supports, load sharing, loops, displacements and notes; sensitivities where asked for."""
        at = "" if self.speed is None else f", {self.model.reference_shaft} at {self.speed * RPM_PER_RAD_S:.6g} rpm"
        yield Line(f"{self.model.title or 'Model'}: statics{at}")
        if self.model.has_turned_axes:
            yield (
                "x y z: forces and displacements on shafts in the frame of their shaft, forces on a gear in that of its shaft, "
                "forces on casings along the axes of the model"
            )
        if self.torque:
            yield f"torques about z: {'; '.join(f'{name} {value:.2f} N m' for name, value in self.torque.items())}"
        for name, load in self.load_force.items():
            if load.any():
                yield f"{name}: {_triple(load[:3])} N, {_triple(load[3:])} N m"
        if self.contact_mesh:
            yield from ("", self._meshes())
        if self.rigid_mesh:
            forces = zip(self.rigid_mesh, self.rigid_mesh_force, strict=True)
            yield f"rigid meshes: {'; '.join(f'{mesh} {force:.1f} N' for mesh, force in forces)} along the flank normal"
        if self.faces:
            given = Column("", "given_misalignment_m", where=lambda face: bool(face.given_misalignment_m))
            where = ("face_load_factor", "load_place_m", "peak_place_m", "peak_pressure_pa")
            named = Column("along the face", lambda face: self._helix(face.mesh, face.helix))
            yield from ("", table_of(self, "faces", named, "shaft_misalignment_m", given, *where))
        if self.shares:
            by = Column("", "decided_by", left=False)
            shares = table_of(self, "shares", "gear", "mesh", "share", "factor", by)
            factor = Cell(f"{self.sharing_factor:.4f}", ("sharing_factor",), number=True)
            shares.rows.append((Cell("sharing factor"), Cell(""), Cell("", number=True), factor, Cell("K_gamma")))
            yield from ("", shares)
            if sensitivity:
                yield from ("", *self._sensitivities())
        for loop in self.assembly:
            if loop.gear:
                closes = (
                    f"with all teeth aligned to the shafts' marks {loop.rest_pitches:+.4f} pitches are missing; "
                    f"{loop.gear} clocked by {loop.clocking_deg:+.4f} deg closes it"
                )
                yield f"Loop: {loop.mesh} closes a loop: {closes}"
            else:
                missing = f"{loop.rest_pitches:+.4f} pitches missing"
                if loop.gap_m:
                    missing += f", taken as an index error of {1e6 * loop.gap_m:+.1f} um"
                yield f"Loop: {loop.mesh} closes a loop with the clockings given: {missing}"
        if self.bearing_force or self.support_force:
            yield from ("", self._on_shafts())
        if self.casing_seat_force:
            yield from ("", self._on_casings())
        if self.internal_loads:
            yield from ("", table_of(self, "internal_loads"))
        if self.laws:
            yield from ("", self.operating_points())
        yield from ("", self._moves(), "")
        yield "tilts and twist in urad; L and R: helix at the smaller and the larger z"
        yield f"{self.dofs} dofs, {self.cost}; {self.method}"
        if self.faces:
            agreed = (
                f"; shafts and faces agreed in {self.passes} pass{'es'[: 2 * (self.passes != 1)]}"
                if self.passes
                else ""
            )
            yield (
                "f_ma: misalignment by the shafts, + where flanks stand apart at larger z; z from the middle of the "
                f"face{agreed}"
            )
        for name, load in self.casing_force.items():
            yield f"ground on casing {name}: {_triple(load[:3])} N, {_triple(load[3:])} N m about the origin"
        yield (
            f"error: forces change by {error_words(self.error_estimate)} when every element is halved; "
            f"residual {error_words(self.imbalance)}"
        )
        yield from (*self.remarks(), "")

    def _helix(self, mesh: str, helix: int) -> str:
        """A mesh, and its helix where it has two."""
        return f"{mesh} {'LR'[int(helix)]}" if len(self.contacts_of(mesh)) == 2 else mesh

    def _meshes(self) -> Table:
        two = [len(self.contacts_of(mesh)) == 2 for mesh in self.contact_mesh]

        columns = (
            Column("mesh", lambda k: self._helix(self.contact_mesh[k], self.contact_helix[k])),
            Column("driver", lambda k: self.driver[k] if self.carries[k] else "open"),
            Column("F_n N", "mesh_force", ".1f"),
            Column("helix %", "helix_share", ".2f", "%", where=lambda k: two[k]),
            Column("press um", "mesh_deflection", ".3f", "um"),
            *(Column(f"F{x} N", "mesh_force_on_gear", ".0f", entry=(j,)) for j, x in enumerate("xyz")),
            Column("phase", lambda k: self.mesh_phase.get(self.contact_mesh[k]), ".4f"),
        )
        return table_over(self, "contact", *columns, caption="Forces between the teeth")

    def _sensitivities(self) -> Iterator[Block]:
        """Change of the first branch's share in percentage points, largest first."""
        rows = []
        for name, change in zip(self.parameter, self.share_derivative, strict=True):
            part, _, key = name.rpartition(".")
            step, words = _STEPS["index_error" if key.endswith("index_error") else key]
            helix = " at the larger z" if key == "helix_index_error" else ""
            rows.append((step * change[0], part, f"{words}{helix}"))
        rows.sort(
            key=lambda row: -float(f"{abs(row[0]):.6g}")
        )  # mirrored parts are equal but for rounding: as in the file
        cut = f" (the {_MOST_SENSITIVE} largest of {len(rows)}; --json has all)" if len(rows) > _MOST_SENSITIVE else ""
        first = self.shares[0]
        yield Line(f"Share of {first.mesh} in {first.gear}", f", change in percentage points{cut}")
        shown = [(part, words, f"{100.0 * change:+.3f}") for change, part, words in rows[:_MOST_SENSITIVE]]
        yield grid(shown, "what changes", "by", "share, points", left=2, caption="Sensitivity of the load sharing")

    def _on_shafts(self) -> Table:
        """Forces and moments of bearings and supports on the shafts."""
        rows = []
        for kind, loads in (("bearing", self.bearing_force), ("support", self.support_force)):
            for name, load in loads.items():
                if kind == "support" and not load.any():
                    continue
                parts = ((f"{kind}_force_n", load[:3], ".1f"), (f"{kind}_moment_n_m", load[3:], ".2f"))
                cells = [
                    Cell(written(x, form), (key, name, j), number=True)
                    for key, part, form in parts
                    for j, x in enumerate(part)
                ]
                rows.append((Cell(f"support {name}" if kind == "support" else name), *cells))
        heads = ("on the shaft, from", "Fx N", "Fy N", "Fz N", "Mx N m", "My N m", "Mz N m")
        return Table(tuple(map(Column, heads)), rows, "Forces and moments on the shafts")

    def _on_casings(self) -> Table:
        """Forces on casings: of what stands in their seats, and of the ground at their held sets and mounts."""
        loads = [(address, "seat", load) for address, load in self.casing_seat_force.items()]
        loads += [(address, "ground", load) for address, load in self.casing_ground_force.items()]
        # What is rounding of the largest is shown as 0.
        rows = [
            (address, what, *(written(x if abs(x) > 1e-9 * np.abs(load).max() else 0.0, ".1f") for x in load))
            for address, what, load in loads
        ]
        heads = ("on casing", "of", "Fx N", "Fy N", "Fz N", "Mx Nm", "My Nm", "Mz Nm")
        return grid(rows, *heads, left=2, caption="Forces and moments on the casings")

    def _moves(self) -> Table:
        rows = []
        for place, value in self.place_displacement.items():
            cells = (
                Cell(written(1e6 * x, ".3f" if j < 3 else ".1f"), ("displacement", place, j), 1e6, number=True)
                for j, x in enumerate(value)
            )
            rows.append((Cell(place.partition(".")[2].replace(" left", " L").replace(" right", " R")), *cells))
        heads = ("moves", "x um", "y um", "z um", "tilt_x", "tilt_y", "twist")
        return Table(tuple(map(Column, heads)), rows, "Displacements: tilts and twist in urad")


def _triple(values: np.ndarray) -> str:
    return ", ".join(written(value, ".2f") for value in values)
