"""One integration of a local model: its histories and ledger, kept in memory and, if wished, streamed chunk by chunk."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from rotorgear.analysis.transient.channels import Channels
from rotorgear.analysis.transient.energy_ledger import LedgerBook
from rotorgear.errors import ConvergenceError
from rotorgear.progress import Progress, silent
from rotorgear.results.transient import EnergyLedger
from rotorgear.solvers.time.arguments import Gathered
from rotorgear.solvers.time.local_system import Integrator, LocalSystem, Records, State
from rotorgear.solvers.time.run import Schedule, run

_STATE = ("q", "v", "a", "F", "before", "d", "sums", "last", "events")
_TABLES = ("t", "d", "watched", "F", "values")


class Stream(Protocol):
    """Where a run writes its chunks, and from where an interrupted run continues."""

    def begin(self, settings: dict[str, str]) -> list[dict[str, np.ndarray]]:
        """Say what is run; returns the chunks that are there already of the same run, all or none."""

    def write(self, chunk: dict[str, np.ndarray]) -> None:
        """Keep a chunk, whole or not at all."""


@dataclass
class Histories:
    """What one integration gave: tables chunk by chunk, and the state at its end."""

    state: State
    h: float
    status: str = "success"
    steps: int = 0
    parts: list[dict[str, np.ndarray]] = field(default_factory=list)
    ledger: EnergyLedger | None = None
    motion: list[tuple[np.ndarray, np.ndarray]] = field(default_factory=list)

    def table(self, name: str) -> np.ndarray:
        """All records of "t", "d", "watched", "F" or "values"."""
        return np.concatenate([part[name] for part in self.parts])


def integrate(
    local: LocalSystem,
    integrator: Integrator,
    schedule: Schedule,
    start: State,
    wanted: Channels,
    settled: int,
    *,
    stream: Stream | None = None,
    settings: dict[str, str] | None = None,
    frames: int = 0,
    tolerance: float = 1e-10,
    progress: Progress = silent,
) -> Histories:
    """Integrate from the start state; a run that stops early keeps what it has and says why in `status`.

    Args:
        frames: so many records at the end keep all displacements.
        settled: records before the statistics count; contact events and statistics are counted anew from there.
    """
    state = start.copy()
    found = Histories(state, schedule.h)
    book = LedgerBook(local, schedule.h, start, integrator.damping_rows(local, float(local.rotation.speeds[0])))
    for chunk in stream.begin(settings or {}) if stream else []:
        _take(found, book, chunk)
    boundary = settled * schedule.every
    watched = np.ascontiguousarray(local.watched_vectors.T)

    def receive(records: Records, state: State) -> None:
        part = {
            "t": records.t,
            "d": records.d,
            "watched": records.fields.rows("q", watched),
            "F": records.F,
            "values": wanted.values(records.fields, records.F),
        }
        last = records.t > (schedule.steps - frames * schedule.every + 0.5) * schedule.h
        if frames and last.any():
            found.motion.append((records.t[last], records.fields.chosen(last).rows("q", np.eye(local.n))))
        before = len(book.table)
        book.add(records)
        found.parts.append(part)
        if state.step == boundary:
            state.count_anew()
        if stream is not None:
            rows = np.vstack([np.zeros((0, 7)), *book.table[before:]])
            stream.write({**part, "ledger": rows, "spent": np.array(book.sums()), **state_arrays(state)})

    # The run stops at the end of settling too, so that events are counted from there.
    for goal in sorted({boundary, schedule.steps}):
        if not 0 < goal <= schedule.steps or state.step >= goal:
            continue
        try:
            cost = run(
                local,
                integrator,
                Schedule(schedule.h, goal, schedule.every),
                state,
                receive,
                tolerance=tolerance,
                progress=progress,
            )
            found.steps += cost.steps
        except ConvergenceError as error:
            found.status = str(error)
            break
        except KeyboardInterrupt:
            found.status = f"interrupted after {state.step} of {schedule.steps} steps"
            break
    if state.step < boundary:
        # Nothing counts yet: what was gathered while settling is no statistic.
        state.count_anew()
    if not any(part["t"].size for part in found.parts):
        raise ConvergenceError(found.status)
    found.ledger = book.close()
    return found


def state_arrays(state: State) -> dict[str, np.ndarray]:
    """A state as arrays, for a stream."""
    plain = {f"state {name}": getattr(state, name) for name in _STATE}
    gathered = {f"gathered {name}": value for name, value in state.gathered._asdict().items()}
    inner = {f"inner {name}": value for name, value in state.inner.items()}
    return {"state step": np.array(state.step), **plain, **gathered, **inner}


def _take(found: Histories, book: LedgerBook, chunk: dict[str, np.ndarray]) -> None:
    """Take over a chunk of an interrupted run, with the state at its end."""
    found.parts.append({name: chunk[name] for name in _TABLES})
    if chunk["ledger"].size:
        book.table.append(chunk["ledger"])
    book.set_sums(chunk["spent"])
    state = found.state
    state.step = int(chunk["state step"])
    for name in _STATE:
        setattr(state, name, chunk[f"state {name}"].copy())
    state.gathered = Gathered(*(chunk[f"gathered {name}"].copy() for name in Gathered._fields))
    state.inner = {name.removeprefix("inner "): x.copy() for name, x in chunk.items() if name.startswith("inner ")}
