"""How local displacements act in the kernels of a batch: what a law answers, and what the kernels read. Needs no compiler."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

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
FORCE_SHARE = 3
TABLE_ROWS = 4
# Values of a column: k, c, clearance, 1/depth of regularisation, prescribed force, depth of regularisation.
K, C, CLEARANCE, PER_DEPTH, FORCE, DEPTH = range(6)
VALUES = 6


@dataclass(frozen=True)
class Column:
    """How one local displacement acts.

    Attributes:
        kind: of contact, or PRESCRIBED or OWN_LAW; mode: of its damping.
        stiffness: mean, N/m; damping: N s/m; clearance: between both sides, m.
        depth: regularisation depth over which damping grows, m; prescribed: N, by which the table's share is multiplied.
        counted: whether statistics of contact are kept of it.
    """

    kind: int
    mode: int = 0
    stiffness: float = 0.0
    damping: float = 0.0
    clearance: float = 0.0
    depth: float = 1.0
    prescribed: float = 0.0
    counted: bool = False


class Columns(NamedTuple):
    """m columns as the kernels read them.

    Attributes:
        kind, mode, counted: (m,) as of `Column`.
        jumps: (m,) whether the damping sets in where sides meet: NEVER, only as they CLOSE, or ALWAYS, as they part as well.
        jumping: whether that of any one does.
        values: (m, 6) of one system, (m, 6, w) of a batch: K ... DEPTH.
    """

    kind: np.ndarray
    mode: np.ndarray
    jumps: np.ndarray
    counted: np.ndarray
    jumping: bool
    values: np.ndarray

    @classmethod
    def of(cls, columns: Sequence[Column]) -> Columns:
        """Put columns side by side."""
        kind = np.array([column.kind for column in columns], dtype=np.int64)
        mode = np.array([column.mode for column in columns], dtype=np.int64)
        counted = np.array([column.counted for column in columns], dtype=bool)
        rows = [(c.stiffness, c.damping, c.clearance, 1.0, c.prescribed, c.depth) for c in columns]
        values = np.array(rows, dtype=float).reshape(-1, VALUES)
        values[:, PER_DEPTH] = 1.0 / values[:, DEPTH]
        values[:, DEPTH] = 1.0 / values[:, PER_DEPTH]
        parts = ((kind == DEAD_ZONE) | (kind == UNILATERAL)) & (mode != PENETRATION)
        sudden = parts & (values[:, C] > 0.0)
        jumps = np.where(sudden, np.where(mode == ADHESIVE, ALWAYS, CLOSING), NEVER).astype(np.int64)
        return cls(kind, mode, jumps, counted, bool(np.any(sudden)), values)

    @property
    def stiffness(self) -> np.ndarray:
        """Mean stiffness of each, (m,)."""
        return self.values[:, K]

    @property
    def damping(self) -> np.ndarray:
        """Damping of each, (m,)."""
        return self.values[:, C]

    @property
    def clearance(self) -> np.ndarray:
        """Clearance of each between both sides, (m,)."""
        return self.values[:, CLEARANCE]

    def scaled(self, w: float) -> Columns:
        """Forces over w^2, damping over w: as time counts in 1/w."""
        return self._replace(values=self.values / np.array([w**2, w, 1.0, 1.0, w**2, 1.0]))
