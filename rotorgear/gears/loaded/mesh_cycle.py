"""Loaded tooth contact of one helix over the mesh cycle: positions, slices, compliance of all of them, and the sweep.

Transmission error and stiffness are transverse, along the line of action: k = F_bt / (delta - delta_0), delta_0 being the one
without load; the tangent stiffness is its derivative dF_bt / d delta at the load.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.gears.loaded.contact_points import PatchLoads, Slices, contact_slices, patch_loads
from rotorgear.gears.loaded.loaded_contact import (
    PositionContact,
    hertz_half_width,
    moment_and_tangents,
    solve_contact,
)
from rotorgear.gears.loaded.tooth_contact import ContactProblem
from rotorgear.gears.tooth_fe.gear_compliance import GearCompliance
from rotorgear.progress import Progress, silent

# The patch stays wider than the Hertz strip by this factor, and than this in normal modules.
_STRIP_MARGIN = 1.3
_LEAST_PATCH = 0.08
# Corner contacts are followed up to this share of the base pitch.
_MOST_BEYOND = 0.45
# They are followed a little farther than they touch, so that the next pass does not ask for more.
_MORE_BEYOND = 1.05
# A pass asks for wider patches or farther corners; the next one has them.
_PASSES = 12
# Wider strips (half-width over m_n) are no line contact any more.
_WIDEST_STRIP = 0.5
# Above such a pressure (Pa) no gear steel stays elastic.
_MOST_PRESSURE = 4e9
# First guesses: the load is spread over two thirds of the face, and the teeth give way as one pair of 8 N/(mm um) would.
_FIRST_PEAK = 1.5
_FIRST_STIFFNESS = 8e9


@dataclass(frozen=True)
class MeshCycle:
    """Loaded contact at p positions of a mesh cycle of one helix.

    Attributes:
        position: (p,) u in base pitches; pair k touches at u + k from the pitch point, in the middle of the face.
        load: F_bt (N) of this helix.
        deflection: delta (p,), transmission error under load along the line of action (m).
        no_load: delta_0 (p,), transmission error without load (m).
        tangent: (p,) dF_bt / d delta (N/m).
        moment: (p,) M (N m) of the normal forces about the middle of the face, sum F_i z_i.
        along_face: (p, 2, 2) d(F, M)/d(approach, tilt) along the flank normal (N/m, N, N m), for a tilt (m/m) that opens the
            flanks at larger z.
        slices: the slices of all positions.
        force: (n,) along the flank normal (N).
        strip: (n,) half-widths of the contact (m).
        pressure: (n,) largest Hertz pressure (Pa).
        residual: largest violation of the contact conditions (m).
        least_eigenvalue: smallest one of all compliance matrices (m/N).
        patch: least and largest half-width of the patches in normal modules.
        beyond: how far corner contacts were followed before the start and after the end (m).
        warnings: sentences.
    """

    position: np.ndarray
    load: float
    deflection: np.ndarray
    no_load: np.ndarray
    tangent: np.ndarray
    moment: np.ndarray
    along_face: np.ndarray
    slices: Slices
    force: np.ndarray
    strip: np.ndarray
    pressure: np.ndarray
    residual: float
    least_eigenvalue: float
    patch: tuple[float, float]
    beyond: tuple[float, float]
    warnings: tuple[str, ...] = ()

    @property
    def secant(self) -> np.ndarray:
        """k(u) in N/m, (p,)."""
        return np.asarray(self.load / (self.deflection - self.no_load))

    def share_by_pair(self) -> dict[int, np.ndarray]:
        """Share (p,) of each tooth pair in the load."""
        forces = {}
        for k in np.unique(self.slices.pair):
            of_pair = self.slices.pair == k
            forces[int(k)] = np.bincount(self.slices.position[of_pair], self.force[of_pair], len(self.position))
        total = sum(forces.values(), np.zeros(len(self.position)))
        return {k: value / total for k, value in forces.items()}

    @property
    def contact_ratio(self) -> float:
        """Mean number of tooth pairs that carry load."""
        return float(sum(np.mean(share > 0.0) for share in self.share_by_pair().values()))


def mesh_cycle(problem: ContactProblem, load: float, positions: np.ndarray, progress: Progress = silent) -> MeshCycle:
    """Solve the contact at all positions for F_bt = load (N) on this helix.

    Raises:
        ConvergenceError: a position has no solution to the tolerance.
    """
    # Patches as for the Hertz strip at the pitch point, and corners as for a typical stiffness: guesses that spare passes.
    line = problem.line
    at_pitch_point = line.pitch_point * (line.length - line.pitch_point) / line.length
    radius = at_pitch_point / float(np.cos(line.base_helix_angle))
    strip = hertz_half_width(np.array(_FIRST_PEAK * load / problem.width), np.array(radius), problem.modulus)
    least = _patch_for(float(strip), problem)
    beyond = _beyond(problem, _FIRST_PEAK * load / (_FIRST_STIFFNESS * problem.width) + problem.largest_gap)
    for _ in range(_PASSES):
        cycle, wanted_patch, wanted_beyond = _swept(problem, load, positions, least, beyond, progress)
        # Corners must be followed as far as they touch, but not much farther: slices that never touch cost time.
        near = all(have <= _MORE_BEYOND**2 * want for have, want in zip(beyond, wanted_beyond, strict=True))
        if wanted_patch <= least and near and all(np.array(wanted_beyond) <= beyond):
            return cycle
        least = max(least, 1.02 * wanted_patch)
        beyond = (_MORE_BEYOND * wanted_beyond[0], _MORE_BEYOND * wanted_beyond[1])
    return cycle


def _patch_for(strip: float, problem: ContactProblem) -> float:
    """Least half-width of a patch in normal modules for the widest strip (m)."""
    return max(_LEAST_PATCH, _STRIP_MARGIN * strip / float(np.cos(problem.line.base_helix_angle)) / problem.module)


def _beyond(problem: ContactProblem, approach: float) -> tuple[float, float]:
    """How far corners can touch for an approach along the line of action: there the gap has become as large."""
    grid = np.linspace(0.0, _MOST_BEYOND * problem.line.base_pitch, 401)

    def reach(gear: int) -> float:
        wide = problem.line.corner(gear, grid)[0] >= approach
        return float(grid[np.argmax(wide)]) if wide.any() else float(grid[-1])

    return reach(1), reach(0)  # the gear's tip before the start, the pinion's after the end


def _swept(
    problem: ContactProblem,
    load: float,
    positions: np.ndarray,
    least: float,
    beyond: tuple[float, float],
    progress: Progress,
) -> tuple[MeshCycle, float, tuple[float, float]]:
    """One sweep over all positions; also the patch and the reach of corners that its solution asks for."""
    line = problem.line
    cosine = float(np.cos(line.base_helix_angle))
    p = len(positions)
    slices = contact_slices(line, positions, problem.width, problem.slices, beyond, stations=problem.uncoupled)
    widths = (least, max(problem.patch, least))
    patches = [
        patch_loads(slices, i, problem.compliance[i], problem.module, problem.place(i, slices.z), widths)
        for i in (0, 1)
    ]

    # In the plane of action: length of the contact line dz / cos b_b, and R = rho_1 rho_2 / (rho_1 + rho_2) with
    # rho = xi / cos b_b. The patches' half-widths lie in the transverse section; cos b_b brings them across the line.
    gap = problem.gap(slices)
    length = slices.length / cosine
    R = np.sum(slices.roll[0] * slices.roll[1] / slices.roll.sum(axis=0) * slices.weight, axis=1) / cosine
    log_width = np.log(problem.module * cosine) + np.stack([patch.log_width for patch in patches], -1)
    responses = _Responses(problem, slices, patches)
    force = np.zeros(len(slices))
    strip = np.zeros(len(slices))
    approach = np.zeros(p)
    tangent = np.zeros(p)
    moment = np.zeros(p)
    along_face = np.zeros((p, 2, 2))
    place = slices.z @ slices.weight
    open_gap = np.zeros(p)
    residual = 0.0
    eigenvalue = np.inf
    for i in range(p):
        here = np.flatnonzero(slices.position == i)
        C = responses.compliance(here)
        contact = PositionContact(
            compliance=C,
            gap=gap[here],
            length=length[here],
            local=problem.local,
            log_width=log_width[here],
            radius=R[here],
            modulus=problem.modulus,
        )
        state = solve_contact(contact, load / cosine)
        widest = float(state.strip.max()) / problem.module
        if widest > _WIDEST_STRIP:
            raise AnalysisError(
                f"At this load the contact strip would be {2.0 * widest:.2g} modules wide, which is no line contact any more: "
                "reduce the torque."
            )
        force[here] = state.force
        strip[here] = state.strip
        approach[i] = state.approach
        tangent[i] = state.tangent
        moment[i], along_face[i] = moment_and_tangents(contact, state, place[here])
        open_gap[i] = gap[here].min()  # without load the gears approach until the first slice touches
        residual = max(residual, state.residual)
        eigenvalue = min(eigenvalue, float(np.linalg.eigvalsh(C)[0]))
        progress((i + 1) / p, f"contact {i + 1} of {p}")

    # Hertz: p_0 = 2 F' / (pi a). Along the line of action delta = delta_n / cos b_b and F_bt = F_n cos b_b.
    pressure = np.where(force > 0.0, 2.0 * (force / length) / (np.pi * np.maximum(strip, 1e-300)), 0.0)
    cycle = MeshCycle(
        position=positions,
        load=load,
        deflection=approach / cosine,
        no_load=open_gap / cosine,
        tangent=tangent * cosine**2,
        moment=moment,
        along_face=along_face,
        slices=slices,
        force=force,
        strip=strip,
        pressure=pressure,
        residual=residual,
        least_eigenvalue=eigenvalue,
        patch=widths,
        beyond=beyond,
        warnings=_notes(problem, slices, force, pressure, beyond),
    )
    wanted = _beyond(problem, float((approach - open_gap).max()) / cosine + problem.largest_gap)
    return cycle, _patch_for(float(strip.max()), problem), wanted


class _Responses:
    """Compliance between slices: P_i G_o P_j' of both gears, with o the distance of their tooth pairs."""

    def __init__(self, problem: ContactProblem, slices: Slices, patches: list[PatchLoads]) -> None:
        self.problem = problem
        self.slices = slices
        self.patches = patches
        reach = int(slices.pair.max() - slices.pair.min()) if len(slices) else 0
        self.moved: list[list[np.ndarray]] = []
        for i in (0, 1):
            compliance: GearCompliance = problem.compliance[i]
            # Pair k + 1 of the pinion stands clockwise of pair k, that of the gear the other way.
            side = 1 if i == 0 else -1
            self.moved.append(
                [patches[i].loads @ (problem.scale[i] * compliance.response(side * o)) for o in range(reach + 1)]
            )

    def compliance(self, here: np.ndarray) -> np.ndarray:
        """(n, n) in m/N of the slices `here` of one position."""
        pair = self.slices.pair[here]
        n = len(here)
        distance = pair[:, None] - pair[None, :]
        C = np.zeros((n, n))
        for i in (0, 1):
            loads = self.patches[i].loads[here]
            for o in range(int(distance.max()) + 1):
                part = (loads @ self.moved[i][o][here].T).T
                C += np.where(distance == o, part, 0.0)
        # Only distances o >= 0 are kept, since entry -o of a gear's flexibility is the transpose of entry o.
        C = np.where(distance >= 0, C, C.T)
        if self.problem.plane:
            C = C / self.slices.length[here]  # a plane model answers to a force per width
        if self.problem.uncoupled:
            z = self.slices.z[here, 0]
            C = np.where(np.abs(z[:, None] - z[None, :]) < 1e-9 * self.problem.width, C, 0.0)
        return np.asarray(0.5 * (C + C.T))


