"""Modes at any speed from a small basis: the lowest modes at a few speeds, checked by true solutions in the middles between them.

Snapshots are taken at both ends of the speed range. In the middle between two snapshots the true sparse solution is compared with
the projected one; where a frequency is off by more than `TOLERANCE` the true modes join the basis and both halves are checked in
turn. A mode that is far softer than the stiffness of its dofs is a small difference of large forces, in the true solution as well
as in the projected one: where the basis has its shape already, what rounding explains is no error of the basis, and stands as the
error of the result. Projection: Galerkin on real and imaginary parts of the modes, each independent group of dofs by itself.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from typing import Any

import numpy as np

from rotorgear.analysis.campbell.speed_family import SpeedFamily
from rotorgear.analysis.common.stream import Piece, unkept
from rotorgear.analysis.modal.reach import Reach
from rotorgear.analysis.modal.solve import Wanted, group_notes, solve, with_modal_damping
from rotorgear.errors import AnalysisError, ConvergenceError
from rotorgear.progress import Progress, silent
from rotorgear.quantity import RPM_PER_RAD_S
from rotorgear.solvers.eigen.one_to_one import least_cost
from rotorgear.solvers.eigen.reduced_pencil import Eigen, Pencil, eigen
from rotorgear.solvers.eigen.undamped_basis import ScaledBasis
from rotorgear.system.components import dof_motions
from rotorgear.system.system import System

TOLERANCE = 1e-9
# Part of a mode outside of the basis that is not worth a column: with damping it moves the frequency in proportion.
_NEGLIGIBLE = 1e-8
_MOST_SNAPSHOTS = 65
# Error that rounding may make, and no more: behind it a frequency says nothing.
_MOST_ROUNDED = 1e-5
# More modes than asked for at every snapshot, so that those which come down with speed are known before they arrive.
_SPARE = 4
_SPARE_SHARE = 0.25
_BEYOND_LIMIT = 1.15
_STILL = 1e-5
# Of the modes of a group in the basis, all but the pencil, which follows from the basis.
_OF_EIGEN = ("s", "q", "y", "real")


@dataclass(frozen=True)
class Snapshot:
    """True modes at a speed: those that oscillate, lowest |s| first, s (m,) and free shapes (n, m); rigid shapes (n, r)."""

    speed: float
    s: np.ndarray
    vectors: np.ndarray
    rigid: np.ndarray


@dataclass
class _Group:
    """One independent group of dofs: its basis, its projected matrices and what to look for."""

    dofs: np.ndarray
    space: ScaledBasis
    family: Callable[[float], Pencil]
    shift: float = 1.0
    smallest: float = 0.0
    count: int = 0


class SpeedModes:
    """Modes of a system at any speed from `low` to `high`, from a certified basis.

    Args:
        system: what turns. low, high: ends of the range of speeds. reach: the modes that are asked for. only: as in `modal`.
        progress: is told how far the basis is.
        piece: solves for the true modes, or those in the basis, at a speed, or takes them over.

    Attributes:
        reach: how many of the oscillating modes are asked for.
        snapshots: the true solutions in the basis; checks: (speed, largest relative error) of true solutions that are not.

    Raises:
        ConvergenceError: the basis doesn't reach the tolerance.
    """

    def __init__(
        self,
        system: System,
        low: float,
        high: float,
        reach: Reach,
        only: tuple[str, ...] = (),
        progress: Progress = silent,
        piece: Piece = unkept,
    ) -> None:
        self.system = system
        self.reach = reach
        self._only = only
        self._piece = piece
        self.family = SpeedFamily(system, low, high)
        self.snapshots: list[Snapshot] = []
        self.checks: list[tuple[float, float]] = []
        weight = np.sqrt(_size(system, low))
        nothing = self.family.reduced(np.zeros((system.n, 0)))
        self._parts = [_Group(dofs, ScaledBasis(weight[dofs]), nothing) for dofs in self.family.groups]
        self._known: dict[float, list[Eigen]] = {}
        self._still = 0  # rigid motions and overdamped ones among the lowest, as far as they are known
        self._build(low, high, progress)

    @property
    def error(self) -> float:
        """Largest relative error of an eigenvalue against the true solutions that are not in the basis."""
        return max((error for _, error in self.checks), default=0.0)

    @property
    def size(self) -> int:
        """Number of columns of the basis."""
        return sum(part.space.size for part in self._parts)

    @property
    def notes(self) -> tuple[str, ...]:
        """Sentences about groups of dofs that were solved apart or left out."""
        chosen = [part.dofs for part in self._parts if part.space.size]
        return group_notes(dof_motions(self.system), self.family.groups, chosen)

    def basis(self) -> list[np.ndarray]:
        """The basis of each group over all free dofs, (n, r_g)."""
        found = []
        for part in self._parts:
            whole = np.zeros((self.system.n, part.space.size))
            whole[part.dofs] = part.space.basis
            found.append(whole)
        return found

    def at(self, speed: float) -> list[Eigen]:
        """Oscillating modes of each group at a speed, in coordinates of its basis; without the model's modal damping ratio."""
        speed = float(speed)
        if speed not in self._known:
            done = self._piece(partial(self._in_basis, speed))
            columns = (done[name] for name in _OF_EIGEN)
            pencils = [part.family(speed) for part in self._parts]
            self._known[speed] = [Eigen(*row) for row in zip(*columns, pencils, strict=True)]
        return self._known[speed]

    def _in_basis(self, speed: float) -> dict[str, tuple[np.ndarray, ...]]:
        """What `Eigen` has of each group at a speed, but for the pencil."""
        found = [eigen(p.family(speed), p.shift, p.smallest, p.count) for p in self._parts]
        # In one order in memory, as they come back from a file: products depend on it in the last digit.
        return {name: tuple(np.ascontiguousarray(getattr(one, name)) for one in found) for name in _OF_EIGEN}

    def pencil(self, group: int, speed: float) -> Pencil:
        """Projected matrices of a group at a speed."""
        return self._parts[group].family(speed)

    def damped(self, s: np.ndarray) -> np.ndarray:
        """Eigenvalues with the modal damping ratio of the model added, and without rounding where nothing else damps."""
        if self.family.is_conservative:
            s = np.where(np.isnan(s), s, 1j * s.imag)  # a branch that is not there stays so
        zeta = self.system.model.damping.modal_ratio
        return with_modal_damping(s, zeta) if zeta else s

    def _build(self, low: float, high: float, progress: Progress) -> None:
        ends = list(dict.fromkeys((low, high)))
        for k, speed in enumerate(ends):
            progress(0.3 * k / len(ends), f"true modes, {self.system.n} dofs")
            self._add(self._taken(speed))
        self._project()
        waiting = list(pairwise(ends))
        while waiting:
            a, b = waiting.pop(0)
            middle = self._taken(0.5 * (a + b))
            error = self._error(middle)
            progress(0.5, f"checked at {len(self.checks) + 1} speeds")
            if error <= TOLERANCE:
                self.checks.append((middle.speed, error))
                continue
            if len(self.snapshots) >= _MOST_SNAPSHOTS or not self._add(middle):
                if error <= min(self._rounding(middle), _MOST_ROUNDED):
                    self.checks.append((middle.speed, error))
                    continue
                raise ConvergenceError(
                    f"modes from a basis of {self.size} columns are {error:.1e} off at {middle.speed * RPM_PER_RAD_S:.6g} rpm, "
                    f"above {TOLERANCE:g}; ask for fewer modes or a narrower range of speeds, or use modal at single speeds"
                )
            self._project()
            waiting += pairwise((a, middle.speed, b))

    def _taken(self, speed: float) -> Snapshot:
        """The true modes at a speed, with spare ones."""
        done = self._piece(partial(self._true, speed))
        self._still = done["still"]
        return Snapshot(speed, done["s"], done["vectors"], done["rigid"])

    def _true(self, speed: float) -> dict[str, Any]:
        """What `Snapshot` has of a speed, by the sparse solver, and how many rigid and overdamped motions are known then."""
        asked = self.reach.modes
        count = None if asked is None else asked + max(_SPARE, int(_SPARE_SHARE * asked))
        limit = None if self.reach.limit is None else self.reach.limit * _BEYOND_LIMIT
        while True:
            number = None if count is None else count + self._still
            found = solve(self.system, Wanted(speed, number, limit, self._only))
            s = found.eigenvalues
            moving = np.flatnonzero(~found.rigid & (s.imag > 1e-9 * np.abs(s)))
            if count is None or number is None or len(moving) >= count or len(s) < number:
                break
            self._still += count - len(moving)
        kept = moving[:count]
        shapes = (found.vectors[:, kept], found.vectors[:, found.rigid].real)
        vectors, rigid = map(np.ascontiguousarray, shapes)
        return {"s": s[kept], "vectors": vectors, "rigid": rigid, "still": self._still}

    def _add(self, snapshot: Snapshot) -> int:
        """Put a true solution into the basis; return the number of new columns."""
        self.snapshots.append(snapshot)
        new = 0
        for part in self._parts:
            for vectors in (snapshot.rigid, snapshot.vectors):
                here = vectors[part.dofs]
                here = here[:, np.abs(here).max(axis=0, initial=0.0) > 0.0]
                new += part.space.add_modes(here, _NEGLIGIBLE) if here.shape[1] else 0
        return new

    def _project(self) -> None:
        self._known.clear()
        for part, V in zip(self._parts, self.basis(), strict=True):
            # |s| of the modes of each snapshot that move the group.
            moves = [np.abs(one.vectors[part.dofs]).max(axis=0, initial=0.0) > 0.0 for one in self.snapshots]
            sizes = [np.abs(one.s[moving]) for one, moving in zip(self.snapshots, moves, strict=True)]
            size = np.concatenate(sizes)
            if not part.space.size or not size.size:
                continue
            part.family = self.family.reduced(V)
            part.shift = float(np.sqrt(size.min() * size.max()))
            part.smallest = _STILL * float(size.min())
            part.count = max(map(len, sizes)) + _SPARE

    def _rounding(self, true: Snapshot) -> float:
        """Largest relative error that rounding of K v may make of an eigenvalue, eps |v|^T |K| |v| / (2 |s|^2 v^H M v)."""
        V = true.vectors
        forces = np.sum(np.abs(V) * (abs(self.system.stiffness(true.speed)) @ np.abs(V)), axis=0)
        inertia = np.abs(true.s) ** 2 * np.real(np.sum(V.conj() * (self.system.mass @ V), axis=0))
        return float(np.max(0.5 * np.finfo(float).eps * forces / inertia, initial=0.0))

    def _error(self, true: Snapshot) -> float:
        """Largest relative error of the asked eigenvalues at a speed, each with a partner of its own."""
        found = self.damped(np.concatenate([np.zeros(0), *(part.s for part in self.at(true.speed))]))
        asked = true.s[: max(self.reach.inside(np.abs(true.s)), 1)]
        if len(found) < len(asked):
            return float("inf")
        if not len(asked):
            return 0.0
        distance = np.abs(found - asked[:, None]) / np.abs(asked)[:, None]
        rows, columns = least_cost(np.minimum(distance, 1.0))
        return float(distance[rows, columns].max(initial=0.0))


def _size(system: System, speed: float) -> np.ndarray:
    """Weights of the dofs (n,): stiffness and inertia of each, the latter at a typical dof's own frequency."""
    K = system.stiffness(speed).diagonal()
    M = system.mass.diagonal()
    both = (K > 0.0) & (M > 0.0)
    if not both.any():
        raise AnalysisError("nothing in the model has both stiffness and inertia: there is no vibration to follow")
    size = K + 1e-4 * float(np.median(K[both] / M[both])) * M
    return np.where(size > 0.0, size, size[size > 0.0].min())
