"""The joint quasi-static state: all loaded contacts of a gearbox together, at every position of their mesh cycles.

At a crawl the structure, linear but for its teeth, is in equilibrium at every position u of the cycle:

    K q + sum_i v_i F_i(v_i . q, u_i) = f,        F_i from the contact map of helix i.

Helices and branches share the load, so they are solved together. Reduced to the m contacts (solvers/sparse/newton.py):

    delta = delta_0 - A (F(delta, u) - k delta),   A = V^T (K + V k V^T)^-1 V,

for any k; whatever else of the structure is nonlinear has its tangents at the equilibrium. A contact whose teeth feel the tilt
of their shafts has two such displacements, the approach in the middle of its face and the tilt, and two forces, F and the
moment M about the middle, from its face map. Contacts of one mesh frequency run through one cycle. Of several frequencies
there is no short common period: each cycle is taken for itself, with the other contacts on the mean of their curves,
delta_mean(F) over u.

What that state is and how it shakes a linear model: `joint_state.py`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from typing import TYPE_CHECKING

import numpy as np

from rotorgear.analysis.static.joint_state import Cycle, JointState
from rotorgear.analysis.static.solve import Equilibrated, equilibrate
from rotorgear.errors import AnalysisError, ConvergenceError
from rotorgear.model.layout.state import FaceState
from rotorgear.solvers.sparse.newton import LocalEquilibrium, local_equilibrium
from rotorgear.system.local import teeth_law

if TYPE_CHECKING:
    from rotorgear.forces.law import ForceLaw
    from rotorgear.gears.maps.contact_map import ContactMap
    from rotorgear.gears.maps.face_map import FaceMap

# Positions in a base pitch at least; a map that knows more is followed.
_POSITIONS = 128
# Positions whose curves are made together.
_TOGETHER = 512
# Number of straight pieces of a curve F(delta) at one position for each step of load of its map.
_FINER = 8
# Cycles of several pitches whose rows of the map agree to this share are solved once.
_ALIKE = 1e-10
# Mean state and tangents of nonlinear bearings agree when no mean force changes by more than this share of the largest.
_AGREED = 1e-9
_PASSES = 30

# Displacements (d,) of a contact at one position -> its forces (d,) and their tangents (d, d).
_Curve = Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]


def over_cycle(equilibrium: Equilibrated, speed: float) -> tuple[Equilibrated, JointState | None]:
    """Return the equilibrium that is the mean of the joint state of the loaded teeth, and that state.

    Without loaded teeth (`stiffness = "tooth_fe"`) it is the one given, and there is no such state. A mesh that feels the tilt
    of its shafts takes part with its approach and its tilt where it is about a load along its face (`along_faces.py`).

    Args:
        equilibrium: with the contacts as springs, on the flanks that carry.
        speed: of the reference shaft in rad/s.

    Raises:
        AnalysisError: a position of the cycle has no equilibrium.
        ConvergenceError: mean state and nonlinear parts don't come to agree.
    """
    for _ in range(_PASSES):
        joint = joint_state(equilibrium)
        if joint is None:
            return equilibrium, None
        load = equilibrium.system.state.about_cycle(joint.force, joint.stiffness, joint.start, joint.faces)
        closed = np.where(joint.own >= 0, joint.force > 0.0, equilibrium.closed)
        settled = equilibrate(equilibrium.system.with_state(load), speed, closed, equilibrium.laws)
        change = float(np.abs(settled.force - equilibrium.force).max())
        equilibrium = settled
        if not equilibrium.laws or change <= _AGREED * float(np.abs(settled.force).max()):
            return equilibrium, joint
    raise ConvergenceError(
        "The mean state of the loaded teeth and that of the nonlinear bearings and elements don't come to agree: give the "
        "stiffness of one of them as a number."
    )


def joint_state(equilibrium: Equilibrated) -> JointState | None:
    """Solve all contacts together over their cycles about an equilibrium; None where no contact has a map.

    Raises:
        AnalysisError: a position has no equilibrium.
    """
    load = equilibrium.system.state
    lines = equilibrium.lines
    face_maps = tuple(load.face_map(state, near=True) for state in lines.states)
    maps = tuple(
        load.contact_map(state, near=True) if along is None else None
        for state, along in zip(lines.states, face_maps, strict=True)
    )
    have = [not (one is along is None) for one, along in zip(maps, face_maps, strict=True)]
    if not any(have):
        return None
    phases = [load.path_phase(state.contact) for state in lines.states]
    # Mesh frequencies over the speed of the reference shaft, -1 without a map.
    turning = [equilibrium.system.layout.mesh(state.contact.mesh).order for state in lines.states]
    ratios = [ratio if mapped else -1.0 for ratio, mapped in zip(turning, have, strict=True)]
    frequencies = {round(ratio, 9): ratio for ratio in ratios if ratio >= 0.0}
    number = {key: g for g, key in enumerate(frequencies)}
    own = np.array([number.get(round(ratio, 9), -1) for ratio in ratios])
    problem = _Problem(
        equilibrium=equilibrium,
        maps=maps,
        face_maps=face_maps,
        gap=lines.gap - np.array([state.face.shift if state.face else 0.0 for state in lines.states]),
        pitch=np.array([(phase or 0.0) / (2.0 * math.pi) for phase in phases]),
        sense=np.array([1.0 if state.pinion_drives else -1.0 for state in lines.states]),
    )
    cycles = tuple(problem.cycle(np.flatnonzero(own == g), ratio) for g, ratio in enumerate(frequencies.values()))
    at = np.maximum(own, 0)
    contacts = range(len(maps))
    stiffness = lines.stiffness.copy()
    faces: list[FaceState | None] = [None] * len(maps)
    for i, mapped in enumerate(have):
        if mapped:
            stiffness[i], faces[i] = problem.mean_tangent(i, cycles[own[i]])
    return JointState(
        cycles=cycles,
        own=own,
        force=np.array([cycles[at[i]].force[:, i].mean() for i in contacts]),
        approach=np.array([cycles[at[i]].approach[:, i].mean() for i in contacts]),
        stiffness=stiffness,
        gap=problem.gap,
        maps=maps,
        face_maps=face_maps,
        faces=tuple(faces),
        compliance=problem.compliance_about(stiffness, faces),
        pitch=problem.pitch,
        sense=problem.sense,
    )


@dataclass(frozen=True)
class _Problem:
    """The contacts of an equilibrium, ready for any position; fields as in JointState.

    Its displacements are the approaches of all contacts, then the tilts of those with a face map.
    """

    equilibrium: Equilibrated
    maps: tuple[ContactMap | None, ...]
    face_maps: tuple[FaceMap | None, ...]
    gap: np.ndarray
    pitch: np.ndarray
    sense: np.ndarray

    @cached_property
    def mapped(self) -> np.ndarray:
        """Numbers (m,) of the contacts that have a map."""
        both = zip(self.maps, self.face_maps, strict=True)
        return np.array([i for i, (one, along) in enumerate(both) if not (one is along is None)])

    @cached_property
    def tilting(self) -> np.ndarray:
        """Numbers (t,) of the contacts that have a face map."""
        return np.array([i for i, face_map in enumerate(self.face_maps) if face_map is not None], dtype=int)

    @cached_property
    def moving(self) -> np.ndarray:
        """Numbers (m + t,) of the displacements of contacts that have a map."""
        return np.append(self.mapped, len(self.maps) + np.arange(len(self.tilting)))

    @cached_property
    def place(self) -> np.ndarray:
        """e (c,) in m of the contacts along their faces; 0 without a face map."""
        return self._of_faces([state.face for state in self.equilibrium.lines.states])[0]

    @cached_property
    def vectors(self) -> np.ndarray:
        """V (n, c + t) of the displacements: approaches, in the middle of a face that has a map, and tilts."""
        lines = self.equilibrium.lines
        return np.hstack([lines.vectors - self.place * lines.tilt, lines.tilt[:, self.tilting]])

    @cached_property
    def stiffness(self) -> np.ndarray:
        """k (c,) about which the structure is solved: that of the equilibrium, 0 where it is open."""
        return np.where(self.equilibrium.closed, self.equilibrium.lines.stiffness, 0.0)

    @cached_property
    def springs(self) -> np.ndarray:
        """k (m + t, m + t) of the moving displacements."""
        place, against_tilt = self._of_faces([state.face for state in self.equilibrium.lines.states])
        return self._springs(self.stiffness, place, against_tilt * self.equilibrium.closed)

    def _of_faces(self, faces: Sequence[FaceState | None]) -> np.ndarray:
        """Place in m and stiffness against a tilt in N m, (2, c), of contacts with a face map; 0 of the others."""
        return np.array(
            [
                (face.place, face.tilt_stiffness) if face and face_map else (0.0, 0.0)
                for face, face_map in zip(faces, self.face_maps, strict=True)
            ]
        ).T

    def _springs(self, stiffness: np.ndarray, place: np.ndarray, against_tilt: np.ndarray) -> np.ndarray:
        """Matrix (m + t, m + t) of contacts that are springs k at a place of their face and resist a tilt about it."""
        t = self.tilting
        K = np.diag(np.append(stiffness[self.mapped], against_tilt[t]))
        approaches = np.searchsorted(self.mapped, t)
        tilts = len(self.mapped) + np.arange(len(t))
        K[approaches, tilts] = K[tilts, approaches] = stiffness[t] * place[t]
        K[tilts, tilts] += stiffness[t] * place[t] ** 2
        return K

    @cached_property
    def spring_start(self) -> np.ndarray:
        """F (c,) in N of the contacts where their flanks have not approached, as springs."""
        return np.where(self.equilibrium.closed, self.equilibrium.lines.start, 0.0)

    @cached_property
    def compliance(self) -> np.ndarray:
        """A (c + t, m + t): all displacements under unit forces on the moving ones, with all contacts as springs k."""
        V = self.vectors
        return np.asarray(V.T @ self.equilibrium.solver.solve(V[:, self.moving], carried=True))

    def compliance_about(self, stiffness: np.ndarray, faces: Sequence[FaceState | None]) -> np.ndarray:
        """Approach (c, c) at their places under unit forces there of mapped contacts, about other springs: A (1 + dk A_m)^-1."""
        moving = self.moving
        place, against_tilt = self._of_faces(faces)
        change = self._springs(stiffness, place, against_tilt) - self.springs
        A = self.compliance @ np.linalg.inv(np.eye(len(moving)) + change @ self.compliance[moving])
        count = len(self.maps)
        places = np.vstack([np.eye(count), np.diag(place)[self.tilting]])  # of all displacements in those at the places
        found = np.zeros((count, count))
        found[:, self.mapped] = places.T @ A @ places[np.ix_(moving, self.mapped)]
        return found

    @cached_property
    def start(self) -> np.ndarray:
        """All displacements (c + t,) under the loads with the forces of moving ones k d."""
        equilibrium = self.equilibrium
        found = self.vectors.T @ equilibrium.q
        moment = equilibrium.moment + self.place * equilibrium.force  # about the middle of the face
        force = np.append(equilibrium.force[self.mapped], moment[self.tilting])
        return np.asarray(found + self.compliance @ (force - self.springs @ found[self.moving]))

    def cycle(self, running: np.ndarray, ratio: float) -> Cycle:
        """Solve one cycle: the contacts `running` go through it, the others stay on the mean of their curves."""
        maps = [one for i in running for one in (self.maps[i], self.face_maps[i]) if one is not None]
        periods = math.lcm(*(contact_map.periods for contact_map in maps))
        count = max(_POSITIONS, *(len(contact_map.position) // contact_map.periods for contact_map in maps))
        position = np.arange(count * periods) / count if ratio else np.zeros(1)
        tables = [self._table(int(i), position, i in running) for i in self.mapped]
        key = np.hstack([np.round(approach / (_ALIKE * (np.ptp(approach) or 1.0))) for approach, _ in tables])
        _, first, which = np.unique(key, axis=0, return_index=True, return_inverse=True)
        every = len(self.maps)
        mapped = len(self.mapped)
        approach, force, tilt, moment = np.zeros((4, len(first), every))
        for row, p in enumerate(first):
            if row % _TOGETHER == 0:
                curves = [curves_at(first[row : row + _TOGETHER]) for _, curves_at in tables]
            found = self._at([one[row % _TOGETHER] for one in curves])
            if not found.converged:
                names = ", ".join(dict.fromkeys(self.equilibrium.lines.names))
                raise AnalysisError(
                    f"meshes {names}: the loaded teeth have no equilibrium {position[p]:.3f} base pitches into their cycle; "
                    "look for a helix that hardly carries"
                )
            moved = self.start - self.compliance @ (found.force - self.springs @ found.d)
            approach[row] = moved[:every]
            force[row] = self.spring_start + self.stiffness * (approach[row] - self.gap)
            force[row, self.mapped] = found.force[:mapped]
            approach[row, self.mapped] = found.d[:mapped]
            moment[row, self.tilting] = found.force[mapped:]
            tilt[row, self.tilting] = found.d[mapped:]
        meshes = dict.fromkeys(self.equilibrium.lines.names[i] for i in running)
        every_row = (values[which.ravel()] for values in (approach, force, tilt, moment))
        return Cycle(tuple(meshes), ratio, periods, position, *every_row)

    def _at(self, curves: list[_Curve]) -> LocalEquilibrium:
        """Equilibrium of the mapped contacts on the curves of one position."""
        # Places of the displacements of each curve among the moving ones.
        contact = np.append(self.mapped, self.tilting)
        places = [np.flatnonzero(contact == i) for i in self.mapped]

        def laws(d: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            F = np.zeros(len(d))
            tangent = np.zeros((len(d), len(d)))
            for curve, at in zip(curves, places, strict=True):
                F[at], tangent[np.ix_(at, at)] = curve(d[at])
            return F, tangent

        return local_equilibrium(self.start[self.moving], self.compliance[self.moving], self.springs, laws)

    def mean_tangent(self, contact: int, cycle: Cycle) -> tuple[float, FaceState | None]:
        """Mean tangent (N/m) of a mapped contact over its cycle, and along its face where it has a face map."""
        u = self.sense[contact] * (self.pitch[contact] + cycle.position)
        contact_map = self.maps[contact]
        if contact_map is not None:
            return float(contact_map.stiffness(cycle.approach[:, contact] - self.gap[contact], u).mean()), None
        law = self.face_laws[contact]
        d = np.stack([cycle.approach[:, contact], cycle.tilt[:, contact]], axis=1)
        T = law.evaluate_many(d, 0.0 * d, angle=2.0 * math.pi * u).in_displacement.mean(axis=0)
        place = float(T[0, 1] / T[0, 0])
        against_tilt = float(T[1, 1] - place * T[0, 1])
        tilt = float(cycle.tilt[:, contact].mean())
        couple = float(cycle.moment[:, contact].mean() - place * cycle.force[:, contact].mean()) - against_tilt * tilt
        return float(T[0, 0]), FaceState(place, against_tilt, place * tilt, couple)

    @cached_property
    def face_laws(self) -> dict[int, ForceLaw]:
        """The law of each contact that has a face map, by its number."""
        stiffness = self.equilibrium.lines.stiffness
        return {
            i: teeth_law(face_map, float(stiffness[i]), float(self.gap[i]), order=1.0)
            for i, face_map in enumerate(self.face_maps)
            if face_map is not None
        }

    def _table(
        self, contact: int, position: np.ndarray, runs: bool
    ) -> tuple[np.ndarray, Callable[[np.ndarray], list[_Curve]]]:
        """A contact at the p positions of a cycle, or on the mean of its curves where it does not run through it.

        Returns:
            Approaches (p, a) that tell positions apart, and what gives its curves at some of these, taken by number.
        """
        u = self.sense[contact] * (self.pitch[contact] + position) if runs else None
        face_map = self.face_maps[contact]
        if face_map is not None:
            law = self.face_laws[contact]
            if u is None:
                return _constant(len(position), partial(_along_face, law.mean(), 0.0))
            rows = np.hstack([one.curves(one.load, u) for one in face_map.maps])
            return rows, lambda some: [partial(_along_face, law, float(place)) for place in u[some]]
        contact_map = self.maps[contact]
        assert contact_map is not None
        gap = float(self.gap[contact])
        load = contact_map.load
        far = 10.0 * contact_map.largest_load
        fine = np.append((load[:-1, None] + np.diff(load)[:, None] * (np.arange(_FINER) / _FINER)).ravel(), load[-1])
        forces = np.append(fine, far)

        def approaches(u: np.ndarray) -> np.ndarray:
            return np.column_stack([contact_map.curves(fine, u), contact_map.approach_at(far, u)])

        if u is None:
            mean = gap + approaches(contact_map.position).mean(axis=0)
            return _constant(len(position), partial(_straight, mean, forces))
        rows = np.column_stack([contact_map.at_loads(u), contact_map.approach_at(far, u)])
        return rows, lambda some: [partial(_straight, gap + row, forces) for row in approaches(u[some])]


def _constant(count: int, curve: _Curve) -> tuple[np.ndarray, Callable[[np.ndarray], list[_Curve]]]:
    """A table whose curve is the same at all positions."""
    return np.ones((count, 1)), lambda some: [curve] * len(some)


def _along_face(law: ForceLaw, place: float, d: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Force in N and moment in N m, and their tangents (2, 2), at an approach and a tilt (2,) at a place on the map."""
    found = law.evaluate(d, angle=2.0 * math.pi * place)
    return found.force, found.in_displacement


def _straight(approach: np.ndarray, load: np.ndarray, d: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Force (1,) in N and tangent (1, 1) at an approach (1,), straight between points (n,): rising approach in m, load in N."""
    delta = float(d[0])
    if delta <= approach[0]:
        return np.zeros(1), np.zeros((1, 1))
    i = min(int(np.searchsorted(approach, delta)), len(load) - 1)
    slope = float((load[i] - load[i - 1]) / (approach[i] - approach[i - 1]))
    return np.array([load[i - 1] + slope * (delta - approach[i - 1])]), np.array([[slope]])