def _notes(
    problem: ContactProblem, slices: Slices, force: np.ndarray, pressure: np.ndarray, beyond: tuple[float, float]
) -> tuple[str, ...]:
    """Where the solution leaves what its theory covers."""
    notes = []
    if pressure.max() > _MOST_PRESSURE:
        notes.append(
            f"a contact pressure of {1e-9 * pressure.max():.2g} GPa is beyond any gear steel; the result is elastic"
        )
    # Loaded slices whose kinematic gap is near that of the last place where corners were looked for.
    most = _MOST_BEYOND * problem.line.base_pitch
    cosine = np.cos(problem.line.base_helix_angle)
    widest = min(float(problem.line.corner(gear, np.array([0.9 * most]))[0][0]) for gear in (0, 1)) * cosine
    far = (slices.gap @ slices.weight >= widest) & (force > 0.0)
    if max(beyond) >= most * (1.0 - 1e-9) and far.any():
        notes.append(
            f"tip corners were followed to {_MOST_BEYOND:g} base pitches beyond the line of action only; at this load they may "
            "touch farther out"
        )
    if np.any(slices.corner & (force > 0.0)):
        notes.append(
            "tip corners carry load: sharp corners are taken as line contacts, which may be 5 to 7 % too stiff there"
        )
    return tuple(notes)
