"""Local forces as integrators see them: m relative displacements d, and compiled laws that act on them.

A law has two compiled functions. `schedule(angle, speed, time, parameters, state)` fills what depends on time only, once a
step. `force(parameters, state, d, v, F, Kd, Kv, energy)` fills the force (k,), its tangents in d and v (k*k, row by row) and
energy = [stored, power put in by what is prescribed, power dissipated, contact: 1 front side, -1 back side, 0 apart].
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
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

    def arguments(self) -> Laws:
        """What the compiled loops take."""
        from rotorgear.solvers.time.compiled import FORCE, SCHEDULE, handed

        return Laws(
            tuple(handed(one, SCHEDULE) for one in self.schedules),
            tuple(handed(one, FORCE) for one in self.forces),
            self.kind,
            self.first,
            self.parameters,
            self.parameters_first,
            self.state_first,
            self.block_first,
            self.conserves,
            self.extents,
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
    parameters = [np.ascontiguousarray(law.parameters(), dtype=float) for law in laws]
    m = sum(sizes)
    K = np.zeros((m, m))
    C = np.zeros((m, m))
    first = _starts(sizes)
    for law, at, size in zip(laws, first, sizes, strict=False):
        K[at : at + size, at : at + size] = law.reference_stiffness()
        C[at : at + size, at : at + size] = law.reference_damping()
    return LocalForces(
        laws=laws,
        schedules=tuple(pair[0] for pair in filled),
        forces=tuple(pair[1] for pair in filled),
        kind=np.array([kinds.index(law.functions()) for law in laws], dtype=np.int64),
        first=first,
        parameters=np.concatenate([*parameters, np.zeros(0)]),
        parameters_first=_starts([p.size for p in parameters]),
        state_first=_starts([law.state_size() for law in laws]),
        block_first=_starts([size**2 for size in sizes]),
        conserves=np.array([law.conserves for law in laws], dtype=bool),
        reference_stiffness=K,
        reference_damping=C,
    )


def _starts(sizes: list[int]) -> np.ndarray:
    return np.concatenate([[0], np.cumsum(sizes)]).astype(np.int64)
