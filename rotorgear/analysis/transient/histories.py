"""One integration of a local model: its histories and ledger, kept in memory and, if wished, streamed chunk by chunk.

Energy ledger of a transient: what comes in, what is stored, what is dissipated, and what integration made or lost.

Sums over contacts are taken at every step, those over linear dampers at the records (trapezoidal rule), stored
energies at some of them.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import scipy.sparse as sp

from rotorgear.analysis.common.stream import Stream
from rotorgear.analysis.transient.request import Grid, Task
from rotorgear.errors import ConvergenceError
from rotorgear.model.model import model_hash
from rotorgear.progress import Progress
from rotorgear.results.transient import EnergyLedger
from rotorgear.solvers.time.arguments import Gathered
from rotorgear.solvers.time.local_system import (
    Integrator,
    LocalSystem,
    MotionState,
    Records,
    local_values,
    state_at_rest,
)
from rotorgear.solvers.time.run import Schedule, run
from rotorgear.solvers.time.sisters import turned

# Records of a chunk at which stored energies are evaluated.
_SAMPLES = 4
_ROUNDING = 1e-9


@dataclass
class LedgerBook:
    """Collects the ledger chunk by chunk."""

    system: LocalSystem
    h: float
    start: MotionState
    damping_rows: np.ndarray
    table: list[np.ndarray] = field(default_factory=list)
    # What must be known to go on: energy spent in dampers, and time and power of the last record.
    sums: tuple[float, float, float] | None = None

    def __post_init__(self) -> None:
        s = self.system
        K = sp.csc_array(0.5 * (s.K + s.K.T))
        self._stiffness = K
        # Powers v^T A w, w = v or q, of damping and of forces that circulate: A and unit rows over the dofs that it touches.
        self._powers: list[tuple[np.ndarray, np.ndarray, str]] = []
        for matrix, kind in ((0.5 * (s.D + s.D.T), "v"), (s.K - K, "q")):
            A = sp.csc_array(matrix)
            A.eliminate_zeros()
            touched = np.unique(np.concatenate([A.tocoo().row, A.tocoo().col]))
            if touched.size:
                self._powers.append((A[touched][:, touched].toarray(), np.eye(s.n)[touched], kind))
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
        power = np.zeros(records.t.size)
        for A, rows, kind in self._powers:
            v = records.rows("v", rows)
            w = v if kind == "v" else records.rows("q", rows)
            power = power + np.einsum("ri,ri->r", v, w @ A.T)
        now = records.system
        if now.changes is not None:
            # Planets that go round exchange with their turn what their stiffness and load have changed since the start.
            grown = sp.csc_array(now.K - self.system.K)
            touched = np.unique(np.concatenate([np.flatnonzero(now.load != self.system.load), *grown.tocoo().coords]))
            rows = np.eye(self.system.n)[touched]
            v, q = (records.rows(kind, rows) for kind in "vq")
            pushed = q @ grown[touched][:, touched].T - (now.load - self.system.load)[touched]
            power = power + np.einsum("ri,ri->r", v, pushed)
        if len(self.damping_rows):
            power = power + np.sum(records.rows("v", self.damping_rows) ** 2, axis=1)
        before, t0, p0 = self.sums or (0.0, 0.0, power[0])
        steps = np.diff(records.t, prepend=t0)
        spent = before + np.cumsum(steps * 0.5 * (power + np.concatenate([[p0], power[:-1]])))
        self.sums = (float(spent[-1]), float(records.t[-1]), float(power[-1]))
        which = np.unique(np.linspace(0, records.t.size - 1, _SAMPLES + 1).astype(int)[1:])
        q = records.rows("q", self._all, which)
        v = records.rows("v", self._all, which)
        kinetic, strain = self._stored(q, v)
        laws = records.energy[which].sum(axis=1)
        work = q @ self.system.load - self._work_at_start
        columns = (records.t[which], kinetic, strain, laws[:, 0], work, laws[:, 1], spent[which] + laws[:, 2])
        self.table.append(np.column_stack(columns))

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


_STATE = ("q", "v", "a", "F", "before", "d", "sums", "last", "events")
_TABLES = ("t", "d", "watched", "F", "values")


@dataclass
class Histories:
    """What one integration gave: tables chunk by chunk, and the state at its end."""

    state: MotionState
    h: float
    status: str = "success"
    parts: list[dict[str, np.ndarray]] = field(default_factory=list)
    ledger: EnergyLedger | None = None
    motion: list[tuple[np.ndarray, np.ndarray]] = field(default_factory=list)

    def table(self, name: str) -> np.ndarray:
        """All records of "t", "d", "watched", "F" or "values"."""
        return np.concatenate([part[name] for part in self.parts])


def run_task(
    task: Task,
    integrator: Integrator,
    grid: Grid,
    progress: Progress,
    *,
    stream: Stream | None = None,
    text: str = "",
    key: str = "",
    frames: int = 0,
) -> Histories:
    """Integrate from rest over a grid; a run that stops early keeps what it has and says why in `status`.

    Args:
        task: the model made ready. integrator: the method. progress: is told fraction and step.
        grid: steps and records; contact events and statistics are counted anew from the first record that counts.
        stream: keeps chunks while the run goes on. key: settings of the method, which tell another run from this one.
        text: names a run that only serves another one: it does not go on after an interruption, and keeps the records that count.
        frames: number of records at the end that keep all displacements.
    """
    local = task.local.local
    h = grid.spacing / grid.every
    steps = grid.records * grid.every
    boundary = grid.settled * grid.every
    state = state_at_rest(local, h, task.begin)
    found = Histories(state, h)
    book = LedgerBook(local, h, state.copy(), integrator.damping_rows(local, float(local.rotation.speeds[0])))
    if stream is not None:
        sizes = (
            f"{h!r} {grid.records} {grid.every} {grid.settled} {grid.kept} {local.n} {local.watched_vectors.shape[1]}"
        )
        rotation = f"{local.rotation.times.tolist()} {local.rotation.speeds.tolist()}"
        settings = {"model": model_hash(task.local.system.model), "run": f"{sizes} {integrator.name} {key} {rotation}"}
        for chunk in stream.begin(settings):
            _take_over(chunk, found, book)
    watched = np.ascontiguousarray(local.watched_vectors.T)

    def told(_: float, step: str) -> None:
        progress(state.step / steps, f"{text}: {step}" if text else step)

    def receive(records: Records, state: MotionState) -> None:
        seen = [records.rows("q", watched), task.channels.values(records)]
        if local.seen_sisters.planets.size:
            # Planets that go round are told where they are.
            moved = turned(local.seen_sisters, local.rotation.angle(records.t), np.hstack(seen))
            seen = np.split(moved, [len(watched)], axis=1)
        part = {"t": records.t, "d": records.d, "watched": seen[0], "F": records.F, "values": seen[1]}
        if text and found.parts and found.state.step <= boundary:
            # Of what does not count nobody asks.
            del found.parts[:]
        if grid.kept > 1:
            # Counted from the end, so that the last record is one of those that are kept.
            kept = (grid.records - np.rint(records.t / grid.spacing).astype(int)) % grid.kept == 0
            part = {name: x[kept] for name, x in part.items()}
        last = records.t > (steps - frames * grid.every + 0.5) * h
        if frames and last.any():
            found.motion.append((records.t[last], records.rows("q", np.eye(local.n), last)))
        before = len(book.table)
        book.add(records)
        found.parts.append(part)
        if state.step == boundary:
            state.count_anew()
        if stream is not None:
            rows = np.vstack([np.zeros((0, 7)), *book.table[before:]])
            sums = np.array(book.sums or (0.0, 0.0, 0.0))
            stream.write({**part, "ledger": rows, "spent": sums, **state_arrays(state)})

    # The run stops at the end of settling too, so that events are counted from there.
    for goal in sorted({boundary, steps}):
        if not 0 < goal <= steps or state.step >= goal:
            continue
        try:
            run(local, integrator, Schedule(h, goal, grid.every), state, receive, progress=told)
        except ConvergenceError as error:
            found.status = str(error)
            break
        except KeyboardInterrupt:
            if text:
                raise
            found.status = f"interrupted after {state.step} of {steps} steps"
            break
    if state.step < boundary:
        # Nothing counts yet: what was gathered while settling is no statistic.
        state.count_anew()
    if not any(part["t"].size for part in found.parts):
        raise ConvergenceError(found.status)
    found.ledger = book.close()
    return found


def _take_over(chunk: dict[str, np.ndarray], found: Histories, book: LedgerBook) -> None:
    """Go on from a chunk that an interrupted run has left."""
    state = found.state
    found.parts.append({name: chunk[name] for name in _TABLES})
    if chunk["ledger"].size:
        book.table.append(chunk["ledger"])
    book.sums = tuple(chunk["spent"].tolist())
    state.step = int(chunk["state step"])
    for name in _STATE:
        setattr(state, name, chunk[f"state {name}"].copy())
    state.gathered = Gathered(*(chunk[f"gathered {name}"].copy() for name in Gathered._fields))
    state.inner = {name.removeprefix("inner "): x.copy() for name, x in chunk.items() if name.startswith("inner ")}


def state_arrays(state: MotionState) -> dict[str, np.ndarray]:
    """A state as arrays, for a stream."""
    plain = {f"state {name}": getattr(state, name) for name in _STATE}
    gathered = {f"gathered {name}": value for name, value in state.gathered._asdict().items()}
    inner = {f"inner {name}": value for name, value in state.inner.items()}
    return {"state step": np.array(state.step), **plain, **gathered, **inner}
