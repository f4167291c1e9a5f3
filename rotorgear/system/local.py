"""The system as time integrators take it: the linear structure without its meshes, and each tooth contact as a local law.

Per flank and helix one relative displacement d = v^T q (elements/gear_mesh.py); phases of k(t) and e(t) follow from tooth
numbers and centre lines (model/layout/state.py). Nothing here becomes a sign that elements/gear_mesh.py does not give.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
import scipy.sparse as sp

from rotorgear.elements.gear_mesh import ContactGeometry, contact_vector, face_strains
from rotorgear.elements.matrices import ElementMatrices
from rotorgear.errors import AnalysisError
from rotorgear.model.layout.external_loads import ExternalLoad
from rotorgear.model.layout.mesh_layout import POSITIONS
from rotorgear.model.layout.state import MeshForce, contact_geometry
from rotorgear.model.parts.carrier import written_name
from rotorgear.model.parts.mesh import ErrorHarmonic, StiffnessHarmonic
from rotorgear.solvers.time.local_system import LocalSystem, Rotation
from rotorgear.solvers.time.sisters import sisters_of
from rotorgear.system.assembly import assemble
from rotorgear.system.contacts import contact_lines, rotation_vector
from rotorgear.system.groups import ElementGroup, face_of, mesh_damping, mesh_dofs
from rotorgear.system.loads import centrifugal_loads, outer_loads
from rotorgear.system.local_parts import (
    LocalPart,
    bearing_parts,
    columns_at,
    element_parts,
    expansion_stiffness,
    external_parts,
    friction_part,
    load_parts,
    run_up_parts,
    unbalance_parts,
    without_linear_part,
)
from rotorgear.system.planets import require_alike_around, require_constant, sister_places, turning_carriers
from rotorgear.system.rigid_motions import rigid_motions
from rotorgear.system.run_up import Carried, on_rigid_train
from rotorgear.system.system import System

if TYPE_CHECKING:
    from rotorgear.forces.loaded_teeth import LoadedTeeth
    from rotorgear.forces.mesh_contact import MeshContact
    from rotorgear.gears.maps.contact_map import ContactMap
    from rotorgear.gears.maps.face_map import FaceMap
    from rotorgear.model.layout.state import FaceState

# Depth over which damping grows from zero, and the reference depth of penetration damping, relative to the mean deflection.
_RAMP = 0.02
# Mean deflection that is taken for a mesh without load.
_UNLOADED = 1e-6


@dataclass(frozen=True)
class LocalModel:
    """A system for time integration with the parts behind its local displacements; `asked`: speed and `along_faces` of it."""

    system: System
    local: LocalSystem
    parts: tuple[LocalPart, ...]
    groups: tuple[ElementGroup, ...]
    asked: tuple[float, bool]

    @cached_property
    def released(self) -> LocalModel:
        """The same with all dofs that rigid members take away; itself where nothing is rigid."""
        if self.system.released is self.system:
            return self
        speed, along_faces = self.asked
        return local_model(self.system.released, self.local.rotation, speed, along_faces=along_faces)

    @property
    def meshes(self) -> list[int]:
        """Numbers of the parts that are contacts of meshes."""
        return [i for i, part in enumerate(self.parts) if part.is_mesh]

    @property
    def watched_names(self) -> list[str]:
        """Address and label of what each watched displacement is the transmission error of."""
        return [f"{self.parts[i].part} {self.parts[i].label}" for i in self.meshes]

    @property
    def mesh_columns(self) -> np.ndarray:
        """(c,) local displacements of these contacts."""
        return self.local.forces.first[self.meshes].astype(int)

    @property
    def transverse(self) -> np.ndarray:
        """(c,) displacement of a contact over its approach in the transverse plane."""
        return np.array([self.parts[i].transverse for i in self.meshes])


def local_model(system: System, rotation: Rotation, speed: float, *, along_faces: bool = False) -> LocalModel:
    """Return the structure with its contacts as laws.

    Args:
        system: nodes, dofs and groups; one that is seen from its carrier has no sisters, for nothing of it goes round.
        rotation: speed of the reference over time.
        speed: at which bearings with tables and internal damping are taken, in rad/s.
        along_faces: loaded teeth that feel the tilt of their shafts follow it in time, by maps at several tilts; otherwise they
            keep the tilt of the static state, and resist another one by the tangent about it.

    Raises:
        AnalysisError: planets go round with what their carrier's turn does not allow (`_require_plain_planets`), or what acts
            is not seen alike from the carrier.
    """
    _require_plain_planets(system, rotation)
    from rotorgear.solvers.time.local_forces import gather

    laws = {f"bearings.{name}" for name, bearing in system.model.bearings.items() if bearing.has_law}
    state = system.state.about_nominal_flanks
    maps = [state.face_map(force) if along_faces else None for force in state.forces]
    mapped = {k: teeth for k, teeth in enumerate(maps) if teeth is not None}
    groups = [
        replace(group, matrices=replace(group.matrices, modulus=None, circulation=None))
        if group.part in laws
        else group
        for group in system.groups_at(speed)
        if not group.part.startswith(("meshes.", "nonlinear_elements.", "carriers."))
    ]
    # What planets bring is that of the start of a run-up, and changes from there.
    runs_up = not rotation.is_constant
    carriers = system.of_carriers(float(rotation.speed(np.zeros(1))[0]) if runs_up else speed)
    runs_up = runs_up and bool(carriers)
    groups += carriers
    for k, group in enumerate(group for group in system.groups if group.part.startswith("meshes.")):
        m = group.matrices
        if m.strain is None or m.modulus is None or m.strain.shape[1] != 2:
            continue
        # What resists a tilt, without the spring along the flank normal, whose force is a law of its own. Where that law is one
        # of the tilt as well, the damper alone is left.
        tilt = ElementMatrices(
            strain=m.strain[:, 1:],
            modulus=None if k in mapped else m.modulus[:, 1:, 1:],
            viscosity=None if m.viscosity is None else m.viscosity[:, 1:, 1:],
        )
        groups.append(replace(group, matrices=tilt))
    K = assemble(groups, system.dofs, lambda g: g.matrices.stiffness)
    C = assemble(groups, system.dofs, lambda g: g.matrices.damping)
    damping = system.model.damping
    C = sp.csc_array(C + damping.rayleigh_alpha * system.mass + damping.rayleigh_beta * K)
    parts = (
        *_mesh_parts(system, mapped),
        *bearing_parts(system),
        *element_parts(system),
        *unbalance_parts(system, rotation),
        *load_parts(system),
        *external_parts(system),
        *(run_up_parts(system, rotation) if runs_up else ()),
    )
    T = system.dofs.transform
    nothing = np.zeros((T.shape[0], 0))
    lines = contact_lines(system)
    couple = np.where(np.isin(np.arange(len(lines.states)), list(mapped)), 0.0, lines.couple)
    outside = outer_loads(system, steady=True)
    if carriers and system.is_seen_from_carrier:
        from_rest = [(part.part, part.columns) for part in parts if not part.part.startswith("meshes.")]
        require_alike_around(
            system.layout, system.nodes, [("what is steady of the loads", outside[:, None]), *from_rest]
        )
    load = T.T @ (outside if runs_up else outside + centrifugal_loads(system, speed)) - lines.tilt @ couple
    forces = gather(tuple(part.law for part in parts))
    alone = {part.part for part in without_linear_part(system)}
    about = forces.reference_stiffness.copy()
    size = max(float(np.abs(load).max(initial=0.0)), 1.0)
    for part, (first, last) in zip(parts, pairwise(forces.first), strict=True):
        if part.part in alone:
            about[first:last, first:last] = expansion_stiffness(part.law, size, speed)
    local = LocalSystem(
        M=system.mass,
        D=C,
        K=sp.csc_array(K + assemble(groups, system.dofs, lambda g: g.circulatory_at(speed))),
        B=sp.csc_array(T.T @ np.hstack([nothing, *(part.columns for part in parts)])),
        forces=replace(forces, reference_stiffness=about),
        load=load,
        rotation=rotation,
        G=system.gyroscopic if system.gyroscopic.nnz else None,
        watched=T.T @ np.column_stack([nothing, *(part.rotation for part in parts if part.rotation is not None)]),
    )
    if carriers:
        columns = [f"{part.part} {part.label} {k}" for part in parts for k in range(part.columns.shape[1])]
        joined = [*groups, *(group for group in system.groups if group.part.startswith("meshes."))]
        rigid = rigid_motions(system, joined)
        if not system.is_seen_from_carrier:
            local = replace(local, sisters=sisters_of(sister_places(system.layout, columns)))
        if runs_up:
            still = [group for group in groups if not group.part.startswith("carriers.")]
            K = assemble(still, system.dofs, lambda g: g.matrices.stiffness)
            K = sp.csc_array(K + assemble(still, system.dofs, lambda g: g.circulatory_at(speed)))
            squares = rotation.speeds**2
            least = 0.0 if np.ptp(np.sign(rotation.speeds)) > 0.0 else float(squares.min())
            changes = Carried(system, local, K, rigid, (least, float(squares.max())))
            local = replace(local, changes=changes).at_time(0.0)
        else:
            local = replace(local, load=local.load + on_rigid_train(local, rigid, local.load[:, None])[:, 0])
    return LocalModel(system, local, parts, tuple(groups), (speed, along_faces))


def _require_plain_planets(system: System, rotation: Rotation) -> None:
    """Refuse, by name, what motions in time do not take of planets that go round.

    Raises:
        AnalysisError: loaded teeth, laws of bearings and elements, unbalances that are accelerated, loads that differ.
    """
    model = system.model
    turning = {planets.shaft: planets for planets in turning_carriers(system.layout)}
    if not turning or not np.any(rotation.speeds):
        return
    if not system.is_seen_from_carrier:
        require_constant(system.layout)
    for name, bearing in model.bearings.items():
        if bearing.rigid_directions:
            raise AnalysisError(
                f"bearings.{name}.stiffness: its force in a rigid direction beside planets that go round is not built in time. "
                "Give it a stiffness."
            )
    hold = "or hold the carrier: speed_ratio = 0 of shafts."
    round_with = {planet: planets for planets in turning.values() for planet in planets.planets}
    for mesh in model.meshes:
        both = system.layout.mesh(mesh)
        if both.carrier in turning and (both.has_loaded_teeth or mesh in system.state.faces):
            raise AnalysisError(
                f"meshes.{written_name(mesh)}.stiffness: loaded teeth of planets that go round are not built in time. Give a "
                f"stiffness such as 'iso' and a transmission_error, {hold}{both.carrier}."
            )
    for table in ("bearings", "nonlinear_elements", "unbalances"):
        for name, part in getattr(model, table).items():
            planets = round_with.get(part.shaft)
            accelerated = not rotation.is_constant or not system.layout.turns(part.shaft)
            if planets is not None and {"bearings": getattr(part, "has_law", True), "unbalances": accelerated}.get(
                table, True
            ):
                what = {"bearings": "the law of a bearing", "unbalances": "an unbalance"}.get(table, "an element")
                where = " in a run-up, or where they do not turn on their pins," if table == "unbalances" else ""
                raise AnalysisError(
                    f"{table}.{written_name(name)}: {what} on planets that go round{where} is not built in time. "
                    f"Leave it out, {hold}{planets.shaft}."
                )
    same: dict[str, ExternalLoad] = {}
    for load in system.layout.external_loads:
        planets = round_with.get(load.places[0].shaft)
        if planets is None:
            continue
        name = written_name(load.address.removeprefix("loads."))
        first_of = same.setdefault(name, load)
        # What stays is known to the structure at the place of the start; what varies is a law, of all sisters or of none.
        varies = [one.history is not None or bool(one.amplitude.any()) for one in (first_of, load)]
        if varies[0] != varies[1] or not np.array_equal(first_of.constant, load.constant):
            raise AnalysisError(
                f"loads.{name}: a load on planets that go round is built in time where what stays of it is the same for all of "
                f"them, and all of them have what varies. Make it so, {hold}{planets.shaft}."
            )


def _mesh_parts(system: System, faces: dict[int, FaceMap]) -> Iterator[LocalPart]:
    """The contacts of all helices, each with what goes with it: impacts at its corners, friction, and the flank behind it."""
    state = system.state.about_nominal_flanks
    for number, force in enumerate(state.forces):
        contact = force.contact
        address = f"meshes.{contact.mesh}"
        label = contact.mesh if len(state.of_mesh(contact.mesh)) == 1 else f"{contact.mesh} helix {contact.helix + 1}"
        geometry = contact_geometry(force)
        spring = _mesh_law(system, force, geometry, state.phase(contact) or 0.0)
        along = faces.get(number)
        # Flanks that tilt have their approach in the middle of the face, others at the place where they carry.
        dofs = mesh_dofs(system.layout, system.nodes, force)[0]
        face = face_of(system.layout, force)
        strains = face_strains(geometry, replace(face, place=0.0)) if along else face_strains(geometry, face)[:1]
        columns = columns_at(system, dofs, strains)
        approach = columns[:, :1]
        rotation = columns_at(system, dofs[:12], rotation_vector(force)[None])[:, 0]
        transverse = float(np.cos(contact.base_helix_angle))

        working: MeshContact | LoadedTeeth = spring
        behind: MeshContact | LoadedTeeth = _back(spring)
        teeth = along or state.contact_map(force)
        blows = []
        if teeth is not None:
            # A map begins where its flanks touch, a spring about a mean state does not.
            gap = (replace(force, face=None) if along else force).gap(system.layout)
            touching = replace(spring, error_mean=gap)
            working = _loaded_teeth(touching, teeth, force, state.path_phase(contact) or 0.0)
            if spring.impact:
                impact = replace(spring, stiffness=0.0, damping=0.0, gap="bilateral", expanded=False)
                blows.append(LocalPart(address, f"{label} impact", impact, approach))
            if spring.gap != "bilateral":
                coast = state.coast_map(force)
                assert coast is not None  # its working load is that of the other flank
                phase = state.on_other_flank(contact.mesh).path_phase(contact) or 0.0
                behind = _loaded_teeth(_back(touching), coast, force.on_other_flank, phase)
                if spring.gap == "dead zone" and not along:
                    working = replace(working, coast=behind)
        # Forces are summed in the order of their parts.
        part = LocalPart(address, label, working, columns, rotation, transverse)
        yield from (part, *blows) if along else (*blows, part)
        yield from friction_part(system, force, geometry, label, spring, dofs[:12], approach)
        # Coast flanks behind flanks that tilt keep the tilt of the mean state, so they are a law of their own.
        if spring.gap == "unilateral" or (along and spring.gap == "dead zone"):
            turned = replace(geometry, torque_sense=-geometry.torque_sense)
            normal = columns_at(system, dofs[:12], contact_vector(turned)[None])
            column = normal if spring.gap == "unilateral" else -approach
            yield LocalPart(address, f"{label} back", behind, column, -rotation, transverse)


def _loaded_teeth(spring: MeshContact, teeth: ContactMap | FaceMap, force: MeshForce, phase: float) -> LoadedTeeth:
    """The map of loaded teeth in place of a spring, with the damping and the errors of that."""
    shared = ("damping", "contact_damping", "order", "phase", "error_cos", "error_sin", "expanded")
    return teeth_law(
        teeth,
        force.contact.stiffness,
        spring.error_mean,
        face=force.face,
        reference=spring.ramp,
        path_phase=phase,
        # Positions count along the path from approach to recess of the pinion: where the gear drives, time runs the other way.
        forward=1 if force.pinion_drives else -1,
        **{name: getattr(spring, name) for name in shared},
    )


def _mesh_law(system: System, force: MeshForce, geometry: ContactGeometry, phase: float) -> MeshContact:
    from rotorgear.forces.mesh_contact import MeshContact

    model = system.model
    contact = force.contact
    both = system.layout.mesh(contact.mesh)
    mesh = both.part
    order = both.order * system.direction

    # Damping grows over a small share of the mean deflection; penetration damping refers to that deflection itself.
    deflection = (force.normal_force / contact.stiffness) or _UNLOADED
    usual = deflection * (1.0 if mesh.contact_damping == "penetration" else _RAMP)
    damping = mesh_damping(system.layout, force, geometry) + model.damping.rayleigh_beta * contact.stiffness
    gap = "bilateral" if mesh.backlash is None else {"line": "dead zone", "own normals": "unilateral"}[mesh.coast_flank]
    error = force.gap(system.layout)
    if force.start is not None:  # a tangent about a mean state carries nothing elsewhere than the contact does
        error -= force.start / contact.stiffness
    impact = mesh.corner_impact
    blow: dict[str, Any] = (
        {"impact": impact.force, "impact_share": impact.duration, "impact_phase": -impact.at} if impact else {}
    )
    return MeshContact(
        stiffness=contact.stiffness,
        damping=damping,
        backlash=mesh.backlash or 0.0,
        gap=gap,
        contact_damping=mesh.contact_damping,
        ramp=usual if mesh.regularisation_depth is None else mesh.regularisation_depth,
        order=order,
        phase=phase,
        **_series("stiffness", mesh.stiffness_variation),
        error_mean=error,
        **_series("error", mesh.transmission_error),
        pieces=cycle_pieces(system, force),
        **blow,
    )


def _back(law: MeshContact) -> MeshContact:
    """The coast flank on its own normal: what opens the working flank closes it."""
    return replace(
        law,
        backlash=0.0,
        error_mean=law.backlash - law.error_mean,
        error_cos=tuple(-x for x in law.error_cos),
        error_sin=tuple(-x for x in law.error_sin),
        expanded=False,
    )


def cycle_pieces(system: System, force: MeshForce) -> tuple[tuple[float, float, float], ...]:
    """Straight pieces of k over its mean in the mesh cycle of one helix, where the file gives a curve or a stiffness model."""
    if not system.layout.mesh(force.contact.mesh).varies:
        return ()
    curve = system.state.curve(force)
    values = curve.evenly(POSITIONS) if curve.event is not None else curve.transverse
    share = values / values.mean()
    # Positions count along the path from approach of the pinion: where the gear drives, time runs the other way.
    if not force.pinion_drives:
        share = np.roll(share[::-1], 1)
    ends = np.roll(share, -1)
    return tuple((i / share.size, float(a), float(b)) for i, (a, b) in enumerate(zip(share, ends, strict=True)))


def _series(what: str, harmonics: tuple[ErrorHarmonic | StiffnessHarmonic, ...]) -> dict[str, Any]:
    """Cosine and sine parts by harmonic from amplitudes and phases, as fields of a law that begin with a word."""
    count = max((item.harmonic for item in harmonics), default=0)
    cosines = np.zeros(count)
    sines = np.zeros(count)
    for item in harmonics:
        cosines[item.harmonic - 1] += item.amplitude * np.cos(item.phase)
        sines[item.harmonic - 1] -= item.amplitude * np.sin(item.phase)
    return {f"{what}_cos": tuple(cosines), f"{what}_sin": tuple(sines)}


# Loads of a law to each step of load of its maps.
_FINER = 8


def teeth_law(
    teeth: ContactMap | FaceMap, stiffness: float, gap: float, face: FaceState | None = None, **more: Any
) -> LoadedTeeth:
    """F(delta, u) of a map, or (F, M)(delta, tilt, u) of the maps along a face.

    Args:
        teeth: of the helix.
        stiffness: of its mean state along the flank normal (N/m).
        gap: what must close before the flanks touch (m).
        face: how the mean state carries along a face that has maps.
        more: further parameters of the law.
    """
    from scipy.interpolate import PchipInterpolator

    from rotorgear.forces.loaded_map import is_large
    from rotorgear.forces.loaded_teeth import LoadedTeeth
    from rotorgear.gears.maps.contact_map import ContactMap

    given: dict[str, Any] = {"periods": teeth.periods, "error_mean": gap, **more}
    if isinstance(teeth, ContactMap) and is_large(teeth.approach[None], tilted=False):
        # Loads between those of a map over many pitches would take several times its memory.
        return LoadedTeeth(teeth.load, teeth.approach, stiffness, slope=teeth.slopes, **given)
    maps = (teeth,) if isinstance(teeth, ContactMap) else teeth.maps
    # Where a contact under the largest loads is no line any more, its map ends earlier.
    solved = min((one.load for one in maps), key=len)
    at = np.arange(_FINER * (len(solved) - 1) + 1) / _FINER
    load = np.interp(at, np.arange(len(solved)), solved)
    # Between its loads the curve is the map's own, which knows its tangents.
    approaches = [one.approaches(load) for one in maps]
    if isinstance(teeth, ContactMap):
        return LoadedTeeth(load, approaches[0], stiffness, **given)
    if face is not None:
        given |= {"place": face.place, "tilt_stiffness": face.tilt_stiffness}
    moment = np.stack([PchipInterpolator(one.load, one.moment, axis=1)(load) for one in maps])
    return LoadedTeeth(load, np.stack(approaches), stiffness, tilt=teeth.tilt, moment=moment, **given)
