"""Local forces as integrators see them: m relative displacements d, and compiled laws that act on them.

A law has two compiled functions. `schedule(angle, speed, time, parameters, state)` fills what depends on time only, once a
step. `force(parameters, state, d, v, F, Kd, Kv, energy)` fills the force (k,), its tangents in d and v (k*k, row by row) and
energy = [stored, power put in by what is prescribed, power dissipated, contact: 1 front side, -1 back side, 0 apart].
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import pairwise
from typing import Any, Protocol

import numpy as np

from rotorgear.solvers.time.arguments import Laws

# Different laws that one model may hold; the compiled loops take a tuple of this length.
MOST_LAWS = 8


@dataclass(frozen=True)
class Repeats:
    """What varies in a law as the reference turns.

    Attributes:
        order: periods in a turn of the reference, positive. harmonics: of it that matter.
        common: whether it belongs to a common period with what else varies: rolling elements don't, for cages turn with slip-free
            kinematics that never repeat with anything else.
    """

    order: float
    harmonics: int = 1
    common: bool = True


class LocalLaw(Protocol):
    """What a law offers to solvers; forces/law.py says more of each."""

    @property
    def components(self) -> int:
        """Number k of its relative displacements."""

    @property
    def uses_velocity(self) -> bool:
        """Whether force or energy depend on the velocities."""

    @property
    def extents(self) -> np.ndarray:
        """Displacements (k,) that change the force by the size of what cancels in it; 0: nothing does."""

    def functions(self) -> tuple[Any, Any]:
        """Return the compiled functions schedule and force."""

    def parameters(self) -> np.ndarray:
        """Return the parameters as the compiled functions read them."""

    def state_size(self) -> int:
        """Length of the time-dependent state."""

    def reference_stiffness(self) -> np.ndarray:
        """Linear stiffness (k, k) about which a solver may expand."""

    def reference_damping(self) -> np.ndarray:
        """Linear damping (k, k) about which a solver may expand."""

    def closed_stiffness(self) -> np.ndarray:
        """Mean stiffness (k, k) with all contacts closed."""

    def mean(self) -> LocalLaw:
        """Return the law without anything that varies in time."""

    def repeats(self) -> tuple[Repeats, ...]:
        """What varies with the angle of the reference."""

    def unsettled(self) -> str:
        """Why the law allows no settled motion, as a clause; empty where it does."""

    @property
    def conserves(self) -> bool:
        """Whether the energy it stores is the potential of its elastic force."""

    def columns(self, speed: float = 1.0) -> tuple[Any, ...]:
        """How each displacement acts in a sweep: a `Column` of solvers/batch/columns.py each."""

    def table(self, angles: np.ndarray, states: np.ndarray, order: float) -> np.ndarray:
        """What varies in the columns, (r, k, 4)."""

    def table_key(self) -> bytes:
        """Bytes that two laws share where their tables are the same."""


@dataclass(frozen=True)
class LocalForces:
    """Laws side by side in flat arrays.

    Attributes:
        laws: the laws in order.
        schedules, forces: compiled functions of the different kinds, filled up to MOST_LAWS.
        kind: (l,) which of them each law uses.
        first: (l + 1,) place of each law's displacements among the m.
        parameters, parameters_first: all parameters, and (l + 1,) where those of each law begin.
        state_first: (l + 1,) the same for the state.
        block_first: (l + 1,) the same for the tangents, k*k each.
        conserves: (l,) whether the energy that a law stores is the potential of its elastic force.
    """

    laws: tuple[LocalLaw, ...]
    schedules: tuple[Any, ...]
    forces: tuple[Any, ...]
    kind: np.ndarray
    first: np.ndarray
    parameters: np.ndarray
    parameters_first: np.ndarray
    state_first: np.ndarray
    block_first: np.ndarray
    conserves: np.ndarray
    reference_stiffness: np.ndarray = field(default_factory=lambda: np.zeros((0, 0)))
    reference_damping: np.ndarray = field(default_factory=lambda: np.zeros((0, 0)))

    @property
    def m(self) -> int:
        """Number of relative displacements."""
        return int(self.first[-1])

    @cached_property
    def extents(self) -> np.ndarray:
        """Displacements (m,) that change the forces by the size of what cancels in them."""
        return np.concatenate([*(law.extents for law in self.laws), np.zeros(0)])

    def with_laws(self, laws: tuple[LocalLaw, ...]) -> LocalForces:
        """Other laws of the same displacements, about the same linear reference."""
        return replace(
            gather(laws), reference_stiffness=self.reference_stiffness, reference_damping=self.reference_damping
        )

    def with_numbers_of(self, laws: tuple[LocalLaw, ...]) -> LocalForces:
        """Laws of the same kinds with as many parameters, about the same reference stiffness; what they share is there once."""
        return replace(
            self,
            laws=laws,
            parameters=_after_each_other([law.parameters() for law in laws]),
            reference_damping=_side_by_side([law.reference_damping() for law in laws], self.first),
        )

    @property
    def mean(self) -> LocalForces:
        """The laws without anything that varies in time, about the same linear reference."""
        return self.with_laws(tuple(law.mean() for law in self.laws))

    @cached_property
    def places(self) -> tuple[np.ndarray, np.ndarray]:
        """Rows and columns (b,) among the m displacements that the entries of the flat tangents belong to."""
        both = [(i, j) for a, b in pairwise(self.first) for i in range(a, b) for j in range(a, b)]
        rows, columns = np.array(both, dtype=int).reshape(-1, 2).T
        return rows, columns

    def matrix(self, blocks: np.ndarray) -> np.ndarray:
        """A tangent (m, m) from the flat one (b,)."""
        A = np.zeros((self.m, self.m))
        A[self.places] = blocks
        return A

    @cached_property
    def _each(self) -> list[tuple[Any, Any, np.ndarray, slice, slice, slice]]:
        """Of each law its functions and parameters, and its parts of the displacements, tangents and states."""
        return [
            (
                self.schedules[kind],
                self.forces[kind],
                self.parameters[self.parameters_first[i] : self.parameters_first[i + 1]],
                slice(self.first[i], self.first[i + 1]),
                slice(self.block_first[i], self.block_first[i + 1]),
                slice(self.state_first[i], self.state_first[i + 1]),
            )
            for i, kind in enumerate(self.kind)
        ]

    def answer(
        self, angle: float, speed: float, t: float, d: np.ndarray, v: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Forces (m,), tangents in d and v (flat blocks) and energies (4 l,) at angle and speed of the reference and a time.

        Law by law from Python: to hand all compiled functions over as one tuple costs a hundred times the evaluation.
        """
        F = np.zeros(self.m)
        energy = np.zeros(4 * len(self.laws))
        states = np.zeros(self.state_first[-1])
        Kd = np.zeros(self.block_first[-1])
        Kv = np.zeros(self.block_first[-1])
        d = np.ascontiguousarray(d, dtype=float)
        v = np.ascontiguousarray(v, dtype=float)
        for i, (schedule, force, parameters, rows, block, own) in enumerate(self._each):
            schedule(angle, speed, t, parameters, states[own])
            force(parameters, states[own], d[rows], v[rows], F[rows], Kd[block], Kv[block], energy[4 * i : 4 * i + 4])
        return F, Kd, Kv, energy

    def arguments(self) -> Laws:
        """What the compiled loops take."""
        from rotorgear.solvers.time.compiled import FORCE, SCHEDULE, handed

        return Laws(
            tuple(handed(one, SCHEDULE) for one in self.schedules),
            tuple(handed(one, FORCE) for one in self.forces),
            *(getattr(self, name) for name in Laws._fields[2:]),
        )


