"""Energy ledger of a transient: what comes in, what is stored, what is dissipated, and what integration made or lost.

Sums over contacts are taken at every step, those over linear dampers at the records (trapezoidal rule), stored
energies at some of them.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import scipy.sparse as sp

from rotorgear.results.transient import EnergyLedger
from rotorgear.solvers.time.local_system import LocalSystem, Records, State, local_values

# Records of a chunk at which stored energies are evaluated.
_SAMPLES = 4
_ROUNDING = 1e-9


@dataclass
class _Power:
    """v^T A w over the dofs that A touches, w = v or q."""

    A: np.ndarray
    rows: np.ndarray
    kind: str

    @staticmethod
    def of(matrix: sp.csc_array, kind: str, n: int) -> _Power | None:
        """None where the matrix has no entries."""
        matrix = sp.csc_array(matrix)
        matrix.eliminate_zeros()
        if not matrix.nnz:
            return None
        touched = np.unique(np.concatenate([matrix.tocoo().row, matrix.tocoo().col]))
        Y = np.zeros((touched.size, n))
        Y[np.arange(touched.size), touched] = 1.0
        return _Power(matrix[touched][:, touched].toarray(), Y, kind)

    def at(self, records: Records) -> np.ndarray:
        v = records.fields.rows("v", self.rows)
        w = v if self.kind == "v" else records.fields.rows("q", self.rows)
        return np.asarray(np.einsum("ri,ri->r", v, w @ self.A.T))


@dataclass
class LedgerBook:
    """Collects the ledger chunk by chunk."""

    system: LocalSystem
    h: float
    start: State
    damping_rows: np.ndarray
    table: list[np.ndarray] = field(default_factory=list)
    _spent: float = 0.0
    _last: tuple[float, float] | None = None

    def __post_init__(self) -> None:
        s = self.system
        K = sp.csc_array(0.5 * (s.K + s.K.T))
        self._stiffness = K
        candidates = [
            _Power.of(sp.csc_array(0.5 * (s.D + s.D.T)), "v", s.n),
            _Power.of(sp.csc_array(s.K - K), "q", s.n),
        ]
        self._powers = [power for power in candidates if power is not None]
        self._load = s.load[None, :]
        self._all = np.eye(s.n)
        _, energy = local_values(s, self.start.q, self.start.v, 0.0)
        contact = float(energy.reshape(-1, 4)[:, 0].sum())
        kinetic, strain = self._stored(self.start.q[None], self.start.v[None])
        self._stored_at_start = float(kinetic[0] + strain[0]) + contact
        self._work_at_start = float(s.load @ self.start.q)
        self.table.append(np.array([[0.0, kinetic[0], strain[0], contact, 0.0, 0.0, 0.0]]))

    def _stored(self, q: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        s = self.system
        return 0.5 * np.einsum("ri,ri->r", v, (s.M @ v.T).T), 0.5 * np.einsum("ri,ri->r", q, (self._stiffness @ q.T).T)

    def add(self, records: Records) -> None:
        """Take a chunk of records."""
        if not records.t.size:
            return
        power = sum((p.at(records) for p in self._powers), np.zeros(records.t.size))
        if len(self.damping_rows):
            power = power + np.sum(records.fields.rows("v", self.damping_rows) ** 2, axis=1)
        t0, p0 = self._last or (0.0, power[0])
        steps = np.diff(records.t, prepend=t0)
        spent = self._spent + np.cumsum(steps * 0.5 * (power + np.concatenate([[p0], power[:-1]])))
        self._spent, self._last = float(spent[-1]), (float(records.t[-1]), float(power[-1]))
        which = np.unique(np.linspace(0, records.t.size - 1, _SAMPLES + 1).astype(int)[1:])
        fields = records.fields.chosen(which)
        q = fields.rows("q", self._all)
        v = fields.rows("v", self._all)
        kinetic, strain = self._stored(q, v)
        laws = records.energy[which].sum(axis=1)
        work = q @ self._load[0] - self._work_at_start
        self.table.append(
            np.column_stack(
                [records.t[which], kinetic, strain, laws[:, 0], work, laws[:, 1], spent[which] + laws[:, 2]]
            )
        )

    def sums(self) -> tuple[float, float, float]:
        """What must be known to go on: energy spent in dampers, and time and power of the last record."""
        return (self._spent, *(self._last or (0.0, 0.0)))

    def set_sums(self, sums: np.ndarray) -> None:
        """Go on after a chunk that was read."""
        self._spent, self._last = float(sums[0]), (float(sums[1]), float(sums[2]))

    def close(self) -> EnergyLedger:
        """Return the ledger."""
        t, kinetic, strain, contact, work, excitation, dissipated = np.vstack(self.table).T
        stored = kinetic + strain + contact
        numerical = stored - self._stored_at_start - work - excitation + dissipated
        # Less than rounding of the energy that is stored is no exchange of energy.
        terms = (work, excitation, dissipated, stored - self._stored_at_start, kinetic)
        scale = max(_ROUNDING * float(np.abs(stored).max()), *(float(np.abs(x).max()) for x in terms))
        share = float(np.abs(numerical).max()) / scale if scale > 0.0 else 0.0
        return EnergyLedger(t, kinetic, strain, contact, work, excitation, dissipated, numerical, share)
