"""Loaded tooth contact of one helix over the mesh cycle: positions, slices, compliance of all of them, and the sweep.

Transmission error and stiffness are transverse, along the line of action: k = F_bt / (delta - delta_0), delta_0 being the one
without load; the tangent stiffness is its derivative dF_bt / d delta at the load.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.gears.loaded.contact_points import PatchLoads, Slices, contact_slices, patch_loads
from rotorgear.gears.loaded.loaded_contact import ContactState, PositionContact, hertz_half_width, solve_contact
from rotorgear.gears.loaded.tooth_contact import ContactProblem
from rotorgear.gears.tooth_fe.gear_compliance import GearCompliance
from rotorgear.progress import Progress, silent

# The patch stays wider than the Hertz strip by this factor, and than this in normal modules.
_STRIP_MARGIN = 1.3
_LEAST_PATCH = 0.08
# Corner contacts are followed up to this share of the base pitch.
_MOST_BEYOND = 0.45
_PASSES = 12
# Wider strips (half-width over m_n) are no line contact any more; above such a pressure (Pa) no gear steel stays elastic.
_WIDEST_STRIP = 0.5
_MOST_PRESSURE = 4e9
# They are followed a little farther than they touch, so that the next pass does not ask for more.
_MORE_BEYOND = 1.05


@dataclass(frozen=True)
class MeshCycle:
    """Loaded contact at p positions of a mesh cycle of one helix.

    Attributes:
        position: (p,) u in base pitches; pair k touches at u + k from the pitch point, in the middle of the face.
        load: F_bt (N) of this helix.
        deflection, no_load: (p,) transmission error under load and without, along the line of action (m).
        tangent: (p,) dF_bt / d delta (N/m).
        slices: the slices of all positions; force (n,) along the flank normal; strip (n,) half-widths of the contact (m).
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
        found = {}
        for k in np.unique(self.slices.pair):
            own = self.slices.pair == k
            found[int(k)] = np.bincount(self.slices.position[own], self.force[own], len(self.position))
        total = sum(found.values(), np.zeros(len(self.position)))
        return {k: value / total for k, value in found.items()}

    @property
    def contact_ratio(self) -> float:
        """Mean number of tooth pairs that carry load."""
        return float(sum(np.mean(share > 0.0) for share in self.share_by_pair().values()))


def mesh_cycle(problem: ContactProblem, load: float, positions: np.ndarray, progress: Progress = silent) -> MeshCycle:
    """Solve the contact at all positions for F_bt = load (N) on this helix.

    Raises:
        ConvergenceError: a position has no solution to the tolerance.
    """
    line = problem.line
    normal = load / np.cos(line.base_helix_angle)
    strip = hertz_half_width(np.array(1.5 * load / problem.width), np.array(_mean_radius(problem)), problem.modulus)
    least = _patch_for(float(strip), problem)
    beyond = _beyond(problem, 1.5 * load / (8e9 * problem.width) + problem.largest_gap)
    for _ in range(_PASSES):
        cycle, wanted_patch, wanted_beyond = _swept(problem, load, normal, positions, least, beyond, progress)
        near = all(have <= _MORE_BEYOND**2 * want for have, want in zip(beyond, wanted_beyond, strict=True))
        if wanted_patch <= least and near and all(np.array(wanted_beyond) <= beyond):
            return cycle
        least = max(least, 1.02 * wanted_patch)
        beyond = (_MORE_BEYOND * wanted_beyond[0], _MORE_BEYOND * wanted_beyond[1])
    return cycle


def _mean_radius(problem: ContactProblem) -> float:
    first = problem.line.pitch_point
    return first * (problem.line.length - first) / problem.line.length / float(np.cos(problem.line.base_helix_angle))


def _patch_for(strip: float, problem: ContactProblem) -> float:
    """Least half-width of a patch in normal modules for the widest strip (m)."""
    return max(_LEAST_PATCH, _STRIP_MARGIN * strip / float(np.cos(problem.line.base_helix_angle)) / problem.module)


def _beyond(problem: ContactProblem, approach: float) -> tuple[float, float]:
    """How far corners can touch for an approach along the line of action: there the gap has become as large."""
    grid = np.linspace(0.0, _MOST_BEYOND * problem.line.base_pitch, 401)
    found = []
    for gear in (1, 0):
        wide = problem.line.corner(gear, grid)[0] >= approach
        found.append(float(grid[np.argmax(wide)]) if wide.any() else float(grid[-1]))
    return found[0], found[1]


