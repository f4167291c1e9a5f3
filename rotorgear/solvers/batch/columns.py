"""How local displacements act in the kernels of a batch: what a law answers, and what the kernels read. Needs no compiler."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np

from rotorgear.solvers.contact.kinds import ADHESIVE, DEAD_ZONE, PENETRATION, UNILATERAL

# Kinds of columns beside the contacts of solvers/contact/kinds.py: a force that is prescribed, or a law of its own, which the
# kernels call by pointer, one system at a time.
PRESCRIBED = 3
OWN_LAW = 4
# When the damping of a column jumps, or nearly does: never, as sides close, or as they close and as they part.
NEVER = 0
CLOSING = 1
ALWAYS = 2
# Rows of the tables of what varies: share of the mean stiffness, error, its slope, share of the prescribed force.
STIFFNESS = 0
ERROR = 1
SLOPE = 2
PUSH = 3
TABLE_ROWS = 4


@dataclass(frozen=True)
class Column:
    """How one local displacement acts.

    Attributes:
        kind: of contact, or PRESCRIBED or OWN_LAW; mode: of its damping.
        stiffness: mean, N/m; damping: N s/m; clearance: between both sides, m.
        depth: regularisation depth over which damping grows, m; push: N, by which the table's share is multiplied.
        counted: whether statistics of contact are kept of it.
    """

    kind: int
    mode: int = 0
    stiffness: float = 0.0
    damping: float = 0.0
    clearance: float = 0.0
    depth: float = 1.0
    push: float = 0.0
    counted: bool = False


@dataclass(frozen=True)
class Columns:
    """The columns of a system, arrays (m,), as `Column` has them but for per_depth = 1/depth."""

    kind: np.ndarray
    mode: np.ndarray
    stiffness: np.ndarray
    damping: np.ndarray
    clearance: np.ndarray
    per_depth: np.ndarray
    push: np.ndarray
    counted: np.ndarray

    @classmethod
    def of(cls, columns: Sequence[Column]) -> Columns:
        """Put columns side by side."""
        kind, mode, stiffness, damping, clearance, depth, push, counted = (
            np.array([getattr(column, item.name) for column in columns]) for item in fields(Column)
        )
        return cls(
            kind.astype(np.int64),
            mode.astype(np.int64),
            stiffness.astype(float),
            damping.astype(float),
            clearance.astype(float),
            1.0 / depth.astype(float),
            push.astype(float),
            counted.astype(bool),
        )

    @property
    def jumps(self) -> np.ndarray:
        """(m,) whether the damping sets in where sides meet: NEVER, only as they CLOSE, or ALWAYS, as they part as well."""
        parts = ((self.kind == DEAD_ZONE) | (self.kind == UNILATERAL)) & (self.mode != PENETRATION)
        sudden = parts & (self.damping > 0.0)
        return np.where(sudden, np.where(self.mode == ADHESIVE, ALWAYS, CLOSING), NEVER).astype(np.int64)

    @property
    def values(self) -> np.ndarray:
        """(m, 6) as the kernels read them: k, c, clearance, 1/depth, prescribed force, depth."""
        return np.stack(
            [self.stiffness, self.damping, self.clearance, self.per_depth, self.push, 1.0 / self.per_depth], axis=1
        )

    def scaled(self, w: float) -> Columns:
        """Forces over w^2, damping over w: as time counts in 1/w."""
        return Columns(
            self.kind,
            self.mode,
            self.stiffness / w**2,
            self.damping / w,
            self.clearance,
            self.per_depth,
            self.push / w**2,
            self.counted,
        )