def gather(laws: tuple[LocalLaw, ...]) -> LocalForces:
    """Put laws side by side.

    Raises:
        ValueError: more than MOST_LAWS different kinds.
    """
    from rotorgear.solvers.time.kernel_contact import no_force, no_schedule

    kinds: list[tuple[Any, Any]] = []
    for law in laws:
        if law.functions() not in kinds:
            kinds.append(law.functions())
    if len(kinds) > MOST_LAWS:
        raise ValueError(f"{len(kinds)} different force laws, at most {MOST_LAWS} can act in one model")
    filled = kinds + [(no_schedule, no_force)] * (MOST_LAWS - len(kinds))
    sizes = [law.components for law in laws]
    parameters = [law.parameters() for law in laws]
    first = _starts(sizes)
    return LocalForces(
        laws=laws,
        schedules=tuple(pair[0] for pair in filled),
        forces=tuple(pair[1] for pair in filled),
        kind=np.array([kinds.index(law.functions()) for law in laws], dtype=np.int64),
        first=first,
        parameters=_after_each_other(parameters),
        parameters_first=_starts([p.size for p in parameters]),
        state_first=_starts([law.state_size() for law in laws]),
        block_first=_starts([size**2 for size in sizes]),
        conserves=np.array([law.conserves for law in laws], dtype=bool),
        reference_stiffness=_side_by_side([law.reference_stiffness() for law in laws], first),
        reference_damping=_side_by_side([law.reference_damping() for law in laws], first),
    )


def _after_each_other(parameters: list[np.ndarray]) -> np.ndarray:
    """All parameters in a row."""
    parts = [np.ascontiguousarray(own, dtype=float) for own in parameters]
    # Of one law as they are: maps over a long cycle are large.
    return parts[0] if len(parts) == 1 else np.concatenate([*parts, np.zeros(0)])


def _side_by_side(blocks: list[np.ndarray], first: np.ndarray) -> np.ndarray:
    """Blocks on the diagonal of a matrix (m, m)."""
    found = np.zeros((first[-1], first[-1]))
    for block, (a, b) in zip(blocks, pairwise(first.tolist()), strict=True):
        found[a:b, a:b] = block
    return found


def _starts(sizes: list[int]) -> np.ndarray:
    return np.concatenate([[0], np.cumsum(sizes)]).astype(np.int64)