def _swept(
    problem: ContactProblem,
    load: float,
    normal: float,
    positions: np.ndarray,
    least: float,
    beyond: tuple[float, float],
    progress: Progress,
) -> tuple[MeshCycle, float, tuple[float, float]]:
    """One sweep over all positions; also the patch and the reach of corners that its solution asks for."""
    line = problem.line
    p = len(positions)
    slices = contact_slices(line, positions, problem.width, problem.slices, beyond, stations=problem.uncoupled)
    widths = (least, max(problem.patch, least))
    patches = [
        patch_loads(slices, i, problem.compliance[i], problem.module, problem.place(i, slices.z), widths)
        for i in (0, 1)
    ]
    gap = problem.gap(slices)
    length = slices.length / np.cos(line.base_helix_angle)
    R = np.sum(slices.roll[0] * slices.roll[1] / slices.roll.sum(axis=0) * slices.weight, axis=1) / np.cos(
        line.base_helix_angle
    )
    log_width = np.log(problem.module * np.cos(line.base_helix_angle)) + np.stack(
        [patch.log_width for patch in patches], -1
    )
    responses = _Responses(problem, slices, patches)
    force = np.zeros(len(slices))
    strip = np.zeros(len(slices))
    approach = np.zeros(p)
    tangent = np.zeros(p)
    open_gap = np.zeros(p)
    residual = 0.0
    eigenvalue = np.inf
    for i in range(p):
        own = np.flatnonzero(slices.position == i)
        C = responses.compliance(own)
        contact = PositionContact(C, gap[own], length[own], problem.local, log_width[own], R[own], problem.modulus)
        state: ContactState = solve_contact(contact, normal)
        force[own] = state.force
        strip[own] = state.strip
        approach[i] = state.approach
        tangent[i] = state.tangent
        open_gap[i] = gap[own].min()
        _require_line_contact(problem, state)
        residual = max(residual, state.residual)
        eigenvalue = min(eigenvalue, float(np.linalg.eigvalsh(C)[0]))
        progress((i + 1) / p, f"contact {i + 1} of {p}")
    cosine = float(np.cos(line.base_helix_angle))
    load_per_length = force / length
    pressure = np.where(force > 0.0, 2.0 * load_per_length / (np.pi * np.maximum(strip, 1e-300)), 0.0)
    cycle = MeshCycle(
        positions,
        load,
        approach / cosine,
        open_gap / cosine,
        tangent * cosine**2,
        slices,
        force,
        strip,
        pressure,
        residual,
        eigenvalue,
        widths,
        beyond,
        _notes(problem, slices, force, pressure, beyond),
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

    def compliance(self, own: np.ndarray) -> np.ndarray:
        """(n, n) in m/N of the slices `own` of one position."""
        pair = self.slices.pair[own]
        n = len(own)
        distance = pair[:, None] - pair[None, :]
        C = np.zeros((n, n))
        for i in (0, 1):
            loads = self.patches[i].loads[own]
            for o in range(int(distance.max()) + 1):
                part = (loads @ self.moved[i][o][own].T).T
                C += np.where(distance == o, part, 0.0)
        C = np.where(distance >= 0, C, C.T)
        if self.problem.plane:
            C = C / self.slices.length[own]
        if self.problem.uncoupled:
            z = self.slices.z[own, 0]
            C = np.where(np.abs(z[:, None] - z[None, :]) < 1e-9 * self.problem.width, C, 0.0)
        return np.asarray(0.5 * (C + C.T))


def _require_line_contact(problem: ContactProblem, state: ContactState) -> None:
    widest = float(state.strip.max()) / problem.module
    if widest > _WIDEST_STRIP:
        raise AnalysisError(
            f"At this load the contact strip would be {2.0 * widest:.2g} modules wide, which is no line contact any more: reduce "
            "the torque."
        )


def _notes(
    problem: ContactProblem, slices: Slices, force: np.ndarray, pressure: np.ndarray, beyond: tuple[float, float]
) -> tuple[str, ...]:
    notes = []
    if pressure.max() > _MOST_PRESSURE:
        notes.append(
            f"a contact pressure of {1e-9 * pressure.max():.2g} GPa is beyond any gear steel; the result is elastic"
        )
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
