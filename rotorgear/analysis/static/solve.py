"""Solves a model in statics and settles which contacts carry, and on which flank.

Contacts are springs that only push: one that would pull is opened; where the loads need it, it carries on its other flank
instead, and the torque flow is turned there. That is repeated until every contact carries or is open with a gap.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp

from rotorgear.analysis.static.film_heat import in_heat_balance
from rotorgear.elements.matrices import ElementMatrices
from rotorgear.errors import AnalysisError
from rotorgear.model.checks.bearings import one_sided
from rotorgear.model.layout.state import OperatingPoint
from rotorgear.model.parts.fields import DOF_NAMES
from rotorgear.note import Note
from rotorgear.quantity import RPM_PER_RAD_S
from rotorgear.solvers.sparse.factor import factor_symmetric
from rotorgear.solvers.sparse.newton import EVALUATIONS, local_equilibrium
from rotorgear.solvers.sparse.nullspace import StaticSolver, UnbalancedLoadError
from rotorgear.system.assembly import assemble
from rotorgear.system.contacts import ContactLines, contact_lines
from rotorgear.system.groups import ElementGroup
from rotorgear.system.loads import centrifugal_loads, outer_loads
from rotorgear.system.local_parts import LocalPart, expansion_stiffness, without_linear_part
from rotorgear.system.rigid_motions import rigid_motions
from rotorgear.system.system import System

if TYPE_CHECKING:
    from rotorgear.forces.law import ForceLaw
    from rotorgear.gears.stiffness.face_load import FaceLoad

# A contact pulls where its force is below minus this share of the largest one.
_PULLS = 1e-9
# Of the largest stiffness of a film along its axes.
_ROUNDING = 1e-14


@dataclass(frozen=True)
class LawState:
    """A law in equilibrium: displacements d and force (k,), and its tangents there, (k, k), stiffness and damping."""

    part: LocalPart
    d: np.ndarray
    force: np.ndarray
    stiffness: np.ndarray
    damping: np.ndarray

    def at(self, speed: float) -> OperatingPoint:
        """Where an equilibrium at a speed of the reference shaft in rad/s found the law."""
        # Rolling elements that turn: force and tangents are means over a pitch of them.
        averaged = bool(self.part.law.cycle()) and speed != 0.0
        return OperatingPoint(self.part.part, speed, self.force, self.d, self.stiffness, self.damping, averaged)

    def doubts(self, speed: float) -> tuple[Note, ...]:
        """What the law leaves out in this equilibrium, at a speed of the reference shaft in rad/s."""
        return tuple(Note(self.part.part, what, "", value) for what, value in self.part.law.doubts(self.d, speed))


@dataclass(frozen=True)
class Equilibrated:
    """A solved system: q (n,), forces of the c contacts (0 where open), and what derivatives need.

    `moment` (c,) is that of the contacts against the tilt of their flanks, about their places (N m). `faces` (c,) has the load
    along the face of each contact that feels the tilt of its shafts and carries, else None; `passes` counts how often these
    loads were asked for.
    """

    system: System
    groups: list[ElementGroup]
    lines: ContactLines
    closed: np.ndarray
    solver: StaticSolver
    motions: np.ndarray
    loads: np.ndarray
    q: np.ndarray
    force: np.ndarray
    moment: np.ndarray
    notes: tuple[Note, ...]
    laws: tuple[LawState, ...] = ()
    faces: tuple[FaceLoad | None, ...] = ()
    passes: int = 0

    @property
    def presses(self) -> np.ndarray:
        """(c,) whether a contact carries a force: flanks that only touch do not."""
        return np.asarray(self.closed & (self.force > _PULLS * np.max(self.force, initial=0.0)))


def equilibrate(
    system: System, speed: float, closed: np.ndarray | None = None, near: Sequence[LawState] = ()
) -> Equilibrated:
    """Return the equilibrium under torques, forces and moments from outside, weight and index errors.

    Args:
        system: about a mean load.
        speed: of the reference shaft in rad/s.
        closed: (c,) contacts that are taken to carry first; None: all.
        near: the laws in a known equilibrium, such as that at a speed near by, from which this one is looked for.

    Raises:
        AnalysisError: no loads, a motion that nothing holds and the loads push, or flanks that can't be settled.
    """
    closed = np.ones(len(system.state.forces), bool) if closed is None else closed
    tried: set[tuple[object, ...]] = set()
    while True:
        state = (tuple(force.torque_sense for force in system.state.forces), tuple(closed))
        if state in tried:
            names = ", ".join(dict.fromkeys(force.contact.mesh for force in system.state.forces))
            raise AnalysisError(
                f"no set of flanks carries the loads: meshes {names} open and close in turn; check index errors and loads"
            )
        tried.add(state)
        equilibrium = _solve(system, speed, closed, near)
        size = _PULLS * float(np.max(np.abs(equilibrium.force), initial=0.0))
        pressed = equilibrium.lines.force(equilibrium.q)
        worst = int(np.argmin(equilibrium.force)) if equilibrium.force.size else -1
        through = np.flatnonzero(~closed & (pressed > size))
        pulls = worst >= 0 and equilibrium.force[worst] < -size
        closed = closed.copy()
        if through.size:
            closed[through[0]] = True
        elif pulls:
            # It is opened, or its mesh carries on the other flank where the loads can't do without it.
            closed[worst] = False
            try:
                _solve(system, speed, closed, near)
            except _PushedMotionError:
                closed[worst] = True
                system = system.with_state(system.state.on_other_flank(system.state.forces[worst].contact.mesh))
        elif (turned := _met_behind(equilibrium, size)) is not None:
            system, closed = turned
        else:
            return equilibrium


def _met_behind(equilibrium: Equilibrated, size: float) -> tuple[System, np.ndarray] | None:
    """The system with a mesh on its other flanks where all its contacts stand open by more than the backlash.

    With it (c,) the contacts that carry then; None where no open mesh meets the flank behind. Forces below `size` (N) are none.
    """
    system = equilibrium.system
    names = equilibrium.lines.names
    for name in dict.fromkeys(names):
        own = np.array([other == name for other in names])
        if system.layout.mesh(name).part.backlash is None or equilibrium.closed[own].any():
            continue
        turned = system.with_state(system.state.on_other_flank(name))
        pressed = own & (contact_lines(turned).force(equilibrium.q) > size)
        if pressed.any():
            return turned, equilibrium.closed | pressed
    return None


class _PushedMotionError(AnalysisError):
    """The loads push a motion that nothing holds."""


# Forces of planets that go round are known where the largest of them changes by less than this share; rounds that are tried.
_SETTLED = 1e-13
_ROUNDS = 60


def _solve(system: System, speed: float, closed: np.ndarray, near: Sequence[LawState]) -> Equilibrated:
    """The equilibrium of some contacts, with what planets that go round add to the stiffness as loads of their displacements.

    These loads do no work on free rotations: what the linear terms leave there is of the order that they neglect, as the torque
    of a mesh at the radius to which the pins give.
    """
    turning = [group for group in system.groups_at(speed) if group.part.startswith("carriers.")]
    if not turning:
        return _solve_under(system, speed, closed, near, np.zeros(system.n))
    D = assemble(turning, system.dofs, lambda g: g.matrices.stiffness)
    D = D + assemble(turning, system.dofs, lambda g: g.circulatory_at(speed))
    f = np.zeros(system.n)
    for _ in range(_ROUNDS):
        found = _solve_under(system, speed, closed, near, f)
        before = f
        f = -(D @ found.q)
        R = found.motions
        f = f - R @ np.linalg.lstsq(R, f)[0] if R.shape[1] else f
        if np.abs(f - before).max(initial=0.0) <= _SETTLED * np.abs(f).max(initial=0.0):
            T = system.dofs.transform
            on_all = T @ before if system.dofs.selects else T @ factor_symmetric(sp.csc_array(T.T @ T)).solve(before)
            return replace(found, loads=found.loads + on_all)
    raise AnalysisError(
        f"no equilibrium of planets that go round was found at {speed * RPM_PER_RAD_S:.6g} rpm: near this speed their "
        "centrifugal load grows as fast as what holds them"
    )


def _solve_under(
    system: System, speed: float, closed: np.ndarray, near: Sequence[LawState], beside: np.ndarray
) -> Equilibrated:
    lines = contact_lines(system)
    meshes = iter(closed)
    groups = [
        group
        for group in system.groups_at(speed)
        if not group.part.startswith(("nonlinear_elements.", "carriers."))
        and (not group.part.startswith("meshes.") or next(meshes))
    ]
    groups, notes = without_torsion_to_ground(system, groups)
    if speed and system.uneven_planets:
        why = "planets that differ, or stand at unequal angles, are taken as they stand"
        notes = (*notes, Note("carriers", "what their displacements change of the centrifugal load", why))
    at_rest = np.zeros(system.n)
    loads = outer_loads(system) + centrifugal_loads(system, speed)
    f = (
        system.dofs.transform.T @ loads
        + beside
        - (
            lines.vectors @ np.where(closed, lines.force(at_rest), 0.0)
            + lines.tilt @ np.where(closed, lines.moment(at_rest), 0.0)
        )
    )
    parts = without_linear_part(system)
    size = max(float(np.abs(loads).max(initial=0.0)), 1.0)
    about = [expansion_stiffness(part.law, size, speed) for part in parts]
    K, R = _held(system, [*groups, *map(law_group, parts, about)], speed)
    solver = StaticSolver(K, R)
    laws = _laws_at_rest(system, parts, about, solver, f, speed, near)
    # Of a model without such laws this is the one linear solution.
    pushed = sum((part.columns @ (k @ law.d - law.force) for part, k, law in zip(parts, about, laws, strict=True)), 0.0)
    try:
        q = solver.solve((f + system.dofs.transform.T @ (pushed + np.zeros_like(loads)))[:, None])[:, 0]
    except UnbalancedLoadError:
        raise _PushedMotionError(_mechanism(system, R, f)) from None
    if R.shape[1]:
        # Of the free motions that leaves open, those that make the displacements of the reference shaft's first node smallest.
        rows = 6 * int(system.nodes.on_shaft(system.model.reference_shaft)[0]) + np.arange(6)
        here = system.dofs.expand(q)[rows]
        q = np.asarray(q - R @ np.linalg.lstsq(system.dofs.expand(R)[rows], here, rcond=1e-9)[0])
    if parts:  # derivatives are about the state found
        K, R = _held(system, [*groups, *(law_group(law.part, law.stiffness) for law in laws)], speed)
        solver = StaticSolver(K, R)
    force = np.where(closed, lines.force(q), 0.0)
    moment = np.where(closed, lines.moment(q), 0.0)
    turning = [group.turning_at(speed) for group in groups]
    return Equilibrated(system, turning, lines, closed, solver, R, loads, q, force, moment, notes, tuple(laws))


def _held(system: System, groups: list[ElementGroup], speed: float) -> tuple[sp.csc_array, np.ndarray]:
    """Stiffness (n, n) of element groups, and the motions (n, r) that strain none of them."""
    K = assemble(groups, system.dofs, lambda g: g.matrices.stiffness)
    N = assemble(groups, system.dofs, lambda g: g.circulatory_at(speed))
    return sp.csc_array(K + N) if N.nnz else K, rigid_motions(system, groups)


def law_group(part: LocalPart, stiffness: np.ndarray) -> ElementGroup:
    """A law as springs of a stiffness (k, k) between its displacements."""
    dofs = np.flatnonzero(np.any(part.columns != 0.0, axis=1))
    strain = part.columns[dofs].T
    symmetric = 0.5 * (stiffness + stiffness.T)
    skew = 0.5 * (stiffness - stiffness.T)
    if np.any(part.law.extents) and not np.any(skew):
        # Where one tilting pad alone carries, a film holds the shaft along its pivot only, and rounding must not seem to hold it
        # across: springs along the axes of the stiffness, in units of the displacements that change the film.
        unit = np.where(part.law.extents > 0.0, part.law.extents, 1.0)
        size, axes = np.linalg.eigh(unit[:, None] * symmetric * unit)
        symmetric = np.diag(np.where(np.abs(size) > _ROUNDING * np.abs(size).max(), size, 0.0))
        strain = axes.T @ (strain / unit[:, None])
    matrices = ElementMatrices(
        strain=strain[None], modulus=symmetric[None], circulation=skew[None] if np.any(skew) else None
    )
    return ElementGroup(part.part, "", matrices, dofs[None])


def _laws_at_rest(
    system: System,
    parts: list[LocalPart],
    about: list[np.ndarray],
    solver: StaticSolver,
    f: np.ndarray,
    speed: float,
    known: Sequence[LawState],
) -> list[LawState]:
    """Find the displacements at which the laws and the structure are in equilibrium.

    Raises:
        AnalysisError: there are none, or none was found.
    """
    if not parts:
        return []
    T = system.dofs.transform
    B = np.asarray(T.T @ np.hstack([part.columns for part in parts]))
    ends = np.cumsum([0, *(part.law.components for part in parts)])
    k = la.block_diag(*about)

    solved = solver.solve(np.column_stack([f, B]), carried=True)
    places = {state.part.part: state for state in known}
    begun = [places[part.part] for part in parts if part.part in places]
    near = [np.concatenate([state.d for state in begun]) if len(begun) == len(parts) else None]

    def settled(laws: Sequence[ForceLaw]) -> tuple[np.ndarray, list[np.ndarray]]:
        def forces(d: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            states = [law.linearised(d[a:b], speed=speed) for law, (a, b) in zip(laws, pairwise(ends), strict=True)]
            tangents = la.block_diag(*(state.stiffness for state in states))
            return np.concatenate([state.force for state in states]), tangents

        films = sum(law.many_kinks for law in laws)
        found = local_equilibrium(
            B.T @ solved[:, 0],
            B.T @ solved[:, 1:],
            k,
            forces,
            near[0],
            extents=np.concatenate([law.extents for law in laws]),
            evaluations=EVALUATIONS // max(films, 1),
        )
        if not found.converged:
            names = ", ".join(part.part for part in parts)
            usual = "look for a law that can't carry the load, such as a journal bearing at standstill"
            seen = "; ".join(one_sided(system.layout)) or usual
            raise AnalysisError(
                f"no equilibrium was found with {names} under these loads at {speed * RPM_PER_RAD_S:.6g} rpm: {seen}"
            )
        near[0] = found.d
        return found.d, [found.d[a:b] for a, b in pairwise(ends)]

    laws = [part.law for part in parts]
    for i, part in enumerate(parts):
        if part.part in places and getattr(part.law, "heats", False):
            # A film in heat balance begins with the viscosity that it has in the known equilibrium.
            laws[i] = replace(part.law, viscosity=places[part.part].part.law.viscosity)  # type: ignore[call-arg, attr-defined]
    warmed, found = in_heat_balance(laws, speed, settled)
    states = []
    for part, law, (a, b) in zip(parts, warmed, pairwise(ends), strict=True):
        d = found[a:b]
        if why := law.beyond(d, speed):
            raise AnalysisError(f"{part.part}: in equilibrium at {speed * RPM_PER_RAD_S:.6g} rpm {why}")
        tangent = law.settled(d).linearised(d, speed=speed)
        states.append(LawState(replace(part, law=law), d, tangent.force, tangent.stiffness, tangent.damping))
    return states


def is_loaded(system: System) -> bool:
    """Whether anything loads the model in statics: torques, forces from outside, weight, index errors or clockings."""
    gravity = system.model.operation.gravity if system.model.operation else None
    index = any(mesh.index_error or mesh.helix_index_error for mesh in system.model.meshes.values())
    index = index or bool(system.layout.clocking_gaps)
    return bool(system.state.applied or index or (gravity and any(gravity)) or system.layout.loaded_from_outside)


def without_torsion_to_ground(
    system: System, groups: list[ElementGroup]
) -> tuple[list[ElementGroup], tuple[Note, ...]]:
    """Leave torsional springs between turning shafts and the ground out: what turns can't wind them up.

    They are machines that turn as well, whose torque is among the loads. Where a support holds a shaft of the same
    part of the train fixed in torsion, nothing turns, and they stay.
    """
    train = system.train
    model = system.model
    fixed = [s.shaft for s in model.supports.values() if {"torsion", "all"} & set(s.fixed)]
    held = {train.group[shaft] for shaft in fixed if train.ratios[shaft] != 0}
    kept = []
    notes = []
    for group in groups:
        table = group.part.partition(".")[0]
        B = group.matrices.strain
        D = group.matrices.modulus
        turns = bool(group.shaft) and train.ratios.get(group.shaft, 0) != 0 and train.group[group.shaft] not in held
        if table in ("bearings", "supports") and turns and B is not None and D is not None:
            twist = B[0][:, -1] != 0.0  # the torsion of the shaft's own node, which comes last
            if np.any(D[0][twist]):
                cut = D.copy()
                cut[:, twist, :] = 0.0
                cut[:, :, twist] = 0.0
                group = replace(group, matrices=replace(group.matrices, modulus=cut))
                why = "the shaft turns, and the loads hold the torque"
                notes.append(Note(group.part, "torsional stiffness to ground", why))
        kept.append(group)
    return kept, tuple(notes)


def _mechanism(system: System, R: np.ndarray, f: np.ndarray) -> str:
    """One sentence about the free motion that the loads push most."""
    pushed = R @ (R.T @ f)
    moved = np.abs(system.dofs.expand(pushed)[: 6 * len(system.nodes)]).reshape(-1, 6)
    held = moved.copy()
    held[:, 5] = 0.0  # a train may turn; what lets it turn without its loads in balance is the other motion
    if held.max() > 1e-6 * moved.max():
        moved = held
    node, dof = np.unravel_index(int(np.argmax(moved)), moved.shape)
    shaft = system.nodes.shaft[int(node)]
    name = DOF_NAMES[int(dof)]
    remedy = {"z": "an axial bearing or a fixed support", "torsion": "loads that balance, or a mesh or coupling"}
    return (
        f"the model is a mechanism in statics: nothing holds shaft '{shaft}' in {name}, and the loads push it; "
        f"give it {remedy.get(name, 'a bearing or a support')}"
    )
